/* Writes a mesh as one polyhedron(), which OpenSCAD uses without uniting anything. OpenSCAD expects
 * the vertices of a face in clockwise order, seen from outside, so the order is reversed. */
#include "emit/meshparts.h"
#include "emit/rows.h"
#include "emit/values.h"

/* Time that CGAL takes per triangle to convert a polyhedron that is cut or united, s. Measured with
 * OpenSCAD 2021.01 and 7,000 to 40,000 triangles. */
static const double seconds_per_triangle = 3e-4;

static void put_point(Text *out, const void *mesh, size_t i)
{
    put_triple(out, "[", ((const VesselMesh *)mesh)->points[i], ",", "],\n");
}

static void put_face(Text *out, const void *mesh, size_t i)
{
    const uint32_t *corner = ((const VesselMesh *)mesh)->triangles[i];
    text_printf(out, "[%u,%u,%u],\n", corner[2], corner[1], corner[0]);
}

Status openscad_write_mesh(const EmitParams *params, EmitOutput *to, Err *err)
{
    const VesselMesh *mesh = params->mesh;
    Box box = mesh_box(mesh);
    Values values = {0};
    add_file(&values, params->file, ".stl", "");
    add_about(&values, params, box, vec3(0, 0, 0));
    add_count(&values, "triangles", mesh->n_triangles);
    add_count(&values, "quick", OPENSCAD_QUICK);
    text_printf(add_value(&values, "seconds"), "%.2g",
                seconds_per_triangle * (double)mesh->n_triangles);
    text_printf(add_value(&values, "middle"), "%.4g", (box.low.z + box.high.z) / 2);
    put_text(add_value(&values, "low"), "[%v]", box.low);
    put_text(add_value(&values, "high"), "[%v]", box.high);
    add_list(&values, "points", put_point, mesh, mesh->n_points);
    add_list(&values, "faces", put_face, mesh, mesh->n_triangles);
    return values_expand(&values, params, "openscad/polyhedron.scad", to->file, err);
}
