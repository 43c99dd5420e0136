/* Brute force along a ray of the potential, for tests of proofs. For a blob, the field is
 * multiplied by FIELD_LEVEL, so that it has the same level as the potential. */
#ifndef CORCAST_TESTS_FIELD_WALK_H
#define CORCAST_TESTS_FIELD_WALK_H

#include "field_scenes.h"
#include <stdlib.h>

/* Potential by which the picture may be off: a millionth for each term that the ray passes, all of
 * which may be left out somewhere along it, and for single precision. */
static inline long double epsilon_of(size_t n_terms)
{
    return 1e-6L * (long double)(n_terms + 4);
}

typedef struct Near {
    const FieldSegment *segment;
    double on, off; /* along the ray; outside, the term is below e^-32, or 0 */
    double bend;    /* bound of the term's second derivative along any line, 1/mm^2 */
} Near;

typedef struct Walk {
    Ray ray;
    bool blob;
    Near *near; /* by rising `on` */
    size_t n;
    double t;
} Walk;

static inline int compare_near(const void *a, const void *b)
{
    double one = ((const Near *)a)->on, other = ((const Near *)b)->on;
    return (one > other) - (one < other);
}

/* The distances of the ray's line from the segment, and from the segment's own line. */
static inline void line_distances(Ray ray, const FieldSegment *segment, double *to_segment,
                                  double *to_line)
{
    Vec3 span = vec3_sub(segment->b, segment->a), from = vec3_sub(segment->a, ray.origin);
    Vec3 across = vec3_add_scaled(span, ray.direction, -vec3_dot(span, ray.direction));
    Vec3 start = vec3_add_scaled(from, ray.direction, -vec3_dot(from, ray.direction));
    double length2 = vec3_dot(across, across);
    double s = length2 > 0 ? -vec3_dot(start, across) / length2 : 0;
    *to_line = vec3_length(vec3_add_scaled(start, across, s));
    *to_segment = vec3_length(vec3_add_scaled(start, across, fmin(fmax(s, 0), 1)));
}

/* On a line with sine s and cosine c to the axis, a term is exp(-e^2) G A, G = exp(-w^2) and A the
 * axial factor: the suprema of G'', 2 |G'| |A'| and |A''| are 4 exp(-3/2) s^2, 2 sqrt(2/e) /
 * sqrt(pi) s c and sqrt(2/e) / sqrt(pi) c^2, times k^2. */
static inline double bend_of(const FieldSegment *segment, Ray ray, double to_line)
{
    Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
    double c = fabs(vec3_dot(axis, ray.direction)),
           s = vec3_length(vec3_cross(axis, ray.direction));
    double k = sqrt(2) / segment->radius_mm;
    return k * k * exp(-k * k * to_line * to_line) *
           (0.8926 * s * s + 0.9682 * s * c + 0.4841 * c * c);
}

/* What a segment of the geometry's model adds at x, and its gradient unless that is NULL. */
static inline long double walk_term(bool blob, const FieldSegment *segment, LongVec3 x,
                                    LongVec3 *gradient)
{
    const long double level = (long double)FIELD_LEVEL;
    if (!blob)
        return exact_term(segment, x, gradient);
    long double term = exact_blob_term(segment, x, gradient);
    if (gradient)
        *gradient = (LongVec3){gradient->x * level, gradient->y * level, gradient->z * level};
    return term * level;
}

/* Of a component of radius R and strength S the second derivative along any line is at most
 * 8 S / R^2, or -4 S / R^2. */
static inline double blob_bend(const FieldSegment *segment)
{
    double sum = 0;
    for (int i = 0; i < BLOB_TUBES; i++)
        sum += 12 * blob_shape.tube[i].strength / pow(blob_shape.tube[i].radius, 2);
    for (int i = 0; i < BLOB_BEAD_PAIRS; i++)
        sum += 24 * blob_shape.bead[i].strength / pow(blob_shape.bead[i].radius, 2);
    return FIELD_LEVEL * sum / (segment->radius_mm * segment->radius_mm);
}

/* Farther than so many radii from its segment a term is below e^-32, or 0. */
static inline double walk_reach(bool blob)
{
    return blob ? blob_reach(&blob_shape) : 4;
}

static inline Walk walk_start(const Geometry *geometry, Ray ray, Near *near)
{
    Walk walk = {.ray = ray, .blob = geometry->model == SCENE_BLOB, .near = near};
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *segment = &geometry->segments[i];
        double r = segment->radius_mm, to_segment, to_line;
        line_distances(ray, segment, &to_segment, &to_line);
        double reach = r * walk_reach(walk.blob);
        if (to_segment > reach)
            continue;
        double t_a = vec3_dot(vec3_sub(segment->a, ray.origin), ray.direction);
        double t_b = vec3_dot(vec3_sub(segment->b, ray.origin), ray.direction);
        near[walk.n++] = (Near){segment, fmin(t_a, t_b) - reach, fmax(t_a, t_b) + reach,
                                walk.blob ? blob_bend(segment) : bend_of(segment, ray, to_line)};
    }
    qsort(near, walk.n, sizeof *near, compare_near);
    walk.t = walk.n ? near[0].on : HUGE_VAL;
    return walk;
}

static inline LongVec3 point_at(const Walk *walk, double t)
{
    Ray ray = walk->ray;
    long double s = (long double)t;
    return (LongVec3){(long double)ray.origin.x + s * (long double)ray.direction.x,
                      (long double)ray.origin.y + s * (long double)ray.direction.y,
                      (long double)ray.origin.z + s * (long double)ray.direction.z};
}

static inline long double slope_along(const Walk *walk, LongVec3 gradient)
{
    Vec3 d = walk->ray.direction;
    return gradient.x * (long double)d.x + gradient.y * (long double)d.y +
           gradient.z * (long double)d.z;
}

static inline bool is_far(bool blob, const FieldSegment *segment, Vec3 x)
{
    Vec3 span = vec3_sub(segment->b, segment->a), from = vec3_sub(x, segment->a);
    double s = vec3_dot(from, span) / vec3_dot(span, span);
    Vec3 across = vec3_add_scaled(from, span, -fmin(fmax(s, 0), 1));
    return vec3_length(across) > walk_reach(blob) * segment->radius_mm;
}

/* Walks on to where the potential first reaches the level; false when it never does. */
static inline bool walk_to(Walk *walk, long double level)
{
    for (;;) {
        long double lack = level, slope = 0;
        double bend = 0, next = HUGE_VAL, smallest = HUGE_VAL;
        LongVec3 x = point_at(walk, walk->t);
        for (size_t i = 0; i < walk->n; i++) {
            const Near *near = &walk->near[i];
            if (near->on > walk->t) {
                next = near->on;
                break;
            }
            if (near->off < walk->t)
                continue;
            bend += near->bend;
            smallest = fmin(smallest, near->segment->radius_mm);
            if (is_far(walk->blob, near->segment, ray_at(walk->ray, walk->t)))
                continue;
            LongVec3 gradient;
            lack -= walk_term(walk->blob, near->segment, x, &gradient);
            slope += slope_along(walk, gradient);
        }
        if (lack <= 1e-10L)
            return true;
        double step = HUGE_VAL, p = (double)slope, root = sqrt(p * p + 2 * bend * (double)lack);
        if (bend > 0)
            step = p > 0 ? 2 * (double)lack / (p + root) : (root - p) / bend;
        walk->t = fmin(walk->t + fmax(step, 2e-5 * smallest), next);
        if (!(walk->t < HUGE_VAL))
            return false;
    }
}

/* The n-th of the sums whose union is the surface, with its segments in `members`. */
static inline Geometry sum_of(const Geometry *geometry, size_t number, FieldSegment *members)
{
    const IndexLists *lists = &geometry->blend.members;
    Geometry sum = {.model = geometry->model, .segments = members};
    if (!geometry->blend.n_groups)
        return *geometry;
    for (uint32_t i = lists->first[number]; i < lists->first[number + 1]; i++)
        members[sum.n_segments++] = geometry->segments[lists->items[i]];
    return sum;
}

#endif
