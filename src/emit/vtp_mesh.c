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

/* The binary arrays of a file, in the order of the file. */
typedef struct ArrayTable {
    const EmitParams *params;
    const char *const *offset_names; /* per array: the name of its offset in the template */
    int n;
    size_t (*length)(const EmitParams *params, int array); /* returns the length of an array in
                                                            * numbers of 4 bytes */
    void (*put)(const EmitParams *params, int array, Text *out);
} ArrayTable;

static Status put_arrays(Text *out, void *context, Err *err)
{
    const ArrayTable *table = context;
    Record record = {.length = 0};
    for (int array = 0; array < table->n; array++) {
        uint64_t bytes = 4 * (uint64_t)table->length(table->params, array);
        put_word(&record, (uint32_t)bytes, 4);
        put_word(&record, (uint32_t)(bytes >> 32), 4);
        flush_record(&record, out);
        table->put(table->params, array, out);
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
static Status put_document(Values *values, ArrayTable *table, const char *template, Text *out,
                           Err *err)
{
    size_t offset = 0;
    add_texts(values, table->params);
    for (int array = 0; array < table->n; array++) {
        add_count(values, table->offset_names[array], offset);
        offset += 8 + 4 * table->length(table->params, array);
    }
    add_part(values, "arrays", put_arrays, table);
    return values_expand(values, table->params, template, out, err);
}

/* ---- triangles ------------------------------------------------------------------------------- */

enum { FACES, SEGMENTS, POINTS, CORNERS, OFFSETS, SURFACE_ARRAYS };
static const char *const surface_offset_names[SURFACE_ARRAYS] = {
    "at_faces", "at_segments", "at_points", "at_corners", "at_offsets"};

static size_t surface_length(const EmitParams *params, int array)
{
    const VesselMesh *mesh = params->mesh;
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

static void put_surface_array(const EmitParams *params, int array, Text *out)
{
    Record record = {.length = 0};
    for (size_t i = 0; i < surface_length(params, array); i++) {
        put_number(params, array, i, &record);
        flush_record(&record, out);
    }
}

Status vtp_write_mesh(const EmitParams *params, EmitOutput *to, Err *err)
{
    ArrayTable table = {params, surface_offset_names, SURFACE_ARRAYS, surface_length,
                        put_surface_array};
    Values values = {0};
    add_count(&values, "n_points", params->mesh->n_points);
    add_count(&values, "n_triangles", params->mesh->n_triangles);
    return put_document(&values, &table, "vtk/surface.vtp", to->file, err);
}

/* ---- layers of prisms ------------------------------------------------------------------------ */

enum {
    CELL_FACES,
    CELL_SEGMENTS,
    CELL_LAYERS,
    CELL_POINTS,
    CELL_CORNERS,
    CELL_OFFSETS,
    CELL_TYPES,
    CELL_ARRAYS
};
static const char *const cell_offset_names[CELL_ARRAYS] = {
    "at_faces", "at_segments", "at_layers", "at_points", "at_corners", "at_offsets", "at_types"};

static size_t cells_length(const EmitParams *params, int array)
{
    if (array == CELL_POINTS)
        return 3 * params->layers->n_points;
    if (array != CELL_CORNERS)
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
    return cell->kind == CELL_PRISM   ? 0
           : cell->kind == CELL_INNER ? meshends_parts(params->ends) + 1
                                      : params->ends->parts[cell->triangle] + 1;
}

/* Appends the numbers of an array for one cell. The normal of a prism's first triangle points away
 * from its second triangle. `end` is the total number of corners of all cells up to and including
 * this one. */
static void put_cell(const EmitParams *params, int array, const PrismCell *cell, size_t end,
                     Record *record)
{
    static const int types[] = {
        [CELL_SURFACE] = 5, [CELL_PRISM] = 13, [CELL_RING] = 9, [CELL_INNER] = 5};
    if (array == CELL_CORNERS)
        for (int k = 0; k < cell->n_corners; k++)
            put_word(record, cell->corners[k], 4);
    else
        put_word(record,
                 array == CELL_FACES ? (uint32_t)face_of(params, cell)
                 : array == CELL_SEGMENTS
                     ? params->vessels->ids[mesh_segment(params->mesh, cell->triangle)]
                 : array == CELL_LAYERS  ? (uint32_t)cell->layer
                 : array == CELL_OFFSETS ? (uint32_t)end
                                         : (uint32_t)types[cell->kind],
                 4);
}

static void put_cell_array(const EmitParams *params, int array, Text *out)
{
    Record record = {.length = 0};
    PrismCell cell;
    if (array == CELL_POINTS) {
        for (size_t i = 0; i < params->layers->n_points; i++) {
            put_floats(&record, params->layers->points[i]);
            flush_record(&record, out);
        }
        return;
    }
    for (size_t i = 0, end = 0; i < prismcell_slots(params); i++)
        if (prismcell_at(params, i, &cell)) {
            end += (size_t)cell.n_corners;
            put_cell(params, array, &cell, end, &record);
            flush_record(&record, out);
        }
}

Status vtu_write_layers(const EmitParams *params, EmitOutput *to, Err *err)
{
    ArrayTable table = {params, cell_offset_names, CELL_ARRAYS, cells_length, put_cell_array};
    Values values = {0};
    add_count(&values, "n_points", params->layers->n_points);
    add_count(&values, "n_cells", prismcell_count(params));
    return put_document(&values, &table, "vtk/layers.vtu", to->file, err);
}
