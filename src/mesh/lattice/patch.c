/* Stores the triangles of one junction region while they are made. Points and triangles are arrays
 * that grow. A step that removes triangles marks them, and compacts the arrays once at its end,
 * because indices of points must stay valid during the step. */
#include "mesh/lattice/patch.h"

#include <stdlib.h>

const char patch_items[] = "points of a junction";

void patch_release(Patch *patch)
{
    free(patch->points);
    free(patch->triangles);
    free(patch->scratch);
    *patch = (Patch){0};
}

PatchPoint patch_surface_point(const JunctionField *field, Vec3 x, const FieldValue *value,
                               Vec3 gradient)
{
    const PotentialTerm *term = &field->terms[value->largest_term];
    return (PatchPoint){.x = x,
                        .normal = vec3_scale(gradient, -1 / vec3_length(gradient)),
                        .radius_mm = term->radius_mm,
                        .segment = term->segment,
                        .vessel_stub = term->stub,
                        .rim_stub = NO_STUB};
}

Status patch_add_point(Patch *patch, PatchPoint point, uint32_t *index, Err *err)
{
    TRY(mem_reserve(&patch->points, &patch->point_capacity, patch->n_points + 1,
                    sizeof *patch->points, patch_items, err));
    *index = (uint32_t)patch->n_points;
    patch->points[patch->n_points++] = point;
    return STATUS_OK;
}

Status patch_add_triangle(Patch *patch, PatchTriangle triangle, Err *err)
{
    TRY(mem_reserve(&patch->triangles, &patch->triangle_capacity, patch->n_triangles + 1,
                    sizeof *patch->triangles, patch_items, err));
    patch->triangles[patch->n_triangles++] = triangle;
    return STATUS_OK;
}

static Status reserve_scratch(Patch *patch, size_t per_point, Err *err)
{
    return mem_reserve(&patch->scratch, &patch->scratch_capacity, per_point * patch->n_points,
                       sizeof *patch->scratch, patch_items, err);
}

Status patch_compact(Patch *patch, Err *err)
{
    size_t kept = 0, n_points = 0;
    TRY(reserve_scratch(patch, 1, err));
    uint32_t *renamed = patch->scratch;
    for (size_t i = 0; i < patch->n_triangles; i++)
        if (patch->triangles[i].at[0] != PATCH_REMOVED)
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
    return STATUS_OK;
}

/* Makes the scratch a union-find forest of the points [base/sets.h]. */
static size_t find_parts(const Patch *patch)
{
    size_t parts = patch->n_points;
    sets_begin(patch->scratch, patch->n_points);
    for (size_t i = 0; i < patch->n_triangles; i++)
        for (int k = 1; k < 3; k++) {
            const uint32_t *at = patch->triangles[i].at;
            parts -= sets_join(patch->scratch, at[0], at[k]);
        }
    return parts;
}

Status patch_count_parts(Patch *patch, size_t *parts, Err *err)
{
    TRY(reserve_scratch(patch, 1, err));
    *parts = find_parts(patch);
    return STATUS_OK;
}

Status patch_keep_largest(Patch *patch, Err *err)
{
    uint32_t best = 0;
    TRY(reserve_scratch(patch, 2, err));
    uint32_t *root = patch->scratch, *count = root + patch->n_points;
    if (find_parts(patch) < 2)
        return STATUS_OK;
    for (size_t i = 0; i < patch->n_points; i++)
        count[i] = 0;
    for (uint32_t i = 0; i < patch->n_points; i++) {
        uint32_t part = sets_find(root, i);
        count[part]++;
        best = count[part] > count[best] ? part : best;
    }
    for (size_t i = 0; i < patch->n_triangles; i++)
        if (sets_find(root, patch->triangles[i].at[0]) != best)
            patch->triangles[i].at[0] = PATCH_REMOVED;
    return patch_compact(patch, err);
}
