/* Reads networks of Amira and Avizo (.am).
 *
 * The header defines the number of elements of each kind, and declares which block holds which
 * numbers of the elements. A block begins with a line "@1". Its numbers are text, or binary, or
 * binary and compressed by HxZip (zlib) or HxByteRLE: a byte n above 127 is followed by n - 128
 * bytes that are copied; any other byte n is followed by one byte that is repeated n times.
 *
 * The ContentType tells how elements are connected. All kinds become polylines of VtkData.
 *
 *   HxSpatialGraph  The points of an edge run from its first vertex to its second vertex, both
 *                   included. The points of one edge follow those of the edge before. Edges that
 *                   share a vertex are joined. Numbers of a vertex go to the points at the vertex.
 *   HxLineSet       LineIdx lists the vertices of one line after the other; -1 ends a line.
 *   SkeletonGraph   NeighbourList lists the neighbours of one vertex after the other, and
 *                   NeighbourCount states how many each vertex has. Origins are roots. */
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"
#include "treeio/vtk/vtpbytes.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Kinds of elements. LINES have the entries of LineIdx, NEIGHBOURS those of NeighbourList. */
enum { VERTEX, EDGE, POINT, VERTICES, LINES, NEIGHBOURS, ORIGINS, ELEMENTS };

static const char *const element_names[ELEMENTS] = {"VERTEX", "EDGE",       "POINT",  "Vertices",
                                                    "Lines",  "Neighbours", "Origins"};

/* How elements are connected. */
typedef enum AmiraContent { SPATIAL_GRAPH, LINE_SET, SKELETON, CONTENTS } AmiraContent;

static const char *const content_names[CONTENTS] = {"HxSpatialGraph", "HxLineSet", "SkeletonGraph"};

typedef enum AmiraPacking { BYTE_RLE, ZIP, PLAIN } AmiraPacking;

static const char *const packing_names[PLAIN] = {"HxByteRLE", "HxZip"};

static const CursorSyntax syntax = {
    .separators = " \t\r\n\v\f,=",
    .single = "{}()",
    .comment = '#',
    .has_quotes = true,
    .skips_zeros = true,
};

/* An array that the header declares: numbers of all elements of a kind. */
typedef struct AmiraField {
    size_t of;  /* index of the kind of elements */
    char *name; /* owned */
    VtkType type;
    size_t components;
    long long block;
    AmiraPacking packing;
    size_t packed; /* bytes in the file if the block is packed */
    double *value; /* owned; NULL until the block has been read */
} AmiraField;

typedef struct AmiraReader {
    Graph *graph;
    Cursor cursor;
    size_t size; /* of the file */
    bool is_text, is_big_endian;
    AmiraContent content;
    char content_name[40];
    bool has_count[ELEMENTS];
    size_t count[ELEMENTS];
    ARRAY(AmiraField) fields;
    double taken; /* bytes of memory for the numbers of all blocks so far */
    VtkData data;
} AmiraReader;

static void release(AmiraReader *reader)
{
    for (size_t i = 0; i < reader->fields.n; i++) {
        free(reader->fields.items[i].name);
        free(reader->fields.items[i].value);
    }
    ARRAY_RELEASE(&reader->fields);
    vtk_release(&reader->data);
}

/* ---- header ---- */

/* Sets the unit that the header states. The letter mu may be in UTF-8 or Latin-1. */
static void set_unit(Graph *graph, const char *name)
{
    bool is_micro = strcmp(name, "\xc2\xb5m") == 0 || strcmp(name, "\xb5m") == 0;
    for (int unit = 0; unit < LENGTH_UNITS; unit++)
        if (strcmp(is_micro ? "um" : name, length_unit_names[unit]) == 0) {
            graph->unit = (LengthUnit)unit;
            graph->unit_is_stated = true;
        }
}

/* Reads the words between braces after "Parameters" or another word that is not an element. */
static Status read_parameters(AmiraReader *reader, Err *err)
{
    char word[CURSOR_WORD], last[CURSOR_WORD] = "";
    for (size_t depth = 1; depth > 0; memcpy(last, word, sizeof last)) {
        if (!cursor_word(&reader->cursor, word))
            return err_set(err, STATUS_INPUT, "the header has a '{' without a '}'");
        depth += strcmp(word, "{") == 0;
        depth -= strcmp(word, "}") == 0;
        if (strcasecmp(last, "ContentType") == 0) {
            size_t content = keyword_find(word, content_names, CONTENTS);
            if (content < CONTENTS)
                reader->content = (AmiraContent)content;
            snprintf(reader->content_name, sizeof reader->content_name, "%.39s", word);
        }
        if (strcasecmp(last, "Coordinates") == 0)
            set_unit(reader->graph, word);
    }
    return STATUS_OK;
}

/* Reads "define VERTEX 3" after "define", or "3" after "nVertices". */
static Status read_count(AmiraReader *reader, const char *name, Err *err)
{
    char count[CURSOR_WORD];
    size_t of = keyword_find(name, element_names, ELEMENTS);
    int32_t number;
    if (!cursor_word(&reader->cursor, count))
        return err_set(err, STATUS_INPUT, "the header ends after '%.40s'", name);
    if (of == ELEMENTS)
        return STATUS_OK;
    TRY(field_integer(name, count, 0, INT32_MAX, &number, err));
    reader->count[of] = (size_t)number;
    reader->has_count[of] = true;
    return check_elements(name, number, reader->size, err);
}

/* Reads a type, "float[3]" or "int". More than 16 components, the number of a 4 x 4 matrix, are
 * refused: no array of a network has so many, and each would become a column. */
static Status read_type(AmiraField *field, const char *word, Err *err)
{
    enum { MAX_COMPONENTS = 16 };
    size_t length = strcspn(word, "[");
    long long components = 1;
    char number[CURSOR_WORD];
    snprintf(number, sizeof number, "%s", word[length] ? word + length + 1 : "1]");
    number[strcspn(number, "]")] = '\0';
    field->type = vtk_type_called(NAMING_AMIRA, word, length);
    if (field->type == VTK_TYPES || !integer_parse(number, 1, MAX_COMPONENTS, &components))
        return err_set(err, STATUS_INPUT, "'%.40s' is not a known type of numbers", word);
    field->components = (size_t)components;
    return STATUS_OK;
}

/* Reads "(HxZip,123)" after the number of a block. */
static Status read_packing(Cursor *cursor, AmiraField *field, Err *err)
{
    char name[CURSOR_WORD], bytes[CURSOR_WORD];
    long long size = 0;
    if (!cursor_accept(cursor, "("))
        return STATUS_OK;
    if (!cursor_word(cursor, name) || !cursor_word(cursor, bytes) ||
        !integer_parse(bytes, 0, INT64_MAX, &size) || !cursor_accept(cursor, ")"))
        return err_set(err, STATUS_INPUT, "the compression of block @%lld is unknown",
                       field->block);
    field->packing = (AmiraPacking)keyword_find(name, packing_names, PLAIN);
    field->packed = (size_t)size;
    if (field->packing == PLAIN)
        return err_set(err, STATUS_INPUT,
                       "block @%lld is packed by '%.40s'; it must be HxByteRLE or HxZip",
                       field->block, name);
    return STATUS_OK;
}

/* Reads "{ float[3] VertexCoordinates } @1" after "VERTEX". */
static Status read_declaration(AmiraReader *reader, size_t of, Err *err)
{
    Cursor *cursor = &reader->cursor;
    char type[CURSOR_WORD], name[CURSOR_WORD], block[CURSOR_WORD];
    AmiraField field = {.of = of, .packing = PLAIN};
    if (!cursor_accept(cursor, "{") || !cursor_word(cursor, type) || !cursor_word(cursor, name) ||
        !cursor_accept(cursor, "}") || !cursor_word(cursor, block) || *block != '@' ||
        !integer_parse(block + 1, 0, INT32_MAX, &field.block))
        return err_set(err, STATUS_INPUT,
                       "the declaration is not understood; it must be '%s { TYPE NAME } @BLOCK'",
                       element_names[of]);
    TRY(read_type(&field, type, err));
    TRY(read_packing(cursor, &field, err));
    TRY(ARRAY_RESERVE(&reader->fields, 1, "arrays", err));
    TRY(mem_strdup(&field.name, name, err));
    reader->fields.items[reader->fields.n++] = field;
    return STATUS_OK;
}

static Status read_statement(AmiraReader *reader, const char *word, Err *err)
{
    char name[CURSOR_WORD];
    if (strcasecmp(word, "define") == 0)
        return cursor_word(&reader->cursor, name)
                   ? read_count(reader, name, err)
                   : err_set(err, STATUS_INPUT, "the header ends after 'define'");
    size_t of = keyword_find(word, element_names, ELEMENTS);
    if (of < ELEMENTS)
        return read_declaration(reader, of, err);
    if (*word == 'n' && keyword_find(word + 1, element_names, ELEMENTS) < ELEMENTS)
        return read_count(reader, word + 1, err);
    return cursor_accept(&reader->cursor, "{") ? read_parameters(reader, err) : STATUS_OK;
}

/* Checks that the content is known and that the declared counts are complete. */
static Status check_header(const AmiraReader *reader, Err *err)
{
    static const size_t needed[CONTENTS][3] = {[SPATIAL_GRAPH] = {VERTEX, EDGE, POINT},
                                               [LINE_SET] = {VERTICES, VERTICES, LINES},
                                               [SKELETON] = {VERTICES, VERTICES, NEIGHBOURS}};
    if (reader->content == CONTENTS)
        return err_set(
            err, STATUS_INPUT,
            "the ContentType is '%s'; it must be HxSpatialGraph, HxLineSet or SkeletonGraph",
            reader->content_name);
    for (size_t k = 0; k < 3; k++) {
        size_t of = needed[reader->content][k];
        if (!reader->has_count[of])
            return err_set(err, STATUS_INPUT, "the header does not define %s", element_names[of]);
    }
    return STATUS_OK;
}

/* Returns the start of the first line that begins with "@" and a digit, or NULL. */
static char *first_block(const Cursor *cursor)
{
    for (char *at = cursor->start; (at = memmem(at, (size_t)(cursor->end - at), "\n@", 2)); at++)
        if (isdigit((unsigned char)at[2]))
            return at + 1;
    return NULL;
}

/* Reads the header, up to the first block. */
static Status read_header(AmiraReader *reader, Err *err)
{
    Cursor *cursor = &reader->cursor;
    char word[CURSOR_WORD], *end_of_file = cursor->end, *end = first_block(cursor);
    size_t length = strcspn(cursor->start, "\n");
    if (!end)
        return err_set(err, STATUS_INPUT, "the file has no block of numbers");
    bool is_little = memmem(cursor->start, length, "LITTLE-ENDIAN", 13) != NULL;
    reader->is_text = memmem(cursor->start, length, "ASCII", 5) != NULL;
    reader->is_big_endian = !reader->is_text && !is_little;
    cursor->end = end;
    while (cursor_word(cursor, word))
        TRY(read_statement(reader, word, err));
    TRY(check_header(reader, err));
    cursor->at = end;
    cursor->end = end_of_file;
    return STATUS_OK;
}

/* ---- blocks ---- */

/* Unpacks run lengths. Errors: STATUS_INPUT unless they unpack to exactly `size` bytes. */
static Status unpack_rle(const char *from, size_t packed, char *to, size_t size, Err *err)
{
    size_t at = 0, n = 0;
    while (at < packed) {
        unsigned char control = (unsigned char)from[at++];
        size_t count = control & 0x7f, takes = control > 0x7f ? count : 1;
        if (takes > packed - at || count > size - n)
            break;
        if (control > 0x7f)
            memcpy(to + n, from + at, count);
        else
            memset(to + n, from[at], count);
        n += count;
        at += takes;
    }
    return n == size && at == packed
               ? STATUS_OK
               : err_set(err, STATUS_INPUT, "not byte runs that unpack to %zu bytes", size);
}

/* Unpacks a compressed block into the field's numbers. */
static Status unpack(AmiraReader *reader, const AmiraField *field, size_t n, Err *err)
{
    size_t size = n * vtk_type_size(field->type);
    const char *from = reader->cursor.at;
    char *bytes = NULL;
    TRY(mem_calloc(&bytes, size, 1, "bytes of a block", err));
    Status status = field->packing == BYTE_RLE
                        ? unpack_rle(from, field->packed, bytes, size, err)
                        : bytes_inflate(from, field->packed, bytes, size, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "the %zu bytes of @%lld are ", field->packed, field->block);
    TRY_GOTO(status);
    vtk_numbers(field->type, reader->is_big_endian, bytes, n, field->value);
done:
    reader->cursor.at += field->packed;
    free(bytes);
    return status;
}

/* Checks, before memory is allocated, that the rest of the file can hold n numbers. A byte run
 * expands one byte to at most 127 / 2 < 64 bytes, and zlib to at most 1032. */
static Status check_claim(const AmiraReader *reader, const AmiraField *field, size_t n, Err *err)
{
    static const double max_ratio[] = {[BYTE_RLE] = 64, [ZIP] = 1032};
    size_t left = cursor_left(&reader->cursor);
    double needs = (double)n * (reader->is_text ? 2 : (double)vtk_type_size(field->type));
    double has = (double)left + reader->is_text;
    if (field->packing != PLAIN) {
        if (field->packed > left)
            return err_set(err, STATUS_INPUT, "the file ends within the %zu bytes of @%lld",
                           field->packed, field->block);
        has = (double)field->packed * max_ratio[field->packing];
    }
    if (needs > has)
        return err_set(err, STATUS_INPUT,
                       "%zu numbers of '%.40s' do not fit in the %zu bytes that are left", n,
                       field->name, left);
    return STATUS_OK;
}

/* Reads the n numbers of a block, text or binary. */
static Status read_block(AmiraReader *reader, AmiraField *field, Err *err)
{
    Cursor *cursor = &reader->cursor;
    size_t n = reader->count[field->of] * field->components, size = vtk_type_size(field->type);
    TRY(check_claim(reader, field, n, err));
    reader->taken += (double)n * sizeof *field->value;
    TRY(check_unpacked(reader->taken, reader->size, err));
    TRY(mem_check(reader->taken + (double)n * (double)size, reader->graph->name, err));
    free(field->value);
    field->value = NULL;
    TRY(mem_calloc(&field->value, n, sizeof *field->value, "numbers of a block", err));
    if (reader->is_text)
        return cursor_numbers(cursor, field->name, n, field->value, err);
    if (field->packing != PLAIN)
        return unpack(reader, field, n, err);
    vtk_numbers(field->type, reader->is_big_endian, cursor->at, n, field->value);
    cursor->at += n * size;
    return STATUS_OK;
}

/* Reads the number of a block and passes over the rest of its line. */
static Status read_block_line(Cursor *cursor, long long *block, Err *err)
{
    char word[32];
    size_t length = 0;
    while (length < cursor_left(cursor) && length < sizeof word - 1 &&
           !isspace((unsigned char)cursor->at[length]))
        length++;
    memcpy(word, cursor->at, length);
    word[length] = '\0';
    if (*word != '@' || !integer_parse(word + 1, 0, INT32_MAX, block))
        return err_set(err, STATUS_INPUT, "'%.30s' was found where a block must begin", word);
    cursor_skip_line(cursor);
    return STATUS_OK;
}

/* Reads all blocks, in the order of the file. */
static Status read_blocks(AmiraReader *reader, Err *err)
{
    Cursor *cursor = &reader->cursor;
    for (;;) {
        long long block;
        size_t i = 0;
        while (cursor->at < cursor->end && isspace((unsigned char)*cursor->at))
            cursor->at++;
        if (cursor->at == cursor->end)
            return STATUS_OK;
        TRY(read_block_line(cursor, &block, err));
        while (i < reader->fields.n && reader->fields.items[i].block != block)
            i++;
        if (i == reader->fields.n)
            return err_set(err, STATUS_INPUT, "block @%lld is not declared in the header", block);
        TRY(read_block(reader, &reader->fields.items[i], err));
    }
}

/* ---- the network ---- */

static AmiraField *find_field(const AmiraReader *reader, size_t of, const char *name)
{
    for (size_t i = 0; i < reader->fields.n; i++)
        if (reader->fields.items[i].of == of && strcasecmp(reader->fields.items[i].name, name) == 0)
            return &reader->fields.items[i];
    return NULL;
}

static Status need_field(const AmiraReader *reader, size_t of, const char *name, size_t components,
                         AmiraField **field, Err *err)
{
    *field = find_field(reader, of, name);
    if (*field && (*field)->value && (*field)->components == components)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: no block holds %s { %s } with %zu number%s each",
                   reader->graph->name, element_names[of], name, components,
                   components == 1 ? "" : "s");
}

/* Finds the end of the points of each edge. The caller frees *end. */
static Status find_ends(const AmiraReader *reader, const AmiraField *counts, size_t **end, Err *err)
{
    size_t edges = reader->count[EDGE], points = reader->count[POINT], at = 0;
    size_t *made = NULL;
    double sum = 0;
    for (size_t i = 0; i < edges; i++) {
        double count = counts->value[i];
        if (!(count >= 2) || count != floor(count))
            return err_set(
                err, STATUS_INPUT,
                "%s: edge %zu has %g points; it must have at least 2, the points of its vertices",
                reader->graph->name, i, count);
        sum += count;
    }
    if (sum != (double)points)
        return err_set(err, STATUS_INPUT,
                       "%s: the edges have %.15g points in total; the header defines POINT as %zu",
                       reader->graph->name, sum, points);
    TRY(mem_calloc(&made, edges, sizeof *made, "edges", err));
    for (size_t i = 0; i < edges; i++)
        made[i] = at += (size_t)counts->value[i];
    *end = made;
    return STATUS_OK;
}

/* Joins the end point of an edge to the first end point at the same vertex. first[v] is 1 + that
 * point, or 0 if there is none yet. */
static Status join_vertex(const AmiraReader *reader, double vertex, size_t point, size_t *first,
                          Err *err)
{
    if (!(vertex >= 0 && vertex < (double)reader->count[VERTEX]) || vertex != floor(vertex))
        return err_set(err, STATUS_INPUT,
                       "%s: an edge refers to vertex %g; there are %zu vertices, counted from 0",
                       reader->graph->name, vertex, reader->count[VERTEX]);
    size_t *of = &first[(size_t)vertex];
    if (*of == 0)
        *of = point + 1;
    else
        TRY(graph_join(reader->graph, *of - 1, point, err));
    return STATUS_OK;
}

/* Joins edges at their vertices. vertex[i] receives 1 + the vertex at point i, or 0 for a point
 * inside an edge. The caller frees *vertex. */
static Status join_edges(const AmiraReader *reader, const AmiraField *ends, const size_t *end,
                         size_t **vertex, Err *err)
{
    size_t *first = NULL, *made = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&first, reader->count[VERTEX], sizeof *first, "vertices", err));
    TRY_GOTO(mem_calloc(&made, reader->count[POINT], sizeof *made, "points", err));
    for (size_t i = 0, at = 0; i < reader->count[EDGE]; at = end[i++]) {
        const double *of = &ends->value[2 * i];
        TRY_GOTO(join_vertex(reader, of[0], at, first, err));
        TRY_GOTO(join_vertex(reader, of[1], end[i] - 1, first, err));
        made[at] = (size_t)of[0] + 1;
        made[end[i] - 1] = (size_t)of[1] + 1;
    }
    *vertex = made;
    made = NULL;
done:
    free(first);
    free(made);
    return status;
}

/* Copies numbers of vertices to the points at the vertices. Other points get NAN. */
static Status copy_to_points(const AmiraReader *reader, const AmiraField *field,
                             const size_t *vertex, double **value, Err *err)
{
    size_t n = reader->count[POINT], components = field->components;
    TRY(mem_calloc(value, n * components, sizeof **value, "numbers of points", err));
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < components; k++)
            (*value)[i * components + k] =
                vertex[i] ? field->value[(vertex[i] - 1) * components + k] : (double)NAN;
    return STATUS_OK;
}

/* Moves a declared array to the VtkData. */
static Status add_array(AmiraReader *reader, AmiraField *field, const size_t *vertex, Err *err)
{
    VtkArray array = {.n = reader->count[field->of == VERTEX ? POINT : field->of],
                      .components = field->components};
    VtkData *data = &reader->data;
    if (field->of == VERTEX)
        TRY(copy_to_points(reader, field, vertex, &array.value, err));
    array.name = field->name;
    field->name = NULL;
    if (field->of != VERTEX) {
        array.value = field->value;
        field->value = NULL;
    }
    return vtk_add_array(
        field->of == EDGE ? &data->arrays[GRAPH_LINES] : &data->arrays[GRAPH_POINTS], &array, err);
}

/* Names of the arrays that hold positions and connections, not values. */
static const char *const own_arrays[] = {"VertexCoordinates", "EdgeConnectivity",
                                         "NumEdgePoints",     "EdgePointCoordinates",
                                         "Coordinates",       "NeighbourCount"};

/* Adds the arrays of values. `vertex` is that of copy_to_points. It is NULL if the file is not a
 * spatial graph; arrays of the elements of a spatial graph then belong to nothing and are left out.
 */
static Status add_arrays(AmiraReader *reader, const size_t *vertex, Err *err)
{
    for (size_t i = 0; i < reader->fields.n; i++) {
        size_t of = reader->fields.items[i].of;
        bool is_own = !reader->fields.items[i].value || of == LINES || of == NEIGHBOURS ||
                      of == ORIGINS || (!vertex && of <= POINT);
        for (size_t k = 0; k < sizeof own_arrays / sizeof *own_arrays && !is_own; k++)
            is_own = strcasecmp(reader->fields.items[i].name, own_arrays[k]) == 0;
        if (!is_own)
            TRY(add_array(reader, &reader->fields.items[i], vertex, err));
    }
    return STATUS_OK;
}

/* Adds one polyline per edge. Takes ownership of `end`. */
static Status add_lines(AmiraReader *reader, const AmiraField *positions, size_t *end, Err *err)
{
    VtkData *data = &reader->data;
    size_t points = reader->count[POINT], edges = reader->count[EDGE];
    data->end = end;
    data->n_lines = data->n_cells = edges;
    data->n_points = data->n_corners = points;
    TRY(mem_calloc(&data->point, 3 * points, sizeof *data->point, "points", err));
    TRY(mem_calloc(&data->corner, points, sizeof *data->corner, "points", err));
    TRY(mem_calloc(&data->cell, edges, sizeof *data->cell, "edges", err));
    memcpy(data->point, positions->value, 3 * points * sizeof *data->point);
    for (size_t i = 0; i < points; i++)
        data->corner[i] = (double)i;
    for (size_t i = 0; i < edges; i++)
        data->cell[i] = i;
    return STATUS_OK;
}

/* Adds the edges of an HxSpatialGraph. */
static Status add_spatial_graph(AmiraReader *reader, Err *err)
{
    AmiraField *vertices, *ends, *counts, *positions;
    size_t *end = NULL, *vertex = NULL;
    Status status = STATUS_OK;
    TRY(need_field(reader, VERTEX, "VertexCoordinates", 3, &vertices, err));
    TRY(need_field(reader, EDGE, "EdgeConnectivity", 2, &ends, err));
    TRY(need_field(reader, EDGE, "NumEdgePoints", 1, &counts, err));
    TRY(need_field(reader, POINT, "EdgePointCoordinates", 3, &positions, err));
    TRY(find_ends(reader, counts, &end, err));
    TRY_GOTO(add_lines(reader, positions, end, err));
    TRY_GOTO(join_edges(reader, ends, end, &vertex, err));
    TRY_GOTO(add_arrays(reader, vertex, err));
done:
    free(vertex);
    return status;
}

/* Moves the positions of the vertices to the points of the network. */
static Status add_vertices(AmiraReader *reader, Err *err)
{
    AmiraField *positions;
    TRY(need_field(reader, VERTICES, "Coordinates", 3, &positions, err));
    reader->data.point = positions->value;
    reader->data.n_points = reader->count[VERTICES];
    positions->value = NULL;
    return STATUS_OK;
}

/* Renames the first array of vertices to "radius" if no array is called a radius. Line sets of
 * Amira give the radius no name of its own: the array is called Data or Data0. */
static Status name_radius(AmiraReader *reader, Err *err)
{
    AmiraField *data = find_field(reader, VERTICES, "Data0");
    data = data ? data : find_field(reader, VERTICES, "Data");
    if (!data || !data->value || data->components != 1 || find_field(reader, VERTICES, "radius") ||
        find_field(reader, VERTICES, "thickness") ||
        (reader->graph->options && reader->graph->options->radius_array))
        return STATUS_OK;
    TRY(reading_note(reader->graph->reading, err, "used the vertex numbers '%.60s' as radii",
                     data->name));
    char *name;
    TRY(mem_strdup(&name, "radius", err));
    free(data->name);
    data->name = name;
    return STATUS_OK;
}

/* Adds the lines of an HxLineSet. */
static Status add_line_set(AmiraReader *reader, Err *err)
{
    VtkData *data = &reader->data;
    AmiraField *lines;
    size_t first = 0;
    TRY(need_field(reader, LINES, "LineIdx", 1, &lines, err));
    TRY(add_vertices(reader, err));
    for (size_t i = 0, n = reader->count[LINES]; i <= n; i++) {
        if (i < n && lines->value[i] != -1)
            continue;
        if (i - first > 1)
            TRY(vtk_add_line(data, data->n_cells++, lines->value + first, i - first, 0, err));
        first = i + 1;
    }
    return name_radius(reader, err);
}

/* Adds an array "root" [vtkmeaning.c] with 1 at the origins and 0 at other points. */
static Status add_origins(AmiraReader *reader, Err *err)
{
    VtkData *data = &reader->data;
    const AmiraField *origins = find_field(reader, ORIGINS, "Origins");
    if (!origins || !origins->value || origins->components != 1 || data->n_points == 0)
        return STATUS_OK;
    VtkArrays *arrays = &data->arrays[GRAPH_POINTS];
    TRY(vtk_set_number(arrays, "root", data->n_points - 1, 0, reader->size, err));
    double *root = vtk_find_array(arrays, "root")->value;
    for (size_t i = 0; i < data->n_points; i++)
        root[i] = 0;
    for (size_t i = 0; i < reader->count[ORIGINS]; i++)
        if (origins->value[i] >= 0 && origins->value[i] < (double)data->n_points)
            root[(size_t)origins->value[i]] = 1;
    return STATUS_OK;
}

/* Adds one line per pair of neighbours. Both vertices list the other one, so the line is added at
 * the lower vertex. */
static Status add_skeleton(AmiraReader *reader, Err *err)
{
    VtkData *data = &reader->data;
    AmiraField *counts, *list;
    size_t at = 0, n = reader->count[NEIGHBOURS];
    TRY(need_field(reader, VERTICES, "NeighbourCount", 1, &counts, err));
    TRY(need_field(reader, NEIGHBOURS, "NeighbourList", 1, &list, err));
    TRY(add_vertices(reader, err));
    for (size_t i = 0; i < data->n_points; i++) {
        double count = counts->value[i];
        if (!(count >= 0 && count <= (double)(n - at)) || count != floor(count))
            return err_set(err, STATUS_INPUT,
                           "%s: vertex %zu has %g neighbors, but only %zu entries are left",
                           reader->graph->name, i, count, n - at);
        for (size_t end = at + (size_t)count; at < end; at++) {
            const double corner[] = {(double)i, list->value[at]};
            if (corner[1] > corner[0])
                TRY(vtk_add_line(data, data->n_cells++, corner, 2, 0, err));
        }
    }
    return add_origins(reader, err);
}

Status amira_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static Status (*const add[CONTENTS])(AmiraReader *, Err *) = {
        [SPATIAL_GRAPH] = add_spatial_graph, [LINE_SET] = add_line_set, [SKELETON] = add_skeleton};
    AmiraReader reader = {.graph = graph,
                          .cursor = cursor_of(graph->name, &syntax, bytes, size),
                          .size = size,
                          .content = CONTENTS};
    Status status = STATUS_OK;
    graph->unit = LENGTH_UM;
    TRY_GOTO(cursor_locate_error(&reader.cursor, read_header(&reader, err), err));
    TRY_GOTO(cursor_locate_error(&reader.cursor, read_blocks(&reader, err), err));
    TRY_GOTO(add[reader.content](&reader, err));
    if (reader.content != SPATIAL_GRAPH)
        TRY_GOTO(add_arrays(&reader, NULL, err));
    TRY_GOTO(vtk_to_graph(&reader.data, graph, err));
done:
    release(&reader);
    return status;
}

bool amira_detect(const char *start)
{
    return strncasecmp(start, "# AmiraMesh", 11) == 0 || strncasecmp(start, "# Avizo", 7) == 0;
}
