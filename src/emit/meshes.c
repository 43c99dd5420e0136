/* Writes meshes as binary STL and PLY. */
#include "emit/meshparts.h"
#include "emit/record.h"
#include "emit/rows.h"

#include <stdlib.h>

/* The header of binary STL has 80 bytes of text, which must not begin with "solid" as text STL
 * does. A triangle takes 50 bytes. */
Status stl_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    const VesselMesh *mesh = params->mesh;
    char header[81] = {0};
    snprintf(header, sizeof header, "%s, binary STL, units=mm", params->generator);
    text_append(to->file, header, 80);
    Record record = {.length = 0};
    put_word(&record, (uint32_t)mesh->n_triangles, 4);
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        float normal[3];
        mesh_flat_normal(mesh, i, normal);
        put_floats(&record, normal);
        for (int k = 0; k < 3; k++)
            put_floats(&record, mesh->points[mesh->triangles[i][k]]);
        put_word(&record, 0, 2);
        flush_record(&record, to->file);
    }
    return text_check(to->file, err);
}

static void put_ply_points(const EmitParams *params, const uint32_t *segments, Text *out)
{
    const VesselMesh *mesh = params->mesh;
    Record record = {.length = 0};
    for (size_t i = 0; i < mesh->n_points; i++) {
        uint8_t codes[3];
        vessel_color_codes(params, segments[i], codes);
        put_floats(&record, mesh->points[i]);
        put_floats(&record, mesh->normals[i]);
        for (int k = 0; k < 3; k++)
            put_word(&record, codes[k], 1);
        flush_record(&record, out);
    }
}

static void put_ply_faces(const EmitParams *params, Text *out)
{
    const VesselMesh *mesh = params->mesh;
    Record record = {.length = 0};
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        put_word(&record, 3, 1);
        for (int k = 0; k < 3; k++)
            put_word(&record, mesh->triangles[i][k], 4);
        put_word(&record, params->vessels->ids[mesh_segment(mesh, i)], 4);
        put_word(&record, mesh_is_cap(mesh, i), 1);
        flush_record(&record, out);
    }
}

/* Each point has a normal and a color. Each triangle has the SWC id of its segment and a flag for
 * caps. */
Status ply_write(const EmitParams *params, EmitOutput *to, Err *err)
{
    uint32_t *segments = NULL;
    TRY(mesh_point_segments(params->mesh, &segments, err));
    text_printf(to->file,
                "ply\nformat binary_little_endian 1.0\ncomment %s, units=mm\n"
                "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n"
                "property float nx\nproperty float ny\nproperty float nz\n"
                "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                "element face %zu\nproperty list uchar int vertex_indices\n"
                "property int segment\nproperty uchar cap\nend_header\n",
                params->generator, params->mesh->n_points, params->mesh->n_triangles);
    put_ply_points(params, segments, to->file);
    put_ply_faces(params, to->file);
    free(segments);
    return text_check(to->file, err);
}
