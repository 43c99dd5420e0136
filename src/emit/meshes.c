/* Triangles for printers and CAD: STL and PLY. Binary numbers are little-endian, put byte by byte,
 * so that the machine's order does not matter; a buffer of one record at a time goes to the text.
 */
#include "emit/rows.h"

#include <string.h>

/* A record of a binary file. */
typedef struct Record {
    char bytes[64];
    size_t length;
} Record;

static void put_word(Record *record, uint32_t word, int bytes)
{
    for (int i = 0; i < bytes; i++)
        record->bytes[record->length++] = (char)(word >> 8 * i & 0xff);
}

static void put_float(Record *record, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_word(record, bits, 4);
}

static void put_floats(Record *record, const float values[3])
{
    for (int axis = 0; axis < 3; axis++)
        put_float(record, values[axis]);
}

static void flush_record(Record *record, Text *out)
{
    text_append(out, record->bytes, record->length);
    record->length = 0;
}

/* The unit normal of a triangle, by the right hand. */
static void flat_normal(const VesselMesh *mesh, const uint32_t triangle[3], float normal[3])
{
    Vec3 at[3];
    for (int i = 0; i < 3; i++) {
        const float *x = mesh->points[triangle[i]];
        at[i] = vec3((double)x[0], (double)x[1], (double)x[2]);
    }
    Vec3 across = vec3_cross(vec3_sub(at[1], at[0]), vec3_sub(at[2], at[0]));
    double length = vec3_length(across);
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = length > 0 ? (float)(vec3_component(across, axis) / length) : 0;
}

/* 80 bytes of text that do not begin as the text form does, then triangles of 50 bytes. */
Status stl_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err)
{
    (void)second;
    (void)report;
    const VesselMesh *mesh = params->mesh;
    char header[81] = {0};
    snprintf(header, sizeof header, "%s, binary STL, units=mm", params->generator);
    text_append(out, header, 80);
    Record record = {.length = 0};
    put_word(&record, (uint32_t)mesh->n_triangles, 4);
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        float normal[3];
        flat_normal(mesh, mesh->triangles[i], normal);
        put_floats(&record, normal);
        for (int k = 0; k < 3; k++)
            put_floats(&record, mesh->points[mesh->triangles[i][k]]);
        put_word(&record, 0, 2);
        flush_record(&record, out);
    }
    return text_check(out, err);
}

/* Points with normals, and for each triangle the SWC id of its segment and whether it closes an
 * end. */
Status ply_write(const EmitParams *params, Text *out, Text *second, EmitReport *report, Err *err)
{
    (void)second;
    (void)report;
    const VesselMesh *mesh = params->mesh;
    text_printf(out,
                "ply\nformat binary_little_endian 1.0\ncomment %s, units=mm\n"
                "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n"
                "property float nx\nproperty float ny\nproperty float nz\n"
                "element face %zu\nproperty list uchar int vertex_indices\n"
                "property int segment\nproperty uchar cap\nend_header\n",
                params->generator, mesh->n_points, mesh->n_triangles);
    Record record = {.length = 0};
    for (size_t i = 0; i < mesh->n_points; i++) {
        put_floats(&record, mesh->points[i]);
        put_floats(&record, mesh->normals[i]);
        flush_record(&record, out);
    }
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        put_word(&record, 3, 1);
        for (int k = 0; k < 3; k++)
            put_word(&record, mesh->triangles[i][k], 4);
        put_word(&record, params->vessels->ids[mesh->labels[i] & ~MESH_CAP], 4);
        put_word(&record, (mesh->labels[i] & MESH_CAP) != 0, 1);
        flush_record(&record, out);
    }
    return text_check(out, err);
}
