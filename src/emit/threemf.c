/* 3MF: one object of XML in a ZIP archive [3MF Consortium, Core Specification 1.3; Materials and
 * Properties Extension 1.2, section 3]. All vessels are one mesh, painted triangle by triangle with
 * the colour of the segment: parts of one colour each would be open where they meet. */
#include "emit/threemf.h"

#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/zip.h"

/* A colour for each segment, or the one of all. */
static Status put_colors(Text *out, void *context, Err *err)
{
    const EmitParams *params = context;
    size_t n = params->appearance->colors ? params->vessels->n_segments : 1;
    for (size_t i = 0; i < n; i++) {
        text_puts(out, "<m:color color=\"#");
        put_color_code(out, params, (uint32_t)i);
        text_puts(out, "\"/>\n");
    }
    return text_check(out, err);
}

void threemf_add_about(Values *values, EmitParams *params)
{
    text_escaped(add_value(values, "generator"), params->generator);
    text_escaped(add_value(values, "description"), params->description);
    text_escaped(add_value(values, "command"), params->command);
    add_part(values, "colors", put_colors, params);
}

void threemf_put_vertex(Vec3 at, Text *out)
{
    char text[3][NUMBER_TEXT_SIZE];
    text_printf(
        out, "<vertex x=\"%s\" y=\"%s\" z=\"%s\"/>\n", number_text_float((float)at.x + 0, text[0]),
        number_text_float((float)at.y + 0, text[1]), number_text_float((float)at.z + 0, text[2]));
}

static Status put_vertices(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = ((const EmitParams *)context)->mesh;
    for (uint32_t i = 0; i < mesh->n_points; i++)
        threemf_put_vertex(mesh_point(mesh, i), out);
    return text_check(out, err);
}

static Status put_triangles(Text *out, void *context, Err *err)
{
    const EmitParams *params = context;
    const VesselMesh *mesh = params->mesh;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const uint32_t *corner = mesh->triangles[i];
        text_printf(out, "<triangle v1=\"%u\" v2=\"%u\" v3=\"%u\"", corner[0], corner[1],
                    corner[2]);
        if (params->appearance->colors)
            text_printf(out, " pid=\"1\" p1=\"%u\"", mesh_segment(mesh, i));
        text_puts(out, "/>\n");
    }
    return text_check(out, err);
}

static Status put_model(Text *out, void *context, Err *err)
{
    Values values = {0};
    threemf_add_about(&values, context);
    add_part(&values, "vertices", put_vertices, context);
    add_part(&values, "triangles", put_triangles, context);
    return values_expand(&values, context, "3mf/model.xml", out, err);
}

static Status put_types(Text *out, void *context, Err *err)
{
    Values none = {0};
    return values_expand(&none, context, "3mf/content_types.xml", out, err);
}

static Status put_relations(Text *out, void *context, Err *err)
{
    Values none = {0};
    return values_expand(&none, context, "3mf/rels.xml", out, err);
}

Status threemf_put_archive(const EmitParams *params,
                           Status (*put)(Text *out, void *context, Err *err), void *context,
                           Text *out, Err *err)
{
    EmitParams own = *params;
    const ZipEntry entries[] = {{"[Content_Types].xml", put_types, &own},
                                {"_rels/.rels", put_relations, &own},
                                {"3D/3dmodel.model", put, context}};
    TRY(zip_put(entries, sizeof entries / sizeof *entries, out, err));
    return text_check(out, err);
}

Status threemf_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err)
{
    (void)second;
    (void)report;
    EmitParams own = *params;
    return threemf_put_archive(params, put_model, &own, out, err);
}
