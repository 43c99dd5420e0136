/* A mesh2 for POV-Ray: points and normals, then for each triangle the numbers of both, so that caps
 * are flat: their normals follow those of the points, one for each triangle of a cap. The faces
 * stand there twice, with textures and without: a mesh2 that has textures does not take another. */
#include "emit/meshparts.h"
#include "emit/povray_members.h"
#include "emit/povray_text.h"
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
    bool is_part = items->n < geometry->scene->geometry.n_segments;
    if (is_part)
        TRY(vesselmesh_part(whole, items->index, items->n, &object.mesh, err));
    text_printf(add_value(&values, "triangles"), "%zu", object.mesh.n_triangles);
    text_printf(add_value(&values, "n_points"), "%zu", object.mesh.n_points);
    text_printf(add_value(&values, "n_normals"), "%zu", count_normals(&object.mesh));
    text_printf(add_value(&values, "n_textures"), "%zu", items->n);
    add_part(&values, "points", put_points, &object.mesh);
    add_part(&values, "normals", put_normals, &object.mesh);
    add_part(&values, "normal_faces", put_normal_faces, &object.mesh);
    add_part(&values, "paints", put_paints, &object);
    add_part(&values, "painted_faces", put_painted_faces, &object.mesh);
    add_part(&values, "faces", put_faces, &object.mesh);
    Status status = values_expand(&values, geometry->params, "povray/mesh_lists.inc", out, err);
    if (is_part)
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
