/* Serves the writers of meshes: triangles by Strahler order, colors as codes, and boxes.
 *
 * Triangles are sorted by Strahler order with a counting sort. The sort is stable, so that
 * neighbouring triangles stay together. */
#include "emit/meshparts.h"

#include "image/image.h"
#include <math.h>
#include <stdlib.h>

static size_t order_of(const EmitParams *params, size_t triangle)
{
    uint32_t segment = params->vessels->segments[mesh_segment(params->mesh, triangle)].segment;
    return (size_t)params->anatomy->order[segment];
}

Status triangles_by_order(const EmitParams *params, IndexLists *out, Err *err)
{
    const size_t n = params->mesh->n_triangles;
    TRY(indexlists_begin(out, MAX_ORDERS + 1, "triangles", err));
    for (size_t i = 0; i < n; i++)
        indexlists_count(out, order_of(params, i));
    TRY(indexlists_allot(out, "triangles", err));
    for (size_t i = 0; i < n; i++)
        indexlists_put(out, order_of(params, i), (uint32_t)i);
    return STATUS_OK;
}

Rgb vessel_color(const EmitParams *params, uint32_t segment)
{
    return appearance_color(params->appearance, params->vessels->segments[segment].segment);
}

void vessel_color_codes(const EmitParams *params, uint32_t segment, uint8_t codes[3])
{
    Rgb color = vessel_color(params, segment);
    const float linear[3] = {color.r, color.g, color.b};
    for (int i = 0; i < 3; i++)
        codes[i] = (uint8_t)image_code(linear[i], ENCODING_SRGB, 8);
}

void put_color_code(Text *out, const EmitParams *params, uint32_t segment)
{
    uint8_t codes[3];
    vessel_color_codes(params, segment, codes);
    text_printf(out, "%02X%02X%02X", codes[0], codes[1], codes[2]);
}

/* A GGX lobe with alpha^2 = 2 / (m + 2) is as wide as a Blinn-Phong lobe of exponent m [Karis, Real
 * Shading in Unreal Engine 4, 2013]. A Blinn-Phong lobe of exponent 4 n is as wide as a Phong lobe
 * of exponent n. The roughness is the square root of alpha. */
double microfacet_roughness(const Finish *finish)
{
    return elementary_pow(2 / (4 * (double)finish->phong_size + 2), 0.25);
}

Box box_with_vessel(Box box, const FieldSegment *segment)
{
    box = box_with_ball(box, segment->a, segment->radius_mm);
    return box_with_ball(box, segment->b, segment->radius_mm);
}

Box vessels_box(const VesselTree *vessels)
{
    Box box = box_empty();
    for (size_t i = 0; i < vessels->n_segments; i++)
        box = box_with_vessel(box, &vessels->segments[i]);
    return box;
}

Box mesh_box(const VesselMesh *mesh)
{
    Box box = box_empty();
    for (size_t i = 0; i < mesh->n_points; i++)
        box = box_with_ball(box, mesh_point(mesh, (uint32_t)i), 0);
    return box;
}

Status mesh_point_segments(const VesselMesh *mesh, uint32_t **segments, Err *err)
{
    uint32_t *made;
    TRY(mem_calloc(&made, mesh->n_points, sizeof *made, "points", err));
    for (size_t i = mesh->n_triangles; i-- > 0;)
        for (int k = 0; k < 3; k++)
            made[mesh->triangles[i][k]] = mesh_segment(mesh, i);
    *segments = made;
    return STATUS_OK;
}
