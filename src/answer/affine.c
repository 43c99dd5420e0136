/* Computes the power of a form. max(v, 0)^n is convex for n >= 1: it lies below its chord and, over
 * an interval, above the tangent at any of its points. The tangent at the middle has nearly the
 * slope of the chord; the difference of the slopes times half the width makes up for it. */
#include "answer/affine.h"

/* Bounds the error of elementary_pow, relative, with room for the roundings around it. */
static const double power_error = 8 * FORM_U;
/* Powers below this bound, as those far from a highlight, need no slope. */
static const double negligible = 1e-12;

Form form_power(Form f, double exponent)
{
    const double low = fmax(form_low(f), 0), high = form_high(f);
    if (!(high > 0))
        return high <= 0 ? form_of(0, 0) : form_of(0.5, (double)INFINITY);
    const double top = elementary_pow(high, exponent) * (1 + power_error) + FORM_TINY;
    if (top < negligible)
        return form_rounded(form_of(0.5 * top, 0.5 * top), top);
    const double bottom = low > 0 ? elementary_pow(low, exponent) * (1 - power_error) : 0;
    if (high - low < 1e-9 || exponent < 1 || !isfinite(high) || form_low(f) < -high)
        return form_rounded(form_of(0.5 * (bottom + top), 0.5 * (top - bottom)),
                            2 * (bottom + top));
    /* Where f may be negative, the function is 0 there, and still convex. */
    const double from = form_low(f), middle = 0.5 * (from + high), width = high - from;
    const double slope = (top - bottom) / width,
                 chord = fmax(top - slope * high, bottom - slope * from);
    const double at = middle > 0 ? elementary_pow(middle, exponent) * (1 - power_error) : 0;
    const double tangent = middle > 0 ? exponent * at / middle : 0;
    const double low_line = at - slope * middle - 0.5 * width * fabs(tangent - slope);
    return form_rounded(form_line(f, slope, low_line, chord),
                        64 * (top + slope * (fabs(from) + high) + 0.5 * width * tangent));
}
