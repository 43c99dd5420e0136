/* triangle_search: finds the hits of a ray with a triangle mesh, by a bounding volume hierarchy of
 * triangles.
 *
 * It repeats POV-Ray's intersection with the triangles of a mesh2 (shape/mesh.cpp of 3.7.0.10): the
 * ray is intersected with the plane of the triangle, whose normal and distance are in single
 * precision. The hit must lie within the three edges, projected along the axis of the largest
 * component of the normal.
 *
 * The shading normal is interpolated between the normals of the corners, in POV-Ray's order of the
 * corners and in single precision where POV-Ray uses it. Pictures would differ otherwise: a
 * highlight of size 40 enlarges one rounding error 40 times. */
#include "render/cast/boxcast.h"

#include <stdlib.h>

static const double epsilon = 1e-10; /* POV-Ray's EPSILON */

/* The points x of the plane have normal . x + distance = 0. */
typedef struct TrianglePlane {
    float normal[3]; /* unit, inward; 0 of a triangle without area, which no ray meets */
    float distance;
} TrianglePlane;

static Vec3 vec3_of(const float values[3])
{
    return vec3((double)values[0], (double)values[1], (double)values[2]);
}

/* Returns the axis of a vector's largest component; among equal components, POV-Ray's choice. */
static int main_axis(Vec3 v)
{
    double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
    if (x > y)
        return x > z ? 0 : 2;
    return y > z ? 1 : 2;
}

static void find_corners(const VesselMesh *mesh, size_t triangle, Vec3 at[3])
{
    for (int k = 0; k < 3; k++)
        at[k] = mesh_point(mesh, mesh->triangles[triangle][k]);
}

/* Returns the plane of a triangle; its normal is 0 if the triangle has no area. */
static TrianglePlane triangle_plane(const Vec3 at[3])
{
    Vec3 across = vec3_cross(vec3_sub(at[2], at[0]), vec3_sub(at[1], at[0]));
    double length = vec3_length(across);
    if (length == 0)
        return (TrianglePlane){0};
    Vec3 normal = vec3_scale(across, 1 / length);
    return (TrianglePlane){{(float)normal.x, (float)normal.y, (float)normal.z},
                           (float)-vec3_dot(normal, at[0])};
}

static Box triangle_box(const RayIndex *index, size_t triangle)
{
    Box box = box_empty();
    Vec3 at[3];
    find_corners(&index->geometry->mesh, triangle, at);
    for (int k = 0; k < 3; k++)
        box = box_with_ball(box, at[k], 0);
    /* A hit lies off the triangle by the rounding of its plane. */
    return box_padded(box, 1e-6 * (vec3_length(box.low) + vec3_length(box.high)));
}

static Status build(RayIndex *index, const CellParams *cells, Err *err)
{
    (void)cells;
    const VesselMesh *mesh = &index->geometry->mesh;
    TRY(mem_calloc(&index->planes, mesh->n_triangles, sizeof *index->planes, "triangles", err));
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        Vec3 at[3];
        find_corners(mesh, i, at);
        index->planes[i] = triangle_plane(at);
    }
    return rayindex_build_boxes(index, mesh->n_triangles, triangle_box, err);
}

/* Returns twice the signed area of the triangle between the point (x, y) and the edge from a to b,
 * projected to the plane of the two axes. */
static double side_of(Vec3 a, Vec3 b, int along_x, int along_y, double x, double y)
{
    double ax = vec3_component(a, along_x), ay = vec3_component(a, along_y);
    double bx = vec3_component(b, along_x), by = vec3_component(b, along_y);
    return (bx - x) * (by - ay) - (by - y) * (bx - ax);
}

/* Returns true if a point of the triangle's plane lies within the triangle, edges included. */
static bool contains(const Vec3 at[3], Vec3 normal, Vec3 point)
{
    int axis = main_axis(normal), along_x = axis == 0, along_y = axis == 2 ? 1 : 2;
    double px = vec3_component(point, along_x), py = vec3_component(point, along_y);
    double a = side_of(at[0], at[1], along_x, along_y, px, py);
    double b = side_of(at[1], at[2], along_x, along_y, px, py);
    double c = side_of(at[2], at[0], along_x, along_y, px, py);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/* Callback of type ItemCrossings. Returns the number of hits, 0 or 1. Sets hits[0].t only. */
static inline int triangle_crossings(const void *items, uint32_t triangle, Ray ray,
                                     Hit hits[ITEM_CROSSINGS], double *rank)
{
    (void)rank;
    const RayIndex *index = items;
    const TrianglePlane *plane = &index->planes[triangle];
    Vec3 normal = vec3_of(plane->normal), at[3];
    double along = vec3_dot(normal, ray.direction);
    if (fabs(along) < epsilon)
        return 0;
    hits->t = -((double)plane->distance + vec3_dot(normal, ray.origin)) / along;
    find_corners(&index->geometry->mesh, triangle, at);
    return contains(at, normal, ray_at(ray, hits->t));
}

/* Rounds a vector to single precision. */
static Vec3 single(Vec3 v)
{
    return vec3((double)(float)v.x, (double)(float)v.y, (double)(float)v.z);
}

/* Returns true if POV-Ray exchanges the first two corners, so that all triangles have the same
 * winding when viewed along the axis. */
static bool is_turned(const Vec3 at[3], Vec3 normal)
{
    int axis = main_axis(normal), along_x = axis == 0, along_y = axis == 2 ? 1 : 2;
    Vec3 back = vec3_sub(at[1], at[2]), edge = vec3_sub(at[1], at[0]);
    return vec3_component(back, along_x) * vec3_component(edge, along_y) <
           vec3_component(back, along_y) * vec3_component(edge, along_x);
}

/* Returns the interpolated normal at a point of the triangle. u goes from 0 at the first corner to
 * 1 at the opposite edge. v goes along that edge; it is measured along the axis of the edge's
 * largest component. */
static Vec3 smooth_normal(const VesselMesh *mesh, size_t triangle, Vec3 plane_normal, Vec3 point)
{
    Vec3 at[3], normal[3];
    find_corners(mesh, triangle, at);
    for (int k = 0; k < 3; k++)
        normal[k] = single(vec3_normalized(vec3_of(mesh->normals[mesh->triangles[triangle][k]])));
    if (is_turned(at, plane_normal)) {
        Vec3 corner = at[0], other = normal[0];
        at[0] = at[1];
        at[1] = corner;
        normal[0] = normal[1];
        normal[1] = other;
    }
    Vec3 edge = vec3_normalized(vec3_sub(at[1], at[2])), from = vec3_sub(at[0], at[2]);
    Vec3 across = single(vec3_normalized(vec3_sub(vec3_scale(edge, vec3_dot(from, edge)), from)));
    Vec3 perp = single(vec3_scale(across, -1 / vec3_dot(from, across)));
    Vec3 in = vec3_sub(point, at[0]), opposite = vec3_sub(at[2], at[1]);
    double u = vec3_dot(in, perp);
    if (u < epsilon)
        return vec3_normalized(normal[0]);
    int axis = main_axis(opposite);
    double v = (vec3_component(in, axis) / u + vec3_component(vec3_sub(at[0], at[1]), axis)) /
               vec3_component(opposite, axis);
    Vec3 ahead = vec3_add_scaled(vec3_sub(normal[1], normal[0]), vec3_sub(normal[2], normal[1]), v);
    return vec3_normalized(vec3_add_scaled(normal[0], ahead, u));
}

/* Returns the shading normal at a point of the triangle: that of the plane on the flat cap of a
 * vessel's end, otherwise interpolated. */
static Vec3 normal_at(const VesselMesh *mesh, size_t triangle, Vec3 plane_normal, Vec3 point)
{
    float flat[3];
    if (!mesh_is_cap(mesh, triangle))
        return smooth_normal(mesh, triangle, plane_normal, point);
    mesh_flat_normal(mesh, triangle, flat);
    return vec3_normalized(vec3_of(flat));
}

static bool first_triangle(const RayIndex *index, void *workspace, const RayPart *part, RayHit *hit)
{
    (void)workspace;
    const VesselMesh *mesh = &index->geometry->mesh;
    Hit nearest;
    uint32_t triangle;
    if (!boxcast_first(&index->boxes, part, part->t_min, triangle_crossings, index, &nearest,
                       &triangle))
        return false;
    const Vec3 plane_normal = vec3_of(index->planes[triangle].normal);
    hit->t = nearest.t;
    hit->from_inside = vec3_dot(plane_normal, part->ray.direction) < 0;
    hit->normal = normal_at(mesh, triangle, plane_normal, ray_at(part->ray, nearest.t));
    hit->index = mesh_segment(mesh, triangle);
    return true;
}

static bool any_triangle(const RayIndex *index, void *workspace, const RayPart *part)
{
    (void)workspace;
    return boxcast_any(&index->boxes, part, part->t_min, triangle_crossings, index);
}

const RaySearch triangle_search = {
    .nearest_mm = NEAREST_VISIBLE_MM, .build = build, .first = first_triangle, .any = any_triangle};
