/* Evaluates, parses and writes a curve of few points that is interpolated over the logarithm of x,
 * such as a Murray exponent that depends on the radius.
 *
 * On a logarithmic scale, radii of 0.1 and 1 mm are as far apart as radii of 1 and 10 mm. So are
 * the levels of such vessels in a tree. A curve has few points, so a linear search finds those
 * around x. */
#include "base/logcurve.h"

#include "base/elementary.h"
#include "base/number.h"
#include <math.h>
#include <string.h>

double logcurve_at(const LogCurve *curve, double x)
{
    size_t k = 0;
    while (k < curve->n && curve->n > 1 && x > curve->argument[k])
        k++;
    if (k == 0 || k == curve->n)
        return curve->value[k == 0 ? 0 : k - 1];
    double low = curve->argument[k - 1],
           part = elementary_log(x / low) / elementary_log(curve->argument[k] / low);
    return curve->value[k - 1] + part * (curve->value[k] - curve->value[k - 1]);
}

bool logcurve_is_same(const LogCurve *a, const LogCurve *b)
{
    bool same = a->n == b->n;
    for (size_t k = 0; same && k < a->n; k++)
        same = a->value[k] == b->value[k] && (a->n == 1 || a->argument[k] == b->argument[k]);
    return same;
}

/* Returns true if all values of the curve are in `range`. */
static bool logcurve_is_within(const LogCurve *curve, Range range)
{
    bool within = true;
    for (size_t k = 0; within && k < curve->n; k++)
        within = range_has(range, curve->value[k]);
    return within;
}

/* Parses one X:Y pair at *at, and moves *at behind it. */
static bool take_point(const char **at, LogCurve *curve)
{
    size_t k = curve->n;
    if (k == LOGCURVE_MAX_POINTS || !number_take(at, &curve->argument[k]) || *(*at)++ != ':' ||
        !number_take(at, &curve->value[k]))
        return false;
    curve->n++;
    return curve->argument[k] > (k > 0 ? curve->argument[k - 1] : 0);
}

static bool parse_points(const char *chars, LogCurve *curve)
{
    do {
        if (!take_point(&chars, curve))
            return false;
    } while (*chars++ == ',');
    return chars[-1] == '\0';
}

bool logcurve_parse(const char *chars, Range range, LogCurve *out)
{
    LogCurve made = {.n = 0};
    bool read = false;
    if (strchr(chars, ':')) {
        read = parse_points(chars, &made);
    } else {
        made.n = 1;
        read = number_parse(chars, &made.value[0]);
    }
    if (!read || !logcurve_is_within(&made, range))
        return false;
    *out = made;
    return true;
}

void text_logcurve(Text *text, const LogCurve *curve)
{
    for (size_t k = 0; k < curve->n; k++) {
        text_puts(text, k > 0 ? "," : "");
        if (curve->n > 1) {
            text_number(text, curve->argument[k]);
            text_puts(text, ":");
        }
        text_number(text, curve->value[k]);
    }
}
