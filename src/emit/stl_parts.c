/* STL as text: a solid for each wall and each end, named, which OpenFOAM's snappyHexMesh makes
 * patches of. Triangles are sorted by their parts with counting, so that they keep their order
 * within each. Numbers read back to the same floats, so that the solids fit together exactly. */
#include "emit/meshparts.h"
#include "emit/rows.h"

#include <stdlib.h>

/* Numbers of the triangles, part by part, in *sorted, and where each part ends in *ends (both
 * owned). */
static Status sort_triangles(const EmitParams *params, uint32_t **sorted, size_t **ends, Err *err)
{
    const size_t n = params->mesh->n_triangles, n_parts = meshends_parts(params->ends);
    const uint32_t *parts = params->ends->parts;
    TRY(mem_calloc(sorted, n, sizeof **sorted, "triangles", err));
    TRY(mem_calloc(ends, n_parts + 1, sizeof **ends, "parts", err));
    size_t *next = *ends;
    for (size_t i = 0; i < n; i++)
        next[parts[i] + 1]++;
    for (size_t part = 0; part < n_parts; part++)
        next[part + 1] += next[part];
    for (size_t i = 0; i < n; i++)
        (*sorted)[next[parts[i]]++] = (uint32_t)i;
    return STATUS_OK;
}

static void put_triangle(const VesselMesh *mesh, uint32_t triangle, Text *out)
{
    float normal[3];
    mesh_flat_normal(mesh, triangle, normal);
    put_mesh_floats(out, "facet normal ", normal, " ", "\nouter loop\n");
    for (int k = 0; k < 3; k++)
        put_mesh_floats(out, "vertex ", mesh->points[mesh->triangles[triangle][k]], " ", "\n");
    text_puts(out, "endloop\nendfacet\n");
}

Status stl_write_parts(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                       Err *err)
{
    (void)second;
    (void)report;
    uint32_t *sorted = NULL;
    size_t *ends = NULL;
    Status status;
    TRY_GOTO(sort_triangles(params, &sorted, &ends, err));
    for (size_t part = 0, i = 0; part < meshends_parts(params->ends); part++) {
        const char *name = meshends_part_name(params->ends, part);
        text_printf(out, "solid %s\n", name);
        for (; i < ends[part]; i++)
            put_triangle(params->mesh, sorted[i], out);
        text_printf(out, "endsolid %s\n", name);
    }
    TRY_GOTO(text_check(out, err));
done:
    free(sorted);
    free(ends);
    return status;
}
