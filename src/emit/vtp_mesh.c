/* Writes a mesh as XML PolyData of VTK, with the arrays that SimVascular reads. `ModelFaceID` has
 * the number of each triangle's part, counted from 1. `FaceNames`, in the field data, has the names
 * of the parts in that order; VTK filters pass field data on. The arrays of numbers follow the XML
 * document as binary data, each preceded by its size in bytes. */
#include "emit/meshparts.h"
#include "emit/record.h"
#include "emit/rows.h"
#include "emit/values.h"

/* The binary arrays in the order of the file, and the template's names for their offsets. */
enum { FACES, SEGMENTS, POINTS, CORNERS, OFFSETS, ARRAYS };
static const char *const offset_names[ARRAYS] = {"at_faces", "at_segments", "at_points",
                                                 "at_corners", "at_offsets"};

/* Returns the length of an array, in numbers of 4 bytes. */
static size_t array_length(const VesselMesh *mesh, int array)
{
    return array == POINTS    ? 3 * mesh->n_points
           : array == CORNERS ? 3 * mesh->n_triangles
                              : mesh->n_triangles;
}

static void put_number(const EmitParams *params, int array, size_t i, Record *record)
{
    const VesselMesh *mesh = params->mesh;
    if (array == POINTS)
        put_float(record, mesh->points[i / 3][i % 3]);
    else if (array == CORNERS)
        put_word(record, mesh->triangles[i / 3][i % 3], 4);
    else if (array == FACES)
        put_word(record, params->ends->parts[i] + 1, 4);
    else if (array == SEGMENTS)
        put_word(record, params->vessels->ids[mesh_segment(mesh, i)], 4);
    else
        put_word(record, (uint32_t)(3 * (i + 1)), 4);
}

static Status put_arrays(Text *out, void *context, Err *err)
{
    const EmitParams *params = context;
    Record record = {.length = 0};
    for (int array = 0; array < ARRAYS; array++) {
        size_t n = array_length(params->mesh, array);
        uint64_t bytes = 4 * (uint64_t)n;
        put_word(&record, (uint32_t)bytes, 4);
        put_word(&record, (uint32_t)(bytes >> 32), 4);
        flush_record(&record, out);
        for (size_t i = 0; i < n; i++) {
            put_number(params, array, i, &record);
            flush_record(&record, out);
        }
    }
    return text_check(out, err);
}

/* Appends a string as the codes of its characters and a 0, the only text format for strings in
 * VTK's XML. Appends nothing for NULL. */
static void put_letters(Text *text, const char *chars)
{
    for (const char *at = chars; at && *at; at++)
        text_printf(text, "%d ", (unsigned char)*at);
    text_puts(text, chars ? "0\n" : NULL);
}

static void add_texts(Values *values, const EmitParams *params)
{
    Text *names = add_value(values, "names");
    for (size_t part = 0; part < meshends_parts(params->ends); part++)
        put_letters(names, meshends_part_name(params->ends, part));
    add_count(values, "n_names", meshends_parts(params->ends));
    Text *about = add_value(values, "about");
    put_letters(about, params->generator);
    put_letters(about, params->description);
    put_letters(about, params->command);
    put_letters(about, "mm");
}

Status vtp_write_mesh(const EmitParams *params, EmitOutput *to, Err *err)
{
    const VesselMesh *mesh = params->mesh;
    EmitParams context = *params;
    Values values = {0};
    size_t offset = 0;
    add_texts(&values, params);
    add_count(&values, "n_points", mesh->n_points);
    add_count(&values, "n_triangles", mesh->n_triangles);
    for (int array = 0; array < ARRAYS; array++) {
        add_count(&values, offset_names[array], offset);
        offset += 8 + 4 * array_length(mesh, array);
    }
    add_part(&values, "arrays", put_arrays, &context);
    return values_expand(&values, params, "vtk/surface.vtp", to->file, err);
}
