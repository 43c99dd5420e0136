/* Affine arithmetic over a rectangle of the picture: numbers with a proven error bound.
 *
 * The points of the rectangle have coordinates ex and ey in [-1, 1]. A Form encloses a quantity
 * that varies over the rectangle: at each point, the quantity is in [v - e, v + e], where v = c + x
 * ex + y ey. A form with x = y = 0 is a constant. If the rectangle is a single point (one ray), all
 * forms are constants.
 *
 * Rounding: IEEE 754 bounds the error of each operation by U times its result, U = 2^-53. Each
 * function adds two terms to e. The first is U times an upper bound of the sum of the magnitudes of
 * all numbers that the function rounds. The factors 2, 4, 8 and 16 before such sums count the
 * operations, rounded up; docs/ANSWERS.md, section 3, derives them. The second term is FORM_TINY,
 * which bounds underflow. The computation of e itself also rounds: e is a sum of fewer than 30
 * terms, none of them negative, so a factor of 1 + 64 U covers this rounding.
 *
 * An error may be infinite or NaN: the form then encloses every number. A comparison with NaN is
 * false; comparisons are written so that false proves nothing. */
#ifndef CORCAST_ANSWER_AFFINE_H
#define CORCAST_ANSWER_AFFINE_H

#include "base/base.h"
#include <math.h>
#include <stdbool.h>

#define FORM_U 0x1p-53   /* relative rounding error of an operation on doubles */
#define FORM_TINY 1e-300 /* more than the errors of underflow in one function */

typedef struct Form {
    double c, x, y, e; /* e >= 0 */
} Form;

/* A vector whose components are forms. */
typedef struct Form3 {
    Form x, y, z;
} Form3;

/* Returns the constant form of the number `c`, whose error is at most `e` >= 0. */
static inline Form form_of(double c, double e)
{
    return (Form){c, 0, 0, e};
}

static inline bool form_is_constant(Form f)
{
    return f.x == 0 && f.y == 0;
}

/* Returns an upper bound of |c + x ex + y ey| over the rectangle, without e. */
static inline double form_span(Form f)
{
    return fabs(f.c) + fabs(f.x) + fabs(f.y);
}

/* Return the lower and the upper bound of the quantity over the rectangle, including e. */
static inline double form_low(Form f)
{
    const double low = f.c - (fabs(f.x) + fabs(f.y) + f.e) * (1 + 8 * FORM_U);
    return low - 4 * FORM_U * fabs(low) - FORM_TINY;
}

static inline double form_high(Form f)
{
    const double high = f.c + (fabs(f.x) + fabs(f.y) + f.e) * (1 + 8 * FORM_U);
    return high + 4 * FORM_U * fabs(high) + FORM_TINY;
}

/* Returns an upper bound of the quantity's magnitude over the rectangle, including e. */
static inline double form_most(Form f)
{
    return (form_span(f) + f.e) * (1 + 8 * FORM_U) + FORM_TINY;
}

/* Returns f with rounding errors added to e. `rounded` is a bound of the sum of the magnitudes of
 * all numbers that were rounded. */
static inline Form form_rounded(Form f, double rounded)
{
    f.e = (f.e + FORM_U * rounded + FORM_TINY) * (1 + 64 * FORM_U);
    return f;
}

static inline Form form_neg(Form f)
{
    return (Form){-f.c, -f.x, -f.y, f.e};
}

static inline Form form_add(Form a, Form b)
{
    const Form sum = {a.c + b.c, a.x + b.x, a.y + b.y, a.e + b.e};
    return form_rounded(sum, form_span(sum));
}

static inline Form form_sub(Form a, Form b)
{
    return form_add(a, form_neg(b));
}

/* Returns f times an exact number. */
static inline Form form_scale(Form f, double by)
{
    const Form product = {f.c * by, f.x * by, f.y * by, f.e * fabs(by)};
    return form_rounded(product, form_span(product));
}

/* Returns the product of two varying forms. The product has terms in ex^2 and ey^2, which are in
 * [0, 1], that is, 0.5 +- 0.5. Half of the coefficient of such a term therefore goes into c, and
 * half into e. */
static inline Form form_mul_varying(Form a, Form b)
{
    const double xx = a.x * b.x, yy = a.y * b.y, xy = a.x * b.y + a.y * b.x;
    const double span_a = form_span(a), span_b = form_span(b);
    const Form product = {a.c * b.c + 0.5 * (xx + yy), a.c * b.x + a.x * b.c, a.c * b.y + a.y * b.c,
                          0.5 * (fabs(xx) + fabs(yy)) + fabs(xy) + a.e * (span_b + b.e) +
                              b.e * span_a};
    return form_rounded(product, 8 * span_a * span_b);
}

/* Returns the product of a form `a` and a constant form `b`. */
static inline Form form_mul_constant(Form a, Form b)
{
    const double factor = fabs(b.c), span = form_span(a);
    const Form product = {a.c * b.c, a.x * b.c, a.y * b.c, a.e * (factor + b.e) + b.e * span};
    return form_rounded(product, 2 * factor * span);
}

static inline __attribute__((always_inline)) Form form_mul(Form a, Form b)
{
    return form_is_constant(b)   ? form_mul_constant(a, b)
           : form_is_constant(a) ? form_mul_constant(b, a)
                                 : form_mul_varying(a, b);
}

/* Returns a form that encloses g(f), for a function g whose graph over the range of f is in a
 * strip: slope t + bottom <= g(t) <= slope t + top for all t in this range. */
static inline Form form_line(Form f, double slope, double bottom, double top)
{
    const double offset = 0.5 * (bottom + top);
    const Form line = {slope * f.c + offset, slope * f.x, slope * f.y,
                       fabs(slope) * f.e + 0.5 * fabs(top - bottom)};
    return form_rounded(line, 4 * (fabs(slope) * form_span(f) + fabs(bottom) + fabs(top)));
}

/* Returns sqrt(f). The result is valid only at points of the rectangle where f >= 0. It is the
 * constant 0 if f <= 0 everywhere. */
static inline Form form_sqrt(Form f)
{
    const double low = form_low(f), high = form_high(f);
    if (high <= 0)
        return form_of(0, 0);
    const double s = low > 0 ? sqrt(low) * (1 - 4 * FORM_U) : 0, t = sqrt(high) * (1 + 4 * FORM_U);
    const double slope = 1 / (s + t), chord = s * t * slope;
    return form_rounded(form_line(f, slope, chord, chord + (t - s) * (t - s) * 0.25 * slope),
                        8 * (t + fabs(slope) * form_most(f)));
}

/* Returns 1 / f. The error of the result is infinite if f may be 0. */
static inline Form form_inverse(Form f)
{
    double low = form_low(f), high = form_high(f);
    if (high < 0)
        return form_neg(form_inverse(form_neg(f)));
    if (!(low > 0))
        return form_of(0, (double)INFINITY);
    const double slope = -1 / (low * high), top = (low + high) * -slope;
    return form_rounded(form_line(f, slope, 2 * sqrt(-slope), top),
                        16 * (top + fabs(slope) * high));
}

/* Returns a form that encloses both a and b. */
static inline Form form_hull(Form a, Form b)
{
    const Form mean = {0.5 * (a.c + b.c), 0.5 * (a.x + b.x), 0.5 * (a.y + b.y),
                       0.5 * (fabs(a.c - b.c) + fabs(a.x - b.x) + fabs(a.y - b.y)) +
                           fmax(a.e, b.e)};
    return form_rounded(mean, 2 * (form_span(a) + form_span(b)));
}

/* Returns max(f, 0). */
static inline Form form_positive(Form f)
{
    const double low = form_low(f), high = form_high(f);
    if (low >= 0)
        return f;
    if (!(high > 0))
        return high <= 0 ? form_of(0, 0) : f;
    /* max(t, 0) is convex: it is below its chord, and above the line through 0 with the chord's
     * slope. */
    const double slope = high / (high - low);
    return form_rounded(form_line(f, slope, 0, -low * slope), 8 * (high - low));
}

/* Returns an enclosure of a quantity that f encloses and that is known to be in [low, high]:
 *
 * e not finite   the constant form of [low, high]
 * e > |x| + |y|  the constant form of the intersection of [low, high] and the range of f, because
 *                the slopes of f matter little
 * else           f, because a constant would lose the slopes
 *
 * If the range of f is inside [low, high], the result is f in every case. */
static inline Form form_known(Form f, double low, double high)
{
    if (form_low(f) >= low && form_high(f) <= high)
        return f;
    if (fabs(f.x) + fabs(f.y) < f.e && isfinite(f.e)) { /* the slopes matter little */
        const double from = fmax(form_low(f), low), to = fmin(form_high(f), high);
        return form_rounded(form_of(0.5 * (from + to), 0.5 * fabs(to - from)),
                            fabs(from) + fabs(to));
    }
    return isfinite(f.e) ? f : form_of(0.5 * (low + high), 0.5 * (high - low));
}

/* Returns max(f, 0) to the power `exponent` > 0. Requires f <= 1 up to rounding, as for the cosine
 * of an angle. */
Form form_power(Form f, double exponent);

/* ---- vectors --------------------------------------------------------------------------------- */

static inline Form3 form3_of(double x, double y, double z)
{
    return (Form3){form_of(x, 0), form_of(y, 0), form_of(z, 0)};
}

static inline Form3 form3_neg(Form3 a)
{
    return (Form3){form_neg(a.x), form_neg(a.y), form_neg(a.z)};
}

static inline Form3 form3_add(Form3 a, Form3 b)
{
    return (Form3){form_add(a.x, b.x), form_add(a.y, b.y), form_add(a.z, b.z)};
}

static inline Form3 form3_sub(Form3 a, Form3 b)
{
    return (Form3){form_sub(a.x, b.x), form_sub(a.y, b.y), form_sub(a.z, b.z)};
}

static inline Form3 form3_mul(Form3 a, Form by)
{
    return (Form3){form_mul(a.x, by), form_mul(a.y, by), form_mul(a.z, by)};
}

static inline bool form3_is_constant(Form3 a)
{
    return form_is_constant(a.x) && form_is_constant(a.y) && form_is_constant(a.z);
}

/* Returns the dot product of a and a constant vector b as one sum: three products per coefficient,
 * each of which is rounded at most three times. */
static inline __attribute__((always_inline)) Form form3_dot_constant(Form3 a, Form3 b)
{
    const double bx = fabs(b.x.c), by = fabs(b.y.c), bz = fabs(b.z.c);
    const double ax = form_span(a.x), ay = form_span(a.y), az = form_span(a.z);
    const Form dot = {a.x.c * b.x.c + a.y.c * b.y.c + a.z.c * b.z.c,
                      a.x.x * b.x.c + a.y.x * b.y.c + a.z.x * b.z.c,
                      a.x.y * b.x.c + a.y.y * b.y.c + a.z.y * b.z.c,
                      a.x.e * (bx + b.x.e) + a.y.e * (by + b.y.e) + a.z.e * (bz + b.z.e) +
                          ax * b.x.e + ay * b.y.e + az * b.z.e};
    return form_rounded(dot, 4 * (ax * bx + ay * by + az * bz));
}

static inline __attribute__((always_inline)) Form form3_dot(Form3 a, Form3 b)
{
    if (form3_is_constant(b))
        return form3_dot_constant(a, b);
    if (form3_is_constant(a))
        return form3_dot_constant(b, a);
    return form_add(form_add(form_mul(a.x, b.x), form_mul(a.y, b.y)), form_mul(a.z, b.z));
}

static inline Form3 form3_cross(Form3 a, Form3 b)
{
    return (Form3){form_sub(form_mul(a.y, b.z), form_mul(a.z, b.y)),
                   form_sub(form_mul(a.z, b.x), form_mul(a.x, b.z)),
                   form_sub(form_mul(a.x, b.y), form_mul(a.y, b.x))};
}

/* Returns the length of a. */
static inline Form form3_length(Form3 a)
{
    return form_sqrt(form3_dot(a, a));
}

/* Returns a / length of a. The errors are infinite if a may be 0 at a point of the rectangle. */
static inline Form3 form3_unit(Form3 a)
{
    return form3_mul(a, form_inverse(form3_length(a)));
}

#endif
