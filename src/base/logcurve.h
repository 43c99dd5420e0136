/* A function y(x), x > 0, given by points (x, y), such as Murray's exponent as a function of the
 * parent's radius. Between two points, y is linear in log x. Beyond the first and the last point, y
 * is constant. As text, a curve is a number, "3", or a list of X:Y pairs, "0.05:3,1:2.2".
 *
 *     LogCurve gamma;
 *     if (logcurve_parse("0.05:3,1:2.2", range, &gamma))
 *         y = logcurve_at(&gamma, radius_mm); */
#ifndef CORCAST_BASE_LOGCURVE_H
#define CORCAST_BASE_LOGCURVE_H

#include "base/range.h"
#include "base/text.h"
#include <stdbool.h>
#include <stddef.h>

enum { LOGCURVE_MAX_POINTS = 16 };

/* A curve. It owns nothing. */
typedef struct LogCurve {
    size_t n; /* number of points, at most LOGCURVE_MAX_POINTS; 1: a constant; 0: unknown */
    /* x of the points: above 0 and increasing; unused if n is 1 */
    double argument[LOGCURVE_MAX_POINTS];
    double value[LOGCURVE_MAX_POINTS]; /* y of the points */
} LogCurve;

/* Returns the curve that has one value everywhere. */
static inline LogCurve logcurve_constant(double value)
{
    return (LogCurve){.n = 1, .value = {value}};
}

/* Returns y at x, which must be above 0. The curve must have n >= 1. Cost: O(n). */
double logcurve_at(const LogCurve *curve, double x);

/* Returns true if both curves have the same points. */
bool logcurve_is_same(const LogCurve *a, const LogCurve *b);

/* Parses the whole string `chars` as a curve with values in `range`. Returns false, and leaves *out
 * unchanged, if the string is not such a curve. */
bool logcurve_parse(const char *chars, Range range, LogCurve *out);
/* Appends the curve as text that logcurve_parse converts back to the same curve. */
void text_logcurve(Text *text, const LogCurve *curve);

#endif
