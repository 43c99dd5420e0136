/* Tests whether a ray meets a bounding box exactly as POV-Ray does, with its rounding, because the
 * order of boxes decides which of two equal hits POV-Ray shows.
 *
 * POV-Ray intersects a ray with an object if two tests find that the ray meets the object's box:
 * the test of its leaf in the hierarchy of boxes (Check_And_Enqueue of bounding/bbox.cpp of
 * 3.7.0.10), and the test of the object itself (Intersect_BBox_Dir of scene/objects.cpp). Both
 * compute in single precision, in different orders. The boxes above the leaf contain the leaf's box
 * and are not tested here: they differ from tile to tile. */
#include "render/cast/povray_bound.h"

/* POV-Ray's constants EPSILON, BOUND_HUGE and MIN_ISECT_DEPTH, in units of t. */
static const double epsilon = 1e-10, bound_huge = 2e10;
static const float min_isect_depth = 1e-4F;

/* A bounding box: its lower corner and its size. */
typedef struct PovrayBox {
    float low[3], size[3];
} PovrayBox;

/* Returns a box in single precision, as POV-Ray stores it. */
static PovrayBox bound_of(Box box)
{
    return (PovrayBox){{(float)box.low.x, (float)box.low.y, (float)box.low.z},
                       {(float)(box.high.x - box.low.x), (float)(box.high.y - box.low.y),
                        (float)(box.high.z - box.low.z)}};
}

BoundRay bound_ray(Ray ray)
{
    Vec3 o = ray.origin, d = ray.direction;
    return (BoundRay){{(float)o.x, (float)o.y, (float)o.z},
                      {(float)(1 / d.x), (float)(1 / d.y), (float)(1 / d.z)}};
}

/* The leaf's test. Sets *first to the t at which the ray enters the box. */
static bool meets_leaf(const BoundRay *ray, const PovrayBox *bound, double *first)
{
    double last = bound_huge;
    *first = -bound_huge;
    for (int axis = 0; axis < 3; axis++) {
        float low = bound->low[axis], size = bound->size[axis], origin = ray->origin[axis],
              inverse = ray->inverse[axis];
        if (isinf(inverse)) {
            if (origin < low || origin > low + size)
                return false;
            continue;
        }
        double at_low = (double)((low - origin) * inverse);
        double at_high = at_low + (double)(size * inverse);
        *first = fmax(*first, fmin(at_low, at_high));
        last = fmin(last, fmax(at_low, at_high));
    }
    return *first <= last && last >= epsilon;
}

/* The test of the object. If the ray is parallel to a side and its origin lies in the plane of that
 * side, 0 times infinity gives NaN, and every comparison with it is false. A NaN from x therefore
 * remains and fails the last comparison. A NaN from y or z is skipped. */
static bool meets_object(const BoundRay *ray, const PovrayBox *bound)
{
    float near[3], far[3];
    for (int axis = 0; axis < 3; axis++) {
        float low = bound->low[axis], high = low + bound->size[axis];
        bool down = ray->inverse[axis] < 0;
        near[axis] = ((down ? high : low) - ray->origin[axis]) * ray->inverse[axis];
        far[axis] = ((down ? low : high) - ray->origin[axis]) * ray->inverse[axis];
    }
    float first = near[0], last = far[0];
    for (int axis = 1; axis < 3; axis++) {
        if (first > far[axis] || near[axis] > last)
            return false;
        first = near[axis] > first ? near[axis] : first;
        last = far[axis] < last ? far[axis] : last;
    }
    return first < HUGE_VALF && last > min_isect_depth;
}

bool povray_looks_into(const BoundRay *ray, Box box, double *order)
{
    PovrayBox bound = bound_of(box);
    return meets_leaf(ray, &bound, order) && meets_object(ray, &bound);
}
