/* A tree as VTK has it, legacy or XML: first a vertex for each root, then a polyline for each
 * branch. A polyline has points of its own, all with the values of its segments, its first point
 * with those of its first segment, so that a tube about it is as thick as the vessel from end to
 * end, where points shared with the parent would make it a cone. Points that are one node have one
 * `id`, by which the tree is found again [vtktree.c]; what is known of it are lines of text in the
 * field data. Which arrays there are is one table for both kinds of files; numbers go through one
 * buffer, whatever the tree's size. */
#include "treeio/branches.h"
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points are numbered so that those of a polyline follow each other. */
typedef struct Lines {
    const Tree *tree;
    Branches branches;
    int32_t *node;   /* of each point; owned */
    int32_t *values; /* the node whose values the point has; owned */
    size_t n_points, n_roots;
} Lines;

typedef enum Kind {
    RADIUS,
    ID,
    TYPE,
    SHARE,
    COLUMN,
    POSITION,
    VERTS,
    VERT_ENDS,
    LINES,
    LINE_ENDS,
    KINDS
} Kind;

/* An array of numbers that a file has. */
typedef struct Sheet {
    Kind kind;
    size_t column; /* of the tree, of COLUMN */
    size_t n;      /* numbers */
} Sheet;

/* Of each kind: section and name in XML, type, components. */
static const struct {
    const char *section, *name, *type;
    size_t components;
} kinds[KINDS] = {
    [RADIUS] = {"PointData", "radius", "Float64", 1},
    [ID] = {"PointData", "id", "Int32", 1},
    [TYPE] = {"PointData", "type", "Int32", 1},
    [SHARE] = {"PointData", "flow_share", "Float64", 1},
    [COLUMN] = {"PointData", NULL, "Float64", 1},
    [POSITION] = {"Points", "Points", "Float64", 3},
    [VERTS] = {"Verts", "connectivity", "Int32", 1},
    [VERT_ENDS] = {"Verts", "offsets", "Int32", 1},
    [LINES] = {"Lines", "connectivity", "Int32", 1},
    [LINE_ENDS] = {"Lines", "offsets", "Int32", 1},
};

static void release(Lines *lines)
{
    branches_release(&lines->branches);
    free(lines->node);
    free(lines->values);
}

static void add_point(Lines *lines, size_t node, size_t values)
{
    lines->node[lines->n_points] = (int32_t)node;
    lines->values[lines->n_points++] = (int32_t)values;
}

static Status make_lines(const Tree *tree, Lines *lines, Err *err)
{
    *lines = (Lines){.tree = tree};
    TRY(branches_find(tree, &lines->branches, err));
    const Branches *branches = &lines->branches;
    size_t most = tree->n + branches->n;
    TRY(mem_calloc(&lines->node, most, sizeof *lines->node, "points", err));
    TRY(mem_calloc(&lines->values, most, sizeof *lines->values, "points", err));
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            add_point(lines, i, i);
    lines->n_roots = lines->n_points;
    for (size_t k = 0, at = 0; k < branches->n; k++) {
        size_t first = (size_t)branches->node[at];
        add_point(lines, (size_t)tree->parent[first], first);
        for (; at < branches->end[k]; at++)
            add_point(lines, (size_t)branches->node[at], (size_t)branches->node[at]);
    }
    return STATUS_OK;
}

static bool has_types(const Tree *tree)
{
    for (size_t i = 0; i < tree->n; i++)
        if (tree->type[i] != TREE_VESSEL_TYPE)
            return true;
    return false;
}

/* Number `i` of an array. */
static double number_at(const Lines *lines, const Sheet *sheet, size_t i)
{
    const Tree *tree = lines->tree;
    switch (sheet->kind) {
    case RADIUS:
        return tree->radius_mm[lines->values[i]];
    case ID:
        return tree->id[lines->node[i]];
    case TYPE:
        return tree->type[lines->node[i]];
    case SHARE:
        return tree->flow_share[lines->node[i]];
    case COLUMN:
        return tree->column[sheet->column].value[lines->values[i]];
    case POSITION:
        return vec3_component(tree->position[lines->node[i / 3]], (int)(i % 3));
    case LINES:
        return (double)(lines->n_roots + i);
    case LINE_ENDS:
        return (double)(lines->branches.end[i] + i + 1);
    case VERT_ENDS:
        return (double)i + 1;
    default:
        return (double)i;
    }
}

/* The array's name, for a column "NAME [UNIT]". */
static void put_name(const Lines *lines, const Sheet *sheet, Text *text)
{
    text_clear(text);
    if (sheet->kind != COLUMN)
        text_puts(text, kinds[sheet->kind].name);
    else
        vtk_put_column_name(&lines->tree->column[sheet->column], text);
}

static void write_numbers(const Lines *lines, const Sheet *sheet, bool is_big_endian, FILE *stream)
{
    enum { PIECE = 2048 };
    const VtkType *type = vtk_type_of_xml(kinds[sheet->kind].type);
    double numbers[PIECE];
    char bytes[PIECE * sizeof *numbers];
    for (size_t done = 0, n; done < sheet->n; done += n) {
        n = sheet->n - done < PIECE ? sheet->n - done : PIECE;
        for (size_t i = 0; i < n; i++)
            numbers[i] = number_at(lines, sheet, done + i);
        vtk_bytes(type, is_big_endian, numbers, n, bytes);
        fwrite(bytes, type->size, n, stream);
    }
}

/* ---- sheets ---------------------------------------------------------------------------------- */

typedef struct Sheets {
    Sheet *sheet; /* owned */
    size_t n, capacity;
} Sheets;

static Status add_sheet(Sheets *sheets, Kind kind, size_t column, size_t n, Err *err)
{
    TRY(mem_reserve(&sheets->sheet, &sheets->capacity, sheets->n + 1, sizeof *sheets->sheet,
                    "arrays", err));
    sheets->sheet[sheets->n++] = (Sheet){kind, column, n};
    return STATUS_OK;
}

/* The arrays of points, in the order of the file. */
static Status list_values(const Lines *lines, Sheets *sheets, Err *err)
{
    const Tree *tree = lines->tree;
    TRY(add_sheet(sheets, RADIUS, 0, lines->n_points, err));
    for (size_t k = 0; k < tree->n_columns; k++)
        TRY(add_sheet(sheets, COLUMN, k, lines->n_points, err));
    TRY(add_sheet(sheets, ID, 0, lines->n_points, err));
    if (has_types(tree))
        TRY(add_sheet(sheets, TYPE, 0, lines->n_points, err));
    if (tree->flow_share)
        TRY(add_sheet(sheets, SHARE, 0, lines->n_points, err));
    return STATUS_OK;
}

/* ---- XML ------------------------------------------------------------------------------------- */

static Status list_all(const Lines *lines, Sheets *sheets, Err *err)
{
    TRY(list_values(lines, sheets, err));
    TRY(add_sheet(sheets, POSITION, 0, 3 * lines->n_points, err));
    TRY(add_sheet(sheets, VERTS, 0, lines->n_roots, err));
    TRY(add_sheet(sheets, VERT_ENDS, 0, lines->n_roots, err));
    TRY(add_sheet(sheets, LINES, 0, lines->n_points - lines->n_roots, err));
    return add_sheet(sheets, LINE_ENDS, 0, lines->branches.n, err);
}

/* What is known of the tree, as the numbers of its letters, a 0 behind each line. */
static void put_remarks(const TreeMeta *meta, Text *text)
{
    Text line = TEXT_INIT;
    size_t n = 0;
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);)
        n++;
    text_printf(text,
                "    <FieldData>\n      <DataArray type=\"String\" Name=\"" VTK_KNOWN "\" "
                "NumberOfTuples=\"%zu\" format=\"ascii\">\n",
                n);
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);) {
        const char *chars = text_chars(&line);
        for (const char *at = chars ? chars : ""; *at; at++)
            text_printf(text, "%d ", (unsigned char)*at);
        text_puts(text, chars ? "0\n" : NULL);
    }
    text_puts(text, "      </DataArray>\n    </FieldData>\n");
    text_release(&line);
}

static size_t bytes_of(const Sheet *sheet)
{
    return sheet->n * vtk_type_of_xml(kinds[sheet->kind].type)->size;
}

static void put_sheets(const Lines *lines, const Sheets *sheets, Text *text)
{
    Text name = TEXT_INIT;
    const char *section = NULL;
    size_t offset = 0;
    for (size_t i = 0; i < sheets->n; i++) {
        const Sheet *sheet = &sheets->sheet[i];
        const char *own = kinds[sheet->kind].section;
        if (section && section != own)
            text_printf(text, "      </%s>\n", section);
        if (section != own)
            text_printf(text, i == 0 ? "      <%s Scalars=\"radius\">\n" : "      <%s>\n", own);
        section = own;
        put_name(lines, sheet, &name);
        text_printf(text, "        <DataArray type=\"%s\" Name=\"", kinds[sheet->kind].type);
        text_escaped(text, text_chars(&name));
        text_printf(text, "\" NumberOfComponents=\"%zu\" format=\"appended\" offset=\"%zu\"/>\n",
                    kinds[sheet->kind].components, offset);
        offset += sizeof(uint64_t) + bytes_of(sheet);
    }
    text_printf(text, "      </%s>\n", section);
    text_release(&name);
}

/* All that stands before the bytes. */
static Status write_document(const Lines *lines, const Sheets *sheets, FILE *stream, Err *err)
{
    Text text = TEXT_TO(stream);
    text_puts(&text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
                     "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PolyData>\n");
    put_remarks(&lines->tree->meta, &text);
    text_printf(&text,
                "    <Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"%zu\" "
                "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
                lines->n_points, lines->n_roots, lines->branches.n);
    put_sheets(lines, sheets, &text);
    text_puts(&text, "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
    Status status = text_flush(&text, err);
    text_release(&text);
    return status;
}

static Status write_xml(const Lines *lines, const Sheets *sheets, FILE *stream, Err *err)
{
    TRY(write_document(lines, sheets, stream, err));
    for (size_t i = 0; i < sheets->n; i++) {
        const double size = (double)bytes_of(&sheets->sheet[i]);
        char header[sizeof(uint64_t)];
        vtk_bytes(vtk_type_of_xml("UInt64"), false, &size, 1, header);
        fwrite(header, 1, sizeof header, stream);
        write_numbers(lines, &sheets->sheet[i], false, stream);
    }
    fputs("\n  </AppendedData>\n</VTKFile>\n", stream);
    return STATUS_OK;
}

Status vtp_write(const Tree *tree, FILE *stream, Err *err)
{
    Lines lines;
    Sheets sheets = {0};
    Status status = make_lines(tree, &lines, err);
    if (status == STATUS_OK)
        status = list_all(&lines, &sheets, err);
    if (status == STATUS_OK)
        status = write_xml(&lines, &sheets, stream, err);
    free(sheets.sheet);
    release(&lines);
    return status;
}

/* ---- legacy ---------------------------------------------------------------------------------- */

/* A name without blanks, as legacy files have it. */
static void put_encoded(const char *name, Text *text)
{
    for (; name && *name; name++) {
        unsigned char letter = (unsigned char)*name;
        if (letter <= ' ' || letter == '%' || letter == '"' || letter >= 0x7f)
            text_printf(text, "%%%02X", letter);
        else
            text_append(text, name, 1);
    }
}

/* A binary string: two bits say in how many bytes its length stands. */
static void put_string(const char *chars, Text *text)
{
    size_t length = strlen(chars), bytes = length < 0x40 ? 1 : length < 0x4000 ? 2 : 4;
    static const unsigned marks[] = {[1] = 0xc0, [2] = 0x80, [4] = 0x40};
    for (size_t k = bytes; k-- > 0;) {
        char byte = (char)((length >> 8 * k & 0xff) | (k + 1 == bytes ? marks[bytes] : 0));
        text_append(text, &byte, 1);
    }
    text_append(text, chars, length);
}

static void put_legacy_remarks(const TreeMeta *meta, Text *text)
{
    Text line = TEXT_INIT;
    size_t n = 0;
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);)
        n++;
    text_printf(text, "FIELD FieldData 1\n" VTK_KNOWN " 1 %zu string\n", n);
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);) {
        const char *chars = text_chars(&line);
        if (chars)
            put_string(chars, text);
        else
            text_puts(text, NULL);
    }
    text_puts(text, "\n");
    text_release(&line);
}

/* A cell a row: how many points, and their numbers. */
static void write_cells(const Lines *lines, FILE *stream)
{
    const Branches *branches = &lines->branches;
    const VtkType *type = vtk_type_of_xml("Int32");
    size_t point = 0, n_segments = lines->n_points - lines->n_roots;
    char bytes[8];
    fprintf(stream, "VERTICES %zu %zu\n", lines->n_roots, 2 * lines->n_roots);
    for (; point < lines->n_roots; point++) {
        vtk_bytes(type, true, (const double[]){1, (double)point}, 2, bytes);
        fwrite(bytes, 1, sizeof bytes, stream);
    }
    if (branches->n > 0)
        fprintf(stream, "\nLINES %zu %zu\n", branches->n, branches->n + n_segments);
    for (size_t k = 0, at = 0; k < branches->n; at = branches->end[k++]) {
        size_t n = branches->end[k] - at + 1;
        vtk_bytes(type, true, &(const double){(double)n}, 1, bytes);
        fwrite(bytes, 1, 4, stream);
        for (size_t i = 0; i < n; i++, point++) {
            vtk_bytes(type, true, &(const double){(double)point}, 1, bytes);
            fwrite(bytes, 1, 4, stream);
        }
    }
}

static Status write_head(const Lines *lines, FILE *stream, Err *err)
{
    Text text = TEXT_TO(stream);
    text_puts(&text, "# vtk DataFile Version 3.0\narterial tree, mm\nBINARY\nDATASET POLYDATA\n");
    put_legacy_remarks(&lines->tree->meta, &text);
    text_printf(&text, "POINTS %zu double\n", lines->n_points);
    Status status = text_flush(&text, err);
    text_release(&text);
    return status;
}

static Status write_sheet(const Lines *lines, const Sheet *sheet, FILE *stream, Err *err)
{
    Text text = TEXT_TO(stream), name = TEXT_INIT;
    bool is_float = vtk_type_of_xml(kinds[sheet->kind].type)->is_float;
    put_name(lines, sheet, &name);
    put_encoded(text_chars(&name), &text);
    text_printf(&text, " 1 %zu %s\n", sheet->n, is_float ? "double" : "int");
    Status status = text_flush(&text, err);
    if (status == STATUS_OK)
        status = text_check(&name, err);
    text_release(&text);
    text_release(&name);
    write_numbers(lines, sheet, true, stream);
    putc('\n', stream);
    return status;
}

static Status write_legacy(const Lines *lines, const Sheets *sheets, FILE *stream, Err *err)
{
    const Sheet points = {.kind = POSITION, .n = 3 * lines->n_points};
    TRY(write_head(lines, stream, err));
    write_numbers(lines, &points, true, stream);
    putc('\n', stream);
    write_cells(lines, stream);
    fprintf(stream, "\nPOINT_DATA %zu\nFIELD FieldData %zu\n", lines->n_points, sheets->n);
    for (size_t i = 0; i < sheets->n; i++)
        TRY(write_sheet(lines, &sheets->sheet[i], stream, err));
    return STATUS_OK;
}

Status vtk_write(const Tree *tree, FILE *stream, Err *err)
{
    Lines lines;
    Sheets sheets = {0};
    Status status = make_lines(tree, &lines, err);
    if (status == STATUS_OK)
        status = list_values(&lines, &sheets, err);
    if (status == STATUS_OK)
        status = write_legacy(&lines, &sheets, stream, err);
    free(sheets.sheet);
    release(&lines);
    return status;
}
