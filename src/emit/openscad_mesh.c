/* One polyhedron() of a mesh: nothing to unite, so that OpenSCAD takes it as it is. OpenSCAD turns
 * the faces of a solid the other way round: clockwise, seen from outside. */
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/values.h"

/* What CGAL takes to convert a triangle, when a polyhedron is cut or united [OpenSCAD 2021.01,
 * 7,000 to 40,000 triangles]. */
static const double seconds_a_triangle = 3e-4;

static Status put_points(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
    for (size_t i = 0; i < mesh->n_points; i++)
        put_mesh_floats(out, "[", mesh->points[i], ",", "],\n");
    return text_check(out, err);
}

static Status put_faces(Text *out, void *context, Err *err)
{
    const VesselMesh *mesh = context;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const uint32_t *corner = mesh->triangles[i];
        text_printf(out, "[%u,%u,%u],\n", corner[2], corner[1], corner[0]);
    }
    return text_check(out, err);
}

Status openscad_write_mesh(const EmitParams *params, Text *out, Text *second, EmitReport *report,
                           Err *err)
{
    (void)second;
    (void)report;
    VesselMesh mesh = *params->mesh;
    Box box = mesh_box(&mesh);
    Values values = {0};
    add_file(&values, params->file, ".stl", "");
    add_about(&values, params, box, vec3(0, 0, 0));
    text_printf(add_value(&values, "triangles"), "%zu", mesh.n_triangles);
    text_printf(add_value(&values, "quick"), "%d", OPENSCAD_QUICK);
    text_printf(add_value(&values, "seconds"), "%.2g",
                seconds_a_triangle * (double)mesh.n_triangles);
    text_printf(add_value(&values, "middle"), "%.4g", (box.low.z + box.high.z) / 2);
    put_point(add_value(&values, "low"), box.low);
    put_point(add_value(&values, "high"), box.high);
    add_part(&values, "points", put_points, &mesh);
    add_part(&values, "faces", put_faces, &mesh);
    return values_expand(&values, params, "openscad/polyhedron.scad", out, err);
}
