/* Reads legacy VTK. A keyword announces numbers, which follow as text or as big-endian bytes. The
 * announced count is compared with the number of bytes that are left before memory is allocated.
 *
 * Cells have two forms. Before version 5 of the format, each cell is a count followed by that many
 * point indices. From version 5 on, cells are two arrays, OFFSETS and CONNECTIVITY. */
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const CursorSyntax syntax = {.separators = " \t\r\n", .single = ""};

typedef struct LegacyReader {
    Cursor cursor;
    bool is_binary;
    VtkData data;
    VtkCells cells[VTK_CELL_KINDS];
    size_t n_types;    /* number of types of the cells of kind CELLS */
    VtkArrays *arrays; /* receives attributes */
    size_t n;          /* number of values of an attribute */
} LegacyReader;

static Status read_count(LegacyReader *reader, const char *what, size_t *count, Err *err)
{
    char word[CURSOR_WORD];
    long long number;
    cursor_word(&reader->cursor, word);
    if (!integer_parse(word, 0, INT64_MAX / 64, &number))
        return err_set(err, STATUS_INPUT, "the number of %s is '%.40s'; it must be an integer",
                       what, word);
    *count = (size_t)number;
    return STATUS_OK;
}

/* Reads the type of an array. `numbers_only` as in vtk_find_type. */
static Status read_type(LegacyReader *reader, const char *numbers_only, VtkType *type, Err *err)
{
    char word[CURSOR_WORD];
    cursor_word(&reader->cursor, word);
    return vtk_find_type(NAMING_LEGACY, word, numbers_only, type, err);
}

/* Reads `n` numbers of a type into *out (owned). */
static Status read_numbers(LegacyReader *reader, VtkType type, const char *what, size_t n,
                           double **out, Err *err)
{
    Cursor *cursor = &reader->cursor;
    double *made = NULL;
    Status status = STATUS_OK;
    if (reader->is_binary)
        cursor_skip_line(cursor);
    size_t left = cursor_left(cursor), size = reader->is_binary ? vtk_type_size(type) : 2;
    if (n > (left + 1) / size)
        return err_set(err, STATUS_INPUT,
                       "%s announces %zu numbers, but only %zu bytes of the file are left", what, n,
                       left);
    TRY(mem_calloc(&made, n, sizeof *made, "numbers", err));
    if (!reader->is_binary)
        TRY_GOTO(cursor_numbers(cursor, what, n, made, err));
    if (reader->is_binary) {
        vtk_numbers(type, true, cursor->at, n, made);
        cursor->at += n * size;
    }
    *out = made;
    made = NULL;
done:
    free(made);
    return status;
}

/* ---- arrays ---------------------------------------------------------------------------------- */

/* Replaces "%41" and the like by the characters that they stand for, in place. */
static void decode(char *name)
{
    char *to = name;
    for (const char *from = name; *from; from++) {
        unsigned code;
        if (*from == '%' && sscanf(from + 1, "%2x", &code) == 1 && code > 0) {
            *to++ = (char)code;
            from += from[2] ? 2 : 1;
        } else {
            *to++ = *from;
        }
    }
    *to = '\0';
}

/* Reads the length of a binary string. The first two bits of the length state its number of bytes.
 */
static Status read_length(Cursor *cursor, size_t *length, Err *err)
{
    static const size_t sizes[] = {8, 4, 2, 1};
    size_t left = cursor_left(cursor);
    size_t size = left ? sizes[(unsigned char)*cursor->at >> 6] : 1;
    uint64_t made = 0;
    for (size_t k = 0; k < size && k < left; k++)
        made = made << 8 | ((unsigned char)cursor->at[k] & (k ? 0xff : 0x3f));
    if (left < size || made > left - size)
        return err_set(err, STATUS_INPUT, "the file ends within a string");
    cursor->at += size;
    *length = (size_t)made;
    return STATUS_OK;
}

/* Appends a line to the array's text. The line ends at its first zero byte. */
static Status add_text(VtkArray *array, const char *line, size_t length, Err *err)
{
    TRY(mem_reserve(&array->text, &array->capacity, array->text_size + length + 1, 1,
                    "bytes of text", err));
    char *to = array->text + array->text_size;
    memcpy(to, line, length);
    to[length] = '\0';
    decode(to);
    array->text_size += strlen(to) + 1;
    return STATUS_OK;
}

/* Reads n strings, in text one per line, in binary each after its length. */
static Status read_texts(LegacyReader *reader, VtkArray *array, size_t n, Err *err)
{
    Cursor *cursor = &reader->cursor;
    cursor_skip_line(cursor);
    for (size_t i = 0; i < n; i++) {
        size_t length = 0;
        if (cursor->at >= cursor->end)
            return err_set(err, STATUS_INPUT, "the file ends within a string");
        if (reader->is_binary)
            TRY(read_length(cursor, &length, err));
        else
            length = strcspn(cursor->at, "\r\n");
        TRY(add_text(array, cursor->at, length, err));
        cursor->at += length;
        if (!reader->is_binary)
            cursor_skip_line(cursor);
    }
    return STATUS_OK;
}

/* Reads an array of `components` x `n` values and adds it to reader->arrays. */
static Status read_array(LegacyReader *reader, char *name, VtkType type, size_t components,
                         size_t n, Err *err)
{
    VtkArray array = {.n = n, .components = components};
    Status status = STATUS_OK;
    /* Real arrays have at most some tens of components. The limit keeps n * components * 8 below
     * SIZE_MAX. */
    if (components == 0 || components > 1000 || n > SIZE_MAX / 1000 / sizeof(double))
        return err_set(err, STATUS_INPUT, "the array '%.40s' has %zu components, too many", name,
                       components);
    decode(name);
    TRY_GOTO(mem_strdup(&array.name, name, err));
    if (type == VTK_TEXT)
        TRY_GOTO(read_texts(reader, &array, n * components, err));
    else
        TRY_GOTO(read_numbers(reader, type, array.name, n * components, &array.value, err));
    return vtk_add_array(reader->arrays, &array, err);
done:
    vtk_release_array(&array);
    return status;
}

/* Skips the description of an array, which ends at an empty line. */
static void skip_metadata(Cursor *cursor)
{
    cursor_skip_line(cursor);
    while (cursor->at < cursor->end && !strchr("\r\n", *cursor->at))
        cursor_skip_line(cursor);
}

/* ---- blocks ---------------------------------------------------------------------------------- */

/* Reads "FIELD name n" and its arrays. */
static Status read_field(LegacyReader *reader, Err *err)
{
    Cursor *cursor = &reader->cursor;
    char word[CURSOR_WORD];
    size_t n_arrays = 0, components = 0, n = 0;
    VtkType type;
    cursor_word(cursor, word);
    TRY(read_count(reader, "arrays", &n_arrays, err));
    for (size_t i = 0; i < n_arrays; i++) {
        while (cursor_accept(cursor, "METADATA"))
            skip_metadata(cursor);
        if (!cursor_word(cursor, word))
            return err_set(err, STATUS_INPUT, "the file ends after %zu of %zu arrays", i, n_arrays);
        TRY(read_count(reader, "components", &components, err));
        TRY(read_count(reader, "values", &n, err));
        TRY(read_type(reader, NULL, &type, err));
        TRY(read_array(reader, word, type, components, n, err));
    }
    return STATUS_OK;
}

static Status read_scalars(LegacyReader *reader, Err *err)
{
    char name[CURSOR_WORD], word[CURSOR_WORD];
    VtkType type;
    long long components = 1;
    cursor_word(&reader->cursor, name);
    TRY(read_type(reader, NULL, &type, err));
    if (cursor_word_in_line(&reader->cursor, word) && !integer_parse(word, 1, 1000, &components))
        return err_set(err, STATUS_INPUT,
                       "the number of components is '%.40s'; it must be an integer", word);
    if (cursor_accept(&reader->cursor, "LOOKUP_TABLE"))
        cursor_word(&reader->cursor, word);
    return read_array(reader, name, type, (size_t)components, reader->n, err);
}

/* Skips "LOOKUP_TABLE name n" and its colors. */
static Status skip_table(LegacyReader *reader, Err *err)
{
    char word[CURSOR_WORD];
    size_t n = 0;
    double *colors = NULL;
    cursor_word(&reader->cursor, word);
    TRY(read_count(reader, "colors", &n, err));
    TRY(read_numbers(reader, VTK_UINT8, "LOOKUP_TABLE", 4 * n, &colors, err));
    free(colors);
    return STATUS_OK;
}

static Status read_points(LegacyReader *reader, Err *err)
{
    VtkType type;
    VtkData *data = &reader->data;
    if (data->point)
        return err_set(err, STATUS_INPUT, "there is a second section POINTS; only one is allowed");
    TRY(read_count(reader, "points", &data->n_points, err));
    TRY(read_type(reader, "POINTS", &type, err));
    return read_numbers(reader, type, "POINTS", 3 * data->n_points, &data->point, err);
}

static Status read_cell_types(LegacyReader *reader, Err *err)
{
    double **types = &reader->cells[VTK_CELL_KINDS - 1].type;
    if (*types)
        return err_set(err, STATUS_INPUT,
                       "there is a second section CELL_TYPES; only one is allowed");
    TRY(read_count(reader, "cells", &reader->n_types, err));
    return read_numbers(reader, VTK_INT32, "CELL_TYPES", reader->n_types, types, err);
}

static Status skip_description(LegacyReader *reader, Err *err)
{
    (void)err;
    skip_metadata(&reader->cursor);
    return STATUS_OK;
}

static const struct {
    const char *keyword;
    Status (*read)(LegacyReader *reader, Err *err);
} blocks[] = {
    {"POINTS", read_points},   {"CELL_TYPES", read_cell_types}, {"FIELD", read_field},
    {"SCALARS", read_scalars}, {"LOOKUP_TABLE", skip_table},    {"METADATA", skip_description},
};

/* Attributes "KEYWORD name [components] [type]". */
static const struct {
    const char *keyword;
    size_t components; /* 0: the file states them */
    bool is_color;     /* one byte each, or numbers if the file is text */
} attributes[] = {
    {"VECTORS", 3, false},      {"NORMALS", 3, false},
    {"TENSORS", 9, false},      {"TENSORS6", 6, false},
    {"GLOBAL_IDS", 1, false},   {"PEDIGREE_IDS", 1, false},
    {"EDGE_FLAGS", 1, false},   {"TEXTURE_COORDINATES", 0, false},
    {"COLOR_SCALARS", 0, true},
};

static Status read_attribute(LegacyReader *reader, size_t k, Err *err)
{
    char name[CURSOR_WORD];
    size_t components = attributes[k].components;
    VtkType type = VTK_UINT8;
    cursor_word(&reader->cursor, name);
    if (components == 0)
        TRY(read_count(reader, "components", &components, err));
    if (!attributes[k].is_color)
        TRY(read_type(reader, NULL, &type, err));
    return read_array(reader, name, type, components, reader->n, err);
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* Reads "OFFSETS type" and "CONNECTIVITY type", whose numbers were announced. */
static Status read_offset_cells(LegacyReader *reader, size_t n_offsets, VtkCells *cells, Err *err)
{
    VtkType type;
    TRY(read_type(reader, "OFFSETS", &type, err));
    TRY(read_numbers(reader, type, "OFFSETS", n_offsets, &cells->end, err));
    if (!cursor_accept(&reader->cursor, "CONNECTIVITY"))
        return err_set(err, STATUS_INPUT, "OFFSETS must be followed by CONNECTIVITY");
    TRY(read_type(reader, "CONNECTIVITY", &type, err));
    TRY(read_numbers(reader, type, "CONNECTIVITY", cells->n_corners, &cells->corner, err));
    cells->n = n_offsets > 0 ? n_offsets - 1 : 0;
    if (n_offsets > 0)
        memmove(cells->end, cells->end + 1, cells->n * sizeof *cells->end);
    return STATUS_OK;
}

/* Reads `n` cells, each a count and as many point indices; `size` is the count of all numbers.
 * Moves the point indices to the front of the array. */
static Status read_counted_cells(LegacyReader *reader, size_t n, size_t size, VtkCells *cells,
                                 Err *err)
{
    TRY(read_numbers(reader, VTK_INT32, "the cells", size, &cells->corner, err));
    if (n > size)
        return err_set(err, STATUS_INPUT, "%zu cells cannot be stored in %zu numbers", n, size);
    TRY(mem_calloc(&cells->end, n, sizeof *cells->end, "cells", err));
    size_t from = 0, to = 0;
    for (cells->n = 0; cells->n < n; cells->n++) {
        double count = from < size ? cells->corner[from] : -1;
        if (!(count >= 0 && count <= (double)(size - from - 1)) || count != floor(count))
            return err_set(
                err, STATUS_INPUT,
                "cell %zu states %g points, but all cells together have only %zu numbers", cells->n,
                count, size);
        memmove(cells->corner + to, cells->corner + from + 1, (size_t)count * sizeof(double));
        from += 1 + (size_t)count;
        to += (size_t)count;
        cells->end[cells->n] = (double)to;
    }
    cells->n_corners = to;
    return STATUS_OK;
}

static Status read_cells(LegacyReader *reader, VtkCells *cells, Err *err)
{
    size_t n = 0, size = 0;
    if (cells->n > 0 || cells->end)
        return err_set(err, STATUS_INPUT,
                       "there is a second section for cells of this kind; only one is allowed");
    TRY(read_count(reader, "cells", &n, err));
    TRY(read_count(reader, "numbers", &size, err));
    cells->n_corners = size;
    return cursor_accept(&reader->cursor, "OFFSETS")
               ? read_offset_cells(reader, n, cells, err)
               : read_counted_cells(reader, n, size, cells, err);
}

/* ---- the file -------------------------------------------------------------------------------- */

/* Reads what a keyword announces. */
static Status read_block(LegacyReader *reader, const char *keyword, Err *err)
{
    static const char *const data[] = {[GRAPH_POINTS] = "POINT_DATA", [GRAPH_LINES] = "CELL_DATA"};
    size_t of = keyword_find(keyword, data, 2);
    if (of < 2) {
        reader->arrays = &reader->data.arrays[of];
        return read_count(reader, "values", &reader->n, err);
    }
    for (size_t k = 0; k < VTK_CELL_KINDS; k++)
        if (strcasecmp(keyword, vtk_cell_kinds[k].legacy) == 0)
            return read_cells(reader, &reader->cells[k], err);
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++)
        if (strcasecmp(keyword, blocks[k].keyword) == 0)
            return blocks[k].read(reader, err);
    for (size_t k = 0; k < sizeof attributes / sizeof *attributes; k++)
        if (strcasecmp(keyword, attributes[k].keyword) == 0)
            return read_attribute(reader, k, err);
    return err_set(err, STATUS_INPUT, "'%.40s' is not a keyword of a VTK file of lines", keyword);
}

/* Reads the four lines before the first block. */
static Status read_head(LegacyReader *reader, Err *err)
{
    static const char *const codings[] = {"ASCII", "BINARY"}, *const sets[] = {"POLYDATA",
                                                                               "UNSTRUCTURED_GRID"};
    Cursor *cursor = &reader->cursor;
    char word[CURSOR_WORD];
    size_t length = strcspn(cursor->at, "\r\n");
    if (!vtk_detect(cursor->at))
        return err_set(
            err, STATUS_INPUT,
            "the file begins with '%.*s'; a legacy VTK file begins with '# vtk DataFile Version'",
            length < 40 ? (int)length : 40, cursor->at);
    cursor_skip_line(cursor);
    cursor_skip_line(cursor);
    cursor_word(cursor, word);
    size_t coding = keyword_find(word, codings, 2);
    if (coding == 2)
        return err_set(err, STATUS_INPUT, "the third line is '%.40s'; it must be ASCII or BINARY",
                       word);
    if (!cursor_accept(cursor, "DATASET"))
        return err_set(err, STATUS_INPUT, "there is no DATASET after '%.40s'", word);
    cursor_word(cursor, word);
    if (keyword_find(word, sets, 2) == 2)
        return err_set(err, STATUS_INPUT,
                       "the dataset is %.40s; it must be POLYDATA or UNSTRUCTURED_GRID", word);
    reader->is_binary = cursor->in_bytes = coding == 1;
    return STATUS_OK;
}

static Status read_all(LegacyReader *reader, Err *err)
{
    char keyword[CURSOR_WORD];
    reader->arrays = &reader->data.arrays[VTK_OF_FILE];
    TRY(read_head(reader, err));
    while (cursor_word(&reader->cursor, keyword))
        TRY(read_block(reader, keyword, err));
    if (reader->cursor.at < reader->cursor.end)
        return err_set(err, STATUS_INPUT, "a zero byte was found instead of a keyword");
    return STATUS_OK;
}

static Status add_all_cells(LegacyReader *reader, Err *err)
{
    const VtkCells *typed = &reader->cells[VTK_CELL_KINDS - 1];
    if (typed->n != reader->n_types)
        return err_set(err, STATUS_INPUT,
                       "there are %zu CELLS, but %zu CELL_TYPES; each cell needs one type",
                       typed->n, reader->n_types);
    for (size_t k = 0; k < VTK_CELL_KINDS; k++)
        TRY(vtk_add_cells(&reader->data, &reader->cells[k], &vtk_cell_kinds[k], 0, err));
    return STATUS_OK;
}

bool vtk_detect(const char *start)
{
    static const char head[] = "# vtk DataFile Version";
    return strncasecmp(start, head, sizeof head - 1) == 0;
}

Status vtk_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    LegacyReader reader = {.cursor = cursor_of(graph->name, &syntax, bytes, size)};
    Status status = STATUS_OK;
    TRY_GOTO(cursor_locate_error(&reader.cursor, read_all(&reader, err), err));
    status = add_all_cells(&reader, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", graph->name);
    TRY_GOTO(status);
    status = vtk_to_graph(&reader.data, graph, err);
done:
    for (size_t k = 0; k < VTK_CELL_KINDS; k++)
        vtk_release_cells(&reader.cells[k]);
    vtk_release(&reader.data);
    return status;
}
