/* Writes a mesh2 for POV-Ray: points and normals, then the indices of both for each triangle. The
 * list of normals has one normal per point, followed by a flat normal for each triangle of a cap.
 * The faces are listed twice, with and without textures, because a mesh2 with textures cannot be
 * given another texture. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

static void put_point(Text *out, const void *mesh, size_t i)
{
    put_triple(out, "<", ((const VesselMesh *)mesh)->points[i], ",", ">,\n");
}

static Status put_normals(Text *out, const void *context, Err *err)
{
    const VesselMesh *mesh = context;
    for (size_t i = 0; i < mesh->n_points; i++)
        put_triple(out, "<", mesh->normals[i], ",", ">,\n");
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        float normal[3];
        mesh_flat_normal(mesh, i, normal);
        if (mesh_is_cap(mesh, i))
            put_triple(out, "<", normal, ",", ">,\n");
    }
    return text_check(out, err);
}

static void put_corners(Text *out, const VesselMesh *mesh, size_t triangle, const char *after)
{
    const uint32_t *corner = mesh->triangles[triangle];
    put_text(out, "<%u,%u,%u>,%s", corner[0], corner[1], corner[2], after);
}

static void put_face(Text *out, const void *mesh, size_t i)
{
    put_corners(out, mesh, i, "\n");
}

/* Appends a face with the index of its texture. */
static void put_painted_face(Text *out, const void *mesh, size_t i)
{
    put_corners(out, mesh, i, "");
    put_text(out, "%u,\n", mesh_segment(mesh, i));
}

static Status put_normal_faces(Text *out, const void *context, Err *err)
{
    const VesselMesh *mesh = context;
    size_t flat = mesh->n_points;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        if (mesh_is_cap(mesh, i)) {
            put_text(out, "<%z,%z,%z>,\n", flat, flat, flat);
            flat++;
        } else
            put_corners(out, mesh, i, "\n");
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

static void put_texture(Text *out, const void *context, size_t i)
{
    const PovrayGeometry *geometry = context;
    const PovrayItems *items = &geometry->objects[geometry->object];
    const FieldSegment *segment = &geometry->scene->geometry.segments[items->index[i]];
    put_text(out, "Vessel_Paint(%n,", segment->radius_mm);
    put_paint(out, geometry->params, segment->segment);
    text_puts(out, ")\n");
}

/* Appends the lists of a mesh2, by their template. */
static Status put_lists(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const PovrayItems *items = &geometry->objects[geometry->object];
    const VesselMesh *whole = &geometry->scene->geometry.mesh;
    VesselMesh mesh = *whole; /* the triangles of this object; its labels are indices in `items` */
    Values values = {.digits = geometry->params->digits};
    bool is_part = items->n < geometry->scene->geometry.n_segments;
    if (is_part)
        TRY(vesselmesh_part(whole, items->index, items->n, &mesh, err));
    add_count(&values, "triangles", mesh.n_triangles);
    add_count(&values, "n_points", mesh.n_points);
    add_count(&values, "n_normals", count_normals(&mesh));
    add_count(&values, "n_textures", items->n);
    add_list(&values, "points", put_point, &mesh, mesh.n_points);
    add_part(&values, "normals", put_normals, &mesh);
    add_part(&values, "normal_faces", put_normal_faces, &mesh);
    add_list(&values, "paints", put_texture, geometry, items->n);
    add_list(&values, "painted_faces", put_painted_face, &mesh, mesh.n_triangles);
    add_list(&values, "faces", put_face, &mesh, mesh.n_triangles);
    Status status = values_expand(&values, geometry->params, "povray/mesh_lists.inc", out, err);
    if (is_part)
        vesselmesh_release(&mesh);
    return status;
}

Status put_mesh(Text *out, const PovrayGeometry *geometry, Err *err)
{
    return put_declaration(out, geometry, "mesh2", put_lists, err);
}

Status put_mesh_macros(Text *out, const void *geometry, Err *err)
{
    return put_template(((const PovrayGeometry *)geometry)->params, "povray/mesh_macros.inc", out,
                        err);
}
