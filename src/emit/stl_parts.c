/* Writes STL as text, with a named solid for each wall and each end. OpenFOAM's snappyHexMesh makes
 * a patch of each solid. Within a part, triangles keep the order of the mesh. Numbers read back to
 * the same floats, so that the solids fit together exactly. */
#include "emit/meshparts.h"
#include "emit/puttext.h"
#include "emit/rows.h"

static void put_triangle(const VesselMesh *mesh, uint32_t triangle, Text *out)
{
    float normal[3];
    mesh_flat_normal(mesh, triangle, normal);
    put_triple(out, "facet normal ", normal, " ", "\nouter loop\n");
    for (int k = 0; k < 3; k++)
        put_triple(out, "vertex ", mesh->points[mesh->triangles[triangle][k]], " ", "\n");
    text_puts(out, "endloop\nendfacet\n");
}

Status stl_write_parts(const EmitParams *params, EmitOutput *to, Err *err)
{
    const ItemKeys parts = {params->ends->parts, params->mesh->n_triangles, 1};
    const size_t n = meshends_parts(params->ends);
    IndexLists lists = {0};
    Status status;
    TRY_GOTO(indexlists_sort(&lists, n, parts, "triangles", err));
    for (size_t part = 0; part < n; part++) {
        const char *name = meshends_part_name(params->ends, part);
        text_printf(to->file, "solid %s\n", name);
        for (uint32_t i = lists.first[part]; i < lists.first[part + 1]; i++)
            put_triangle(params->mesh, lists.items[i], to->file);
        text_printf(to->file, "endsolid %s\n", name);
    }
    TRY_GOTO(text_check(to->file, err));
done:
    indexlists_release(&lists);
    return status;
}
