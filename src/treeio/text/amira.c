/* Networks of Amira and Avizo (.am): a header of words that says how many elements of each kind
 * there are and which block holds which of their numbers, then the blocks, "@1" and so on, each on
 * a line of its own, in text, as packed numbers, or as these compressed by HxByteRLE (a byte n
 * above 127: the next n - 128 bytes as they are; else: the next byte n times) or HxZip (zlib).
 *
 * The ContentType says how elements are connected; all become polylines of what VTK's files have:
 * HxSpatialGraph: the points of an edge run from its first vertex to its second, both included,
 * edge after edge; edges that share a vertex are joined. Numbers of vertices go to the points that
 *     lie there.
 * HxLineSet: LineIdx lists the vertices of a line, and -1 ends it.
 * SkeletonGraph: NeighbourList lists the neighbours of each vertex, NeighbourCount of them; Origins
 *     are roots. */
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"

#include <ctype.h>
#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Kinds of elements. LINES have the entries of LineIdx, NEIGHBOURS those of NeighbourList. */
typedef enum Element {
    VERTEX,
    EDGE,
    POINT,
    VERTICES,
    LINES,
    NEIGHBOURS,
    ORIGINS,
    ELEMENTS
} Element;

/* Without regard to case. */
static const char *const element_names[] = {
    [VERTEX] = "VERTEX", [EDGE] = "EDGE",       [POINT] = "POINT",          [VERTICES] = "Vertices",
    [LINES] = "Lines",   [ORIGINS] = "Origins", [NEIGHBOURS] = "Neighbours"};

/* How elements are connected. */
typedef enum Content { NO_NETWORK, SPATIAL_GRAPH, LINE_SET, SKELETON, CONTENTS } Content;

static const char *const content_names[] = {[NO_NETWORK] = "",
                                            [SPATIAL_GRAPH] = "HxSpatialGraph",
                                            [LINE_SET] = "HxLineSet",
                                            [SKELETON] = "SkeletonGraph"};

typedef enum Packing { PLAIN, BYTE_RLE, ZIP } Packing;

static const char *const packing_names[] = {[BYTE_RLE] = "HxByteRLE", [ZIP] = "HxZip"};

enum { N_PACKINGS = sizeof packing_names / sizeof *packing_names };

/* Amira's types of numbers, as legacy VTK calls them. */
static const struct {
    const char *name, *legacy;
} types[] = {{"float", "float"}, {"double", "double"},         {"int", "int"},
             {"short", "short"}, {"ushort", "unsigned_short"}, {"byte", "unsigned_char"},
             {"long", "long"}};

enum { N_TYPES = sizeof types / sizeof *types, MOST_COMPONENTS = 16 };

/* Numbers of all vertices, edges or points. */
typedef struct Field {
    Element of;
    char *name; /* owned */
    const VtkType *type;
    size_t components;
    long long block;
    Packing packing;
    size_t packed; /* bytes in the file, when packed */
    double *value; /* owned; NULL until its block has been read */
} Field;

typedef struct Reader {
    Graph *graph;
    char *bytes, *at, *end; /* of the whole file */
    bool is_text, is_big_endian;
    Content content;
    char content_name[40];
    bool has_count[ELEMENTS];
    size_t count[ELEMENTS];
    Field *field;
    size_t n_fields, capacity;
    double taken; /* bytes that the numbers of all blocks take so far */
    VtkData data;
} Reader;

static void release(Reader *reader)
{
    for (size_t i = 0; i < reader->n_fields; i++) {
        free(reader->field[i].name);
        free(reader->field[i].value);
    }
    free(reader->field);
    vtk_release(&reader->data);
}

/* Puts file and line in front of the sentence. */
static Status blame(const Reader *reader, Status status, Err *err)
{
    size_t line = 1;
    for (const char *at = reader->bytes; at < reader->at; at++)
        line += *at == '\n';
    if (status == STATUS_INPUT)
        err_prefix(err, "%s:%zu: ", reader->graph->name, line);
    return status;
}

/* ---- header ---- */

enum { WORD_SIZE = 256 };

/* The next word of the header, which ends at `end`: a text in quotes, one of { } ( ) or what stands
 * between blanks, commas, '=' and these. False at the end. */
static bool next_word(Reader *reader, const char *end, char word[WORD_SIZE])
{
    static const char alone[] = "{}()", between[] = " \t\r\n\v\f,=";
    size_t n = 0;
    while (reader->at < end && (strchr(between, *reader->at) || *reader->at == '#'))
        if (*reader->at++ == '#')
            while (reader->at < end && *reader->at != '\n')
                reader->at++;
    if (reader->at == end)
        return false;
    bool quoted = *reader->at == '"';
    if (quoted)
        reader->at++;
    const char *from = reader->at;
    while (reader->at < end && (quoted ? *reader->at != '"'
                                       : *reader->at != '\0' && !strchr(alone, *reader->at) &&
                                             !strchr(between, *reader->at) && *reader->at != '"'))
        reader->at++;
    if (reader->at == from && !quoted)
        reader->at++;
    n = (size_t)(reader->at - from);
    n = n < WORD_SIZE ? n : WORD_SIZE - 1;
    memcpy(word, from, n);
    word[n] = '\0';
    reader->at += quoted && reader->at < end;
    return true;
}

static bool is_word(Reader *reader, const char *end, const char *expected)
{
    char word[WORD_SIZE];
    char *before = reader->at;
    if (next_word(reader, end, word) && strcmp(word, expected) == 0)
        return true;
    reader->at = before;
    return false;
}

static void take_unit(Graph *graph, const char *said)
{
    bool is_micro = strcmp(said, "\xc2\xb5m") == 0 || strcmp(said, "\xb5m") == 0;
    for (int unit = 0; unit < LENGTH_UNITS; unit++)
        if (strcmp(is_micro ? "um" : said, length_unit_names[unit]) == 0) {
            graph->unit = (LengthUnit)unit;
            graph->unit_said = true;
        }
}

static void set_content(Reader *reader, const char *name)
{
    snprintf(reader->content_name, sizeof reader->content_name, "%.39s", name);
    for (int content = SPATIAL_GRAPH; content < CONTENTS; content++)
        if (strcasecmp(name, content_names[content]) == 0)
            reader->content = (Content)content;
}

/* What stands in braces behind "Parameters" and the like. */
static Status read_parameters(Reader *reader, const char *end, Err *err)
{
    char word[WORD_SIZE], last[WORD_SIZE] = "";
    for (size_t depth = 1; depth > 0; memcpy(last, word, sizeof last)) {
        if (!next_word(reader, end, word))
            return err_set(err, STATUS_INPUT, "a brace of the header is not closed");
        depth += strcmp(word, "{") == 0;
        depth -= strcmp(word, "}") == 0;
        if (strcasecmp(last, "ContentType") == 0)
            set_content(reader, word);
        if (strcasecmp(last, "Coordinates") == 0)
            take_unit(reader->graph, word);
    }
    return STATUS_OK;
}

/* ELEMENTS for another word. */
static Element element_called(const char *name)
{
    int of = 0;
    while (of < ELEMENTS && strcasecmp(name, element_names[of]) != 0)
        of++;
    return (Element)of;
}

/* Reads "define VERTEX 3" behind "define", or "3" behind "nVertices". */
static Status read_count(Reader *reader, const char *end, const char *name, Err *err)
{
    char count[WORD_SIZE];
    Element of = element_called(name);
    int32_t number;
    if (!next_word(reader, end, count))
        return err_set(err, STATUS_INPUT, "the header ends behind '%.40s'", name);
    if (of == ELEMENTS)
        return STATUS_OK;
    TRY(field_whole(name, count, 0, INT32_MAX, &number, err));
    reader->count[of] = (size_t)number;
    reader->has_count[of] = true;
    return check_elements(name, number, (size_t)(reader->end - reader->bytes), err);
}

/* "float[3]" or "int". */
static Status read_type(Field *field, const char *word, Err *err)
{
    size_t length = strcspn(word, "[");
    long long components = 1;
    char number[WORD_SIZE];
    snprintf(number, sizeof number, "%s", word[length] ? word + length + 1 : "1]");
    number[strcspn(number, "]")] = '\0';
    for (size_t i = 0; i < N_TYPES && !field->type; i++)
        if (strlen(types[i].name) == length && strncasecmp(types[i].name, word, length) == 0)
            field->type = vtk_type_of_legacy(types[i].legacy, strlen(types[i].legacy));
    if (!field->type || !integer_parse(number, 1, MOST_COMPONENTS, &components))
        return err_set(err, STATUS_INPUT, "'%.40s' is no type of numbers that is read", word);
    field->components = (size_t)components;
    return STATUS_OK;
}

/* "(HxZip,123)" behind the number of a block. */
static Status read_packing(Reader *reader, const char *end, Field *field, Err *err)
{
    char name[WORD_SIZE], bytes[WORD_SIZE];
    long long size = 0;
    if (!is_word(reader, end, "("))
        return STATUS_OK;
    if (!next_word(reader, end, name) || !next_word(reader, end, bytes) ||
        !integer_parse(bytes, 0, INT64_MAX, &size) || !is_word(reader, end, ")"))
        return err_set(err, STATUS_INPUT, "the block @%lld is packed in no way that is known",
                       field->block);
    for (int packing = BYTE_RLE; packing < N_PACKINGS; packing++)
        if (strcasecmp(name, packing_names[packing]) == 0)
            field->packing = (Packing)packing;
    field->packed = (size_t)size;
    if (field->packing == PLAIN)
        return err_set(err, STATUS_INPUT,
                       "the block @%lld is packed by '%.40s'; HxByteRLE and HxZip are read",
                       field->block, name);
    return STATUS_OK;
}

/* "{ float[3] VertexCoordinates } @1" behind "VERTEX". */
static Status read_declaration(Reader *reader, const char *end, Element of, Err *err)
{
    char type[WORD_SIZE], name[WORD_SIZE], block[WORD_SIZE];
    Field field = {.of = of};
    if (!is_word(reader, end, "{") || !next_word(reader, end, type) ||
        !next_word(reader, end, name) || !is_word(reader, end, "}") ||
        !next_word(reader, end, block) || *block != '@' ||
        !integer_parse(block + 1, 0, INT32_MAX, &field.block))
        return err_set(err, STATUS_INPUT, "a declaration is '%s { TYPE NAME } @BLOCK'",
                       element_names[of]);
    TRY(read_type(&field, type, err));
    TRY(read_packing(reader, end, &field, err));
    TRY(mem_reserve(&reader->field, &reader->capacity, reader->n_fields + 1, sizeof field, "arrays",
                    err));
    TRY(mem_strdup(&field.name, name, err));
    reader->field[reader->n_fields++] = field;
    return STATUS_OK;
}

static Status read_statement(Reader *reader, const char *end, const char *word, Err *err)
{
    char name[WORD_SIZE];
    if (strcasecmp(word, "define") == 0)
        return next_word(reader, end, name)
                   ? read_count(reader, end, name, err)
                   : err_set(err, STATUS_INPUT, "the header ends behind 'define'");
    Element of = element_called(word);
    if (of < ELEMENTS)
        return read_declaration(reader, end, of, err);
    if (*word == 'n' && element_called(word + 1) < ELEMENTS)
        return read_count(reader, end, word + 1, err);
    return is_word(reader, end, "{") ? read_parameters(reader, end, err) : STATUS_OK;
}

static Status check_header(const Reader *reader, Err *err)
{
    static const Element needed[CONTENTS][3] = {[SPATIAL_GRAPH] = {VERTEX, EDGE, POINT},
                                                [LINE_SET] = {VERTICES, VERTICES, LINES},
                                                [SKELETON] = {VERTICES, VERTICES, NEIGHBOURS}};
    if (reader->content == NO_NETWORK)
        return err_set(err, STATUS_INPUT,
                       "the ContentType is '%s'; networks are HxSpatialGraph, HxLineSet or "
                       "SkeletonGraph",
                       reader->content_name);
    for (size_t k = 0; k < 3; k++) {
        Element of = needed[reader->content][k];
        if (!reader->has_count[of])
            return err_set(err, STATUS_INPUT, "the header does not define %s", element_names[of]);
    }
    return STATUS_OK;
}

/* Where the first line begins that is "@" and a number; NULL when there is none. */
static char *first_block(const Reader *reader)
{
    for (char *at = reader->bytes; (at = memmem(at, (size_t)(reader->end - at), "\n@", 2)); at++)
        if (isdigit((unsigned char)at[2]))
            return at + 1;
    return NULL;
}

static Status read_header(Reader *reader, Err *err)
{
    char word[WORD_SIZE];
    char *end = first_block(reader);
    size_t length = strcspn(reader->bytes, "\n");
    if (!end)
        return err_set(err, STATUS_INPUT, "the file has no block of numbers");
    bool is_little = memmem(reader->bytes, length, "LITTLE-ENDIAN", 13) != NULL;
    reader->is_text = memmem(reader->bytes, length, "ASCII", 5) != NULL;
    reader->is_big_endian = !reader->is_text && !is_little;
    while (next_word(reader, end, word))
        TRY(read_statement(reader, end, word, err));
    TRY(check_header(reader, err));
    reader->at = end;
    return STATUS_OK;
}

/* ---- blocks ---- */

static size_t bytes_left(const Reader *reader)
{
    return (size_t)(reader->end - reader->at);
}

static Status read_text(Reader *reader, double *value, size_t n, Err *err)
{
    enum { NUMBER_SIZE = 400 };
    for (size_t i = 0; i < n; i++) {
        char number[NUMBER_SIZE];
        while (reader->at < reader->end && isspace((unsigned char)*reader->at))
            reader->at++;
        const char *from = reader->at;
        while (reader->at < reader->end && !isspace((unsigned char)*reader->at))
            reader->at++;
        size_t length = (size_t)(reader->at - from);
        length = length < NUMBER_SIZE ? length : NUMBER_SIZE - 1;
        memcpy(number, from, length);
        number[length] = '\0';
        if (!number_parse(number, &value[i]))
            return err_set(err, STATUS_INPUT, "'%.40s' is no number, and %zu are to come%s", number,
                           n - i, decimal_comma_hint(number));
    }
    return STATUS_OK;
}

/* False when what is packed is not exactly `size` bytes. */
static bool unpack_rle(const char *from, size_t packed, char *to, size_t size)
{
    size_t at = 0, n = 0;
    while (at < packed) {
        unsigned char control = (unsigned char)from[at++];
        size_t count = control & 0x7f, takes = control > 0x7f ? count : 1;
        if (takes > packed - at || count > size - n)
            return false;
        if (control > 0x7f)
            memcpy(to + n, from + at, count);
        else
            memset(to + n, from[at], count);
        n += count;
        at += takes;
    }
    return n == size;
}

static Status unpack_zip(const char *from, size_t packed, char *to, size_t size, bool *fits,
                         Err *err)
{
    struct libdeflate_decompressor *inflater = libdeflate_alloc_decompressor();
    if (!inflater)
        return mem_out_of("to inflate", "a block", err);
    *fits =
        libdeflate_zlib_decompress(inflater, from, packed, to, size, NULL) == LIBDEFLATE_SUCCESS;
    libdeflate_free_decompressor(inflater);
    return STATUS_OK;
}

static Status unpack(Reader *reader, const Field *field, size_t n, double *value, Err *err)
{
    size_t size = n * field->type->size;
    char *bytes = NULL;
    bool fits = false;
    TRY(mem_calloc(&bytes, size, 1, "bytes of a block", err));
    Status status = STATUS_OK;
    if (field->packing == BYTE_RLE)
        fits = unpack_rle(reader->at, field->packed, bytes, size);
    else
        status = unpack_zip(reader->at, field->packed, bytes, size, &fits, err);
    if (status == STATUS_OK && !fits)
        status = err_set(err, STATUS_INPUT, "the %zu bytes of @%lld do not unpack to %zu",
                         field->packed, field->block, size);
    if (status == STATUS_OK)
        vtk_numbers(field->type, reader->is_big_endian, bytes, n, value);
    free(bytes);
    return status;
}

/* Whether as many numbers can be in the file: zlib makes at most 1032 bytes of one. */
static Status check_claim(const Reader *reader, const Field *field, size_t n, Err *err)
{
    enum { MOST_OF_RLE = 64, MOST_OF_ZIP = 1032 };
    double needs = (double)n * (reader->is_text ? 2 : (double)field->type->size);
    double has = (double)bytes_left(reader) + reader->is_text;
    if (field->packing != PLAIN) {
        if (field->packed > bytes_left(reader))
            return err_set(err, STATUS_INPUT, "the file ends within the %zu bytes of @%lld",
                           field->packed, field->block);
        has = (double)field->packed * (field->packing == ZIP ? MOST_OF_ZIP : MOST_OF_RLE);
    }
    if (needs > has)
        return err_set(err, STATUS_INPUT, "%zu numbers of '%.40s' cannot be in the %.0f bytes left",
                       n, field->name, (double)bytes_left(reader));
    return STATUS_OK;
}

static Status read_block(Reader *reader, Field *field, Err *err)
{
    size_t n = reader->count[field->of] * field->components;
    TRY(check_claim(reader, field, n, err));
    reader->taken += (double)n * sizeof *field->value;
    TRY(check_unpacked(reader->taken, (size_t)(reader->end - reader->bytes), err));
    TRY(mem_check(reader->taken + (double)n * (double)field->type->size, reader->graph->name, err));
    free(field->value);
    field->value = NULL;
    TRY(mem_calloc(&field->value, n, sizeof *field->value, "numbers of a block", err));
    if (reader->is_text)
        return read_text(reader, field->value, n, err);
    if (field->packing != PLAIN) {
        TRY(unpack(reader, field, n, field->value, err));
        reader->at += field->packed;
        return STATUS_OK;
    }
    vtk_numbers(field->type, reader->is_big_endian, reader->at, n, field->value);
    reader->at += n * field->type->size;
    return STATUS_OK;
}

/* The number of a block, whose line ends behind it. */
static Status read_block_line(Reader *reader, long long *block, Err *err)
{
    char word[32];
    size_t length = 0;
    while (length < bytes_left(reader) && length < sizeof word - 1 &&
           !isspace((unsigned char)reader->at[length]))
        length++;
    memcpy(word, reader->at, length);
    word[length] = '\0';
    if (*word != '@' || !integer_parse(word + 1, 0, INT32_MAX, block))
        return err_set(err, STATUS_INPUT, "'%.30s' stands where a block begins", word);
    const char *stop = memchr(reader->at, '\n', bytes_left(reader));
    reader->at = stop ? reader->at + (stop - reader->at) + 1 : reader->end;
    return STATUS_OK;
}

static Status read_blocks(Reader *reader, Err *err)
{
    for (;;) {
        long long block;
        size_t i = 0;
        while (reader->at < reader->end && isspace((unsigned char)*reader->at))
            reader->at++;
        if (reader->at == reader->end)
            return STATUS_OK;
        TRY(read_block_line(reader, &block, err));
        while (i < reader->n_fields && reader->field[i].block != block)
            i++;
        if (i == reader->n_fields)
            return err_set(err, STATUS_INPUT, "the block @%lld is not declared", block);
        TRY(read_block(reader, &reader->field[i], err));
    }
}

/* ---- the network ---- */

static Field *find_field(const Reader *reader, Element of, const char *name)
{
    for (size_t i = 0; i < reader->n_fields; i++)
        if (reader->field[i].of == of && strcasecmp(reader->field[i].name, name) == 0)
            return &reader->field[i];
    return NULL;
}

static Status need_field(const Reader *reader, Element of, const char *name, size_t components,
                         Field **field, Err *err)
{
    *field = find_field(reader, of, name);
    if (*field && (*field)->value && (*field)->components == components)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: there is no block of %s { %s } with %zu number%s each",
                   reader->graph->name, element_names[of], name, components,
                   components == 1 ? "" : "s");
}

/* Where the points of each edge end, in *end (owned). */
static Status find_ends(const Reader *reader, const Field *counts, size_t **end, Err *err)
{
    size_t edges = reader->count[EDGE], points = reader->count[POINT], at = 0;
    size_t *made = NULL;
    double sum = 0;
    for (size_t i = 0; i < edges; i++) {
        double count = counts->value[i];
        if (!(count >= 2) || count != floor(count))
            return err_set(err, STATUS_INPUT,
                           "%s: edge %zu has %g points; it needs those of both its vertices",
                           reader->graph->name, i, count);
        sum += count;
    }
    if (sum != (double)points)
        return err_set(err, STATUS_INPUT, "%s: the edges have %.15g points together, POINT is %zu",
                       reader->graph->name, sum, points);
    TRY(mem_calloc(&made, edges, sizeof *made, "edges", err));
    for (size_t i = 0; i < edges; i++)
        made[i] = at += (size_t)counts->value[i];
    *end = made;
    return STATUS_OK;
}

/* Joins the end of an edge with the first that has the same vertex. */
static Status join_vertex(const Reader *reader, double vertex, size_t point, size_t *first,
                          Err *err)
{
    if (!(vertex >= 0 && vertex < (double)reader->count[VERTEX]) || vertex != floor(vertex))
        return err_set(err, STATUS_INPUT, "%s: an edge leads to vertex %g; there are %zu",
                       reader->graph->name, vertex, reader->count[VERTEX]);
    size_t *of = &first[(size_t)vertex];
    if (*of == 0)
        *of = point + 1;
    else
        TRY(graph_join(reader->graph, *of - 1, point, err));
    return STATUS_OK;
}

/* The vertex + 1 that lies at each point, in *vertex (owned). */
static Status join_edges(const Reader *reader, const Field *ends, const size_t *end,
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

/* Numbers of vertices as numbers of points, NAN between vertices. */
static Status spread(const Reader *reader, const Field *field, const size_t *vertex, double **value,
                     Err *err)
{
    size_t n = reader->count[POINT], components = field->components;
    TRY(mem_calloc(value, n * components, sizeof **value, "numbers of points", err));
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < components; k++)
            (*value)[i * components + k] =
                vertex[i] ? field->value[(vertex[i] - 1) * components + k] : (double)NAN;
    return STATUS_OK;
}

/* Hands a field over as an array of VTK's. */
static Status add_array(Reader *reader, Field *field, const size_t *vertex, Err *err)
{
    VtkArray array = {.n = reader->count[field->of == VERTEX ? POINT : field->of],
                      .components = field->components};
    VtkData *data = &reader->data;
    if (field->of == VERTEX)
        TRY(spread(reader, field, vertex, &array.value, err));
    array.name = field->name;
    field->name = NULL;
    if (field->of != VERTEX) {
        array.value = field->value;
        field->value = NULL;
    }
    return vtk_add_array(field->of == EDGE ? &data->of_cells : &data->of_points, &array, err);
}

/* Those that are needed to connect points are no arrays. */
static Status add_arrays(Reader *reader, const size_t *vertex, Err *err)
{
    static const char *const own[] = {"VertexCoordinates",    "EdgeConnectivity", "NumEdgePoints",
                                      "EdgePointCoordinates", "Coordinates",      "NeighbourCount"};
    for (size_t i = 0; i < reader->n_fields; i++) {
        Element of = reader->field[i].of;
        bool is_own = !reader->field[i].value || of == LINES || of == NEIGHBOURS || of == ORIGINS;
        for (size_t k = 0; k < sizeof own / sizeof *own && !is_own; k++)
            is_own = strcasecmp(reader->field[i].name, own[k]) == 0;
        if (!is_own)
            TRY(add_array(reader, &reader->field[i], vertex, err));
    }
    return STATUS_OK;
}

static Status add_lines(Reader *reader, const Field *places, size_t *end, Err *err)
{
    VtkData *data = &reader->data;
    size_t points = reader->count[POINT], edges = reader->count[EDGE];
    data->end = end;
    data->n_lines = data->n_cells = edges;
    data->n_points = data->n_corners = points;
    TRY(mem_calloc(&data->point, 3 * points, sizeof *data->point, "points", err));
    TRY(mem_calloc(&data->corner, points, sizeof *data->corner, "points", err));
    TRY(mem_calloc(&data->cell, edges, sizeof *data->cell, "edges", err));
    memcpy(data->point, places->value, 3 * points * sizeof *data->point);
    for (size_t i = 0; i < points; i++)
        data->corner[i] = (double)i;
    for (size_t i = 0; i < edges; i++)
        data->cell[i] = i;
    return STATUS_OK;
}

static Status add_spatial_graph(Reader *reader, Err *err)
{
    Field *vertices, *ends, *counts, *places;
    size_t *end = NULL, *vertex = NULL;
    TRY(need_field(reader, VERTEX, "VertexCoordinates", 3, &vertices, err));
    TRY(need_field(reader, EDGE, "EdgeConnectivity", 2, &ends, err));
    TRY(need_field(reader, EDGE, "NumEdgePoints", 1, &counts, err));
    TRY(need_field(reader, POINT, "EdgePointCoordinates", 3, &places, err));
    TRY(find_ends(reader, counts, &end, err));
    Status status = add_lines(reader, places, end, err);
    if (status == STATUS_OK)
        status = join_edges(reader, ends, end, &vertex, err);
    if (status == STATUS_OK)
        status = add_arrays(reader, vertex, err);
    free(vertex);
    return status;
}

/* The vertices are the points of the network. */
static Status add_vertices(Reader *reader, Err *err)
{
    Field *places;
    TRY(need_field(reader, VERTICES, "Coordinates", 3, &places, err));
    reader->data.point = places->value;
    reader->data.n_points = reader->count[VERTICES];
    places->value = NULL;
    return STATUS_OK;
}

/* The radius of a line set has no name of its own: it is the first array of one number per vertex,
 * which Amira calls Data or Data0, unless another is called a radius. */
static Status name_radius(Reader *reader, Err *err)
{
    Field *data = find_field(reader, VERTICES, "Data0");
    data = data ? data : find_field(reader, VERTICES, "Data");
    if (!data || !data->value || data->components != 1 || find_field(reader, VERTICES, "radius") ||
        find_field(reader, VERTICES, "thickness") ||
        (reader->graph->options && reader->graph->options->radius_array))
        return STATUS_OK;
    TRY(reading_note(reader->graph->reading, err, "the numbers '%.60s' of vertices are radii",
                     data->name));
    free(data->name);
    return mem_strdup(&data->name, "radius", err);
}

static Status add_line_set(Reader *reader, Err *err)
{
    VtkData *data = &reader->data;
    Field *lines;
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

/* Points that the file calls origins, as the array "root" of VTK's files. */
static Status add_origins(Reader *reader, Err *err)
{
    const Field *origins = find_field(reader, ORIGINS, "Origins");
    VtkArray array = {.n = reader->data.n_points, .components = 1};
    if (!origins || !origins->value || origins->components != 1)
        return STATUS_OK;
    Status status = mem_strdup(&array.name, "root", err);
    if (status == STATUS_OK)
        status = mem_calloc(&array.value, array.n, sizeof *array.value, "numbers of points", err);
    for (size_t i = 0; status == STATUS_OK && i < reader->count[ORIGINS]; i++)
        if (origins->value[i] >= 0 && origins->value[i] < (double)array.n)
            array.value[(size_t)origins->value[i]] = 1;
    if (status == STATUS_OK)
        return vtk_add_array(&reader->data.of_points, &array, err);
    vtk_release_array(&array);
    return status;
}

/* Each edge is in the lists of both its vertices; it is added from the lower one. */
static Status add_skeleton(Reader *reader, Err *err)
{
    VtkData *data = &reader->data;
    Field *counts, *list;
    size_t at = 0, n = reader->count[NEIGHBOURS];
    TRY(need_field(reader, VERTICES, "NeighbourCount", 1, &counts, err));
    TRY(need_field(reader, NEIGHBOURS, "NeighbourList", 1, &list, err));
    TRY(add_vertices(reader, err));
    for (size_t i = 0; i < data->n_points; i++) {
        double count = counts->value[i];
        if (!(count >= 0 && count <= (double)(n - at)) || count != floor(count))
            return err_set(err, STATUS_INPUT, "%s: vertex %zu has %g neighbours of the %zu left",
                           reader->graph->name, i, count, n - at);
        for (size_t end = at + (size_t)count; at < end; at++) {
            const double corner[] = {(double)i, list->value[at]};
            if (corner[1] > corner[0])
                TRY(vtk_add_line(data, data->n_cells++, corner, 2, 0, err));
        }
    }
    return add_origins(reader, err);
}

static Status add_network(Reader *reader, Err *err)
{
    Status status = reader->content == SPATIAL_GRAPH ? add_spatial_graph(reader, err)
                    : reader->content == LINE_SET    ? add_line_set(reader, err)
                                                     : add_skeleton(reader, err);
    if (status == STATUS_OK && reader->content != SPATIAL_GRAPH)
        status = add_arrays(reader, NULL, err);
    return status == STATUS_OK ? vtk_to_graph(&reader->data, reader->graph, err) : status;
}

Status amira_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    Reader reader = {.graph = graph, .bytes = bytes, .at = bytes, .end = bytes + size};
    graph->unit = LENGTH_UM;
    Status status = read_header(&reader, err);
    if (status == STATUS_OK)
        status = read_blocks(&reader, err);
    status = blame(&reader, status, err);
    if (status == STATUS_OK)
        status = add_network(&reader, err);
    release(&reader);
    return status;
}

bool amira_detect(const char *start)
{
    return strncasecmp(start, "# AmiraMesh", 11) == 0 || strncasecmp(start, "# Avizo", 7) == 0;
}
