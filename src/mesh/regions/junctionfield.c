/* Evaluates the potential field of a junction, and lists the terms that matter in a ball.
 *
 * The field is the largest sum over a group of terms. With lengths in units of 1 / k = radius /
 * sqrt 2, the term of a segment is exp(-E^2) (erf u + erf v) / 2. E is the distance of x from the
 * axis, and u and v are the distances of x from the two ends along the axis, positive inwards. A
 * round term is exp(-d^2), where d is the distance of x from the segment. Either all terms of a
 * field are round, or none is.
 *
 * A term is bounded in a ball of radius rho about x. The radial factor exp(-E^2) is between its
 * values at E + rho and at max(0, E - rho). The axial factor (erf u + erf v) / 2 is symmetric about
 * the middle of the segment, where it is largest, and falls on both sides. So in an interval of
 * width 2 rho along the axis, the axial factor is smallest at one of the two ends of the interval,
 * and largest at the point of the interval that is nearest to the middle of the segment. */
#include "mesh/regions/junctionfield.h"

#include "mesh/regions/gauss.h"
#include <float.h>
#include <stdlib.h>

/* Only terms that may exceed this in the ball count for FieldBounds.min_radius_mm and
 * has_unblended_terms. A term of 0.1 FIELD_LEVEL moves the surface of another vessel by 0.025
 * radii. A smaller value splits cells farther away from thin vessels; a larger one makes cells too
 * wide for the blend. */
static const double significant = 0.1 * FIELD_LEVEL;
/* In units of 1 / k: a term is left out of a ball beyond this distance, where exp(-x^2) is below
 * 1e-5, or 7e-5 FIELD_LEVEL. */
static const double out_of_reach = 3.4;
/* The search for creases enlarges the ball by this factor, because surfaces bend away from the
 * planes that approximate them. A ball of less than half a radius, as cells have, misses no crease
 * with 1.2. A larger factor splits cells that have no crease. */
static const double crease_ball_factor = 1.2;
/* A cap that protrudes from a capsule by less than this, in units of the cap's radius, counts as
 * contained in the capsule: the difference may be a rounding error. */
static const double cap_rounding = 1e-9;
/* 1 / sqrt(pi), from the derivative of erf */
static const double inv_sqrt_pi = 0.56418958354775628695;

PotentialTerm potentialterm_make(Vec3 a, Vec3 b, double radius_mm, uint32_t segment,
                                 VesselBody body)
{
    double length = vec3_distance(a, b), k = sqrt(2) / radius_mm;
    return (PotentialTerm){.a = a,
                           .axis = vec3_scale(vec3_sub(b, a), 1 / length),
                           .k = k,
                           .length_k = k * length,
                           .radius_mm = radius_mm,
                           .segment = segment,
                           .stub = NO_STUB,
                           .is_round = body == BODY_ROUND};
}

/* A point in the coordinates of a term: distances from the two ends, inwards, and the squared
 * distance from the axis. */
typedef struct TermPlace {
    double u, v, e2;
    Vec3 across; /* mm */
} TermPlace;

static inline TermPlace place_in(const PotentialTerm *term, Vec3 x)
{
    Vec3 from_a = vec3_sub(x, term->a);
    double along = vec3_dot(from_a, term->axis);
    Vec3 across = vec3_add_scaled(from_a, term->axis, -along);
    return (TermPlace){term->k * along, term->length_k - term->k * along,
                       term->k * term->k * vec3_dot(across, across), across};
}

/* Returns the axial factor of a term. */
static inline double axial(double u, double v)
{
    Pair both = erf_pair((Pair){u, v});
    return 0.5 * (both[0] + both[1]);
}

/* Returns the squared distance to the segment, in units of 1 / k. */
static inline double distance2(const TermPlace *place)
{
    double inside = place->u < place->v ? place->u : place->v;
    return inside < 0 ? place->e2 + inside * inside : place->e2;
}

static inline double value_at(const PotentialTerm *term, const TermPlace *place)
{
    double from_segment = distance2(place);
    if (from_segment > out_of_reach * out_of_reach)
        return 0;
    if (term->is_round)
        return exp_minus(from_segment);
    return exp_minus(place->e2) * axial(place->u, place->v);
}

/* Returns the vector to the place from the nearest point of the segment, mm. */
static Vec3 from_nearest(const PotentialTerm *term, const TermPlace *place)
{
    double beyond = fmax(0, -place->v) - fmax(0, -place->u);
    return vec3_add_scaled(place->across, term->axis, beyond / term->k);
}

double potentialterm_value(const PotentialTerm *term, Vec3 x)
{
    TermPlace place = place_in(term, x);
    return value_at(term, &place);
}

/* Returns the gradient of a term, 1/mm. `value` is the term's value at `place`. Beyond
 * GAUSS_SATURATED erf_pair is constant, so its derivative there is 0. */
static inline Vec3 term_gradient(const PotentialTerm *term, const TermPlace *place, double value)
{
    if (term->is_round)
        return vec3_scale(from_nearest(term, place), -2 * term->k * term->k * value);
    Pair ends = {place->u, place->v}, zero = {0, 0};
    Pair gaussians = exp_minus_pair(place->e2 + ends * ends);
    gaussians = pair_select((PairBits)(pair_abs(ends) < GAUSS_SATURATED), gaussians, zero);
    return vec3_add_scaled(vec3_scale(place->across, -2 * term->k * term->k * value), term->axis,
                           term->k * inv_sqrt_pi * (gaussians[0] - gaussians[1]));
}

/* Returns an upper bound of a term in the ball of radius rho, in units of 1 / k, about `place`. */
static double upper_bound(const PotentialTerm *term, const TermPlace *place, double rho)
{
    if (term->is_round) {
        double from_segment = fmax(0, sqrt(distance2(place)) - rho);
        return exp_minus(from_segment * from_segment);
    }
    double across = fmax(0, sqrt(place->e2) - rho), to_middle = 0.5 * (place->v - place->u);
    double shift = fmin(rho, fabs(to_middle)) * (to_middle > 0 ? 1 : -1);
    return exp_minus(across * across) * axial(place->u + shift, place->v - shift);
}

/* Returns a lower bound of a term in the ball of radius rho, in units of 1 / k, about `place`. */
static double lower_bound(const PotentialTerm *term, const TermPlace *place, double rho)
{
    double across = sqrt(term->is_round ? distance2(place) : place->e2) + rho;
    if (across > 2)
        return 0; /* 0 is a lower bound, too, and the bound exp(-4) < 0.02 is too small to prove
                     that a sum reaches the level */
    if (term->is_round)
        return exp_minus(across * across);
    double at_b = axial(place->u + rho, place->v - rho),
           at_a = axial(place->u - rho, place->v + rho);
    return exp_minus(across * across) * fmax(0, fmin(at_b, at_a));
}

void localfieldpool_release(LocalFieldPool *pool)
{
    free(pool->terms);
    free(pool->groups);
    free(pool->work);
    *pool = (LocalFieldPool){0};
}

static Status reserve_local(LocalFieldPool *pool, size_t terms, size_t words, Err *err)
{
    TRY(mem_reserve(&pool->terms, &pool->term_capacity, pool->n_terms + terms, sizeof *pool->terms,
                    "terms of a junction", err));
    return mem_reserve(&pool->groups, &pool->group_capacity, pool->n_groups + words,
                       sizeof *pool->groups, "terms of a junction", err);
}

Status localfield_too_many_terms(Err *err)
{
    return err_set(err, STATUS_INFEASIBLE,
                   "more than %d segments meet at one point; leave some out", MAX_LOCAL_TERMS);
}

/* Returns an empty LocalField at the top of the pool. The caller appends its terms and groups. */
static LocalField begin_local(const LocalFieldPool *pool, uint32_t n_terms)
{
    return (LocalField){(uint32_t)pool->n_terms, n_terms, (uint32_t)pool->n_groups, 0,
                        (n_terms + 63) / 64};
}

Status localfield_from_field(const JunctionField *field, LocalFieldPool *pool, LocalField *out,
                             Err *err)
{
    LocalField local = begin_local(pool, field->n_terms);
    size_t words = (size_t)local.words * field->n_groups;
    TRY(reserve_local(pool, field->n_terms, words, err));
    for (uint32_t i = 0; i < field->n_terms; i++)
        pool->terms[pool->n_terms++] = i;
    uint64_t *groups = &pool->groups[pool->n_groups];
    for (size_t i = 0; i < words; i++)
        groups[i] = 0;
    for (uint32_t g = 0; g < field->n_groups; g++)
        for (uint32_t i = field->first[g]; i < field->first[g + 1]; i++)
            groups[g * local.words + field->members[i] / 64] |= (uint64_t)1
                                                                << field->members[i] % 64;
    pool->n_groups += words;
    local.n_groups = field->n_groups;
    *out = local;
    return STATUS_OK;
}

Status localfield_copy(const LocalFieldPool *from, const LocalField *local, LocalFieldPool *to,
                       LocalField *out, Err *err)
{
    size_t words = (size_t)local->words * local->n_groups;
    TRY(reserve_local(to, local->n_terms, words, err));
    LocalField copy = begin_local(to, local->n_terms);
    copy.n_groups = local->n_groups;
    for (uint32_t i = 0; i < local->n_terms; i++)
        to->terms[to->n_terms++] = from->terms[local->first_term + i];
    for (size_t i = 0; i < words; i++)
        to->groups[to->n_groups++] = from->groups[local->first_group + i];
    *out = copy;
    return STATUS_OK;
}

/* Groups are not compared with each other if there are more than this, because the time of the
 * comparisons grows with the square of their number. Groups that are subsets of others then stay.
 * They cost time, but do not change the field. */
enum { MAX_COMPARED_GROUPS = 256 };

static bool is_subset(const uint64_t *a, const uint64_t *b, uint32_t words)
{
    for (uint32_t i = 0; i < words; i++)
        if (a[i] & ~b[i])
            return false;
    return true;
}

/* Adds the group at the top of the pool to a local field, unless the group is a subset of a group
 * of the local field. Removes the groups that are subsets of the added group. */
static void add_group(LocalFieldPool *pool, LocalField *local)
{
    uint64_t *groups = &pool->groups[local->first_group];
    uint32_t words = local->words, kept = 0;
    uint64_t *added = &groups[(size_t)local->n_groups * words];
    if (local->n_groups >= MAX_COMPARED_GROUPS) {
        pool->n_groups += words;
        local->n_groups++;
        return;
    }
    for (uint32_t g = 0; g < local->n_groups; g++)
        if (is_subset(added, &groups[(size_t)g * words], words))
            return;
    for (uint32_t g = 0; g <= local->n_groups; g++) {
        if (g < local->n_groups && is_subset(&groups[(size_t)g * words], added, words))
            continue;
        for (uint32_t i = 0; i < words; i++)
            groups[(size_t)kept * words + i] = groups[(size_t)g * words + i];
        kept++;
    }
    local->n_groups = kept;
    pool->n_groups = local->first_group + (size_t)kept * words;
}

/* Restricts each group of `local` to the terms listed in pool->work, and appends it to *out. Bit i
 * of a restricted group stands for pool->work[i]. */
static Status narrow_groups(LocalFieldPool *pool, const LocalField *local, LocalField *out,
                            Err *err)
{
    for (uint32_t g = 0; g < local->n_groups; g++) {
        TRY(reserve_local(pool, 0, out->words, err));
        const uint64_t *group = &pool->groups[local->first_group + (size_t)g * local->words];
        uint64_t *narrow = &pool->groups[pool->n_groups];
        for (uint32_t i = 0; i < out->words; i++)
            narrow[i] = 0;
        for (uint32_t i = 0; i < out->n_terms; i++)
            narrow[i / 64] |= (group[pool->work[i].index / 64] >> pool->work[i].index % 64 & 1)
                              << i % 64;
        add_group(pool, out);
    }
    return STATUS_OK;
}

/* Returns the sum of the values of a group's terms. Term i has values[i * stride]. */
static double group_sum(const uint64_t *group, uint32_t words, const double *values, size_t stride)
{
    double sum = 0;
    for (uint32_t w = 0; w < words; w++)
        for (uint64_t bits = group[w]; bits; bits &= bits - 1)
            sum += values[(w * 64 + (uint32_t)__builtin_ctzll(bits)) * stride];
    return sum;
}

static const uint64_t *group_of(const LocalFieldPool *pool, const LocalField *local, uint32_t index)
{
    return &pool->groups[local->first_group + (size_t)index * local->words];
}

/* Returns the group with the highest lower bound of its sum in the ball. */
static uint32_t leading_group(const LocalFieldPool *pool, const LocalField *local)
{
    const size_t stride = sizeof *pool->work / sizeof pool->work->lower;
    double most = -1;
    uint32_t best = 0;
    for (uint32_t g = 0; g < local->n_groups; g++) {
        double lower =
            group_sum(group_of(pool, local, g), local->words, &pool->work->lower, stride);
        if (lower > most) {
            most = lower;
            best = g;
        }
    }
    return best;
}

/* Returns true if the sum over group `a` is certainly below the sum over group `b` everywhere in
 * the ball. Terms that are in both groups cancel, so they are left out. */
static bool is_below(const LocalFieldPool *pool, const LocalField *local, const uint64_t *a,
                     const uint64_t *b)
{
    const size_t stride = sizeof *pool->work / sizeof pool->work->lower;
    uint64_t only_a[MAX_LOCAL_TERMS / 64], only_b[MAX_LOCAL_TERMS / 64];
    for (uint32_t w = 0; w < local->words; w++) {
        only_a[w] = a[w] & ~b[w];
        only_b[w] = b[w] & ~a[w];
    }
    return group_sum(only_a, local->words, &pool->work->upper, stride) <
           group_sum(only_b, local->words, &pool->work->lower, stride);
}

/* Returns true if no group contains all the terms that matter. A term matters if it may exceed
 * `significant`, and if the sum of one of its groups may be the largest somewhere in the ball. */
static bool has_unblended_terms(const LocalFieldPool *pool, const LocalField *local)
{
    if (local->n_terms > MAX_LOCAL_TERMS)
        return false;
    uint64_t matters[MAX_LOCAL_TERMS / 64] = {0};
    const uint64_t *leader = group_of(pool, local, leading_group(pool, local));
    for (uint32_t g = 0; g < local->n_groups; g++) {
        const uint64_t *group = group_of(pool, local, g);
        for (uint32_t w = 0; w < local->words && !is_below(pool, local, group, leader); w++)
            matters[w] |= group[w];
    }
    for (uint32_t i = 0; i < local->n_terms; i++)
        if (pool->work[i].upper <= significant)
            matters[i / 64] &= ~((uint64_t)1 << i % 64);
    for (uint32_t g = 0; g < local->n_groups; g++)
        if (is_subset(matters, group_of(pool, local, g), local->words))
            return false;
    return true;
}

/* A plane that approximates a surface that may pass through a ball. */
typedef struct NearSurface {
    Vec3 normal;
    double outside; /* signed distance of the ball's centre from the plane, mm; above 0 outside */
} NearSurface;

/* Returns true if two planes meet in a ball of this radius, or if their normals differ by more than
 * 120 degrees, as on the two sides of a narrow gap. Two sides of a gap meet outside the ball, but
 * need small cells, too. A smaller angle would split cells at blunt creases that the ball does not
 * contain. */
static bool surfaces_meet(const NearSurface *a, const NearSurface *b, double radius_mm)
{
    double cosine = vec3_dot(a->normal, b->normal);
    /* (distance of the centre from the line where the planes meet * sine of their angle)^2 */
    double line_distance2 =
        a->outside * a->outside + b->outside * b->outside - 2 * cosine * a->outside * b->outside;
    return cosine < -0.5 || line_distance2 <= (1 - cosine * cosine) * radius_mm * radius_mm;
}

/* Returns the height from which on the capsule `cover` contains the round cap at one end of another
 * capsule. Heights are in units of the cap's radius, along `outward`; 0: `cover` contains the whole
 * cap; 1: none of it.
 *
 * The cap's ball protrudes from `cover` by s radii. At height h the cap's circle has the radius
 * sqrt(1 - h^2). It is in a `cover` of the same direction if this is at most 1 - s, so from
 * h = sqrt(2 s) on. An angle between the two axes raises the height by at most the sine of the
 * angle. The length of `cover` is not taken into account. */
static double uncovered_height(Vec3 end, Vec3 outward, double radius_mm, const PotentialTerm *cover)
{
    const TermPlace place = place_in(cover, end);
    const double protrusion =
        (sqrt(distance2(&place)) / cover->k + radius_mm - cover->radius_mm) / radius_mm;
    if (protrusion < cap_rounding)
        return 0;
    const double cosine = vec3_dot(outward, cover->axis) * (place.u < place.v ? 1 : -1);
    if (protrusion > 0.5 || cosine <= 0)
        return 1; /* sqrt(2 * 0.5) = 1, or `cover` does not continue outwards */
    return fmin(1, sqrt(2 * protrusion) + sqrt(fmax(0, 1 - cosine * cosine)));
}

/* Returns the plane of the i-th term, a capsule. The plane is tangent at the capsule's point that
 * is nearest to `center`. If another capsule covers this point of a cap, the plane is tangent at
 * the edge of the cap's uncovered part. `outside` is HUGE_VAL if the ball does not reach that part.
 */
static NearSurface find_surface(const JunctionField *field, const LocalFieldPool *pool,
                                const LocalField *local, uint32_t i, Vec3 center, double radius_mm)
{
    const uint32_t *terms = &pool->terms[local->first_term];
    const PotentialTerm *term = &field->terms[terms[i]];
    const TermPlace place = place_in(term, center);
    const double beyond = fmax(0, fmax(-place.u, -place.v)) / term->k;
    const Vec3 from_axis = from_nearest(term, &place);
    double uncovered = 1;
    NearSurface surface = {vec3_normalized(from_axis), vec3_length(from_axis) - term->radius_mm};
    if (beyond == 0)
        return surface;
    const Vec3 outward = place.u < 0 ? vec3_scale(term->axis, -1) : term->axis;
    for (uint32_t k = 0; k < local->n_terms; k++)
        if (k != i)
            uncovered = fmin(uncovered, uncovered_height(vec3_sub(center, from_axis), outward,
                                                         term->radius_mm, &field->terms[terms[k]]));
    if (beyond <= uncovered * vec3_length(from_axis))
        return surface;
    surface.normal =
        vec3_add_scaled(vec3_scale(vec3_normalized(place.across), sqrt(1 - uncovered * uncovered)),
                        outward, uncovered);
    surface.outside = beyond <= uncovered * term->radius_mm + radius_mm
                          ? vec3_dot(from_axis, surface.normal) - term->radius_mm
                          : HUGE_VAL;
    return surface;
}

/* Returns the maximum of |n1 - n2|, in [0, 2], over the unit normals of the capsules' surfaces that
 * meet in the ball. Only terms that may equal FIELD_LEVEL in the ball have a surface there. */
static double find_crease(const JunctionField *field, const LocalFieldPool *pool,
                          const LocalField *local, Vec3 center, double radius_mm)
{
    NearSurface surfaces[MAX_LOCAL_TERMS];
    uint32_t n = 0;
    double most = 0;
    for (uint32_t i = 0; i < local->n_terms && n < MAX_LOCAL_TERMS; i++) {
        if (pool->work[i].upper < FIELD_LEVEL || pool->work[i].lower > FIELD_LEVEL)
            continue;
        surfaces[n] = find_surface(field, pool, local, i, center, crease_ball_factor * radius_mm);
        if (surfaces[n].outside == HUGE_VAL)
            continue;
        for (uint32_t k = 0; k < n; k++)
            if (surfaces_meet(&surfaces[k], &surfaces[n], crease_ball_factor * radius_mm))
                most = fmax(most, vec3_distance(surfaces[k].normal, surfaces[n].normal));
        n++;
    }
    return most;
}

/* Computes the bounds of the field in a ball from the bounds of its terms. */
static void sum_bounds(const JunctionField *field, const LocalFieldPool *pool,
                       const LocalField *local, Vec3 center, double radius_mm, FieldBounds *bounds)
{
    *bounds = (FieldBounds){.min_radius_mm = HUGE_VAL};
    for (uint32_t i = 0; i < local->n_terms; i++) {
        uint32_t index = pool->terms[local->first_term + i];
        double radius = field->terms[index].radius_mm, upper = pool->work[i].upper;
        bounds->sum_upper += upper;
        if (upper > bounds->largest_upper) {
            bounds->largest_upper = upper;
            bounds->largest_term = index;
        }
        if (upper > significant)
            bounds->min_radius_mm = fmin(bounds->min_radius_mm, radius);
    }
    for (uint32_t g = 0; g < local->n_groups; g++) {
        const uint64_t *group = &pool->groups[local->first_group + (size_t)g * local->words];
        const TermBounds *work = pool->work;
        const size_t stride = sizeof *work / sizeof work->upper;
        double upper = group_sum(group, local->words, &work->upper, stride);
        double lower = group_sum(group, local->words, &work->lower, stride);
        bounds->upper = fmax(bounds->upper, upper);
        bounds->lower = fmax(bounds->lower, lower);
    }
    bool is_round = field->n_terms > 0 && field->terms[0].is_round;
    if (is_round)
        bounds->max_normal_difference = find_crease(field, pool, local, center, radius_mm);
    else
        bounds->has_unblended_terms = local->n_groups > 1 && has_unblended_terms(pool, local);
}

Status localfield_narrow(const JunctionField *field, LocalFieldPool *pool, const LocalField *local,
                         const FieldBalls *balls, NarrowField *out, Err *err)
{
    TRY(reserve_local(pool, local->n_terms, 0, err));
    TRY(mem_reserve(&pool->work, &pool->work_capacity, local->n_terms, sizeof *pool->work, "terms",
                    err));
    TermBounds *work = pool->work;
    LocalField narrow = begin_local(pool, 0);
    for (uint32_t i = 0; i < local->n_terms; i++) {
        uint32_t index = pool->terms[local->first_term + i];
        const PotentialTerm *term = &field->terms[index];
        TermPlace place = place_in(term, balls->center);
        double reach = out_of_reach + term->k * balls->radius_mm,
               inner = term->k * balls->inner_radius_mm;
        if (distance2(&place) > reach * reach)
            continue;
        work[narrow.n_terms++] =
            (TermBounds){i, upper_bound(term, &place, inner), lower_bound(term, &place, inner)};
        pool->terms[pool->n_terms++] = index;
    }
    narrow.words = (narrow.n_terms + 63) / 64;
    TRY(narrow_groups(pool, local, &narrow, err));
    sum_bounds(field, pool, &narrow, balls->center, balls->inner_radius_mm, &out->bounds);
    out->local = narrow;
    return STATUS_OK;
}

/* Finds the group with the largest sum. values[i] is the value of the local field's i-th term. */
static FieldValue largest_group(const LocalFieldPool *pool, const LocalField *local,
                                const double *values)
{
    FieldValue best = {.phi = 0};
    for (uint32_t g = 0; g < local->n_groups; g++) {
        const uint64_t *group = &pool->groups[local->first_group + (size_t)g * local->words];
        double sum = group_sum(group, local->words, values, 1);
        if (sum > best.phi)
            best = (FieldValue){.phi = sum, .group = g};
    }
    return best;
}

/* The caller has checked that n_terms <= MAX_LOCAL_TERMS. Without groups the field is 0. */
FieldValue localfield_value(const JunctionField *field, const LocalFieldPool *pool,
                            const LocalField *local, Vec3 x)
{
    double values[MAX_LOCAL_TERMS], sum = 0;
    const uint32_t *terms = &pool->terms[local->first_term];
    for (uint32_t i = 0; i < local->n_terms && local->n_groups == 1; i++)
        sum += potentialterm_value(&field->terms[terms[i]], x);
    if (local->n_groups < 2)
        return (FieldValue){.phi = sum};
    for (uint32_t i = 0; i < local->n_terms; i++)
        values[i] = potentialterm_value(&field->terms[terms[i]], x);
    return largest_group(pool, local, values);
}

/* The gradient of a sum of terms, and its largest term so far. */
typedef struct GradientSum {
    Vec3 gradient;
    double phi, largest;
    uint32_t largest_term;
} GradientSum;

static inline void add_term(GradientSum *sum, const PotentialTerm *term, uint32_t index,
                            const TermPlace *place, double value)
{
    if (value == 0)
        return;
    sum->phi += value;
    sum->gradient = vec3_add(sum->gradient, term_gradient(term, place, value));
    if (value > sum->largest) {
        sum->largest = value;
        sum->largest_term = index;
    }
}

/* Finds the group with the largest sum, and then the gradient of this sum alone. */
static FieldValue gradient_of_largest(const JunctionField *field, const LocalFieldPool *pool,
                                      const LocalField *local, Vec3 x, Vec3 *gradient)
{
    double values[MAX_LOCAL_TERMS];
    TermPlace places[MAX_LOCAL_TERMS];
    const uint32_t *terms = &pool->terms[local->first_term];
    GradientSum sum = {.largest = 0};
    for (uint32_t i = 0; i < local->n_terms; i++) {
        places[i] = place_in(&field->terms[terms[i]], x);
        values[i] = value_at(&field->terms[terms[i]], &places[i]);
    }
    FieldValue best = largest_group(pool, local, values);
    const uint64_t *group = group_of(pool, local, best.group);
    for (uint32_t i = 0; i < local->n_terms; i++)
        if (group[i / 64] >> i % 64 & 1)
            add_term(&sum, &field->terms[terms[i]], terms[i], &places[i], values[i]);
    *gradient = sum.gradient;
    best.largest_term = sum.largest_term;
    return best;
}

/* Most local fields have one group, which holds all terms. Their sums need no arrays. */
FieldValue localfield_gradient(const JunctionField *field, const LocalFieldPool *pool,
                               const LocalField *local, Vec3 x, Vec3 *gradient)
{
    const uint32_t *terms = &pool->terms[local->first_term];
    GradientSum sum = {.largest = 0};
    if (local->n_groups > 1)
        return gradient_of_largest(field, pool, local, x, gradient);
    for (uint32_t i = 0; i < local->n_terms && local->n_groups == 1; i++) {
        const PotentialTerm *term = &field->terms[terms[i]];
        TermPlace place = place_in(term, x);
        add_term(&sum, term, terms[i], &place, value_at(term, &place));
    }
    *gradient = sum.gradient;
    return (FieldValue){.phi = sum.phi, .largest_term = sum.largest_term};
}

/* A lone vessel of radius r has phi = exp(-2 (d / r)^2) at the distance d from its axis, so the
 * result is 2 (d / r - 1). Clamping phi keeps the logarithm finite where phi is 0, and the root
 * real where blended terms sum to more than 1. The bounds 1e-12 and 0.9 are reached at 3.7 and 0.23
 * radii from the axis, so heights near the surface are exact. */
double field_height(double phi)
{
    return sqrt(-2 * elementary_log(fmin(fmax(phi, 1e-12), 0.9))) - 2;
}
