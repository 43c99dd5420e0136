/* A mesh2 for POV-Ray: points and normals, then for each triangle the numbers of both, so that caps
 * are flat: their normals follow those of the points, one for each triangle of a cap. In a scene it
 * is the geometry, and its faces stand there twice, with textures and without: a mesh2 that has
 * textures does not take another. An exported one has textures only if it has colours. */
#include "emit/meshparts.h"
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/rows.h"
#include "emit/values.h"

static Status put_points(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
    for (size_t i = 0; i < mesh->n_points; i++)
        put_mesh_floats(out, "<", mesh->points[i], ",", ">,\n");
    return text_check(out, err);
}

static Status put_normals(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
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

static void put_corners(Text *out, const VesselMesh *mesh, size_t triangle)
{
    const uint32_t *corner = mesh->triangles[triangle];
    text_printf(out, "<%u,%u,%u>,", corner[0], corner[1], corner[2]);
}

static Status put_faces(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        put_corners(out, mesh, i);
        text_puts(out, "\n");
    }
    return text_check(out, err);
}

/* With the number of each one's texture. */
static Status put_painted_faces(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        put_corners(out, mesh, i);
        text_printf(out, "%u,\n", mesh_segment(mesh, i));
    }
    return text_check(out, err);
}

static Status put_normal_faces(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
    size_t flat = mesh->n_points;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        if (mesh_is_cap(mesh, i)) {
            text_printf(out, "<%zu,%zu,%zu>,", flat, flat, flat);
            flat++;
        } else
            put_corners(out, mesh, i);
        text_puts(out, "\n");
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

/* What both have in common; the mesh must outlive the values. */
static void add_mesh(Values *values, VesselMesh *mesh, size_t n_textures)
{
    text_printf(add_value(values, "triangles"), "%zu", mesh->n_triangles);
    text_printf(add_value(values, "n_points"), "%zu", mesh->n_points);
    text_printf(add_value(values, "n_normals"), "%zu", count_normals(mesh));
    text_printf(add_value(values, "n_textures"), "%zu", n_textures);
    add_part(values, "points", put_points, mesh);
    add_part(values, "normals", put_normals, mesh);
    add_part(values, "normal_faces", put_normal_faces, mesh);
}

/* ---- the geometry of a scene ----------------------------------------------------------------- */

/* One object of the geometry. */
typedef struct MeshObject {
    const PovrayGeometry *geometry;
    VesselMesh mesh; /* its labels are indices of the object's items */
} MeshObject;

static Status put_paints(Text *out, void *context, Err *err)
{
    const MeshObject *object = context;
    const PovrayGeometry *geometry = object->geometry;
    const PovrayItems *items = &geometry->objects[geometry->object];
    for (size_t i = 0; i < items->n; i++) {
        const FieldSegment *segment = &geometry->scene->geometry.segments[items->index[i]];
        text_puts(out, "Vessel_Paint(");
        text_number(out, segment->radius_mm);
        text_puts(out, ",");
        put_paint(out, geometry->params, segment->segment);
        text_puts(out, ")\n");
    }
    return text_check(out, err);
}

static Status put_lists(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const PovrayItems *items = &geometry->objects[geometry->object];
    const VesselMesh *whole = &geometry->scene->geometry.mesh;
    MeshObject object = {.geometry = geometry, .mesh = *whole};
    Values values = {0};
    if (geometry->object > 0)
        TRY(vesselmesh_part(whole, items->index, items->n, &object.mesh, err));
    add_mesh(&values, &object.mesh, items->n);
    add_part(&values, "paints", put_paints, &object);
    add_part(&values, "painted_faces", put_painted_faces, &object.mesh);
    add_part(&values, "faces", put_faces, &object.mesh);
    Status status = values_expand(&values, geometry->params, "povray/mesh_lists.inc", out, err);
    if (geometry->object > 0)
        vesselmesh_release(&object.mesh);
    return status;
}

Status put_mesh(Text *out, PovrayGeometry *geometry, Err *err)
{
    return put_declaration(out, geometry, "mesh2", put_lists, err);
}

Status put_mesh_macros(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Values values = {0};
    return values_expand(&values, geometry->params, "povray/mesh_macros.inc", out, err);
}

/* ---- a file of its own ----------------------------------------------------------------------- */

static size_t count_textures(const EmitParams *params)
{
    return params->appearance->colors ? params->vessels->n_segments : 0;
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

Status povray_write_mesh(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                         Err *err)
{
    (void)second;
    (void)report;
    EmitParams context = *params;
    VesselMesh mesh = *params->mesh;
    const Appearance *appearance = params->appearance;
    Values values = {0};
    text_put_line(add_value(&values, "file"), params->file);
    add_about(&values, params, mesh_box(params->mesh), vec3(0, 0, 0));
    add_float(&values, "red", appearance->color.r);
    add_float(&values, "green", appearance->color.g);
    add_float(&values, "blue", appearance->color.b);
    add_finish(&values, &appearance->finish);
    add_mesh(&values, &mesh, count_textures(params));
    add_part(&values, "textures", put_textures, &context);
    add_part(&values, "faces", appearance->colors ? put_painted_faces : put_faces, &mesh);
    return values_expand(&values, params, "povray/mesh.inc", out, err);
}
