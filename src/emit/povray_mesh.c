/* A mesh2 for POV-Ray: points and normals, then for each triangle the numbers of both, so that caps
 * are flat: their normals follow those of the points, one for each triangle of a cap. */
#include "emit/meshparts.h"
#include "emit/povray_text.h"
#include "emit/rows.h"
#include "emit/values.h"

static size_t count_textures(const EmitParams *params)
{
    return params->appearance->colors ? params->vessels->n_segments : 0;
}

static Status put_points(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = ((const EmitParams *)context)->mesh;
    for (size_t i = 0; i < mesh->n_points; i++)
        put_mesh_floats(out, "<", mesh->points[i], ",", ">,\n");
    return text_check(out, err);
}

static Status put_normals(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = ((const EmitParams *)context)->mesh;
    for (size_t i = 0; i < mesh->n_points; i++)
        put_mesh_floats(out, "<", mesh->normals[i], ",", ">,\n");
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        float normal[3];
        mesh_flat_normal(mesh, i, normal);
        if (mesh_is_cap(mesh, i))
            put_mesh_floats(out, "<", normal, ",", ">,\n");
    }
    return text_check(out, err);
}

static Status put_textures(Text *out, void *context, Err *err)
{
    const EmitParams *params = context;
    for (size_t i = 0; i < count_textures(params); i++) {
        text_puts(out, "Segment_Texture(");
        put_color(out, vessel_color(params, (uint32_t)i));
        text_puts(out, ")\n");
    }
    return text_check(out, err);
}

static Status put_faces(Text *out, void *context, Err *err)
{
    const EmitParams *params = context;
    const VesselMesh *mesh = params->mesh;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const uint32_t *corner = mesh->triangles[i];
        text_printf(out, "<%u,%u,%u>,", corner[0], corner[1], corner[2]);
        if (params->appearance->colors)
            text_printf(out, "%u,", mesh_segment(mesh, i));
        text_puts(out, "\n");
    }
    return text_check(out, err);
}

static Status put_normal_faces(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = ((const EmitParams *)context)->mesh;
    size_t flat = mesh->n_points;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const uint32_t *corner = mesh->triangles[i];
        if (mesh_is_cap(mesh, i)) {
            text_printf(out, "<%zu,%zu,%zu>,\n", flat, flat, flat);
            flat++;
        } else
            text_printf(out, "<%u,%u,%u>,\n", corner[0], corner[1], corner[2]);
    }
    return text_check(out, err);
}

static size_t count_normals(const VesselMesh *mesh)
{
    size_t n = mesh->n_points;
    for (size_t i = 0; i < mesh->n_triangles; i++)
        n += mesh_is_cap(mesh, i);
    return n;
}

static void add_parts(Values *values, EmitParams *params)
{
    add_part(values, "points", put_points, params);
    add_part(values, "normals", put_normals, params);
    add_part(values, "textures", put_textures, params);
    add_part(values, "faces", put_faces, params);
    add_part(values, "normal_faces", put_normal_faces, params);
}

Status povray_write_mesh(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                         Err *err)
{
    (void)second;
    (void)report;
    EmitParams context = *params;
    const Appearance *appearance = params->appearance;
    Values values = {0};
    text_put_line(add_value(&values, "file"), params->file);
    add_about(&values, params, mesh_box(params->mesh), vec3(0, 0, 0));
    add_float(&values, "red", appearance->color.r);
    add_float(&values, "green", appearance->color.g);
    add_float(&values, "blue", appearance->color.b);
    add_finish(&values, &appearance->finish);
    text_printf(add_value(&values, "triangles"), "%zu", params->mesh->n_triangles);
    text_printf(add_value(&values, "n_points"), "%zu", params->mesh->n_points);
    text_printf(add_value(&values, "n_normals"), "%zu", count_normals(params->mesh));
    text_printf(add_value(&values, "n_textures"), "%zu", count_textures(params));
    add_parts(&values, &context);
    return values_expand(&values, params, "povray/mesh.inc", out, err);
}
