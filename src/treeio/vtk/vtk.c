/* Legacy VTK: keywords as text, and behind each the numbers that it announces, as text or as
 * big-endian bytes. Both are read through one cursor; what is announced is checked against the
 * bytes that are left before any room is made for it. Polylines come as counts and points one
 * behind the other (before version 5) or as two arrays, OFFSETS and CONNECTIVITY. */
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WORD = 256 };

typedef struct Cursor {
    const char *name;
    char *start, *at, *end;
    bool is_binary;
} Cursor;

static const char blanks[] = " \t\r\n";

/* Puts file and place in front of the sentence of a STATUS_INPUT. */
static Status blame(const Cursor *cursor, Status status, Err *err)
{
    size_t line = 1;
    if (status != STATUS_INPUT)
        return status;
    if (cursor->is_binary) {
        err_prefix(err, "%s: byte %zu: ", cursor->name, (size_t)(cursor->at - cursor->start));
        return status;
    }
    for (const char *at = cursor->start; at < cursor->at; at++)
        line += *at == '\n';
    err_prefix(err, "%s:%zu: ", cursor->name, line);
    return status;
}

static void skip_blanks(Cursor *cursor)
{
    while (cursor->at < cursor->end && *cursor->at && strchr(blanks, *cursor->at))
        cursor->at++;
}

static size_t word_length(const Cursor *cursor)
{
    size_t length = 0;
    while (cursor->at + length < cursor->end && cursor->at[length] &&
           !strchr(blanks, cursor->at[length]))
        length++;
    return length;
}

/* The next word, cut to its room; "" behind the last. */
static void next_word(Cursor *cursor, char word[WORD])
{
    skip_blanks(cursor);
    size_t length = word_length(cursor), kept = length < WORD ? length : WORD - 1;
    memcpy(word, cursor->at, kept);
    word[kept] = '\0';
    cursor->at += length;
}

/* Likewise, but only up to the end of the line. */
static void next_in_line(Cursor *cursor, char word[WORD])
{
    while (cursor->at < cursor->end && (*cursor->at == ' ' || *cursor->at == '\t'))
        cursor->at++;
    size_t length = word_length(cursor), kept = length < WORD ? length : WORD - 1;
    memcpy(word, cursor->at, kept);
    word[kept] = '\0';
    cursor->at += length;
}

static void skip_line(Cursor *cursor)
{
    while (cursor->at < cursor->end && *cursor->at != '\n')
        cursor->at++;
    if (cursor->at < cursor->end)
        cursor->at++;
}

/* Moves past the word if it is the next one, and says whether it is. */
static bool take_word(Cursor *cursor, const char *word)
{
    Cursor ahead = *cursor;
    char next[WORD];
    next_word(&ahead, next);
    if (strcasecmp(next, word) != 0)
        return false;
    *cursor = ahead;
    return true;
}

static Status read_count(Cursor *cursor, const char *what, size_t *count, Err *err)
{
    char word[WORD];
    long long number;
    next_word(cursor, word);
    if (!integer_parse(word, 0, INT64_MAX / 64, &number))
        return err_set(err, STATUS_INPUT, "the number of %s is '%.40s'; it must be a whole number",
                       what, word);
    *count = (size_t)number;
    return STATUS_OK;
}

/* Reads the type of an array: that of its numbers, or NULL for an array of strings. */
static Status read_type(Cursor *cursor, const VtkType **type, Err *err)
{
    char word[WORD];
    next_word(cursor, word);
    *type = vtk_type_of_legacy(word, strlen(word));
    if (*type || strcasecmp(word, "string") == 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "'%.40s' is no type of numbers", word);
}

/* Reads a type that must be one of numbers: `what` cannot be strings. */
static Status read_number_type(Cursor *cursor, const char *what, const VtkType **type, Err *err)
{
    TRY(read_type(cursor, type, err));
    return *type ? STATUS_OK : err_set(err, STATUS_INPUT, "%s cannot be strings", what);
}

/* ---- numbers --------------------------------------------------------------------------------- */

/* STATUS_INPUT when there are too few bytes left for `n` numbers. */
static Status check_room(const Cursor *cursor, const VtkType *type, const char *what, size_t n,
                         Err *err)
{
    size_t left = (size_t)(cursor->end - cursor->at), size = cursor->is_binary ? type->size : 2;
    if (n <= (left + 1) / size)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s announces %zu numbers, and the file goes on for %zu bytes", what, n, left);
}

static Status read_text_numbers(Cursor *cursor, const char *what, size_t n, double *out, Err *err)
{
    for (size_t i = 0; i < n; i++) {
        skip_blanks(cursor);
        char *end = cursor->at + word_length(cursor), after = *end;
        *end = '\0';
        bool is_number = number_parse(cursor->at, &out[i]);
        Status status =
            is_number     ? STATUS_OK
            : *cursor->at ? err_set(err, STATUS_INPUT, "'%.40s' of %s is no number%s", cursor->at,
                                    what, decimal_comma_hint(cursor->at))
                          : err_set(err, STATUS_INPUT,
                                    "the file ends after %zu of the %zu numbers of %s", i, n, what);
        *end = after;
        TRY(status);
        cursor->at = end;
    }
    return STATUS_OK;
}

/* Reads n numbers to *out (owned). */
static Status read_numbers(Cursor *cursor, const VtkType *type, const char *what, size_t n,
                           double **out, Err *err)
{
    double *made = NULL;
    if (cursor->is_binary)
        skip_line(cursor);
    TRY(check_room(cursor, type, what, n, err));
    TRY(mem_calloc(&made, n, sizeof *made, "numbers", err));
    Status status = STATUS_OK;
    if (cursor->is_binary) {
        vtk_numbers(type, true, cursor->at, n, made);
        cursor->at += n * type->size;
    } else {
        status = read_text_numbers(cursor, what, n, made, err);
    }
    if (status == STATUS_OK)
        *out = made;
    else
        free(made);
    return status;
}

/* ---- arrays ---------------------------------------------------------------------------------- */

/* Puts the characters that "%41" and the like stand for there, in place. */
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

/* The length of the next binary string: two bits say in how many bytes it stands. */
static Status read_length(Cursor *cursor, size_t *length, Err *err)
{
    static const size_t sizes[] = {8, 4, 2, 1};
    size_t left = (size_t)(cursor->end - cursor->at);
    size_t size = left ? sizes[(unsigned char)*cursor->at >> 6] : 1;
    uint64_t made = 0;
    if (left < size)
        return err_set(err, STATUS_INPUT, "the file ends within a text");
    for (size_t k = 0; k < size; k++)
        made = made << 8 | ((unsigned char)cursor->at[k] & (k ? 0xff : 0x3f));
    cursor->at += size;
    if (made > left - size)
        return err_set(err, STATUS_INPUT, "the file ends within a text");
    *length = (size_t)made;
    return STATUS_OK;
}

/* Appends a line to the array's text, without zero bytes of its own. */
static Status add_text(VtkArray *array, size_t *capacity, const char *line, size_t length, Err *err)
{
    TRY(mem_reserve(&array->text, capacity, array->text_size + length + 1, 1, "bytes of text",
                    err));
    memcpy(array->text + array->text_size, line, length);
    array->text[array->text_size + length] = '\0';
    decode(array->text + array->text_size);
    array->text_size += strlen(array->text + array->text_size) + 1;
    return STATUS_OK;
}

static Status read_texts(Cursor *cursor, VtkArray *array, size_t n, Err *err)
{
    size_t capacity = 0;
    skip_line(cursor);
    for (size_t i = 0; i < n; i++) {
        size_t length = 0;
        if (cursor->at >= cursor->end)
            return err_set(err, STATUS_INPUT, "the file ends within a text");
        if (cursor->is_binary) {
            TRY(read_length(cursor, &length, err));
            TRY(add_text(array, &capacity, cursor->at, length, err));
            cursor->at += length;
        } else {
            length = strcspn(cursor->at, "\r\n");
            TRY(add_text(array, &capacity, cursor->at, length, err));
            skip_line(cursor);
        }
    }
    return STATUS_OK;
}

/* Reads an array of `components` x `n` values to `arrays`; `word` is its name, `type` NULL of
 * text. */
static Status read_array(Cursor *cursor, VtkArrays *arrays, char *name, const VtkType *type,
                         size_t components, size_t n, Err *err)
{
    VtkArray array = {.n = n, .components = components};
    if (components == 0 || components > 1000 || n > SIZE_MAX / 1000 / sizeof(double))
        return err_set(err, STATUS_INPUT, "the array '%.40s' has %zu components", name, components);
    decode(name);
    Status status = mem_strdup(&array.name, name, err);
    if (status == STATUS_OK)
        status = type ? read_numbers(cursor, type, array.name, n * components, &array.value, err)
                      : read_texts(cursor, &array, n * components, err);
    if (status == STATUS_OK)
        return vtk_add_array(arrays, &array, err);
    vtk_release_array(&array);
    return status;
}

/* Passes over what is said of an array behind it, up to an empty line. */
static void skip_metadata(Cursor *cursor)
{
    skip_line(cursor);
    while (cursor->at < cursor->end && !strchr("\r\n", *cursor->at))
        skip_line(cursor);
}

static Status read_field(Cursor *cursor, VtkArrays *arrays, Err *err)
{
    char word[WORD];
    size_t n_arrays = 0, components = 0, n = 0;
    const VtkType *type;
    next_word(cursor, word);
    TRY(read_count(cursor, "arrays", &n_arrays, err));
    for (size_t i = 0; i < n_arrays; i++) {
        while (take_word(cursor, "METADATA"))
            skip_metadata(cursor);
        next_word(cursor, word);
        if (!*word)
            return err_set(err, STATUS_INPUT, "the file ends after %zu of %zu arrays", i, n_arrays);
        TRY(read_count(cursor, "components", &components, err));
        TRY(read_count(cursor, "values", &n, err));
        TRY(read_type(cursor, &type, err));
        TRY(read_array(cursor, arrays, word, type, components, n, err));
    }
    return STATUS_OK;
}

static Status read_scalars(Cursor *cursor, VtkArrays *arrays, size_t n, Err *err)
{
    char name[WORD], word[WORD];
    const VtkType *type;
    long long components = 1;
    next_word(cursor, name);
    TRY(read_type(cursor, &type, err));
    next_in_line(cursor, word);
    if (*word && !integer_parse(word, 1, 1000, &components))
        return err_set(err, STATUS_INPUT, "the number of components is '%.40s'", word);
    if (take_word(cursor, "LOOKUP_TABLE"))
        next_word(cursor, word);
    return read_array(cursor, arrays, name, type, (size_t)components, n, err);
}

/* Attributes "NAME name [components] [type]" and their components; 0: the file says how many. */
static const struct Attribute {
    const char *keyword;
    size_t components;
    bool is_color; /* one byte each, or numbers where the file is text */
} attributes[] = {
    {"VECTORS", 3, false},      {"NORMALS", 3, false},
    {"TENSORS", 9, false},      {"TENSORS6", 6, false},
    {"GLOBAL_IDS", 1, false},   {"PEDIGREE_IDS", 1, false},
    {"EDGE_FLAGS", 1, false},   {"TEXTURE_COORDINATES", 0, false},
    {"COLOR_SCALARS", 0, true},
};

static Status read_attribute(Cursor *cursor, const struct Attribute *attribute, VtkArrays *arrays,
                             size_t n, Err *err)
{
    char name[WORD];
    size_t components = attribute->components;
    const VtkType *type = vtk_type_of_legacy("unsigned_char", 13);
    next_word(cursor, name);
    if (components == 0)
        TRY(read_count(cursor, "components", &components, err));
    if (!attribute->is_color)
        TRY(read_type(cursor, &type, err));
    return read_array(cursor, arrays, name, type, components, n, err);
}

/* "LOOKUP_TABLE name n": colours, which nothing here needs. */
static Status skip_table(Cursor *cursor, Err *err)
{
    char word[WORD];
    size_t n = 0;
    double *colors = NULL;
    next_word(cursor, word);
    TRY(read_count(cursor, "colours", &n, err));
    TRY(read_numbers(cursor, vtk_type_of_legacy("unsigned_char", 13), "LOOKUP_TABLE", 4 * n,
                     &colors, err));
    free(colors);
    return STATUS_OK;
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* "OFFSETS type" and "CONNECTIVITY type", whose numbers have been counted. */
static Status read_offset_cells(Cursor *cursor, size_t n_offsets, size_t n_corners, VtkCells *cells,
                                Err *err)
{
    const VtkType *type;
    TRY(read_number_type(cursor, "OFFSETS", &type, err));
    TRY(read_numbers(cursor, type, "OFFSETS", n_offsets, &cells->end, err));
    if (!take_word(cursor, "CONNECTIVITY"))
        return err_set(err, STATUS_INPUT, "OFFSETS must be followed by CONNECTIVITY");
    TRY(read_number_type(cursor, "CONNECTIVITY", &type, err));
    TRY(read_numbers(cursor, type, "CONNECTIVITY", n_corners, &cells->corner, err));
    cells->n = n_offsets > 0 ? n_offsets - 1 : 0;
    cells->n_corners = n_corners;
    if (n_offsets > 0)
        memmove(cells->end, cells->end + 1, cells->n * sizeof *cells->end);
    return STATUS_OK;
}

/* Counts and points one behind the other, `size` numbers. */
static Status read_counted_cells(Cursor *cursor, size_t n, size_t size, VtkCells *cells, Err *err)
{
    TRY(read_numbers(cursor, vtk_type_of_legacy("int", 3), "the cells", size, &cells->corner, err));
    if (n > size)
        return err_set(err, STATUS_INPUT, "%zu cells cannot stand in %zu numbers", n, size);
    TRY(mem_calloc(&cells->end, n, sizeof *cells->end, "cells", err));
    size_t from = 0, to = 0;
    for (cells->n = 0; cells->n < n; cells->n++) {
        double count = from < size ? cells->corner[from] : -1;
        if (!(count >= 0 && count <= (double)(size - from - 1)) || count != floor(count))
            return err_set(err, STATUS_INPUT,
                           "cell %zu has %g points, which %zu numbers cannot hold", cells->n, count,
                           size);
        memmove(cells->corner + to, cells->corner + from + 1, (size_t)count * sizeof(double));
        from += 1 + (size_t)count;
        to += (size_t)count;
        cells->end[cells->n] = (double)to;
    }
    cells->n_corners = to;
    return STATUS_OK;
}

static Status read_cells(Cursor *cursor, VtkCells *cells, Err *err)
{
    size_t n = 0, size = 0;
    if (cells->n > 0)
        return err_set(err, STATUS_INPUT, "cells of one kind are given twice");
    TRY(read_count(cursor, "cells", &n, err));
    TRY(read_count(cursor, "numbers", &size, err));
    if (take_word(cursor, "OFFSETS"))
        return read_offset_cells(cursor, n, size, cells, err);
    return read_counted_cells(cursor, n, size, cells, err);
}

/* ---- the file -------------------------------------------------------------------------------- */

typedef enum CellKind { VERTICES, LINES, POLYGONS, STRIPS, ANY_CELLS, CELL_KINDS } CellKind;

static const struct {
    const char *keyword;
    int type; /* 0: one that is no line */
} cell_kinds[CELL_KINDS] = {
    [VERTICES] = {"VERTICES", VTK_POLY_VERTEX},
    [LINES] = {"LINES", VTK_POLY_LINE},
    [POLYGONS] = {"POLYGONS", 0},
    [STRIPS] = {"TRIANGLE_STRIPS", 0},
    [ANY_CELLS] = {"CELLS", 0},
};

typedef struct Reader {
    Cursor cursor;
    VtkData data;
    VtkCells cells[CELL_KINDS];
    size_t n_types;    /* of ANY_CELLS */
    VtkArrays *arrays; /* that attributes go to */
    size_t n;          /* values of an attribute */
} Reader;

static void release(Reader *reader)
{
    for (int kind = 0; kind < CELL_KINDS; kind++)
        vtk_release_cells(&reader->cells[kind]);
    vtk_release(&reader->data);
}

static Status read_points(Reader *reader, Err *err)
{
    const VtkType *type;
    size_t n = 0;
    TRY(read_count(&reader->cursor, "points", &n, err));
    TRY(read_number_type(&reader->cursor, "POINTS", &type, err));
    if (reader->data.point)
        return err_set(err, STATUS_INPUT, "POINTS are given twice");
    TRY(read_numbers(&reader->cursor, type, "POINTS", 3 * n, &reader->data.point, err));
    reader->data.n_points = n;
    return STATUS_OK;
}

static Status read_cell_types(Reader *reader, Err *err)
{
    TRY(read_count(&reader->cursor, "cells", &reader->n_types, err));
    if (reader->cells[ANY_CELLS].type)
        return err_set(err, STATUS_INPUT, "CELL_TYPES are given twice");
    return read_numbers(&reader->cursor, vtk_type_of_legacy("int", 3), "CELL_TYPES",
                        reader->n_types, &reader->cells[ANY_CELLS].type, err);
}

/* Values of points or of cells follow. */
static Status begin_attributes(Reader *reader, VtkArrays *arrays, Err *err)
{
    reader->arrays = arrays;
    return read_count(&reader->cursor, "values", &reader->n, err);
}

static Status read_block(Reader *reader, const char *keyword, Err *err)
{
    Cursor *cursor = &reader->cursor;
    for (int kind = 0; kind < CELL_KINDS; kind++)
        if (strcasecmp(keyword, cell_kinds[kind].keyword) == 0)
            return read_cells(cursor, &reader->cells[kind], err);
    if (strcasecmp(keyword, "POINTS") == 0)
        return read_points(reader, err);
    if (strcasecmp(keyword, "CELL_TYPES") == 0)
        return read_cell_types(reader, err);
    if (strcasecmp(keyword, "POINT_DATA") == 0)
        return begin_attributes(reader, &reader->data.of_points, err);
    if (strcasecmp(keyword, "CELL_DATA") == 0)
        return begin_attributes(reader, &reader->data.of_cells, err);
    if (strcasecmp(keyword, "FIELD") == 0)
        return read_field(cursor, reader->arrays, err);
    if (strcasecmp(keyword, "SCALARS") == 0)
        return read_scalars(cursor, reader->arrays, reader->n, err);
    if (strcasecmp(keyword, "LOOKUP_TABLE") == 0)
        return skip_table(cursor, err);
    for (size_t i = 0; i < sizeof attributes / sizeof *attributes; i++)
        if (strcasecmp(keyword, attributes[i].keyword) == 0)
            return read_attribute(cursor, &attributes[i], reader->arrays, reader->n, err);
    return err_set(err, STATUS_INPUT, "'%.40s' is no keyword of a VTK file of lines", keyword);
}

/* The four lines before the first block. */
static Status read_head(Reader *reader, Err *err)
{
    Cursor *cursor = &reader->cursor;
    char word[WORD];
    if (!vtk_detect(cursor->at))
        return err_set(err, STATUS_INPUT,
                       "a legacy VTK file begins with '# vtk DataFile Version', this one with "
                       "'%.*s'",
                       (int)strcspn(cursor->at, "\r\n") < 40 ? (int)strcspn(cursor->at, "\r\n")
                                                             : 40,
                       cursor->at);
    skip_line(cursor);
    skip_line(cursor);
    next_word(cursor, word);
    bool is_binary = strcasecmp(word, "BINARY") == 0;
    if (!is_binary && strcasecmp(word, "ASCII") != 0)
        return err_set(err, STATUS_INPUT, "the third line is '%.40s'; it must be ASCII or BINARY",
                       word);
    if (!take_word(cursor, "DATASET"))
        return err_set(err, STATUS_INPUT, "there is no DATASET after '%.40s'", word);
    next_word(cursor, word);
    if (strcasecmp(word, "POLYDATA") != 0 && strcasecmp(word, "UNSTRUCTURED_GRID") != 0)
        return err_set(err, STATUS_INPUT,
                       "the dataset is %.40s; lines are in POLYDATA and UNSTRUCTURED_GRID", word);
    cursor->is_binary = is_binary;
    return STATUS_OK;
}

static Status read_all(Reader *reader, Err *err)
{
    char keyword[WORD];
    reader->arrays = &reader->data.of_file;
    TRY(read_head(reader, err));
    for (;;) {
        next_word(&reader->cursor, keyword);
        if (!*keyword)
            break;
        if (strcasecmp(keyword, "METADATA") == 0)
            skip_metadata(&reader->cursor);
        else
            TRY(read_block(reader, keyword, err));
    }
    if (reader->cursor.at < reader->cursor.end)
        return err_set(err, STATUS_INPUT, "a zero byte where a keyword should be");
    return STATUS_OK;
}

/* In the order in which cells have their values. */
static Status add_all_cells(Reader *reader, Err *err)
{
    if (reader->cells[ANY_CELLS].n != reader->n_types)
        return err_set(err, STATUS_INPUT, "there are %zu CELLS and %zu CELL_TYPES",
                       reader->cells[ANY_CELLS].n, reader->n_types);
    for (int kind = 0; kind < CELL_KINDS; kind++) {
        reader->cells[kind].of = cell_kinds[kind].type;
        TRY(vtk_add_cells(&reader->data, &reader->cells[kind], 0, err));
    }
    return STATUS_OK;
}

bool vtk_detect(const char *start)
{
    static const char head[] = "# vtk DataFile Version";
    return strncasecmp(start, head, sizeof head - 1) == 0;
}

Status vtk_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    Reader reader = {.cursor = {graph->name, bytes, bytes, bytes + size, false}};
    Status status = blame(&reader.cursor, read_all(&reader, err), err);
    if (status == STATUS_OK) {
        status = add_all_cells(&reader, err);
        if (status == STATUS_INPUT)
            err_prefix(err, "%s: ", graph->name);
    }
    if (status == STATUS_OK)
        status = vtk_to_graph(&reader.data, graph, err);
    release(&reader);
    return status;
}
