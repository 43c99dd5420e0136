/* Tests whether the triangles that a split has added to a junction region cross other triangles.
 *
 * The points of split triangles are on the surface, but the triangles may run into the other side
 * of a groove whose triangles are not split. Usually few triangles of a region are new, and they
 * are close together in a crotch. All triangles that reach into the bounding box of the new ones
 * are copied to a small mesh, which is tested by the exact test of the finished mesh. */
#include "mesh/patchcross.h"

#include "mesh/precision.h"
#include "mesh/proof/meshcheck.h"
#include <string.h>

static Box box_of(const Patch *patch, const PatchTriangle *triangle)
{
    Box box = box_empty();
    for (int k = 0; k < 3; k++)
        box = box_with_ball(box, patch->points[triangle->at[k]].x, 0);
    return box;
}

static bool is_new(const PatchTriangle *triangle, size_t first_new)
{
    return triangle->at[0] >= first_new || triangle->at[1] >= first_new ||
           triangle->at[2] >= first_new;
}

/* Fills a mesh with the triangles whose boxes overlap `near`. Its points are relative to `origin`,
 * and are rounded to the grid. */
static void copy_near(const Patch *patch, Box near, Vec3 origin, double grid_mm, VesselMesh *mesh)
{
    for (; mesh->n_points < patch->n_points; mesh->n_points++) {
        Vec3 x = vec3_sub(patch->points[mesh->n_points].x, origin);
        for (int axis = 0; axis < 3; axis++)
            mesh->points[mesh->n_points][axis] =
                mesh_round_to_grid(vec3_component(x, axis), grid_mm);
    }
    for (size_t i = 0; i < patch->n_triangles; i++)
        if (box_overlaps(box_of(patch, &patch->triangles[i]), near))
            memcpy(mesh->triangles[mesh->n_triangles++], patch->triangles[i].at,
                   sizeof *mesh->triangles);
}

/* Counts crossings of triangles in the box, of points relative to `origin` on a grid. */
static Status count(const Patch *patch, Box near, Vec3 origin, double grid_mm, size_t *crossings,
                    Err *err)
{
    VesselMesh mesh = {0};
    Status status;
    TRY_GOTO(mem_calloc(&mesh.points, patch->n_points, sizeof *mesh.points, "points", err));
    TRY_GOTO(
        mem_calloc(&mesh.triangles, patch->n_triangles, sizeof *mesh.triangles, "triangles", err));
    copy_near(patch, near, origin, grid_mm, &mesh);
    TRY_GOTO(meshcheck_crossings(&mesh, grid_mm, 1, NULL, crossings, err));
done:
    vesselmesh_release(&mesh);
    return status;
}

Status patchcross_find(const Patch *patch, size_t first_new, double grid_mm,
                       PatchCrossing *crossing, Err *err)
{
    Box near = box_empty(), all = box_empty();
    size_t rounded, unrounded;
    for (size_t i = 0; i < patch->n_triangles; i++) {
        Box box = box_of(patch, &patch->triangles[i]);
        all = box_union(all, box);
        if (is_new(&patch->triangles[i], first_new))
            near = box_union(near, box);
    }
    *crossing = PATCHCROSS_NONE;
    TRY(count(patch, near, vec3(0, 0, 0), grid_mm, &rounded, err));
    if (rounded == 0)
        return STATUS_OK;
    double fine_mm = mesh_grid(vec3_distance(all.low, all.high));
    TRY(count(patch, near, all.low, fine_mm, &unrounded, err));
    *crossing = unrounded > 0 ? PATCHCROSS_REAL : PATCHCROSS_ROUNDING;
    return STATUS_OK;
}
