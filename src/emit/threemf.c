/* 3MF: one object of XML in a ZIP archive [3MF Consortium, Core Specification 1.3; Materials and
 * Properties Extension 1.2, section 3]. All vessels are one mesh, painted triangle by triangle with
 * the colour of the segment: parts of one colour each would be open where they meet. */
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/values.h"
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

static Status put_vertices(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = ((const EmitParams *)context)->mesh;
    for (size_t i = 0; i < mesh->n_points; i++) {
        char x[NUMBER_TEXT_SIZE], y[NUMBER_TEXT_SIZE], z[NUMBER_TEXT_SIZE];
        text_printf(out, "<vertex x=\"%s\" y=\"%s\" z=\"%s\"/>\n",
                    number_text_float(mesh->points[i][0] + 0, x),
                    number_text_float(mesh->points[i][1] + 0, y),
                    number_text_float(mesh->points[i][2] + 0, z));
    }
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
    const EmitParams *params = context;
    Values values = {0};
    text_escaped(add_value(&values, "generator"), params->generator);
    text_escaped(add_value(&values, "description"), params->description);
    text_escaped(add_value(&values, "command"), params->command);
    add_part(&values, "colors", put_colors, context);
    add_part(&values, "vertices", put_vertices, context);
    add_part(&values, "triangles", put_triangles, context);
    return values_expand(&values, params, "3mf/model.xml", out, err);
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

Status threemf_write(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                     Err *err)
{
    (void)second;
    (void)report;
    EmitParams context = *params;
    const ZipEntry entries[] = {{"[Content_Types].xml", put_types, &context},
                                {"_rels/.rels", put_relations, &context},
                                {"3D/3dmodel.model", put_model, &context}};
    TRY(zip_put(entries, sizeof entries / sizeof *entries, out, err));
    return text_check(out, err);
}
