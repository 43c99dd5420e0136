/* Writes a tree as legacy VTK or as VTK's XML: a vertex for each root, then a polyline for each
 * branch.
 *
 * Each polyline has its own points, with the values of its segments. Its first point has the values
 * of its first segment, so that a tube around the polyline is as thick as the vessel from end to
 * end. If the first point were shared with the parent, viewers would draw a cone.
 *
 * All points of one node have the same `id`, by which vtktree.c restores the tree. The last point
 * of a branch that closes a loop has the `id` of the node that the link names, and the id of the
 * node with the link as `link_id`. The tree's metadata are lines of text in the field data.
 *
 * Both formats have the arrays of one table. Numbers pass through a small buffer, so that a tree of
 * any size needs no copy of its arrays. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Kinds of arrays, in the order of the XML file. */
typedef enum WrittenArrayKind {
    RADIUS,
    COLUMN,
    ID,
    TYPE,
    SHARE,
    LINK,
    POSITION,
    VERTS,
    VERT_ENDS,
    LINES,
    LINE_ENDS,
    KINDS
} WrittenArrayKind;

static const struct {
    const char *section, *name; /* in XML */
    VtkType type;
    size_t components;
} kinds[KINDS] = {
    [RADIUS] = {"PointData", "radius", VTK_DOUBLE, 1},
    [COLUMN] = {"PointData", NULL, VTK_DOUBLE, 1},
    [ID] = {"PointData", "id", VTK_INT32, 1},
    [TYPE] = {"PointData", "type", VTK_INT32, 1},
    [SHARE] = {"PointData", "flow_share", VTK_DOUBLE, 1},
    [LINK] = {"PointData", "link_id", VTK_INT32, 1},
    [POSITION] = {"Points", "Points", VTK_DOUBLE, 3},
    [VERTS] = {"Verts", "connectivity", VTK_INT32, 1},
    [VERT_ENDS] = {"Verts", "offsets", VTK_INT32, 1},
    [LINES] = {"Lines", "connectivity", VTK_INT32, 1},
    [LINE_ENDS] = {"Lines", "offsets", VTK_INT32, 1},
};

/* An array of the file that is written. */
typedef struct WrittenArray {
    WrittenArrayKind kind;
    size_t column; /* of COLUMN: index of the tree's column */
    size_t n;      /* number of numbers */
} WrittenArray;

/* The points and arrays of the file. The points of a polyline have consecutive indices. */
typedef struct VtkLines {
    const Tree *tree;
    Branches branches;
    int32_t *node;   /* per point: its node; owned */
    int32_t *values; /* per point: the node whose values it has; owned */
    size_t n_points, n_roots;
    ARRAY(WrittenArray) arrays;
} VtkLines;

static void release(VtkLines *lines)
{
    branches_release(&lines->branches);
    free(lines->node);
    free(lines->values);
    ARRAY_RELEASE(&lines->arrays);
}

static void add_point(VtkLines *lines, int32_t node, int32_t values)
{
    lines->node[lines->n_points] = node;
    lines->values[lines->n_points++] = values;
}

/* Lists the points: roots, then the points of each branch. */
static Status list_points(VtkLines *lines, Err *err)
{
    const Tree *tree = lines->tree;
    TRY(branches_find(tree, &lines->branches, err));
    const Branches *branches = &lines->branches;
    size_t most = tree->n + branches->n;
    TRY(mem_calloc(&lines->node, most, sizeof *lines->node, "points", err));
    TRY(mem_calloc(&lines->values, most, sizeof *lines->values, "points", err));
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            add_point(lines, (int32_t)i, (int32_t)i);
    lines->n_roots = lines->n_points;
    for (size_t k = 0, at = 0; k < branches->n; k++) {
        int32_t first = branches->node[at];
        add_point(lines, tree->parent[first], first);
        for (; at < branches->end[k]; at++)
            add_point(lines, branches->node[at], branches->node[at]);
    }
    return STATUS_OK;
}

/* Lists the arrays in the order of the file. */
static Status list_arrays(VtkLines *lines, Err *err)
{
    const Tree *tree = lines->tree;
    size_t points = lines->n_points, roots = lines->n_roots;
    const size_t n[KINDS] = {[RADIUS] = points,
                             [ID] = points,
                             [TYPE] = tree_has_types(tree) ? points : 0,
                             [SHARE] = tree->flow_share ? points : 0,
                             [LINK] = tree->link ? points : 0,
                             [POSITION] = 3 * points,
                             [VERTS] = roots,
                             [VERT_ENDS] = roots,
                             [LINES] = points - roots,
                             [LINE_ENDS] = lines->branches.n};
    for (int kind = 0; kind < KINDS; kind++) {
        for (size_t k = 0; kind == COLUMN && k < tree->n_columns; k++)
            TRY(ARRAY_PUSH(&lines->arrays, "arrays", err, (WrittenArray){COLUMN, k, points}));
        if (n[kind] > 0 || kind >= POSITION)
            TRY(ARRAY_PUSH(&lines->arrays, "arrays", err,
                           (WrittenArray){(WrittenArrayKind)kind, 0, n[kind]}));
    }
    return STATUS_OK;
}

/* Returns number `i` of an array. */
static double number_at(const VtkLines *lines, const WrittenArray *array, size_t i)
{
    const Tree *tree = lines->tree;
    switch (array->kind) {
    case RADIUS:
        return tree->radius_mm[lines->values[i]];
    case ID:
        return tree->id[tree_linked_node(tree, (size_t)lines->node[i])];
    case TYPE:
        return tree->type[lines->node[i]];
    case SHARE:
        return tree->flow_share[lines->node[i]];
    case LINK:
        return tree_has_link(tree, (size_t)lines->node[i]) ? tree->id[lines->node[i]] : 0;
    case COLUMN:
        return tree->column[array->column].value[lines->values[i]];
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

static void put_numbers(const VtkLines *lines, const WrittenArray *array, bool is_big_endian,
                        Text *text)
{
    enum { PIECE = 2048 }; /* numbers: both buffers take 16 kB of the stack */
    VtkType type = kinds[array->kind].type;
    double numbers[PIECE];
    char bytes[PIECE * sizeof *numbers];
    for (size_t done = 0, n; done < array->n; done += n) {
        n = array->n - done < PIECE ? array->n - done : PIECE;
        for (size_t i = 0; i < n; i++)
            numbers[i] = number_at(lines, array, done + i);
        vtk_bytes(type, is_big_endian, numbers, n, bytes);
        text_append(text, bytes, n * vtk_type_size(type));
    }
}

/* Writes the array's name, for a column "NAME [UNIT]", into `text`. Returns its characters. */
static const char *name_of(const VtkLines *lines, const WrittenArray *array, Text *text)
{
    if (array->kind != COLUMN)
        return kinds[array->kind].name;
    text_clear(text);
    vtk_put_column_name(&lines->tree->column[array->column], text);
    return text_chars(text);
}

/* Returns the number of lines of metadata. */
static size_t count_remarks(const TreeMeta *meta)
{
    Text line = TEXT_INIT;
    size_t n = 0;
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);)
        n++;
    text_release(&line);
    return n;
}

/* ---- XML ------------------------------------------------------------------------------------- */

/* Appends the metadata as VTK's XML stores strings: the codes of the characters, and 0 after each
 * line. */
static void put_remarks(const TreeMeta *meta, Text *text)
{
    Text line = TEXT_INIT;
    text_printf(text,
                "    <FieldData>\n      <DataArray type=\"String\" Name=\"" VTK_METADATA "\" "
                "NumberOfTuples=\"%zu\" format=\"ascii\">\n",
                count_remarks(meta));
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);) {
        const char *chars = text_chars(&line);
        for (const char *at = chars ? chars : ""; *at; at++)
            text_printf(text, "%d ", (unsigned char)*at);
        text_puts(text, chars ? "0\n" : NULL);
    }
    text_puts(text, "      </DataArray>\n    </FieldData>\n");
    text_release(&line);
}

static size_t bytes_of(const WrittenArray *array)
{
    return array->n * vtk_type_size(kinds[array->kind].type);
}

/* Appends the declarations of all arrays, by sections. */
static void put_arrays(const VtkLines *lines, Text *text)
{
    Text name = TEXT_INIT;
    const char *section = NULL;
    size_t offset = 0;
    for (size_t i = 0; i < lines->arrays.n; i++) {
        const WrittenArray *array = &lines->arrays.items[i];
        const char *own = kinds[array->kind].section;
        if (section && section != own)
            text_printf(text, "      </%s>\n", section);
        if (section != own)
            text_printf(text, i == 0 ? "      <%s Scalars=\"radius\">\n" : "      <%s>\n", own);
        section = own;
        text_printf(text, "        <DataArray type=\"%s\" Name=\"",
                    vtk_type_name(NAMING_XML, kinds[array->kind].type));
        text_escaped(text, name_of(lines, array, &name));
        text_printf(text, "\" NumberOfComponents=\"%zu\" format=\"appended\" offset=\"%zu\"/>\n",
                    kinds[array->kind].components, offset);
        offset += sizeof(uint64_t) + bytes_of(array);
    }
    text_printf(text, "      </%s>\n", section);
    text_release(&name);
}

Status vtp_write(const Tree *tree, Text *text, Err *err)
{
    VtkLines lines = {.tree = tree};
    Status status = STATUS_OK;
    TRY_GOTO(list_points(&lines, err));
    TRY_GOTO(list_arrays(&lines, err));
    text_puts(text, "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
                    "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PolyData>\n");
    put_remarks(&tree->meta, text);
    text_printf(text,
                "    <Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"%zu\" "
                "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
                lines.n_points, lines.n_roots, lines.branches.n);
    put_arrays(&lines, text);
    text_puts(text, "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
    for (size_t i = 0; i < lines.arrays.n; i++) {
        const double size = (double)bytes_of(&lines.arrays.items[i]);
        char header[sizeof(uint64_t)];
        vtk_bytes(VTK_UINT64, false, &size, 1, header);
        text_append(text, header, sizeof header);
        put_numbers(&lines, &lines.arrays.items[i], false, text);
    }
    text_puts(text, "\n  </AppendedData>\n</VTKFile>\n");
done:
    release(&lines);
    return status;
}

/* ---- legacy ---------------------------------------------------------------------------------- */

/* Appends a name in the encoding of legacy VTK: other characters than letters, digits and common
 * signs become "%41". NULL makes the text fail. */
static void put_encoded(const char *name, Text *text)
{
    if (!name)
        text_puts(text, NULL);
    for (; name && *name; name++) {
        unsigned char letter = (unsigned char)*name;
        if (letter <= ' ' || letter == '%' || letter == '"' || letter >= 0x7f)
            text_printf(text, "%%%02X", letter);
        else
            text_append(text, name, 1);
    }
}

/* Appends a binary string. Its first two bits state how many bytes its length takes. */
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
    text_printf(text, "FIELD FieldData 1\n" VTK_METADATA " 1 %zu string\n", count_remarks(meta));
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

static void put_int(double number, Text *text)
{
    char bytes[4];
    vtk_bytes(VTK_INT32, true, &number, 1, bytes);
    text_append(text, bytes, sizeof bytes);
}

/* Appends one row per cell: the number of its points, and their indices. */
static void put_cells(const VtkLines *lines, Text *text)
{
    const Branches *branches = &lines->branches;
    size_t point = 0, n_segments = lines->n_points - lines->n_roots;
    text_printf(text, "VERTICES %zu %zu\n", lines->n_roots, 2 * lines->n_roots);
    for (; point < lines->n_roots; point++) {
        put_int(1, text);
        put_int((double)point, text);
    }
    if (branches->n > 0)
        text_printf(text, "\nLINES %zu %zu\n", branches->n, branches->n + n_segments);
    for (size_t k = 0, at = 0; k < branches->n; at = branches->end[k++]) {
        size_t n = branches->end[k] - at + 1;
        put_int((double)n, text);
        for (size_t i = 0; i < n; i++)
            put_int((double)point++, text);
    }
}

Status vtk_write(const Tree *tree, Text *text, Err *err)
{
    VtkLines lines = {.tree = tree};
    Text name = TEXT_INIT;
    Status status = STATUS_OK;
    TRY_GOTO(list_points(&lines, err));
    TRY_GOTO(list_arrays(&lines, err));
    const WrittenArray *positions = lines.arrays.items;
    while (positions->kind != POSITION)
        positions++;
    text_puts(text, "# vtk DataFile Version 3.0\narterial tree, mm\nBINARY\nDATASET POLYDATA\n");
    put_legacy_remarks(&tree->meta, text);
    text_printf(text, "POINTS %zu double\n", lines.n_points);
    put_numbers(&lines, positions, true, text);
    text_puts(text, "\n");
    put_cells(&lines, text);
    text_printf(text, "\nPOINT_DATA %zu\nFIELD FieldData %zu\n", lines.n_points,
                (size_t)(positions - lines.arrays.items));
    for (const WrittenArray *array = lines.arrays.items; array < positions; array++) {
        put_encoded(name_of(&lines, array, &name), text);
        text_printf(text, " 1 %zu %s\n", array->n,
                    vtk_type_name(NAMING_LEGACY, kinds[array->kind].type));
        put_numbers(&lines, array, true, text);
        text_puts(text, "\n");
    }
done:
    text_release(&name);
    release(&lines);
    return status;
}
