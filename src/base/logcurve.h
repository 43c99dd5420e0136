/* A number that depends on another number, such as Murray's exponent on the parent's radius. The
 * curve has values at some places; between two places the value is linear in the logarithm of the
 * place, and outside it is constant. As text, a curve is a number, "3", or a list of PLACE:VALUE
 * pairs, "0.05:3,1:2.2". */
#ifndef CORCAST_BASE_LOGCURVE_H
#define CORCAST_BASE_LOGCURVE_H

#include "base/range.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>

enum { LOGCURVE_MOST_POINTS = 16 };

typedef struct LogCurve {
    size_t n; /* number of points, at most LOGCURVE_MOST_POINTS; 1: a constant; 0: unknown */
    double place[LOGCURVE_MOST_POINTS]; /* above 0 and increasing; unused if n is 1 */
    double value[LOGCURVE_MOST_POINTS];
} LogCurve;

/* Returns the curve that has one value everywhere. */
static inline LogCurve logcurve_constant(double value)
{
    return (LogCurve){.n = 1, .value = {value}};
}

/* Returns the value at `place`, which must be above 0. The curve must have n >= 1. Cost: O(n). */
double logcurve_at(const LogCurve *curve, double place);

/* Returns true if both curves have the same points. */
bool logcurve_is_same(const LogCurve *a, const LogCurve *b);
/* Returns true if all values of the curve are in `range`. */
bool logcurve_is_within(const LogCurve *curve, Range range);

/* Parses the whole string `chars` as a curve with values in `range`. Returns false, and leaves *out
 * unchanged, if the string is not such a curve. */
bool logcurve_parse(const char *chars, Range range, LogCurve *out);
/* Appends the curve as text that logcurve_parse converts back to the same curve. */
void text_logcurve(Text *text, const LogCurve *curve);

#endif
