/* Writes a mesh as XML PolyData of VTK, and layers of prisms as XML UnstructuredGrid, with the
 * arrays that SimVascular reads. `ModelFaceID` has the number of each cell's part, counted from 1.
 * `FaceNames`, in the field data, has the names of the parts in that order; VTK filters pass field
 * data on. The arrays of numbers follow the XML document as binary data, each preceded by its size
 * in bytes. */
#include "emit/meshparts.h"
#include "emit/prismcells.h"
#include "emit/record.h"
#include "emit/rows.h"
#include "emit/values.h"

/* The binary arrays, in the order of the file. A surface has those up to OFFSETS. */
enum { FACES, SEGMENTS, POINTS, CORNERS, OFFSETS, LAYERS, TYPES, ARRAYS };
static const char *const offset_names[ARRAYS] = {
    "at_faces", "at_segments", "at_points", "at_corners", "at_offsets", "at_layers", "at_types"};

static int array_count(const EmitParams *params)
{
    return prismcell_has_layers(params) ? ARRAYS : OFFSETS + 1;
}

static size_t point_count(const EmitParams *params)
{
    return prismcell_has_layers(params) ? params->layers->n_points : params->mesh->n_points;
}

/* Returns the length of an array in numbers of 4 bytes. */
static size_t array_length(const EmitParams *params, int array)
{
    if (array == POINTS)
        return 3 * point_count(params);
    if (array != CORNERS)
        return prismcell_count(params);
    PrismCell cell;
    size_t n = 0;
    for (size_t i = 0; i < prismcell_slots(params); i++)
        n += prismcell_at(params, i, &cell) ? (size_t)cell.n_corners : 0;
    return n;
}

/* Returns the number of the cell's part: 0 for a prism, and for the inner surface the number after
 * those of all parts. */
static size_t face_of(const EmitParams *params, const PrismCell *cell)
{
    return cell->kind == CELL_PRISM  ? 0
           : cell->kind == CELL_CORE ? meshends_parts(params->ends) + 1
                                     : params->ends->parts[cell->triangle] + 1;
}

/* Appends the numbers of an array for one cell. The normal of a prism's first triangle points away
 * from its second triangle. `end` is the total number of corners of all cells up to and including
 * this one. */
static void put_cell(const EmitParams *params, int array, const PrismCell *cell, size_t end,
                     Record *record)
{
    /* VTK's numbers of cell types: triangle, wedge, quadrangle, triangle. */
    static const int types[] = {
        [CELL_SURFACE] = 5, [CELL_PRISM] = 13, [CELL_END_QUAD] = 9, [CELL_CORE] = 5};
    if (array == CORNERS)
        for (int k = 0; k < cell->n_corners; k++)
            put_word(record, cell->corners[k], 4);
    else
        put_word(record,
                 array == FACES ? (uint32_t)face_of(params, cell)
                 : array == SEGMENTS
                     ? params->vessels->ids[mesh_segment(params->mesh, cell->triangle)]
                 : array == LAYERS  ? (uint32_t)cell->layer
                 : array == OFFSETS ? (uint32_t)end
                                    : (uint32_t)types[cell->kind],
                 4);
}

static void put_points(const EmitParams *params, Record *record, Text *out)
{
    float(*points)[3] =
        prismcell_has_layers(params) ? params->layers->points : params->mesh->points;
    for (size_t i = 0; i < point_count(params); i++) {
        put_floats(record, points[i]);
        flush_record(record, out);
    }
}

/* Appends the binary arrays, each preceded by its size as 8 bytes. */
static Status put_arrays(Text *out, const void *context, Err *err)
{
    const EmitParams *params = context;
    Record record = {.length = 0};
    for (int array = 0; array < array_count(params); array++) {
        uint64_t bytes = 4 * (uint64_t)array_length(params, array);
        PrismCell cell;
        put_word(&record, (uint32_t)bytes, 4);
        put_word(&record, (uint32_t)(bytes >> 32), 4);
        flush_record(&record, out);
        if (array == POINTS) {
            put_points(params, &record, out);
            continue;
        }
        for (size_t i = 0, end = 0; i < prismcell_slots(params); i++)
            if (prismcell_at(params, i, &cell)) {
                end += (size_t)cell.n_corners;
                put_cell(params, array, &cell, end, &record);
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

/* Appends the XML document, made from the template, and the binary arrays. */
static Status put_document(const EmitParams *params, const char *template, Text *out, Err *err)
{
    Values values = {0};
    size_t offset = 0;
    add_texts(&values, params);
    add_count(&values, "n_points", point_count(params));
    add_count(&values, "n_cells", prismcell_count(params));
    for (int array = 0; array < array_count(params); array++) {
        add_count(&values, offset_names[array], offset);
        offset += 8 + 4 * array_length(params, array);
    }
    add_part(&values, "arrays", put_arrays, params);
    return values_expand(&values, params, template, out, err);
}

Status vtp_write_mesh(const EmitParams *params, EmitOutput *to, Err *err)
{
    return put_document(params, "vtk/surface.vtp", to->file, err);
}

Status vtu_write_layers(const EmitParams *params, EmitOutput *to, Err *err)
{
    return put_document(params, "vtk/layers.vtu", to->file, err);
}
