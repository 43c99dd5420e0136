/* A term is bounded in a ball of radius rho about x. Lengths are in units of 1 / k, and E is the
 * distance of x from the axis. The radial factor is between its values at E + rho and at
 * max(0, E - rho). The axial factor is symmetric about the middle of the segment, where it is
 * largest, and falls on both sides. So in an interval of width 2 rho it is smallest at one of the
 * two ends, and largest at the point nearest to the middle. */
#include "mesh/regions/junctionfield.h"

#include "mesh/regions/gauss.h"
#include <float.h>
#include <stdlib.h>

/* A term below this does not count for FieldBounds.min_radius_mm and has_unblended_pair. Reason for
 * the number not recorded. */
static const double significant = 0.1 * FIELD_LEVEL;
/* exp(-x^2) is below 10^-5 beyond this. */
static const double out_of_reach = 3.4;
/* Factor on the radius of the ball, because surfaces bend away from the planes that approximate
 * them. Reason for the number not recorded. */
static const double crease_slack = 1.2;
/* In units of the radius: a cap that is less than this outside a capsule counts as inside it,
 * because of rounding. */
static const double cap_rounding = 1e-9;
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

/* Returns the gradient of a term at a place where the term has this value. */
static inline Vec3 term_gradient(const PotentialTerm *term, const TermPlace *place, double value)
{
    if (term->is_round)
        return vec3_scale(from_nearest(term, place), -2 * term->k * term->k * value);
    Pair ends = {place->u, place->v}, none = {0, 0};
    Pair felt = exp_minus_pair(place->e2 + ends * ends);
    felt = pair_select((PairBits)(pair_abs(ends) < GAUSS_SATURATED), felt, none);
    return vec3_add_scaled(vec3_scale(place->across, -2 * term->k * term->k * value), term->axis,
                           term->k * inv_sqrt_pi * (felt[0] - felt[1]));
}

static double upper_bound(const PotentialTerm *term, const TermPlace *place, double rho)
{
    if (term->is_round) {
        double from_segment = fmax(0, sqrt(distance2(place)) - rho);
        return exp_minus(from_segment * from_segment);
    }
    double across = fmax(0, sqrt(place->e2) - rho), off = 0.5 * (place->v - place->u);
    double towards = fmin(rho, fabs(off)) * (off > 0 ? 1 : -1);
    return exp_minus(across * across) * axial(place->u + towards, place->v - towards);
}

static double lower_bound(const PotentialTerm *term, const TermPlace *place, double rho)
{
    double across = sqrt(term->is_round ? distance2(place) : place->e2) + rho;
    if (across > 2)
        return 0; /* the bound would be below 0.02, which is too small to matter in a sum */
    if (term->is_round)
        return exp_minus(across * across);
    double one = axial(place->u + rho, place->v - rho),
           other = axial(place->u - rho, place->v + rho);
    return exp_minus(across * across) * fmax(0, fmin(one, other));
}

void localfieldpool_release(LocalFieldPool *pool)
{
    free(pool->terms);
    free(pool->groups);
    free(pool->work);
    *pool = (LocalFieldPool){0};
}

static Status reserve_part(LocalFieldPool *pool, size_t terms, size_t words, Err *err)
{
    TRY(mem_reserve(&pool->terms, &pool->term_capacity, pool->n_terms + terms, sizeof *pool->terms,
                    "terms of a junction", err));
    return mem_reserve(&pool->groups, &pool->group_capacity, pool->n_groups + words,
                       sizeof *pool->groups, "terms of a junction", err);
}

Status localfield_refuse(Err *err)
{
    return err_set(err, STATUS_INFEASIBLE,
                   "more than %d segments meet at one point; leave some out", MAX_LOCAL_TERMS);
}

/* Returns a part without groups at the top of the pool. The caller appends its terms and groups. */
static LocalField begin_part(const LocalFieldPool *pool, uint32_t n_terms)
{
    return (LocalField){(uint32_t)pool->n_terms, n_terms, (uint32_t)pool->n_groups, 0,
                        (n_terms + 63) / 64};
}

Status localfield_all(const JunctionField *field, LocalFieldPool *pool, LocalField *out, Err *err)
{
    LocalField part = begin_part(pool, field->n_terms);
    size_t words = (size_t)part.words * field->n_groups;
    TRY(reserve_part(pool, field->n_terms, words, err));
    for (uint32_t i = 0; i < field->n_terms; i++)
        pool->terms[pool->n_terms++] = i;
    uint64_t *groups = &pool->groups[pool->n_groups];
    for (size_t i = 0; i < words; i++)
        groups[i] = 0;
    for (uint32_t g = 0; g < field->n_groups; g++)
        for (uint32_t i = field->first[g]; i < field->first[g + 1]; i++)
            groups[g * part.words + field->members[i] / 64] |= (uint64_t)1
                                                               << field->members[i] % 64;
    pool->n_groups += words;
    part.n_groups = field->n_groups;
    *out = part;
    return STATUS_OK;
}

Status localfield_copy(const LocalFieldPool *from, const LocalField *part, LocalFieldPool *to,
                       LocalField *out, Err *err)
{
    size_t words = (size_t)part->words * part->n_groups;
    TRY(reserve_part(to, part->n_terms, words, err));
    LocalField copy = begin_part(to, part->n_terms);
    copy.n_groups = part->n_groups;
    for (uint32_t i = 0; i < part->n_terms; i++)
        to->terms[to->n_terms++] = from->terms[part->first_term + i];
    for (size_t i = 0; i < words; i++)
        to->groups[to->n_groups++] = from->groups[part->first_group + i];
    *out = copy;
    return STATUS_OK;
}

/* Groups are not compared with each other if there are more than this, because the time of the
 * comparisons grows with the square of their number. */
enum { MOST_COMPARED = 256 };

static bool is_subset(const uint64_t *a, const uint64_t *b, uint32_t words)
{
    for (uint32_t i = 0; i < words; i++)
        if (a[i] & ~b[i])
            return false;
    return true;
}

/* Adds the group at the top of the pool to the part, unless it is a subset of a group of the part.
 * Removes the groups that are subsets of it. */
static void add_group(LocalFieldPool *pool, LocalField *part)
{
    uint64_t *groups = &pool->groups[part->first_group];
    uint32_t words = part->words, kept = 0;
    uint64_t *added = &groups[(size_t)part->n_groups * words];
    if (part->n_groups >= MOST_COMPARED) {
        pool->n_groups += words;
        part->n_groups++;
        return;
    }
    for (uint32_t g = 0; g < part->n_groups; g++)
        if (is_subset(added, &groups[(size_t)g * words], words))
            return;
    for (uint32_t g = 0; g <= part->n_groups; g++) {
        if (g < part->n_groups && is_subset(&groups[(size_t)g * words], added, words))
            continue;
        for (uint32_t i = 0; i < words; i++)
            groups[(size_t)kept * words + i] = groups[(size_t)g * words + i];
        kept++;
    }
    part->n_groups = kept;
    pool->n_groups = part->first_group + (size_t)kept * words;
}

/* Reduces the groups of `part` to the terms that the pool's work lists. */
static Status narrow_groups(LocalFieldPool *pool, const LocalField *part, LocalField *out, Err *err)
{
    for (uint32_t g = 0; g < part->n_groups; g++) {
        TRY(reserve_part(pool, 0, out->words, err));
        const uint64_t *group = &pool->groups[part->first_group + (size_t)g * part->words];
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

/* Returns the sum over a group of numbers that are `stride` doubles apart. */
static double group_sum(const uint64_t *group, uint32_t words, const double *values, size_t stride)
{
    double sum = 0;
    for (uint32_t w = 0; w < words; w++)
        for (uint64_t bits = group[w]; bits; bits &= bits - 1)
            sum += values[(w * 64 + (uint32_t)__builtin_ctzll(bits)) * stride];
    return sum;
}

static const uint64_t *group_of(const LocalFieldPool *pool, const LocalField *part, uint32_t number)
{
    return &pool->groups[part->first_group + (size_t)number * part->words];
}

/* Returns the group with the highest lower bound of its sum in the ball. */
static uint32_t leading_group(const LocalFieldPool *pool, const LocalField *part)
{
    const size_t stride = sizeof *pool->work / sizeof pool->work->lower;
    double most = -1;
    uint32_t best = 0;
    for (uint32_t g = 0; g < part->n_groups; g++) {
        double lower = group_sum(group_of(pool, part, g), part->words, &pool->work->lower, stride);
        if (lower > most) {
            most = lower;
            best = g;
        }
    }
    return best;
}

/* Returns true if the sum over group `a` is below the sum over `b` in all of the ball. Terms of
 * both groups are left out. */
static bool is_below(const LocalFieldPool *pool, const LocalField *part, const uint64_t *a,
                     const uint64_t *b)
{
    const size_t stride = sizeof *pool->work / sizeof pool->work->lower;
    uint64_t only_a[MAX_LOCAL_TERMS / 64], only_b[MAX_LOCAL_TERMS / 64];
    for (uint32_t w = 0; w < part->words; w++) {
        only_a[w] = a[w] & ~b[w];
        only_b[w] = b[w] & ~a[w];
    }
    return group_sum(only_a, part->words, &pool->work->upper, stride) <
           group_sum(only_b, part->words, &pool->work->lower, stride);
}

/* Returns true if two terms that may matter share no group. Only groups whose sum may be the
 * largest somewhere in the ball are looked at. */
static bool has_parted(const LocalFieldPool *pool, const LocalField *part)
{
    if (part->n_terms > MAX_LOCAL_TERMS)
        return false;
    uint64_t matters[MAX_LOCAL_TERMS / 64] = {0};
    const uint64_t *leader = group_of(pool, part, leading_group(pool, part));
    for (uint32_t g = 0; g < part->n_groups; g++) {
        const uint64_t *group = group_of(pool, part, g);
        for (uint32_t w = 0; w < part->words && !is_below(pool, part, group, leader); w++)
            matters[w] |= group[w];
    }
    for (uint32_t i = 0; i < part->n_terms; i++)
        if (pool->work[i].upper <= significant)
            matters[i / 64] &= ~((uint64_t)1 << i % 64);
    for (uint32_t g = 0; g < part->n_groups; g++)
        if (is_subset(matters, group_of(pool, part, g), part->words))
            return false;
    return true;
}

/* A surface that may pass a ball: its normal, and the distance of the centre outside it, mm. */
typedef struct NearSurface {
    Vec3 normal;
    double outside;
} NearSurface;

/* Returns true if two surfaces, taken as planes, meet in a ball of this radius, or face each other
 * in it. */
static bool surfaces_meet(const NearSurface *a, const NearSurface *b, double radius_mm)
{
    double cosine = vec3_dot(a->normal, b->normal);
    double apart = a->outside * a->outside + b->outside * b->outside -
                   2 * cosine * a->outside * b->outside; /* (distance * sine)^2 */
    return cosine < -0.5 || apart <= (1 - cosine * cosine) * radius_mm * radius_mm;
}

/* Returns how far the round cap at one end of a capsule is outside the capsule `cover`, along the
 * outward direction of the end, in units of the radius. A capsule that continues the first one
 * covers its cap, all but a ring if the radius decreases or the direction turns. 1: not covered. */
static double cap_beside(Vec3 end, Vec3 outward, double radius_mm, const PotentialTerm *cover)
{
    const TermPlace place = place_in(cover, end);
    const double short_of =
        (sqrt(distance2(&place)) / cover->k + radius_mm - cover->radius_mm) / radius_mm;
    if (short_of < cap_rounding)
        return 0;
    const double cosine = vec3_dot(outward, cover->axis) * (place.u < place.v ? 1 : -1);
    if (short_of > 0.5 || cosine <= 0)
        return 1;
    return fmin(1, sqrt(2 * short_of) + sqrt(fmax(0, 1 - cosine * cosine)));
}

/* Returns the surface of the i-th term. Beyond an end of the segment, the surface is the cap's
 * tangent plane, or the last tangent plane that no other term covers. `outside` is HUGE_VAL if
 * other terms cover the whole part of the surface that may be in the ball. */
static NearSurface find_surface(const JunctionField *field, const LocalFieldPool *pool,
                                const LocalField *part, uint32_t i, Vec3 center, double radius_mm)
{
    const uint32_t *terms = &pool->terms[part->first_term];
    const PotentialTerm *term = &field->terms[terms[i]];
    const TermPlace place = place_in(term, center);
    const double beyond = fmax(0, fmax(-place.u, -place.v)) / term->k;
    const Vec3 from = from_nearest(term, &place);
    double cap = 1;
    NearSurface surface = {vec3_normalized(from), vec3_length(from) - term->radius_mm};
    if (beyond == 0)
        return surface;
    const Vec3 outward = place.u < 0 ? vec3_scale(term->axis, -1) : term->axis;
    for (uint32_t k = 0; k < part->n_terms; k++)
        if (k != i)
            cap = fmin(cap, cap_beside(vec3_sub(center, from), outward, term->radius_mm,
                                       &field->terms[terms[k]]));
    if (beyond <= cap * vec3_length(from))
        return surface;
    surface.normal = vec3_add_scaled(vec3_scale(vec3_normalized(place.across), sqrt(1 - cap * cap)),
                                     outward, cap);
    surface.outside = beyond <= cap * term->radius_mm + radius_mm
                          ? vec3_dot(from, surface.normal) - term->radius_mm
                          : HUGE_VAL;
    return surface;
}

/* Returns the maximum difference of the normals of surfaces that meet in the ball. */
static double find_crease(const JunctionField *field, const LocalFieldPool *pool,
                          const LocalField *part, Vec3 center, double radius_mm)
{
    NearSurface surfaces[MAX_LOCAL_TERMS];
    uint32_t n = 0;
    double most = 0;
    for (uint32_t i = 0; i < part->n_terms && n < MAX_LOCAL_TERMS; i++) {
        if (pool->work[i].upper < FIELD_LEVEL || pool->work[i].lower > FIELD_LEVEL)
            continue;
        surfaces[n] = find_surface(field, pool, part, i, center, crease_slack * radius_mm);
        if (surfaces[n].outside == HUGE_VAL)
            continue;
        for (uint32_t k = 0; k < n; k++)
            if (surfaces_meet(&surfaces[k], &surfaces[n], crease_slack * radius_mm))
                most = fmax(most, vec3_distance(surfaces[k].normal, surfaces[n].normal));
        n++;
    }
    return most;
}

static void sum_bounds(const JunctionField *field, const LocalFieldPool *pool,
                       const LocalField *part, Vec3 center, double radius_mm, FieldBounds *bounds)
{
    *bounds = (FieldBounds){.min_radius_mm = HUGE_VAL};
    for (uint32_t i = 0; i < part->n_terms; i++) {
        uint32_t number = pool->terms[part->first_term + i];
        double radius = field->terms[number].radius_mm, upper = pool->work[i].upper;
        bounds->sum_upper += upper;
        if (upper > bounds->largest_upper) {
            bounds->largest_upper = upper;
            bounds->largest_term = number;
        }
        if (upper > significant)
            bounds->min_radius_mm = fmin(bounds->min_radius_mm, radius);
    }
    for (uint32_t g = 0; g < part->n_groups; g++) {
        const uint64_t *group = &pool->groups[part->first_group + (size_t)g * part->words];
        const TermBounds *work = pool->work;
        const size_t stride = sizeof *work / sizeof work->upper;
        double upper = group_sum(group, part->words, &work->upper, stride);
        double lower = group_sum(group, part->words, &work->lower, stride);
        bounds->upper = fmax(bounds->upper, upper);
        bounds->lower = fmax(bounds->lower, lower);
    }
    bool is_round = field->n_terms > 0 && field->terms[0].is_round;
    if (is_round)
        bounds->max_normal_difference = find_crease(field, pool, part, center, radius_mm);
    else
        bounds->has_unblended_pair = part->n_groups > 1 && has_parted(pool, part);
}

Status localfield_narrow(const JunctionField *field, LocalFieldPool *pool, const LocalField *part,
                         const FieldBalls *balls, NarrowField *out, Err *err)
{
    TRY(reserve_part(pool, part->n_terms, 0, err));
    TRY(mem_reserve(&pool->work, &pool->work_capacity, part->n_terms, sizeof *pool->work, "terms",
                    err));
    TermBounds *work = pool->work;
    LocalField narrow = begin_part(pool, 0);
    for (uint32_t i = 0; i < part->n_terms; i++) {
        uint32_t index = pool->terms[part->first_term + i];
        const PotentialTerm *term = &field->terms[index];
        TermPlace place = place_in(term, balls->center);
        double reach = out_of_reach + term->k * balls->radius_mm, inner = term->k * balls->inner_mm;
        if (distance2(&place) > reach * reach)
            continue;
        work[narrow.n_terms++] =
            (TermBounds){i, upper_bound(term, &place, inner), lower_bound(term, &place, inner)};
        pool->terms[pool->n_terms++] = index;
    }
    narrow.words = (narrow.n_terms + 63) / 64;
    TRY(narrow_groups(pool, part, &narrow, err));
    sum_bounds(field, pool, &narrow, balls->center, balls->inner_mm, &out->bounds);
    out->local = narrow;
    return STATUS_OK;
}

/* Finds the group with the largest sum. values[] has the values of the part's terms. */
static FieldValue largest_group(const LocalFieldPool *pool, const LocalField *part,
                                const double *values)
{
    FieldValue best = {.phi = 0};
    for (uint32_t g = 0; g < part->n_groups; g++) {
        const uint64_t *group = &pool->groups[part->first_group + (size_t)g * part->words];
        double sum = group_sum(group, part->words, values, 1);
        if (sum > best.phi)
            best = (FieldValue){.phi = sum, .group = g};
    }
    return best;
}

FieldValue localfield_value(const JunctionField *field, const LocalFieldPool *pool,
                            const LocalField *part, Vec3 x)
{
    double values[MAX_LOCAL_TERMS], sum = 0;
    const uint32_t *terms = &pool->terms[part->first_term];
    for (uint32_t i = 0; i < part->n_terms && part->n_groups == 1; i++)
        sum += potentialterm_value(&field->terms[terms[i]], x);
    if (part->n_groups < 2)
        return (FieldValue){.phi = sum};
    for (uint32_t i = 0; i < part->n_terms; i++)
        values[i] = potentialterm_value(&field->terms[terms[i]], x);
    return largest_group(pool, part, values);
}

/* The gradient of a sum of terms, and its largest term so far. */
typedef struct GradientSum {
    Vec3 gradient;
    double phi, largest;
    uint32_t largest_term;
} GradientSum;

static inline void add_term(GradientSum *sum, const PotentialTerm *term, uint32_t number,
                            const TermPlace *place, double value)
{
    if (value == 0)
        return;
    sum->phi += value;
    sum->gradient = vec3_add(sum->gradient, term_gradient(term, place, value));
    if (value > sum->largest) {
        sum->largest = value;
        sum->largest_term = number;
    }
}

/* Finds the group with the largest sum, and then the gradient of this sum alone. */
static FieldValue gradient_of_largest(const JunctionField *field, const LocalFieldPool *pool,
                                      const LocalField *part, Vec3 x, Vec3 *gradient)
{
    double values[MAX_LOCAL_TERMS];
    TermPlace places[MAX_LOCAL_TERMS];
    const uint32_t *terms = &pool->terms[part->first_term];
    GradientSum sum = {.largest = 0};
    for (uint32_t i = 0; i < part->n_terms; i++) {
        places[i] = place_in(&field->terms[terms[i]], x);
        values[i] = value_at(&field->terms[terms[i]], &places[i]);
    }
    FieldValue best = largest_group(pool, part, values);
    const uint64_t *group = group_of(pool, part, best.group);
    for (uint32_t i = 0; i < part->n_terms; i++)
        if (group[i / 64] >> i % 64 & 1)
            add_term(&sum, &field->terms[terms[i]], terms[i], &places[i], values[i]);
    *gradient = sum.gradient;
    best.largest_term = sum.largest_term;
    return best;
}

/* Most parts have one group, which holds all terms. */
FieldValue localfield_gradient(const JunctionField *field, const LocalFieldPool *pool,
                               const LocalField *part, Vec3 x, Vec3 *gradient)
{
    const uint32_t *terms = &pool->terms[part->first_term];
    GradientSum sum = {.largest = 0};
    if (part->n_groups > 1)
        return gradient_of_largest(field, pool, part, x, gradient);
    for (uint32_t i = 0; i < part->n_terms && part->n_groups == 1; i++) {
        const PotentialTerm *term = &field->terms[terms[i]];
        TermPlace place = place_in(term, x);
        add_term(&sum, term, terms[i], &place, value_at(term, &place));
    }
    *gradient = sum.gradient;
    return (FieldValue){.phi = sum.phi, .largest_term = sum.largest_term};
}

double field_height(double phi)
{
    return sqrt(-2 * elementary_log(fmin(fmax(phi, 1e-12), 0.9))) - 2;
}
