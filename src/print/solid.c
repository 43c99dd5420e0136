/* Collects the surfaces of a print in one mesh, and finds the flat ends where surfaces can be
 * joined.
 *
 * A cap of the mesh is a fan of triangles about a point that no other triangle has. Without the
 * fan, one rim is open, whose points are ordered by angle. Two surfaces of one tree whose segments
 * differ in their radii alone have rims with the same number of points at the same angles. */
#include "print/solid.h"

#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

void cutends_release(CutEnds *ends)
{
    free(ends->items);
    free(ends->rims);
    *ends = (CutEnds){0};
}

/* Returns the number of triangles of the cap that begins at `first`. */
static uint32_t count_fan(const VesselMesh *mesh, size_t first)
{
    uint32_t n = 1, middle = mesh->triangles[first][0];
    while (first + n < mesh->n_triangles && mesh_is_cap(mesh, first + n) &&
           mesh->triangles[first + n][0] == middle)
        n++;
    return n;
}

Status cutends_find(const VesselMesh *mesh, CutEnds *out, Err *err)
{
    CutEnds ends = {0};
    size_t points = 0;
    Status status;
    for (size_t i = 0, n; i < mesh->n_triangles; i += n) {
        n = mesh_is_cap(mesh, i) ? count_fan(mesh, i) : 1;
        if (!mesh_is_cap(mesh, i))
            continue;
        int end = mesh->triangles[i][2] == mesh->triangles[i + 1][1];
        TRY_GOTO(ARRAY_PUSH(
            &ends, "ends of vessels", err,
            (CutEnd){mesh_segment(mesh, i), end, (uint32_t)i, (uint32_t)n, false, NULL}));
        points += n;
    }
    TRY_GOTO(mem_calloc(&ends.rims, points, sizeof *ends.rims, "ends of vessels", err));
    uint32_t *rim = ends.rims;
    for (size_t i = 0; i < ends.n; rim += ends.items[i++].n)
        ends.items[i].rim = rim;
    *out = ends;
    return STATUS_OK;
done:
    cutends_release(&ends);
    return status;
}

CutEnd *cutends_at(const CutEnds *ends, uint32_t segment, int end)
{
    size_t low = 0, high = ends->n;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const CutEnd *at = &ends->items[middle];
        if (at->segment < segment || (at->segment == segment && at->end < end))
            low = middle + 1;
        else
            high = middle;
    }
    CutEnd *found = low < ends->n ? &ends->items[low] : NULL;
    return found && found->segment == segment && found->end == end ? found : NULL;
}

void solid_release(Solid *solid)
{
    vesselmesh_release(&solid->mesh);
    *solid = (Solid){0};
}

Status solid_point(Solid *solid, Vec3 x, Vec3 normal, uint32_t *index, Err *err)
{
    VesselMesh *mesh = &solid->mesh;
    size_t needed = mesh->n_points + 1;
    TRY(mem_reserve(&mesh->points, &solid->point_capacity, needed, sizeof *mesh->points, "points",
                    err));
    TRY(mem_reserve(&mesh->normals, &solid->normal_capacity, needed, sizeof *mesh->normals,
                    "points", err));
    for (int axis = 0; axis < 3; axis++) {
        mesh->points[mesh->n_points][axis] =
            mesh_round_to_grid(vec3_component(x, axis), solid->grid_mm);
        mesh->normals[mesh->n_points][axis] = (float)vec3_component(normal, axis);
    }
    *index = (uint32_t)mesh->n_points++;
    return STATUS_OK;
}

Status solid_triangle(Solid *solid, uint32_t a, uint32_t b, uint32_t c, uint32_t label, Err *err)
{
    VesselMesh *mesh = &solid->mesh;
    size_t needed = mesh->n_triangles + 1;
    const uint32_t corners[3] = {a, b, c};
    TRY(mem_reserve(&mesh->triangles, &solid->triangle_capacity, needed, sizeof *mesh->triangles,
                    "triangles", err));
    TRY(mem_reserve(&mesh->labels, &solid->label_capacity, needed, sizeof *mesh->labels,
                    "triangles", err));
    memcpy(mesh->triangles[mesh->n_triangles], corners, sizeof corners);
    mesh->labels[mesh->n_triangles++] = label;
    return STATUS_OK;
}

/* Adds the points of a mesh. index[i] receives the index in the solid of point i, unless it is
 * NONE: then the point is left out. */
static Status add_points(Solid *solid, const VesselMesh *mesh, bool turned, uint32_t *index,
                         Err *err)
{
    for (size_t i = 0; i < mesh->n_points; i++) {
        const float *own = mesh->normals[i];
        Vec3 normal = vec3((double)own[0], (double)own[1], (double)own[2]);
        if (index[i] != NONE)
            TRY(solid_point(solid, mesh_point(mesh, (uint32_t)i),
                            vec3_scale(normal, turned ? -1 : 1), &index[i], err));
    }
    return STATUS_OK;
}

Status solid_surface(Solid *solid, const VesselMesh *mesh, CutEnds *ends, SurfaceUse use, Err *err)
{
    uint32_t *index;
    Status status;
    TRY(mem_calloc(&index, mesh->n_points, sizeof *index, "points", err));
    for (size_t e = 0; e < ends->n; e++)
        if (ends->items[e].opened)
            index[mesh->triangles[ends->items[e].first][0]] = NONE;
    TRY_GOTO(add_points(solid, mesh, use.turned, index, err));
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const uint32_t *at = mesh->triangles[i];
        uint32_t label = mesh->labels[i] | use.flags;
        if (index[at[0]] != NONE)
            TRY_GOTO(solid_triangle(solid, index[at[0]], index[at[use.turned ? 2 : 1]],
                                    index[at[use.turned ? 1 : 2]], label, err));
    }
    for (size_t e = 0; e < ends->n; e++)
        for (uint32_t i = 0; i < ends->items[e].n; i++) {
            const CutEnd *end = &ends->items[e];
            end->rim[i] = index[mesh->triangles[end->first + i][end->end ? 1 : 2]];
        }
done:
    free(index);
    return status;
}

Status solid_ring(Solid *solid, const uint32_t *rim, const uint32_t *next, uint32_t n,
                  uint32_t label, Err *err)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = (i + 1) % n;
        TRY(solid_triangle(solid, rim[i], rim[k], next[k], label, err));
        TRY(solid_triangle(solid, rim[i], next[k], next[i], label, err));
    }
    return STATUS_OK;
}
