/* Writes 3MF: a ZIP archive that contains an XML document [3MF Consortium, Core Specification 1.3;
 * Materials and Properties Extension 1.2, section 3]. All vessels are one mesh, and each triangle
 * has the color of its segment. Separate meshes for each color would be open where they meet. */
#include "emit/threemf.h"

#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/zip.h"

static void put_color(Text *out, const void *params, size_t segment)
{
    text_puts(out, "<m:color color=\"#");
    put_color_code(out, params, (uint32_t)segment);
    text_puts(out, "\"/>\n");
}

void threemf_add_common(Values *values, const EmitParams *params)
{
    text_escaped(add_value(values, "generator"), params->generator);
    text_escaped(add_value(values, "description"), params->description);
    text_escaped(add_value(values, "command"), params->command);
    add_list(values, "colors", put_color, params,
             params->appearance->colors ? params->vessels->n_segments : 1);
}

void threemf_put_vertex(Vec3 at, Text *out)
{
    put_text(out, "<vertex x=\"%f\" y=\"%f\" z=\"%f\"/>\n", at.x + 0, at.y + 0, at.z + 0);
}

static void put_vertex(Text *out, const void *params, size_t i)
{
    threemf_put_vertex(mesh_point(((const EmitParams *)params)->mesh, (uint32_t)i), out);
}

static void put_triangle(Text *out, const void *context, size_t i)
{
    const EmitParams *params = context;
    const VesselMesh *mesh = params->mesh;
    const uint32_t *corner = mesh->triangles[i];
    text_printf(out, "<triangle v1=\"%u\" v2=\"%u\" v3=\"%u\"", corner[0], corner[1], corner[2]);
    if (params->appearance->colors)
        text_printf(out, " pid=\"1\" p1=\"%u\"", mesh_segment(mesh, i));
    text_puts(out, "/>\n");
}

static Status put_model(Text *out, const void *context, Err *err)
{
    const EmitParams *params = context;
    Values values = {0};
    threemf_add_common(&values, params);
    add_list(&values, "vertices", put_vertex, params, params->mesh->n_points);
    add_list(&values, "triangles", put_triangle, params, params->mesh->n_triangles);
    return values_expand(&values, params, "3mf/model.xml", out, err);
}

static Status put_types(Text *out, const void *params, Err *err)
{
    return put_template(params, "3mf/content_types.xml", out, err);
}

static Status put_relations(Text *out, const void *params, Err *err)
{
    return put_template(params, "3mf/rels.xml", out, err);
}

Status threemf_put_archive(const EmitParams *params, TmplPut *put, const void *context, Text *out,
                           Err *err)
{
    const ZipEntry entries[] = {{"[Content_Types].xml", put_types, params},
                                {"_rels/.rels", put_relations, params},
                                {"3D/3dmodel.model", put, context}};
    TRY(zip_put(entries, sizeof entries / sizeof *entries, out, err));
    return text_check(out, err);
}

Status threemf_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    return threemf_put_archive(params, put_model, params, to->file, err);
}
