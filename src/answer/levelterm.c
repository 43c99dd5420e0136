/* The axes of terms along single rays, and the terms of the potential. Lengths of a term are in its
 * own unit. For the potential this is 1 / k = radius / sqrt2, where the term is exp(-q) (erf(u) +
 * erf(v)) / 2: q is the squared distance from the axis line, u and v are the distances from the two
 * ends, positive inwards. Along a ray q is a polynomial of degree 2, and u and v are linear. They
 * are expanded about the point of the ray nearest to the axis, so that a distant camera costs no
 * digits.
 *
 * The choice of the terms of a ray, and the windows of terms, are computed in plain doubles and
 * widened by far more than their rounding errors. Everything else has a proven error. */
#include "answer/levelterm.h"

#include <math.h>

/* Widening of distances that are computed in plain doubles, relative and in the term's unit. */
static const double widening = 1e-6;
/* Errors of elementary_exp, at most 0.51 ulp of a result of at most 1, and of elementary_erf, 5
 * ulp, with room for the roundings around them. */
static const double exp_error = 4 * FORM_U, erf_error = 12 * FORM_U;
static const double inv_sqrt_pi = 0.56418958354775628695;

/* ---- axes ------------------------------------------------------------------------------------ */

static Vec3 middle_of(Form3 v)
{
    return vec3(v.x.c, v.y.c, v.z.c);
}

/* Sets term->distance.middle, the point of the ray nearest to the axis. Returns false if the ray
 * surely passes the axis at more than `reach` mm. */
static bool pass_axis(const LevelAxis *axis, double reach, const Beam *ray, LevelTerm *term)
{
    const Vec3 line = middle_of(axis->axis), unit = middle_of(ray->unit);
    const Vec3 to_start = vec3_sub(middle_of(axis->start), middle_of(ray->origin));
    const double cosine = vec3_dot(line, unit), sine2 = fmax(1 - cosine * cosine, 1e-14);
    double along = (cosine * vec3_dot(to_start, unit) - vec3_dot(to_start, line)) / sine2;
    along = fmin(fmax(along, 0), axis->length.c);
    const Vec3 to_axis = vec3_add_scaled(to_start, line, along);
    term->distance.middle = vec3_dot(to_axis, unit);
    const Vec3 apart = vec3_add_scaled(to_axis, unit, -term->distance.middle);
    return vec3_dot(apart, apart) <= reach * reach * (1 + widening);
}

/* Sets the polynomials of a term; distance.middle must be set. */
static void set_polynomials(const LevelAxis *axis, const Beam *ray, LevelTerm *term)
{
    const Form k = axis->unit;
    const Form k2 = form_mul(k, k);
    const Form3 from = form3_add(form3_sub(ray->origin, axis->start),
                                 form3_mul(ray->unit, form_of(term->distance.middle, 0)));
    const Form along = form3_dot(from, axis->axis), rate = form3_dot(ray->unit, axis->axis);
    term->across = form3_sub(from, form3_mul(axis->axis, along));
    term->across_rate = form3_sub(ray->unit, form3_mul(axis->axis, rate));
    term->distance.square[0] = form_mul(k2, form3_dot(term->across, term->across));
    term->distance.square[1] = form_mul(k2, form3_dot(term->across, term->across_rate));
    term->distance.square[2] = form_mul(k2, form3_dot(term->across_rate, term->across_rate));
    term->along[0] = form_mul(k, along);
    term->along[1] = form_mul(k, rate);
    term->before = form_mul(k, form_sub(axis->length, along));
}

/* Narrows the range to the zeta with low <= start + rate zeta <= high, in plain doubles. Does
 * nothing if rate is about 0. */
static void narrow(double start, double rate, double low, double high, double range[2])
{
    if (fabs(rate) < 1e-12)
        return;
    const double a = (low - start) / rate, b = (high - start) / rate;
    range[0] = fmax(range[0], fmin(a, b));
    range[1] = fmin(range[1], fmax(a, b));
}

void levelterm_interval(const LevelTerm *term, double w, double x, double *from, double *to)
{
    double range[2] = {-(double)INFINITY, (double)INFINITY};
    const double rate = sqrt(fmax(term->distance.square[2].c, 0));
    const double start = rate > 1e-12 ? term->distance.square[1].c / rate : 0;
    w += widening * (1 + w);
    x += widening * (1 + x);
    narrow(start, rate, -w, w, range);
    narrow(term->along[0].c, term->along[1].c, -x, term->along[0].c + term->before.c + x, range);
    *from = term->distance.middle + range[0];
    *to = term->distance.middle + range[1];
}

/* Returns a lower bound of q on the ray, in the term's interval. */
static double min_q(const LevelTerm *term)
{
    const Form *c = term->distance.square;
    if (form_low(c[2]) > 1e-8 * form_most(term->along[1]) * form_most(term->along[1])) {
        const Form drop = form_mul(form_mul(c[1], c[1]), form_inverse(c[2]));
        return fmax(form_low(form_sub(c[0], drop)), 0);
    }
    const double span = fmax(term->to - term->distance.middle, term->distance.middle - term->from);
    const double root = sqrt(fmax(form_low(c[0]), 0)) - sqrt(form_most(c[2])) * span;
    return root > 0 ? root * root * (1 - 1e-9) : 0;
}

bool levelterm_place(const LevelAxis *axis, double reach, const Beam *ray, LevelTerm *term)
{
    if (!pass_axis(axis, reach / axis->unit.c, ray, term))
        return false;
    set_polynomials(axis, ray, term);
    term->unit = axis->unit;
    term->axis = axis->axis;
    levelterm_interval(term, reach, reach, &term->from, &term->to);
    term->least = min_q(term);
    return true;
}

/* ---- the potential --------------------------------------------------------------------------- */

/* The two factors of a term at a point, and the derivative of `ends` along the axis. */
typedef struct TermAt {
    Form gauss;      /* exp(-q) */
    Form ends;       /* (erf(u) + erf(v)) / 2 */
    Form ends_slope; /* (exp(-u^2) - exp(-v^2)) / sqrt(pi) */
} TermAt;

/* Returns exp(-f) of a constant form. */
static Form exp_of_minus(Form f)
{
    const double value = elementary_exp(-f.c);
    if (!(f.e < 1e-3))
        return form_of(value, (double)INFINITY);
    return form_rounded(form_of(value, value * (1.001 * f.e + exp_error)), value);
}

/* Returns erf(f) of a constant form. The slope of erf is at most 1.13. */
static Form erf_of(Form f)
{
    return form_of(f.c < 6 ? elementary_erf(f.c) : 1, 1.13 * f.e + erf_error);
}

/* Returns exp(-f^2) of a constant form. The slope's magnitude is at most 0.86. */
static Form bell_of(Form f)
{
    return form_of(f.c * f.c < 700 ? elementary_exp(-f.c * f.c) : 0, 0.86 * f.e + exp_error);
}

/* Returns start + rate zeta, with the errors of the forms and of the operations. */
static Form at_zeta(Form start, Form rate, double zeta)
{
    return form_add(start, form_scale(rate, zeta));
}

static TermAt term_at(const LevelTerm *term, Form q, double zeta)
{
    const Form u = at_zeta(term->along[0], term->along[1], zeta);
    const Form v = at_zeta(term->before, term->along[1], -zeta);
    return (TermAt){exp_of_minus(q), form_scale(form_add(erf_of(u), erf_of(v)), 0.5),
                    form_scale(form_sub(bell_of(u), bell_of(v)), inv_sqrt_pi)};
}

/* The error of z - middle is one rounding of zeta. `moved` is above this error, and its effect on
 * value and slope is added to their errors. */
static LevelSample sample_potential(const LevelTerm *term, double z)
{
    const double zeta = z - term->distance.middle;
    const Form *c = term->distance.square;
    const Form bend = form_scale(c[2], zeta), rate = form_add(c[1], bend);
    const Form q = form_add(c[0], form_scale(form_add(c[1], rate), zeta));
    const TermAt at = term_at(term, q, zeta);
    const Form value = form_mul(at.gauss, at.ends);
    const Form slope = form_sub(form_mul(form_mul(at.gauss, at.ends_slope), term->along[1]),
                                form_scale(form_mul(value, rate), 2));
    const double moved = 4 * FORM_U * fabs(zeta);
    return (LevelSample){value.c, slope.c, value.e + moved * (fabs(slope.c) + slope.e),
                         slope.e + moved * (term->convex + term->concave)};
}

static Form3 potential_gradient(const LevelTerm *term, Form zeta)
{
    const Form *c = term->distance.square;
    const Form k = term->unit;
    const Form u = form_add(term->along[0], form_mul(term->along[1], zeta));
    const Form v = form_sub(term->before, form_mul(term->along[1], zeta));
    const Form q =
        form_add(c[0], form_mul(form_add(form_scale(c[1], 2), form_mul(c[2], zeta)), zeta));
    const Form gauss = exp_of_minus(q);
    const Form ends = form_add(erf_of(u), erf_of(v)); /* the factors 1/2 and -2 make -1 */
    const Form across = form_neg(form_mul(form_mul(k, k), form_mul(gauss, ends)));
    const Form along =
        form_mul(form_scale(k, inv_sqrt_pi), form_mul(gauss, form_sub(bell_of(u), bell_of(v))));
    return form3_add(form3_mul(form3_add(term->across, form3_mul(term->across_rate, zeta)), across),
                     form3_mul(term->axis, along));
}

/* The bounds of the second derivative are those of docs/METHODS.md, section 2.3, where s and c are
 * k times the speeds, by z, of the ray's point across and along the axis. */
static void bound_potential(LevelTerm *term)
{
    const double s = sqrt(form_most(term->distance.square[2])), c = form_most(term->along[1]);
    const double radial = elementary_exp(-term->least) * (1 + 1e-9), both = 0.9682 * s * c;
    const double ends = form_high(erf_of(form_scale(form_add(term->along[0], term->before), 0.5)));
    term->ends = ends * (1 + 1e-9);
    term->peak = radial * term->ends * (1 + 1e-9);
    term->convex = radial * (0.8926 * ends * s * s + both + 0.4840 * c * c);
    term->concave = radial * (2 * ends * s * s + both + 0.9682 * c * c);
}

/* Beyond an end at the distance x, the term is at most exp(-x^2) / 2. */
static void find_potential_window(LevelTerm *term, double ratio)
{
    levelterm_interval(term, sqrt(elementary_log(ratio)),
                       sqrt(fmax(elementary_log(0.5 * ratio / term->ends), 0)), &term->window_from,
                       &term->window_to);
}

static const LevelKind potential_kind = {sample_potential, potential_gradient,
                                         find_potential_window};

size_t potential_terms(const Face *face, uint32_t index, const Beam *ray, LevelTerm *terms)
{
    const double k = sqrt(2) / face->radius;
    const LevelAxis axis = levelaxis_of(face, form_of(k, 4 * FORM_U * k));
    if (!levelterm_place(&axis, sqrt(2) * ISOSURFACE_REACH, ray, terms))
        return 0;
    terms->kind = &potential_kind;
    terms->face = index;
    bound_potential(terms);
    return 1;
}
