/* Finds the stretches (intervals) of a ray that lie inside a primitive, and the length of a union
 * of stretches.
 *
 * A primitive is a solid: the ray is inside between its first and its second crossing, between the
 * third and the fourth, and so on. The surface of a joint is closed by two discs, which no picture
 * shows, because they lie inside other vessels. Where the rulings of a joint cross, the surface
 * intersects itself; a point counts as inside if an odd number of crossings precedes it. */
#include "render/xray/xray.h"

#include <math.h>
#include <stdlib.h>

/* Sets *t to the parameter at which the ray crosses a disc across the axis. Returns the number of
 * crossings, 0 or 1. */
static int cross_disc(Ray ray, Vec3 center, Vec3 axis, double radius, double *t)
{
    double along = vec3_dot(ray.direction, axis);
    double at = vec3_dot(vec3_sub(center, ray.origin), axis) / along;
    if (!isfinite(at) || !(vec3_distance(ray_at(ray, at), center) <= radius))
        return 0;
    *t = at;
    return 1;
}

/* Sorts by insertion, which suffices for six numbers. */
static void sort_crossings(double *t, int n)
{
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && t[j] < t[j - 1]; j--) {
            double swapped = t[j];
            t[j] = t[j - 1];
            t[j - 1] = swapped;
        }
}

int primitive_inside(const Primitive *primitive, const PrimitiveFrame *frame, Ray ray,
                     RayInterval stretches[3])
{
    Hit hits[4];
    double t[4 + 2]; /* crossings of the surface and of two discs */
    int n = primitive_hits(primitive, frame, ray, hits), made = 0;
    for (int i = 0; i < n; i++)
        t[i] = hits[i].t;
    if (primitive->kind == PRIMITIVE_JOINT) {
        n += cross_disc(ray, primitive->a, primitive->axes[0], primitive->radius_mm, &t[n]);
        n += cross_disc(ray, primitive->b, primitive->axes[1], primitive->radius_b_mm, &t[n]);
    }
    sort_crossings(t, n);
    /* Through the rim of a cylinder, rounding may find the wall and the disc: the first and the
     * last crossing count. */
    if (primitive->kind == PRIMITIVE_CYLINDER && n > 2) {
        t[1] = t[n - 1];
        n = 2;
    }
    for (int i = 0; i + 1 < n; i += 2)
        if (t[i + 1] > 0)
            stretches[made++] = (RayInterval){fmax(t[i], 0), t[i + 1]};
    return made;
}

static int by_from(const void *a, const void *b)
{
    const RayInterval *x = a, *y = b;
    return (x->from > y->from) - (x->from < y->from);
}

double intervals_length(RayInterval *stretches, size_t n)
{
    double length = 0, reached = -HUGE_VAL;
    /* Most columns have few stretches, already in order: sorting is rarely needed. */
    for (size_t i = 1; i < n; i++)
        if (stretches[i].from < stretches[i - 1].from) {
            qsort(stretches, n, sizeof *stretches, by_from);
            break;
        }
    for (size_t i = 0; i < n; i++) {
        if (stretches[i].to > reached)
            length += stretches[i].to - fmax(stretches[i].from, reached);
        reached = fmax(reached, stretches[i].to);
    }
    return length;
}
