/* Finds all points where a ray meets the surface of a blob, with proof that none is missed.
 *
 * Intervals of the ray are halved until a bound proves that an interval has no root, or until it is
 * as narrow as the precision allows.
 *
 * Along a line of unit direction a component's field is f = S (1 - q)^2, with q = d^2 / R^2 < 1.
 * With 0 <= q'' <= 2 / R^2 and q'^2 <= 4 q / R^2, f'' = 2 S (q'^2 - (1 - q) q'') is between
 * -4 S / R^2 and 8 S / R^2, and f' has no jump. So |F''| of the sum F is at most M, the sum of
 * 8 |S| / R^2 over the components that reach into the interval. In an interval of width w, F is
 * within M w^2 / 8 of the straight line between its values at the ends. If this keeps F away from
 * 1, the interval holds no root. */

#include "field/blob.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

typedef struct LongVec {
    long double x, y, z;
} LongVec;

/* A component of the blob that the ray meets. Its field on the ray is 0 except between t0 and t1.
 */
typedef struct RayComponent {
    LongVec a, axis;     /* an end, and the unit direction to the other end */
    long double length;  /* 0: a ball */
    long double radius2; /* mm^2 */
    long double strength;
    long double t0, t1;
} RayComponent;

typedef struct RootSearch {
    LongVec origin, direction;
    ARRAY(RayComponent) components;
    long double low, high;  /* the range of the ray that any component reaches */
    long double min_radius; /* smallest radius of a segment with such a component, mm */
    long double min_width;  /* intervals are halved until they are this wide, mm */
    BlobRoots *roots;
} RootSearch;

static LongVec longvec_of(Vec3 v)
{
    return (LongVec){v.x, v.y, v.z};
}

static LongVec advanced(LongVec p, LongVec d, long double t)
{
    return (LongVec){p.x + d.x * t, p.y + d.y * t, p.z + d.z * t};
}

static long double dot(LongVec a, LongVec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static LongVec minus(LongVec a, LongVec b)
{
    return advanced(a, b, -1);
}

/* Fills *out with the component. Returns false if the ray misses the ball about the component
 * between t_min and t_max. */
static bool component_on_ray(const RootSearch *search, const BlobComponent *component, bool tube,
                             long double t_min, long double t_max, RayComponent *out)
{
    LongVec a = longvec_of(component->a), span = minus(longvec_of(component->b), a);
    long double length = tube ? sqrtl(dot(span, span)) : 0;
    long double radius = component->radius_mm, reach = radius + length / 2;
    LongVec middle = advanced(a, span, tube ? 0.5L : 0), from = minus(middle, search->origin);
    long double t = dot(from, search->direction);
    LongVec off = advanced(from, search->direction, -t);
    long double half2 = reach * reach - dot(off, off);
    if (!(half2 > 0))
        return false;
    long double half = sqrtl(half2);
    *out = (RayComponent){a,
                          length > 0 ? advanced((LongVec){0, 0, 0}, span, 1 / length) : span,
                          length,
                          radius * radius,
                          component->strength,
                          fmaxl(t - half, t_min),
                          fminl(t + half, t_max)};
    return out->t0 < out->t1;
}

static long double field_of(const RayComponent *component, LongVec x)
{
    LongVec from = minus(x, component->a);
    long double foot = fminl(fmaxl(dot(from, component->axis), 0), component->length);
    LongVec off = advanced(from, component->axis, -foot);
    long double inside = 1 - dot(off, off) / component->radius2;
    return inside > 0 ? component->strength * inside * inside : 0;
}

/* Returns the sum of the first n components at t, minus 1. */
static long double excess(const RootSearch *search, size_t n, long double t)
{
    long double sum = -1;
    LongVec x = advanced(search->origin, search->direction, t);
    for (size_t i = 0; i < n; i++)
        sum += field_of(&search->components.items[i], x);
    return sum;
}

/* Moves the components that reach into [low, high] to the front of the first n. Returns their
 * number. *curvature receives the bound M of the second derivative. */
static size_t keep_reaching(RayComponent *components, size_t n, long double low, long double high,
                            long double *curvature)
{
    size_t kept = 0;
    *curvature = 0;
    for (size_t i = 0; i < n; i++) {
        RayComponent at = components[i];
        if (at.t1 < low || at.t0 > high)
            continue;
        components[i] = components[kept];
        components[kept++] = at;
        *curvature += 8 * fabsl(at.strength) / at.radius2;
    }
    return kept;
}

/* Finds the roots between `low` and `high`, where the excess is `f_low` and `f_high`, among the
 * first n. */
static void search_between(RootSearch *search, size_t n, long double low, long double high,
                           long double f_low, long double f_high)
{
    BlobRoots *roots = search->roots;
    if (roots->n == BLOB_ROOTS)
        return;
    long double curvature, width = high - low;
    n = keep_reaching(search->components.items, n, low, high, &curvature);
    bool passes = (f_low < 0) != (f_high < 0);
    if (!passes && fminl(fabsl(f_low), fabsl(f_high)) > curvature * width * width / 8)
        return;
    if (width <= search->min_width) {
        if (passes)
            roots->t[roots->n++] = (double)((low + high) / 2);
        else
            roots->is_complete = false;
        return;
    }
    long double middle = (low + high) / 2, f_middle = excess(search, n, middle);
    search_between(search, n, low, middle, f_low, f_middle);
    search_between(search, n, middle, high, f_middle, f_high);
}

static bool meets_ball(Ray ray, Ball ball)
{
    Vec3 from = vec3_sub(ball.center, ray.origin);
    Vec3 off = vec3_add_scaled(from, ray.direction, -vec3_dot(from, ray.direction));
    return vec3_length(off) <= ball.radius;
}

/* Finds the components that the ray may meet in a range of t. */
static Status list_components(RootSearch *search, const FieldSegment *segments, size_t n, Ray ray,
                              const double range[2], Err *err)
{
    for (size_t i = 0; i < n; i++) {
        BlobComponent components[BLOB_COMPONENTS];
        if (!meets_ball(ray, blob_ball(&segments[i])))
            continue;
        blob_components(&blob_shape, &segments[i], components);
        TRY(ARRAY_RESERVE(&search->components, BLOB_COMPONENTS, "components", err));
        for (int c = 0; c < BLOB_COMPONENTS; c++) {
            RayComponent *next = &search->components.items[search->components.n];
            if (!component_on_ray(search, &components[c], blob_component_is_tube(c), range[0],
                                  range[1], next))
                continue;
            search->low = fminl(search->low, next->t0);
            search->high = fmaxl(search->high, next->t1);
            search->min_radius = fminl(search->min_radius, segments[i].radius_mm);
            search->components.n++;
        }
    }
    return STATUS_OK;
}

Status blob_roots(const FieldSegment *segments, size_t n, Ray ray, double t_min, double t_max,
                  BlobRoots *roots, Err *err)
{
    RootSearch search = {.origin = longvec_of(ray.origin),
                         .direction = longvec_of(ray.direction),
                         .low = HUGE_VALL,
                         .high = -HUGE_VALL,
                         .min_radius = HUGE_VALL,
                         .roots = roots};
    Status status;
    *roots = (BlobRoots){.is_complete = true};
    TRY_GOTO(list_components(&search, segments, n, ray, (const double[2]){t_min, t_max}, err));
    if (search.components.n > 0) {
        long double low = search.low, high = search.high, far = fmaxl(fabsl(low), fabsl(high));
        search.min_width = fmaxl(1e-12L * search.min_radius, 4 * LDBL_EPSILON * far);
        search_between(&search, search.components.n, low, high,
                       excess(&search, search.components.n, low),
                       excess(&search, search.components.n, high));
    }
done:
    ARRAY_RELEASE(&search.components);
    return status;
}
