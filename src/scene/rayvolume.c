/* Finds the boxes that can affect a rectangle of the image: those that its rays can hit, and those
 * that can shadow what its rays hit. A box outside is never needed; a few boxes that are not needed
 * may be kept.
 *
 * The rays through the rectangle fill a frustum, which is cut off at the nearest and at
 * the farthest vessels. Objects that can shadow points of the frustum lie in the convex hull of the
 * frustum and the light.
 *
 * Each hull is stored as half-spaces that contain all its corners: a box outside one half-space is
 * outside the hull. Half-spaces with any normals would be correct. The normals used here are those
 * of the faces of the hull of a frustum and a point: the faces of the frustum, and planes through
 * one of its edges and the point. With these normals few boxes outside the hull are kept.
 *
 * The visible part of the ground may lie far away from the vessels. It is a quadrangle, stored as a
 * frustum without depth. If the horizon is visible, it extends up to the horizon. */
#include "scene/rayvolume.h"

#include "scene/geometry.h"
#include <math.h>
#include <stdlib.h>

/* Corners and faces of a frustum; corners of an area light. */
enum { CORNERS = 8, FACES = 6, LIGHT_CORNERS = 4 };
/* A hull has at most two frusta of points, for parallel light. Its planes come in pairs, two per
 * direction: the three axes, the faces, and the 12 edges with each corner of a light. */
enum { MAX_POINTS = 2 * CORNERS, MAX_PLANES = 2 * (3 + FACES + 12 * LIGHT_CORNERS) };

/* Distance by which half-spaces are moved outwards for rounding, relative to the largest
 * coordinate: far above the rounding error of doubles, and far below a pixel. */
static const double slack = 1e-9;

/* The convex hull of points, as half-spaces that contain it. The first CORNERS points are the
 * corners of a frustum: bit 0 of the index is right, bit 1 below, bit 2 far. */
typedef struct VolumeHull {
    Vec3 point[MAX_POINTS];
    int n_points;
    Vec3 normal[MAX_PLANES]; /* unit; all points x have normal . x <= end */
    double end[MAX_PLANES];
    int n_planes;
} VolumeHull;

struct RayVolume {
    size_t n;
    VolumeHull hulls[]; /* hulls of the pixels' rays, of the rays from vessels to each light, and of
                         * the rays from the ground to each light */
};

/* ---- half-spaces ----------------------------------------------------------------------------- */

static double largest_coordinate(const VolumeHull *hull)
{
    double largest = 0;
    for (int i = 0; i < hull->n_points; i++)
        for (int axis = 0; axis < 3; axis++)
            largest = fmax(largest, fabs(vec3_component(hull->point[i], axis)));
    return largest;
}

/* Adds the two half-spaces perpendicular to a direction; none if it is 0. */
static void add_slab(VolumeHull *hull, Vec3 across)
{
    double length = vec3_length(across), margin = slack * largest_coordinate(hull);
    for (int sign = -1; length > 0 && sign <= 1; sign += 2) {
        Vec3 normal = vec3_scale(across, sign / length);
        double end = -HUGE_VAL;
        for (int i = 0; i < hull->n_points; i++)
            end = fmax(end, vec3_dot(normal, hull->point[i]));
        hull->normal[hull->n_planes] = normal;
        hull->end[hull->n_planes++] = end + margin;
    }
}

/* Adds the half-spaces along the axes and of the faces of the frustum. The normal of a face is the
 * cross product of its diagonals. */
static void add_faces(VolumeHull *hull)
{
    add_slab(hull, vec3(1, 0, 0));
    add_slab(hull, vec3(0, 1, 0));
    add_slab(hull, vec3(0, 0, 1));
    for (int face = 0; face < FACES; face++) {
        int axis = face / 2, first = face % 2 << axis;
        int b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
        const Vec3 *p = hull->point;
        add_slab(hull, vec3_cross(vec3_sub(p[first | b | c], p[first]),
                                  vec3_sub(p[first | c], p[first | b])));
    }
}

/* Adds the half-spaces of the plane through an edge of the frustum and along a direction from it.
 */
static void add_edge(VolumeHull *hull, int from, int to, Vec3 direction)
{
    add_slab(hull, vec3_cross(vec3_sub(hull->point[to], hull->point[from]), direction));
}

/* Adds the half-spaces of the planes through each edge of the frustum and a light. `light` is the
 * position of the light, or the direction towards a parallel light. */
static void add_edges(VolumeHull *hull, Vec3 light, bool parallel)
{
    for (int from = 0; from < CORNERS; from++)
        for (int axis = 0; axis < 3; axis++)
            if (!(from & 1 << axis))
                add_edge(hull, from, from | 1 << axis,
                         parallel ? light : vec3_sub(light, hull->point[from]));
}

/* Returns false if the box is outside one of the half-spaces: if its corner that is farthest
 * inside, chosen by the signs of the normal, is outside. */
static bool hull_meets(const VolumeHull *hull, Box box)
{
    for (int i = 0; i < hull->n_planes; i++) {
        Vec3 n = hull->normal[i];
        double least = n.x * (n.x > 0 ? box.low.x : box.high.x) +
                       n.y * (n.y > 0 ? box.low.y : box.high.y) +
                       n.z * (n.z > 0 ? box.low.z : box.high.z);
        if (least > hull->end[i])
            return false;
    }
    return true;
}

/* ---- rays ------------------------------------------------------------------------------------ */

/* Sets the rays through the corners of the rectangle, enlarged by a pixel on each side. */
static void corner_rays(const Camera *camera, PixelRect part, Ray rays[4])
{
    for (int corner = 0; corner < 4; corner++)
        rays[corner] =
            camera_ray(camera, corner & 1 ? part.left + part.width + 0.5 : part.left - 1.5,
                       corner & 2 ? part.top + part.height + 0.5 : part.top - 1.5);
}

/* Returns the part of the rays between two depths along the direction of view. */
static VolumeHull frustum_between(const Camera *camera, const Ray rays[4], double near_mm,
                                  double far_mm)
{
    VolumeHull frustum = {.n_points = CORNERS};
    for (int i = 0; i < CORNERS; i++) {
        const Ray *ray = &rays[i & 3];
        double along = vec3_dot(ray->direction, camera->direction);
        frustum.point[i] = ray_at(*ray, (i & 4 ? far_mm : near_mm) / along);
    }
    return frustum;
}

/* Returns the part of the rays within the depths of the box. */
static VolumeHull frustum_of_box(const Camera *camera, const Ray rays[4], Box box)
{
    double near_mm = HUGE_VAL, far_mm = 0;
    for (int i = 0; i < CORNERS; i++) {
        Vec3 corner = vec3(i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                           i & 4 ? box.high.z : box.low.z);
        double depth = vec3_dot(vec3_sub(corner, camera->location), camera->direction);
        near_mm = fmin(near_mm, depth);
        far_mm = fmax(far_mm, depth);
    }
    return frustum_between(camera, rays, fmax(0, near_mm), far_mm);
}

/* Returns the part of the ground that the rays hit. */
static VolumeHull frustum_of_ground(const Camera *camera, const Ray rays[4], const Ground *ground)
{
    VolumeHull quadrangle = {.n_points = CORNERS};
    for (int i = 0; i < CORNERS; i++) {
        double t;
        if (!ground_hit(ground, rays[i & 3], 0, SCENE_FARTHEST_MM, &t))
            return frustum_between(camera, rays, 0, SCENE_FARTHEST_MM);
        quadrangle.point[i] = ray_at(rays[i & 3], t);
    }
    return quadrangle;
}

/* Extends a frustum to its convex hull with a light. For parallel light, this is the hull of the
 * frustum and of a copy that is moved towards the light beyond the bounds. */
static void reach_to_light(VolumeHull *hull, const Light *light, Box bounds)
{
    Vec3 towards = vec3_normalized(vec3_sub(light->location, light->target));
    double beyond = largest_coordinate(hull) + vec3_length(bounds.low) + vec3_length(bounds.high);
    if (light->parallel) {
        for (int i = 0; i < CORNERS; i++)
            hull->point[hull->n_points++] = vec3_add_scaled(hull->point[i], towards, 2 * beyond);
        add_faces(hull);
        add_edges(hull, towards, true);
        return;
    }
    const double half = light->round ? 0.501 : 0.5; /* POV-Ray's circles are off the middle */
    int n = light->samples > 1 ? LIGHT_CORNERS : 1;
    for (int k = 0; k < n; k++) {
        Vec3 at = light->location;
        for (int side = 0; n > 1 && side < 2; side++)
            at = vec3_add_scaled(at, light->sides[side], k & 1 << side ? half : -half);
        hull->point[hull->n_points++] = at;
    }
    add_faces(hull);
    for (int k = 0; k < n; k++)
        add_edges(hull, hull->point[CORNERS + k], false);
}

Status rayvolume_new(const View *view, Box bounds, PixelRect part, bool shadows, RayVolume **volume,
                     Err *err)
{
    Ray rays[4];
    size_t max_hulls = shadows ? 1 + 2 * view->n_lights : 1;
    RayVolume *made;
    TRY(mem_calloc(&made, 1, sizeof *made + max_hulls * sizeof *made->hulls, "part", err));
    corner_rays(&view->camera, part, rays);
    VolumeHull seen = frustum_of_box(&view->camera, rays, bounds);
    for (size_t i = 0; shadows && i < view->n_lights; i++) {
        made->hulls[made->n] = seen;
        reach_to_light(&made->hulls[made->n++], &view->lights[i], bounds);
        if (!view->ground.present)
            continue;
        made->hulls[made->n] = frustum_of_ground(&view->camera, rays, &view->ground);
        reach_to_light(&made->hulls[made->n++], &view->lights[i], bounds);
    }
    add_faces(&seen);
    made->hulls[made->n++] = seen;
    *volume = made;
    return STATUS_OK;
}

void rayvolume_free(RayVolume *volume)
{
    free(volume);
}

bool rayvolume_meets(const RayVolume *volume, Box box)
{
    bool meets = !volume;
    for (size_t i = volume ? volume->n : 0; i-- > 0 && !meets;)
        meets = hull_meets(&volume->hulls[i], box);
    return meets;
}
