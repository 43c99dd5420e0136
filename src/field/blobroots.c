/* Intervals of the ray are halved until a bound proves that an interval has no root, or until it is
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

/* A component whose field is above 0 on the ray only between t0 and t1. */
typedef struct Felt {
    LongVec a, axis;     /* an end, and the unit direction to the other end */
    long double length;  /* 0: a ball */
    long double radius2; /* mm^2 */
    long double strength;
    long double t0, t1;
} Felt;

typedef struct RootSearch {
    LongVec origin, direction;
    ARRAY(Felt) felt;
    long double low, high; /* the range of the ray that any component reaches */
    long double least;     /* smallest radius of a segment with such a component, mm */
    long double narrow;    /* intervals are halved until they are this wide, mm */
    BlobRoots *roots;
} RootSearch;

static LongVec point_of(Vec3 v)
{
    return (LongVec){v.x, v.y, v.z};
}

static LongVec along(LongVec p, LongVec d, long double t)
{
    return (LongVec){p.x + d.x * t, p.y + d.y * t, p.z + d.z * t};
}

static long double dot(LongVec a, LongVec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static LongVec less(LongVec a, LongVec b)
{
    return along(a, b, -1);
}

/* Sets *felt to the component. Returns false if the ray misses the ball about the component between
 * t_min and t_max. */
static bool take_component(const RootSearch *search, const BlobComponent *component, bool tube,
                           long double t_min, long double t_max, Felt *felt)
{
    LongVec a = point_of(component->a), span = less(point_of(component->b), a);
    long double length = tube ? sqrtl(dot(span, span)) : 0;
    long double radius = component->radius_mm, reach = radius + length / 2;
    LongVec middle = along(a, span, tube ? 0.5L : 0), from = less(middle, search->origin);
    long double t = dot(from, search->direction);
    LongVec off = along(from, search->direction, -t);
    long double half2 = reach * reach - dot(off, off);
    if (!(half2 > 0))
        return false;
    long double half = sqrtl(half2);
    *felt = (Felt){a,
                   length > 0 ? along((LongVec){0, 0, 0}, span, 1 / length) : span,
                   length,
                   radius * radius,
                   component->strength,
                   fmaxl(t - half, t_min),
                   fminl(t + half, t_max)};
    return felt->t0 < felt->t1;
}

static long double field_of(const Felt *felt, LongVec x)
{
    LongVec from = less(x, felt->a);
    long double foot = fminl(fmaxl(dot(from, felt->axis), 0), felt->length);
    LongVec off = along(from, felt->axis, -foot);
    long double inside = 1 - dot(off, off) / felt->radius2;
    return inside > 0 ? felt->strength * inside * inside : 0;
}

/* Returns the sum of the first n components at t, minus 1. */
static long double excess(const RootSearch *search, size_t n, long double t)
{
    long double sum = -1;
    LongVec x = along(search->origin, search->direction, t);
    for (size_t i = 0; i < n; i++)
        sum += field_of(&search->felt.items[i], x);
    return sum;
}

/* Moves the components that reach into [low, high] to the front of the first n. Returns their
 * number. *curvature receives the bound M of the second derivative. */
static size_t keep_felt(Felt *felt, size_t n, long double low, long double high,
                        long double *curvature)
{
    size_t kept = 0;
    *curvature = 0;
    for (size_t i = 0; i < n; i++) {
        Felt at = felt[i];
        if (at.t1 < low || at.t0 > high)
            continue;
        felt[i] = felt[kept];
        felt[kept++] = at;
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
    n = keep_felt(search->felt.items, n, low, high, &curvature);
    bool passes = (f_low < 0) != (f_high < 0);
    if (!passes && fminl(fabsl(f_low), fabsl(f_high)) > curvature * width * width / 8)
        return;
    if (width <= search->narrow) {
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
static Status list_felt(RootSearch *search, const FieldSegment *segments, size_t n, Ray ray,
                        const double range[2], Err *err)
{
    for (size_t i = 0; i < n; i++) {
        BlobComponent components[BLOB_COMPONENTS];
        if (!meets_ball(ray, blob_ball(&segments[i])))
            continue;
        blob_components(&blob_shape, &segments[i], components);
        TRY(ARRAY_RESERVE(&search->felt, BLOB_COMPONENTS, "components", err));
        for (int c = 0; c < BLOB_COMPONENTS; c++) {
            Felt *next = &search->felt.items[search->felt.n];
            if (!take_component(search, &components[c], blob_component_is_tube(c), range[0],
                                range[1], next))
                continue;
            search->low = fminl(search->low, next->t0);
            search->high = fmaxl(search->high, next->t1);
            search->least = fminl(search->least, segments[i].radius_mm);
            search->felt.n++;
        }
    }
    return STATUS_OK;
}

Status blob_roots(const FieldSegment *segments, size_t n, Ray ray, double t_min, double t_max,
                  BlobRoots *roots, Err *err)
{
    RootSearch search = {.origin = point_of(ray.origin),
                         .direction = point_of(ray.direction),
                         .low = HUGE_VALL,
                         .high = -HUGE_VALL,
                         .least = HUGE_VALL,
                         .roots = roots};
    Status status;
    *roots = (BlobRoots){.is_complete = true};
    TRY_GOTO(list_felt(&search, segments, n, ray, (const double[2]){t_min, t_max}, err));
    if (search.felt.n > 0) {
        long double low = search.low, high = search.high, far = fmaxl(fabsl(low), fabsl(high));
        search.narrow = fmaxl(1e-12L * search.least, 4 * LDBL_EPSILON * far);
        search_between(&search, search.felt.n, low, high, excess(&search, search.felt.n, low),
                       excess(&search, search.felt.n, high));
    }
done:
    ARRAY_RELEASE(&search.felt);
    return status;
}
