/* Writes Wavefront OBJ with a library of materials. Triangles are grouped by Strahler order, and
 * each color is a material. Triangles share points. The list of normals has one normal per point,
 * followed by a flat normal for each triangle of a cap, in the order in which the triangles are
 * written. */
#include "emit/meshparts.h"
#include "emit/puttext.h"
#include "emit/rows.h"

#include <stdlib.h>

static void put_normals(const VesselMesh *mesh, const IndexLists *by_order, Text *out)
{
    for (size_t i = 0; i < mesh->n_points; i++)
        put_triple(out, "vn ", mesh->normals[i], " ", "\n");
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        float normal[3];
        if (!mesh_is_cap(mesh, by_order->items[i]))
            continue;
        mesh_flat_normal(mesh, by_order->items[i], normal);
        put_triple(out, "vn ", normal, " ", "\n");
    }
}

/* Appends a face. OBJ counts points and normals from 1. *n_flat is the number of flat normals that
 * have been used. */
static void put_face(const VesselMesh *mesh, uint32_t triangle, size_t *n_flat, Text *out)
{
    bool cap = mesh_is_cap(mesh, triangle);
    *n_flat += cap;
    text_puts(out, "f");
    for (int k = 0; k < 3; k++) {
        size_t point = (size_t)mesh->triangles[triangle][k] + 1;
        text_printf(out, " %zu//%zu", point, cap ? mesh->n_points + *n_flat : point);
    }
    text_puts(out, "\n");
}

/* Appends a change of material if the color of the triangle differs from *last, and updates
 * *last. */
static void put_material(const EmitParams *params, uint32_t triangle, uint32_t *last, Text *out)
{
    uint8_t codes[3];
    vessel_color_codes(params, mesh_segment(params->mesh, triangle), codes);
    uint32_t code = (uint32_t)codes[0] << 16 | (uint32_t)codes[1] << 8 | codes[2];
    if (code != *last)
        text_printf(out, "usemtl vessel_%06X\n", code);
    *last = code;
}

static void put_groups(const EmitParams *params, const IndexLists *by_order, Text *out)
{
    uint32_t material = UINT32_MAX;
    size_t n_flat = 0;
    for (size_t order = 0; order <= MAX_ORDERS; order++) {
        if (by_order->first[order] < by_order->first[order + 1])
            text_printf(out, "g order_%zu\n", order);
        for (size_t i = by_order->first[order]; i < by_order->first[order + 1]; i++) {
            put_material(params, by_order->items[i], &material, out);
            put_face(params->mesh, by_order->items[i], &n_flat, out);
        }
    }
}

static int compare_colors(const void *a, const void *b)
{
    return memcmp(a, b, 3);
}

/* Appends a material for each different color. Kd is the sRGB code divided by 255, not decoded to
 * linear. The caller checks `out`. */
static Status put_materials(const EmitParams *params, Text *out, Err *err)
{
    const size_t n = params->vessels->n_segments;
    uint8_t(*codes)[3];
    TRY(mem_calloc(&codes, n, sizeof *codes, "colors", err));
    for (size_t i = 0; i < n; i++)
        vessel_color_codes(params, (uint32_t)i, codes[i]);
    qsort(codes, n, sizeof *codes, compare_colors);
    text_printf(out, "# %s\n", params->generator);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || compare_colors(codes[i - 1], codes[i]) != 0)
            text_printf(out, "newmtl vessel_%02X%02X%02X\nKd %.6f %.6f %.6f\nillum 2\n",
                        codes[i][0], codes[i][1], codes[i][2], codes[i][0] / 255.0,
                        codes[i][1] / 255.0, codes[i][2] / 255.0);
    free(codes);
    return STATUS_OK;
}

/* The name must be printable ASCII without blanks, because some readers end the name at any other
 * byte. */
Status obj_check_name(const char *second_file, Err *err)
{
    if (is_ascii_name(second_file, " "))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "the material file of an OBJ cannot be called '%s'; use only printable ASCII "
                   "without blanks",
                   second_file);
}

Status obj_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    const VesselMesh *mesh = params->mesh;
    IndexLists by_order = {0};
    Status status;
    TRY_GOTO(triangles_by_order(params, &by_order, err));
    text_printf(to->file, "# %s, by: %s\n# millimetres, y up\nmtllib %s\no tree\n",
                params->generator, params->command, params->second_file);
    for (size_t i = 0; i < mesh->n_points; i++)
        put_triple(to->file, "v ", mesh->points[i], " ", "\n");
    put_normals(mesh, &by_order, to->file);
    put_groups(params, &by_order, to->file);
    TRY_GOTO(put_materials(params, to->second, err));
    TRY_GOTO(text_check(to->file, err));
done:
    indexlists_release(&by_order);
    return status;
}
