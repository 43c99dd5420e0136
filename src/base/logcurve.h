/* A number that follows another one: given at some places, in between linear in the logarithm of
 * the place, constant outside. As text a number, "3", or PLACE:VALUE pairs, "0.05:3,1:2.2". */
#ifndef CORCAST_BASE_LOGCURVE_H
#define CORCAST_BASE_LOGCURVE_H

#include "base/range.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>

enum { LOGCURVE_MOST_POINTS = 16 };

typedef struct LogCurve {
    size_t n; /* at most LOGCURVE_MOST_POINTS; 1: it is constant; 0: unknown */
    double place[LOGCURVE_MOST_POINTS]; /* above 0, rising; of a constant, not looked at */
    double value[LOGCURVE_MOST_POINTS];
} LogCurve;

static inline LogCurve logcurve_constant(double value)
{
    return (LogCurve){.n = 1, .value = {value}};
}

/* The value at a place above 0, of a curve with points. O(points). */
double logcurve_at(const LogCurve *curve, double place);

bool logcurve_is_same(const LogCurve *a, const LogCurve *b);
/* Whether all values are in the range. */
bool logcurve_is_within(const LogCurve *curve, Range range);

/* Reads the whole of `chars`, values in the range, into *out; false, with *out unchanged, when that
 * is no curve. */
bool logcurve_parse(const char *chars, Range range, LogCurve *out);
/* Appends the text that logcurve_parse reads back to the same curve. */
void text_logcurve(Text *text, const LogCurve *curve);

#endif
