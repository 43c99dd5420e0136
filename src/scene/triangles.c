/* Copies parts of a mesh, and computes normals of triangles. */
#include "scene/triangles.h"

#include <stdlib.h>
#include <string.h>

void vesselmesh_release(VesselMesh *mesh)
{
    free(mesh->points);
    free(mesh->normals);
    free(mesh->triangles);
    free(mesh->labels);
    *mesh = (VesselMesh){0};
}

static Status reserve(const VesselMesh *mesh, VesselMesh *out, Err *err)
{
    TRY(mem_calloc(&out->points, mesh->n_points, sizeof *out->points, "points", err));
    TRY(mem_calloc(&out->normals, mesh->n_points, sizeof *out->normals, "points", err));
    TRY(mem_calloc(&out->triangles, mesh->n_triangles, sizeof *out->triangles, "triangles", err));
    return mem_calloc(&out->labels, mesh->n_triangles, sizeof *out->labels, "triangles", err);
}

/* Returns the index in *out of a point of the mesh. number[point] is this index plus 1, or 0 if the
 * point is not in *out yet. */
static uint32_t take_point(const VesselMesh *mesh, uint32_t point, uint32_t *number,
                           VesselMesh *out)
{
    if (!number[point]) {
        memcpy(out->points[out->n_points], mesh->points[point], sizeof *out->points);
        memcpy(out->normals[out->n_points], mesh->normals[point], sizeof *out->normals);
        number[point] = (uint32_t)++out->n_points;
    }
    return number[point] - 1;
}

Status vesselmesh_part(const VesselMesh *mesh, const uint32_t *segments, size_t n, VesselMesh *out,
                       Err *err)
{
    uint32_t *number = NULL;
    VesselMesh made = {0};
    Status status;
    TRY_GOTO(mem_calloc(&number, mesh->n_points, sizeof *number, "points", err));
    TRY_GOTO(reserve(mesh, &made, err));
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        size_t place = sorted_find(segments, n, mesh_segment(mesh, i));
        if (place == n)
            continue;
        for (int k = 0; k < 3; k++)
            made.triangles[made.n_triangles][k] =
                take_point(mesh, mesh->triangles[i][k], number, &made);
        made.labels[made.n_triangles++] = (uint32_t)place | (mesh->labels[i] & MESH_FLAGS);
    }
    *out = made;
    made = (VesselMesh){0};
done:
    free(number);
    vesselmesh_release(&made);
    return status;
}

void mesh_flat_normal(const VesselMesh *mesh, size_t triangle, float normal[3])
{
    const uint32_t *corner = mesh->triangles[triangle];
    Vec3 a = mesh_point(mesh, corner[0]);
    Vec3 across = vec3_cross(vec3_sub(mesh_point(mesh, corner[1]), a),
                             vec3_sub(mesh_point(mesh, corner[2]), a));
    double length = vec3_length(across);
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = length > 0 ? (float)(vec3_component(across, axis) / length) : 0;
}
