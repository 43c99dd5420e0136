/* Arrays of points and triangles; see patch.h. */
#include "mesh/lattice/patch.h"

#include <stdlib.h>

void patch_release(Patch *patch)
{
    free(patch->points);
    free(patch->triangles);
    *patch = (Patch){0};
}

PatchPoint patch_wall_point(const ZoneField *field, Vec3 x, const FieldValue *value, Vec3 gradient)
{
    const ZoneTerm *term = &field->terms[value->largest];
    return (PatchPoint){.x = x,
                        .normal = vec3_scale(gradient, -1 / vec3_length(gradient)),
                        .radius_mm = term->radius_mm,
                        .segment = term->segment,
                        .tube = term->arm,
                        .arm = NO_ARM};
}

Status patch_add_point(Patch *patch, PatchPoint point, uint32_t *number, Err *err)
{
    TRY(mem_reserve(&patch->points, &patch->point_capacity, patch->n_points + 1,
                    sizeof *patch->points, "points of a junction", err));
    *number = (uint32_t)patch->n_points;
    patch->points[patch->n_points++] = point;
    return STATUS_OK;
}

Status patch_add_triangle(Patch *patch, Triangle triangle, Err *err)
{
    TRY(mem_reserve(&patch->triangles, &patch->triangle_capacity, patch->n_triangles + 1,
                    sizeof *patch->triangles, "triangles of a junction", err));
    patch->triangles[patch->n_triangles++] = triangle;
    return STATUS_OK;
}

void patch_compact(Patch *patch, uint32_t *renamed)
{
    size_t kept = 0, n_points = 0;
    for (size_t i = 0; i < patch->n_triangles; i++)
        if (patch->triangles[i].at[0] != UINT32_MAX)
            patch->triangles[kept++] = patch->triangles[i];
    patch->n_triangles = kept;
    for (size_t i = 0; i < patch->n_points; i++)
        renamed[i] = UINT32_MAX;
    for (size_t i = 0; i < 3 * kept; i++)
        renamed[patch->triangles[i / 3].at[i % 3]] = 0;
    for (size_t i = 0; i < patch->n_points; i++)
        if (renamed[i] == 0) {
            renamed[i] = (uint32_t)n_points;
            patch->points[n_points++] = patch->points[i];
        }
    patch->n_points = n_points;
    for (size_t i = 0; i < 3 * kept; i++)
        patch->triangles[i / 3].at[i % 3] = renamed[patch->triangles[i / 3].at[i % 3]];
}
