/* Finds the first hit of a ray with an isosurface of the potential, by proof and without sampling.
 *
 * Along a ray, every term is exp(-e^2 - w^2) (erf(u) + erf(h - u)) / 2. e, the distance of the ray
 * from the axis line, is constant; w and u are affine in t. A term counts in the interval in which
 * it may exceed the cut-off. The ray is searched run by run. A run is a maximal set of terms
 * whose intervals overlap. T is the level.
 *
 * - Windows. Phi >= T among n terms requires that one of them is at least T / n. p is the peak of
 *   a term. Beside its segment, the term is that large only where w^2 <= ln(n p / T) - e^2. At x
 *   beyond an end, where the term is at most exp(-e^2 - x^2) / 2, only where x^2 <= ln(n / 2T) -
 *   e^2. There is no hit outside these windows.
 * - Safe steps. On [t, next), until the interval of another term begins, Phi'' is at most M, the
 *   sum over terms of exp(-e^2) (0.8926 p w'^2 + 0.9682 |w' u'| + 0.4840 u'^2). With G = exp(-w^2)
 *   and A the axial factor, the suprema of G'', 2 |G'| |A'| and A'' are 4 exp(-3/2), 2 sqrt(2/e) /
 *   sqrt(pi) and sqrt(2/e) / sqrt(pi). With lack = T - Phi(t) and the slope of Phi at t, Phi stays
 *   below T up to the positive root of lack = slope x + M x^2 / 2. Such steps converge
 *   quadratically from before the surface.
 * - Existence. Phi'' is at least -N, computed in the same way from G'' >= -2 and A'' >= -2
 *   sqrt(2/e) / sqrt(pi). If slope^2 >= 2 N lack, Phi reaches T, and rises all the way, before the
 *   smaller root of lack = slope x - N x^2 / 2. This gives a bracket with one crossing, and
 *   Newton's method finds it.
 *
 * A ray that starts inside a vessel leaves it by the same method with the sign of Phi - T inverted,
 * without windows. From a union of bodies, the ray leaves one body after another until it is in
 * none. */
#include "render/cast/raysearch.h"
#include "render/cast/rayterms.h"

#include <float.h>

/* Phi counts as equal to the level within this difference, which exceeds the rounding of Phi. */
static const double touch = 1e-12 * FIELD_LEVEL;

/* For x of at least this, erf(x) = 1 and exp(-x^2) = 0 to the last bit of a sum near the level. */
static const double saturated = 6;

static const double inv_sqrt_pi = 0.56418958354775628695;

/* Returns the first parameter from t on within a window; infinite if there is none. */
static double next_window(const FieldScratch *scratch, double t)
{
    double next = HUGE_VAL;
    for (size_t i = 0; i < scratch->n_run; i++) {
        const RayTerm *term = scratch->run[i];
        if (term->window1 >= t)
            next = fmin(next, fmax(term->window0, t));
    }
    return next;
}

/* The potential of the run along the ray. */
typedef struct RaySample {
    double phi, slope;
    double convex, concave; /* bounds of phi'' and -phi'' until `next` */
    double next;            /* start of the next term's interval */
} RaySample;

static void add_term(const RayTerm *term, double t, RaySample *sample)
{
    double x = t - term->t_mid;
    double w = term->w0 + term->w1 * x;
    double u = term->u0 + term->u1 * x;
    double v = term->h - u;
    double gauss = term->radial * elementary_exp(-w * w);
    double ends = (u < saturated ? elementary_erf(u) : 1) + (v < saturated ? elementary_erf(v) : 1);
    double end_slope =
        (u < saturated ? elementary_exp(-u * u) : 0) - (v < saturated ? elementary_exp(-v * v) : 0);
    sample->phi += 0.5 * gauss * ends;
    sample->slope += gauss * (inv_sqrt_pi * term->u1 * end_slope - w * term->w1 * ends);
    sample->convex += term->convex;
    sample->concave += term->concave;
}

static RaySample sample_at(const FieldScratch *scratch, double t)
{
    RaySample sample = {.next = HUGE_VAL};
    for (size_t i = 0; i < scratch->n_run; i++) {
        const RayTerm *term = scratch->run[i];
        if (term->t0 > t) {
            sample.next = term->t0;
            break;
        }
        if (term->t1 >= t)
            add_term(term, t, &sample);
    }
    return sample;
}

/* The difference between a sample and the level, from outside (side 1) or from inside (side -1). */
typedef struct Approach {
    double lack, slope;     /* `lack` decreases by `slope` per mm; both refer to side * Phi */
    double convex, concave; /* of side * Phi */
} Approach;

static Approach approach_of(const RaySample *sample, double side)
{
    return (Approach){side * (FIELD_LEVEL - sample->phi), side * sample->slope,
                      side > 0 ? sample->convex : sample->concave,
                      side > 0 ? sample->concave : sample->convex};
}

/* Returns the only crossing in [low, high]. The lack at `low` is `at.lack` > 0. */
static double close_bracket(const FieldScratch *scratch, double low, double high, double side,
                            Approach at)
{
    double t = low;
    for (int i = 0; i < 40; i++) {
        double newton = t + at.lack / at.slope;
        double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        double moved = fabs(next - t);
        t = next;
        if (moved <= 2 * DBL_EPSILON * fabs(t))
            break;
        RaySample sample = sample_at(scratch, t);
        at = approach_of(&sample, side);
        if (fabs(at.lack) <= 1e-14 * FIELD_LEVEL)
            break;
        if (at.lack > 0)
            low = t;
        else
            high = t;
    }
    return t;
}

/* Returns the first crossing of the level from t on: into a vessel (side 1) or out of it (side -1).
 * Infinite if there is none up to t_max. */
static double march(const FieldScratch *scratch, double t, double t_max, double side)
{
    for (;;) {
        if (side > 0)
            t = next_window(scratch, t);
        if (!(t <= t_max))
            return HUGE_VAL;
        RaySample sample = sample_at(scratch, t);
        Approach at = approach_of(&sample, side);
        if (at.lack <= touch && at.slope >= 0)
            return t;
        at.lack = fmax(at.lack, 0);
        double existence = at.slope * at.slope - 2 * at.concave * at.lack;
        if (at.slope > 0 && existence >= 0) {
            double high = t + 2 * at.lack / (at.slope + sqrt(existence));
            if (high < sample.next)
                return close_bracket(scratch, t, high, side, at);
        }
        double root = sqrt(at.slope * at.slope + 2 * at.convex * at.lack);
        double step =
            at.slope > 0 ? 2 * at.lack / (at.slope + root) : (root - at.slope) / at.convex;
        t = fmin(fmax(t + step, nextafter(t, HUGE_VAL)), sample.next);
    }
}

/* A search along a ray, and the crossing that it finds. */
typedef struct FieldQuery {
    const Geometry *geometry;
    FieldScratch *scratch;
    RayPart part;     /* its t_max is finite, so that "no crossing", infinite, is beyond it */
    bool off_surface; /* the ray starts at t = 0 on a surface: see is_skin */
    RayHit hit;
} FieldQuery;

static bool is_inside(const RaySample *sample)
{
    return sample->phi > FIELD_LEVEL + touch;
}

/* Returns true if a ray that starts on a surface is inside at t_min only because its start is not
 * exact: hits are within 10^-3 r, so Phi is within 0.4 % of the level. Such a ray leaves the
 * vessel, from its start on. A ray that enters the vessel at its start is inside because the vessel
 * blocks it, even if it is past its deepest point at t_min. */
static bool is_skin(const FieldQuery *query, const RaySample *sample)
{
    return query->off_surface && sample->phi < 1.01 * FIELD_LEVEL && sample->slope < 0 &&
           sample_at(query->scratch, 0).slope < 0;
}

/* Returns the first crossing of the run between t_min and t_max; infinity if there is none. */
static double first_crossing(const FieldQuery *query)
{
    const FieldScratch *scratch = query->scratch;
    double t = fmax(query->part.t_min, scratch->run[0]->t0);
    if (t == query->part.t_min) {
        RaySample start = sample_at(scratch, t);
        if (is_inside(&start)) {
            t = march(scratch, t, query->part.t_max, -1);
            if (!is_skin(query, &start))
                return t;
        }
    }
    return march(scratch, t, query->part.t_max, 1);
}

/* Sets the result to the point of the run at t. */
static void describe_hit(FieldQuery *query, double t)
{
    const FieldScratch *scratch = query->scratch;
    Vec3 x = ray_at(query->part.ray, t), sum = vec3(0, 0, 0);
    double largest = -1;
    query->hit.t = t;
    for (size_t i = 0; i < scratch->n_run; i++) {
        const RayTerm *term = scratch->run[i];
        if (term->t0 > t || term->t1 < t)
            continue;
        Vec3 gradient;
        uint32_t number = term->segment;
        double value = potential_term_gradient(&query->geometry->segments[number], x, &gradient);
        sum = vec3_add(sum, gradient);
        if (value > largest || (value == largest && number < query->hit.index)) {
            largest = value;
            query->hit.index = number;
        }
    }
    double steepness = vec3_length(sum);
    query->hit.normal = vec3_scale(steepness > 0 ? sum : query->part.ray.direction,
                                   steepness > 0 ? -1 / steepness : -1);
}

/* Finds the first hit of the sum of the selected terms. */
static bool hit_of_sum(FieldQuery *query)
{
    while (rayterms_next_run(query->scratch)) {
        if (!rayterms_find_windows(query->scratch))
            continue;
        double t = first_crossing(query);
        if (t <= query->part.t_max) {
            describe_hit(query, t);
            return true;
        }
    }
    return false;
}

/* Selects the terms of one of the scratch's blend groups. */
static void choose_group(const FieldQuery *query, size_t number)
{
    size_t n;
    const uint32_t *members = localgroups_members(query->scratch->groups, number, &n);
    rayterms_choose(query->scratch, members, n);
}

/* If the ray at t_min is inside the body of the selected terms, moves t_min to the point where it
 * leaves (infinite if beyond t_max), describes this point and returns true. Sets *deep to true if
 * the ray was inside by more than is_skin allows; does not change it otherwise. */
static bool leave_body(FieldQuery *query, bool *deep)
{
    const FieldScratch *scratch = query->scratch;
    while (rayterms_next_run(query->scratch) && scratch->run[0]->t0 <= query->part.t_min) {
        if (!rayterms_find_windows(query->scratch))
            continue;
        RaySample start = sample_at(scratch, query->part.t_min);
        if (!is_inside(&start))
            continue;
        double t = march(scratch, query->part.t_min, query->part.t_max, -1);
        if (t <= query->part.t_min)
            return false;
        query->part.t_min = t;
        if (t <= query->part.t_max)
            describe_hit(query, t);
        *deep |= !is_skin(query, &start);
        return true;
    }
    return false;
}

/* Returns true if a ray may be inside a vessel at t_min. */
static bool starts_in_term(const FieldQuery *query)
{
    const FieldScratch *scratch = query->scratch;
    for (size_t i = 0; i < scratch->n_terms; i++)
        if (scratch->terms[i].t0 <= query->part.t_min && scratch->terms[i].t1 >= query->part.t_min)
            return true;
    return false;
}

/* Moves t_min out of the union of the groups' bodies. Returns true if the ray was inside, and not
 * only because it starts on the surface. */
static bool leave_union(FieldQuery *query, size_t n_groups)
{
    bool deep = false, moved = starts_in_term(query);
    while (moved && query->part.t_min <= query->part.t_max) {
        moved = false;
        for (size_t i = 0; i < n_groups && query->part.t_min <= query->part.t_max; i++) {
            choose_group(query, i);
            moved |= leave_body(query, &deep);
        }
    }
    return deep;
}

/* Finds the first hit of the union of the groups' bodies. */
static bool hit_of_union(FieldQuery *query)
{
    FieldScratch *scratch = query->scratch;
    for (size_t i = 0; i < scratch->n_terms; i++)
        scratch->near[i] = scratch->terms[i].segment;
    size_t n_groups = localgroups_find(scratch->groups, scratch->near, scratch->n_terms);
    if (leave_union(query, n_groups))
        return query->part.t_min <= query->part.t_max;
    bool hit = false;
    for (size_t i = 0; i < n_groups; i++) {
        choose_group(query, i);
        if (hit_of_sum(query)) {
            hit = true;
            query->part.t_max = query->hit.t;
        }
    }
    return hit;
}

/* Finds the first hit of a ray. */
static bool search_terms(const RayIndex *index, FieldQuery *query)
{
    query->part.t_max = fmin(query->part.t_max, DBL_MAX);
    if (index->field)
        rayterms_find(index->field, query->scratch, &query->part);
    else
        rayterms_find_listed(index->geometry, index->list, index->n, query->scratch, &query->part);
    if (query->scratch->groups)
        return hit_of_union(query);
    rayterms_choose(query->scratch, NULL, query->scratch->n_terms);
    return hit_of_sum(query);
}

static bool first_of_field(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit)
{
    FieldQuery query = {index->geometry, workspace, *part, .off_surface = false};
    bool found = search_terms(index, &query);
    *hit = query.hit;
    return found;
}

static bool any_of_field(const RayIndex *index, void *workspace, const RayPart *part)
{
    FieldQuery query = {index->geometry, workspace, *part, .off_surface = true};
    return search_terms(index, &query);
}

static Status build(RayIndex *index, const CellParams *cells, Err *err)
{
    (void)cells;
    return fieldindex_build(index->geometry, &index->field, err);
}

const RaySearch field_search = {.nearest_mm = NEAREST_VISIBLE_MM,
                                .build = build,
                                .workspace_new = fieldscratch_new,
                                .workspace_free = fieldscratch_free,
                                .first = first_of_field,
                                .any = any_of_field};
