/* The terms of the potential along single rays. Lengths of a term are in units of 1 / k = radius /
 * sqrt2, where the term is exp(-q) (erf(u) + erf(v)) / 2: q is the squared distance from the axis
 * line, u and v are the distances from the two ends, positive inwards. Along a ray q is a
 * polynomial of degree 2, and u and v are linear. They are expanded about the point of the ray
 * nearest to the segment, so that a distant camera costs no digits.
 *
 * The choice of the terms of a ray, and the windows of terms, are computed in plain doubles and
 * widened by far more than their rounding errors. Everything else has a proven error. */
#include "answer/isosurface.h"

#include <math.h>
#include <stdlib.h>

/* The square of ISOSURFACE_REACH radii, in units of 1 / k. */
static const double reach2 = 2 * ISOSURFACE_REACH * ISOSURFACE_REACH;
/* Widening of distances that are computed in plain doubles, relative and in units of 1 / k. */
static const double widening = 1e-6;
/* Errors of elementary_exp, at most 0.51 ulp of a result of at most 1, and of elementary_erf, 5
 * ulp, with room for the roundings around them. */
static const double exp_error = 4 * FORM_U, erf_error = 12 * FORM_U;
static const double inv_sqrt_pi = 0.56418958354775628695;

/* ---- one term -------------------------------------------------------------------------------- */

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

/* Sets term->distance.middle, the point of the ray nearest to the segment. Returns false if the ray
 * surely passes the segment beyond its reach. */
static bool pass_segment(const Face *face, const Beam *ray, LevelTerm *term)
{
    const Vec3 axis = vec3(face->axis.x.c, face->axis.y.c, face->axis.z.c);
    const Vec3 unit = vec3(ray->unit.x.c, ray->unit.y.c, ray->unit.z.c);
    const Vec3 to_a = vec3_sub(face->at, vec3(ray->origin.x.c, ray->origin.y.c, ray->origin.z.c));
    const double cosine = vec3_dot(axis, unit), sine2 = fmax(1 - cosine * cosine, 1e-14);
    double along = (cosine * vec3_dot(to_a, unit) - vec3_dot(to_a, axis)) / sine2;
    along = fmin(fmax(along, 0), face->length.c);
    const Vec3 to_axis = vec3_add_scaled(to_a, axis, along);
    const double middle = vec3_dot(to_axis, unit), reach = ISOSURFACE_REACH * face->radius;
    const Vec3 apart = vec3_add_scaled(to_axis, unit, -middle);
    if (vec3_dot(apart, apart) > reach * reach * (1 + widening))
        return false;
    term->distance.middle = middle;
    return true;
}

/* Returns k = sqrt2 / radius, 1/mm. */
static Form inverse_unit(const Face *face)
{
    const double k = sqrt(2) / face->radius;
    return form_of(k, 4 * FORM_U * k);
}

/* Sets the polynomials of a term; distance.middle must be set. */
static void set_polynomials(const Face *face, const Beam *ray, LevelTerm *term)
{
    const Form k = inverse_unit(face);
    const Form k2 = form_mul(k, k);
    const Form3 from = form3_add(form3_sub(ray->origin, form3_exact(face->at)),
                                 form3_mul(ray->unit, form_of(term->distance.middle, 0)));
    const Form along = form3_dot(from, face->axis), rate = form3_dot(ray->unit, face->axis);
    term->across = form3_sub(from, form3_mul(face->axis, along));
    term->across_rate = form3_sub(ray->unit, form3_mul(face->axis, rate));
    term->distance.square[0] = form_mul(k2, form3_dot(term->across, term->across));
    term->distance.square[1] = form_mul(k2, form3_dot(term->across, term->across_rate));
    term->distance.square[2] = form_mul(k2, form3_dot(term->across_rate, term->across_rate));
    term->along[0] = form_mul(k, along);
    term->along[1] = form_mul(k, rate);
    term->before = form_mul(k, form_sub(face->length, along));
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

/* Returns an interval that has every z at which the ray is at most sqrt(d^2 + w^2) from the axis
 * line, where d is the ray's least distance from it, and at most x beyond an end of the segment.
 * Lengths w, x and d are in units of 1 / k. */
static void find_interval(const LevelTerm *term, double w, double x, double *from, double *to)
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

/* Computes the term of a segment along a ray. Returns false if it is left out. The bounds of the
 * second derivative are those of docs/METHODS.md, section 2.3, where s and c are
 * k times the speeds, by z, of the ray's point across and along the axis. */
static bool make_term(const Face *face, uint32_t index, const Beam *ray, LevelTerm *term)
{
    if (!pass_segment(face, ray, term))
        return false;
    set_polynomials(face, ray, term);
    term->sample = sample_potential;
    term->face = index;
    find_interval(term, sqrt(reach2), sqrt(reach2), &term->from, &term->to);
    const double s = sqrt(form_most(term->distance.square[2])), c = form_most(term->along[1]);
    const double radial = elementary_exp(-min_q(term)) * (1 + 1e-9), both = 0.9682 * s * c;
    const double ends = form_high(erf_of(form_scale(form_add(term->along[0], term->before), 0.5)));
    term->ends = ends * (1 + 1e-9);
    term->peak = radial * term->ends * (1 + 1e-9);
    term->convex = radial * (0.8926 * ends * s * s + both + 0.4840 * c * c);
    term->concave = radial * (2 * ends * s * s + both + 0.9682 * c * c);
    return true;
}

/* ---- rays ------------------------------------------------------------------------------------ */

Status levelworkspace_make(const AnswerPlan *plan, LevelWorkspace *work, Err *err)
{
    const Geometry *geometry = &plan->scene->geometry;
    if (!plan->is_isosurface)
        return STATUS_OK;
    TRY(mem_calloc(&work->terms, plan->n, sizeof *work->terms, "terms", err));
    TRY(mem_calloc(&work->chosen, plan->n, sizeof *work->chosen, "terms", err));
    TRY(mem_calloc(&work->segments, plan->n, sizeof *work->segments, "terms", err));
    return geometry->blend.n_groups ? localgroups_new(geometry, &work->groups, err) : STATUS_OK;
}

void levelworkspace_release(LevelWorkspace *work)
{
    free(work->terms);
    free(work->chosen);
    free(work->segments);
    localgroups_free(work->groups);
}

static void find_terms(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                       const FaceList *list)
{
    work->n = 0;
    for (size_t i = 0; i < list->n; i++) {
        const uint32_t face = list->faces[i];
        if (plan->faces[face].kind == FACE_SEGMENT &&
            make_term(&plan->faces[face], face, ray, &work->terms[work->n]))
            work->segments[work->n++] = face;
    }
}

/* Chooses the terms of a blend group, or all terms. Sets the windows of the terms: where the
 * sum reaches the level, at least one term reaches level * its peak / sum of all peaks. Returns the
 * ray through the terms; its n is 0 if the level cannot be reached. */
static LevelRay choose_terms(const AnswerPlan *plan, LevelWorkspace *work, size_t group)
{
    size_t n = work->n;
    const uint32_t *members = work->groups ? localgroups_members(work->groups, group, &n) : NULL;
    LevelRay ray = {work->chosen, n, FIELD_LEVEL, plan->dropped, plan->dropped_slope};
    double total = 0;
    for (size_t i = 0; i < n; i++) {
        work->chosen[i] = &work->terms[members ? members[i] : i];
        total += work->chosen[i]->peak;
    }
    const double ratio = total / (FIELD_LEVEL - plan->dropped) * (1 + 1e-9);
    if (!(ratio >= 1))
        ray.n = 0;
    for (size_t i = 0; i < ray.n; i++) {
        LevelTerm *term = &work->terms[members ? members[i] : i];
        find_interval(term, sqrt(elementary_log(ratio)),
                      sqrt(fmax(elementary_log(0.5 * ratio / term->ends), 0)), &term->window_from,
                      &term->window_to);
        term->window_from = fmax(term->window_from, term->from);
        term->window_to = fmin(term->window_to, term->to);
    }
    return ray;
}

/* Returns the number of groups of terms to choose from. */
static size_t count_groups(LevelWorkspace *work)
{
    return work->n == 0   ? 0
           : work->groups ? localgroups_find(work->groups, work->segments, work->n)
                          : 1;
}

/* ---- hits ------------------------------------------------------------------------------------ */

/* Returns the gradient of a term, 1/mm, at a constant form zeta. */
static Form3 gradient_of(const Face *face, const LevelTerm *term, Form zeta)
{
    const Form *c = term->distance.square;
    const Form k = inverse_unit(face);
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
                     form3_mul(face->axis, along));
}

/* Returns the outward unit normal of the sum of the ray's terms at a crossing. */
static Form3 normal_at(const AnswerPlan *plan, const LevelRay *ray, const LevelCrossing *at)
{
    const Form left_out = form_of(0, ray->dropped_slope);
    Form3 sum = {left_out, left_out, left_out};
    for (size_t i = 0; i < ray->n; i++) {
        const LevelTerm *term = ray->terms[i];
        const double zeta = at->z - term->distance.middle;
        if (term->to >= at->z - at->error && term->from <= at->z + at->error)
            sum = form3_add(sum, gradient_of(&plan->faces[term->face], term,
                                             form_rounded(form_of(zeta, at->error), fabs(zeta))));
    }
    const Form3 normal = form3_neg(form3_unit(sum));
    return (Form3){form_known(normal.x, -1, 1), form_known(normal.y, -1, 1),
                   form_known(normal.z, -1, 1)};
}

/* Adds a hit for each term that may be the largest at the crossing. Returns false if there is no
 * space for all. */
static bool add_hits(const AnswerPlan *plan, const LevelRay *ray, const LevelCrossing *at,
                     FaceHit *hits, size_t *n, size_t capacity, const Beam *beam)
{
    const Form depth = form_mul(form_of(at->z, at->error), beam->inverse);
    const Form3 normal = normal_at(plan, ray, at);
    double largest = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < ray->n; i++) {
            const LevelTerm *term = ray->terms[i];
            const LevelSample sample = term->sample(term, at->z);
            const double error =
                sample.value_error + at->error * (fabs(sample.slope) + sample.slope_error +
                                                  at->error * (term->convex + term->concave));
            if (pass == 0) {
                largest = fmax(largest, sample.value - error);
            } else if (!(sample.value + error < largest)) {
                if (*n == capacity)
                    return false;
                hits[(*n)++] =
                    (FaceHit){.face = &plan->faces[term->face], .depth = depth, .v = normal};
            }
        }
    return true;
}

LevelHits isosurface_hits(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                          const FaceList *list, FaceHit *hits, size_t capacity)
{
    LevelHits found = {0};
    find_terms(plan, work, ray, list);
    const size_t groups = count_groups(work);
    for (size_t group = 0; group < groups; group++) {
        const LevelRay terms = choose_terms(plan, work, group);
        const LevelCrossing at = levelray_first(&terms, 0, (double)INFINITY, true);
        if (at.state == LEVEL_UNDECIDED ||
            (at.state == LEVEL_FOUND &&
             !add_hits(plan, &terms, &at, hits, &found.n, capacity, ray)))
            return (LevelHits){.undecided = true};
    }
    return found;
}

int isosurface_blocks(const AnswerPlan *plan, LevelWorkspace *work, const Beam *ray,
                      const FaceList *list, bool parallel)
{
    const double near = parallel ? (double)INFINITY : form_low(ray->length);
    const double far = parallel ? (double)INFINITY : form_high(ray->length);
    int blocked = 0;
    find_terms(plan, work, ray, list);
    const size_t groups = count_groups(work);
    for (size_t group = 0; group < groups && blocked != 1; group++) {
        const LevelRay terms = choose_terms(plan, work, group);
        const LevelCrossing at = levelray_first(&terms, 0, far, false);
        if (at.state == LEVEL_UNDECIDED)
            blocked = -1;
        else if (at.state == LEVEL_FOUND)
            blocked = at.z + at.error < near ? 1 : -1;
    }
    return blocked;
}
