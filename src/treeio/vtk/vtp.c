/* VTK's XML: its arrays are gathered as the elements come, those with numbers in the document at
 * once, and those in the AppendedData behind it, which need not be XML, when that has been found.
 * Then the pieces are put together. The element around an array says what it is for. */
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"
#include "treeio/vtk/vtpbytes.h"
#include "treeio/xml.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum Section {
    POINT_DATA,
    CELL_DATA,
    FIELD_DATA,
    POINTS,
    VERTS,
    LINES,
    STRIPS,
    POLYS,
    CELLS,
    SECTIONS
} Section;

static const char *const section_names[SECTIONS] = {
    "PointData", "CellData", "FieldData", "Points", "Verts", "Lines", "Strips", "Polys", "Cells"};

/* An array of the file. */
typedef struct Array {
    VtkArray array; /* values are there unless it is appended */
    const VtkType *type;
    bool is_text, is_appended;
    size_t offset; /* in the appended data */
    Section section;
    size_t piece;
    double most; /* numbers that it can have, as its piece says */
} Array;

typedef struct Reader {
    const char *name, *bytes;
    size_t size;
    VtpCoding coding;
    Array *array;
    size_t n, capacity;
    size_t pieces;
    double points, cells;         /* as the piece that is being read says; 0 before the first */
    double all_points, all_cells; /* of the pieces so far */
    double taken;                 /* bytes that the numbers of all arrays take so far */
    bool in_array, is_base64;     /* of the array, or the appended data */
    size_t appended;              /* where its first byte is; 0: there is none */
} Reader;

/* What the attribute `compressor` says. */
static const char *const packings[] = {
    [VTP_PLAIN] = "", [VTP_ZLIB] = "vtkZLibDataCompressor", [VTP_LZ4] = "vtkLZ4DataCompressor"};

static Status read_file_element(Reader *reader, const XmlElement *element, Err *err)
{
    const char *type = xml_attribute(element, "type"),
               *order = xml_attribute(element, "byte_order");
    const char *header = xml_attribute(element, "header_type");
    const char *compressor = xml_attribute(element, "compressor");
    if (!type || (strcmp(type, "PolyData") != 0 && strcmp(type, "UnstructuredGrid") != 0))
        return err_set(err, STATUS_INPUT,
                       "the file is of type '%.40s'; lines are in PolyData and UnstructuredGrid",
                       type ? type : "");
    int packing = VTP_PLAIN;
    while (packing <= VTP_LZ4 && strcmp(packings[packing], compressor ? compressor : "") != 0)
        packing++;
    if (packing > VTP_LZ4)
        return err_set(err, STATUS_INPUT, "it is compressed by %.60s; %s and %s are read",
                       compressor, packings[VTP_ZLIB], packings[VTP_LZ4]);
    reader->coding = (VtpCoding){.is_big_endian = order && strcmp(order, "BigEndian") == 0,
                                 .packing = (VtpPacking)packing,
                                 .header_size = header && strcmp(header, "UInt64") == 0 ? 8 : 4};
    return STATUS_OK;
}

static Section section_of(const char *name)
{
    int section = 0;
    while (section < SECTIONS && strcmp(section_names[section], name) != 0)
        section++;
    return (Section)section;
}

static Status read_whole(const XmlElement *element, const char *name, long long most,
                         size_t otherwise, size_t *out, Err *err)
{
    const char *text = xml_attribute(element, name);
    long long number = (long long)otherwise;
    if (text && !integer_parse(text, 0, most, &number))
        return err_set(err, STATUS_INPUT, "%s is '%.40s'; it must be a whole number up to %lld",
                       name, text, most);
    *out = (size_t)number;
    return STATUS_OK;
}

static Status begin_piece(Reader *reader, const XmlElement *element, Err *err)
{
    static const char *const of_cells[] = {"NumberOfCells", "NumberOfVerts", "NumberOfLines",
                                           "NumberOfStrips", "NumberOfPolys"};
    size_t n;
    TRY(read_whole(element, "NumberOfPoints", INT64_MAX, 0, &n, err));
    reader->pieces++;
    reader->points = (double)n;
    reader->cells = 0;
    for (size_t k = 0; k < sizeof of_cells / sizeof *of_cells; k++) {
        TRY(read_whole(element, of_cells[k], INT64_MAX, 0, &n, err));
        reader->cells += (double)n;
    }
    reader->all_points += reader->points;
    reader->all_cells += reader->cells;
    TRY(check_elements("points", reader->all_points, reader->size, err));
    return check_elements("cells", reader->all_cells, reader->size, err);
}

/* How many numbers, or bytes of text, an array can have. Nothing says how long lines, texts and the
 * file's own data are: a hundred for each point and cell and a million besides are more than any of
 * ours takes. */
static double most_numbers(const Reader *reader, const Array *of)
{
    if (!of->is_text && (of->section == POINTS || of->section == POINT_DATA))
        return reader->points * (double)of->array.components;
    if (!of->is_text && of->section == CELL_DATA)
        return reader->cells * (double)of->array.components;
    return fmin(100 * (reader->points + reader->cells) + 1e6, 2 * most_elements(reader->size));
}

static Status begin_array(Reader *reader, Section section, const XmlElement *element, Err *err)
{
    enum { MOST_COMPONENTS = 1000 };
    const char *type = NULL, *name = xml_attribute(element, "Name");
    const char *format = xml_attribute(element, "format");
    Array made = {.section = section, .piece = reader->pieces};
    TRY(xml_needed(element, "type", &type, err));
    made.is_text = strcmp(type, "String") == 0;
    made.type = vtk_type_of_xml(made.is_text ? "UInt8" : type);
    if (!made.type)
        return err_set(err, STATUS_INPUT, "'%.40s' is no type of an array", type);
    made.is_appended = format && strcmp(format, "appended") == 0;
    reader->is_base64 = format && strcmp(format, "binary") == 0;
    TRY(read_whole(element, "NumberOfComponents", MOST_COMPONENTS, 1, &made.array.components, err));
    TRY(read_whole(element, "offset", INT64_MAX, 0, &made.offset, err));
    if (made.array.components == 0)
        made.array.components = 1;
    made.most = most_numbers(reader, &made);
    TRY(mem_reserve(&reader->array, &reader->capacity, reader->n + 1, sizeof made, "arrays", err));
    TRY(mem_strdup(&made.array.name, name ? name : "", err));
    reader->array[reader->n++] = made;
    reader->in_array = !made.is_appended;
    return STATUS_OK;
}

static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    Reader *reader = context;
    if (xml_depth(xml) == 0) {
        if (strcmp(element->name, "VTKFile") != 0)
            return err_set(err, STATUS_INPUT, "the document is <%.40s>; VTK's are <VTKFile>",
                           element->name);
        return read_file_element(reader, element, err);
    }
    if (strcmp(element->name, "Piece") == 0)
        return begin_piece(reader, element, err);
    if (strcmp(element->name, "AppendedData") == 0) {
        const char *encoding = xml_attribute(element, "encoding");
        reader->is_base64 = !encoding || strcmp(encoding, "raw") != 0;
        reader->appended = xml_byte(xml);
        xml_stop(xml);
        return STATUS_OK;
    }
    Section section = section_of(xml_around(xml, 1));
    bool is_array = strcmp(element->name, "DataArray") == 0 || strcmp(element->name, "Array") == 0;
    return is_array && section < SECTIONS ? begin_array(reader, section, element, err) : STATUS_OK;
}

/* Numbers of a text, parted by blanks. */
static Status parse_numbers(char *text, double **out, size_t *n, Err *err)
{
    double *made = NULL;
    size_t capacity = 0, count = 0;
    for (char *at = text + strspn(text, " \t\r\n"); *at;) {
        char *end = at + strcspn(at, " \t\r\n"), *next = end + strspn(end, " \t\r\n");
        *end = '\0';
        Status status =
            mem_reserve(&made, &capacity, count + 1, sizeof *made, "numbers of an array", err);
        if (status == STATUS_OK && !number_parse(at, &made[count]))
            status =
                err_set(err, STATUS_INPUT, "'%.40s' is no number%s", at, decimal_comma_hint(at));
        if (status != STATUS_OK) {
            free(made);
            return status;
        }
        count++;
        at = next;
    }
    *out = made;
    *n = count;
    return STATUS_OK;
}

/* Makes text of numbers that are its bytes. */
static Status to_text(VtkArray *array, size_t n, Err *err)
{
    TRY(mem_calloc(&array->text, n + 1, 1, "bytes of text", err));
    for (size_t i = 0; i < n; i++) {
        double byte = array->value[i];
        array->text[i] = byte >= 0 && byte < 256 ? (char)(unsigned char)byte : ' ';
    }
    array->text_size = n;
    free(array->value);
    array->value = NULL;
    return STATUS_OK;
}

/* The array has these `n` numbers. */
static Status finish_array(Array *of, size_t n, Err *err)
{
    if (of->is_text)
        return to_text(&of->array, n, err);
    of->array.n = n / of->array.components;
    if (n % of->array.components != 0)
        return err_set(err, STATUS_INPUT, "it has %zu numbers, which are no tuples of %zu", n,
                       of->array.components);
    return STATUS_OK;
}

static Status decode(Reader *reader, Array *of, const char *from, size_t left, Err *err)
{
    const char *bytes = NULL;
    char *decoded = NULL;
    size_t size = 0;
    const VtpRoom room = {reader->name, reader->size, of->most, of->type->size, reader->taken};
    TRY(vtp_decode(&reader->coding, reader->is_base64, from, left, &room, &bytes, &size, &decoded,
                   err));
    size_t n = size / of->type->size;
    reader->taken += (double)n * sizeof *of->array.value;
    Status status = mem_calloc(&of->array.value, n, sizeof *of->array.value, "numbers", err);
    if (status == STATUS_OK) {
        vtk_numbers(of->type, reader->coding.is_big_endian, bytes, n, of->array.value);
        status = finish_array(of, n, err);
    }
    free(decoded);
    return status;
}

static Status blame_array(const Array *of, Status status, Err *err)
{
    if (status == STATUS_INPUT)
        err_prefix(err, "the array '%.60s' of %s: ", of->array.name, section_names[of->section]);
    return status;
}

static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    (void)xml;
    Reader *reader = context;
    if (!reader->in_array || (strcmp(name, "DataArray") != 0 && strcmp(name, "Array") != 0))
        return STATUS_OK;
    reader->in_array = false;
    Array *of = &reader->array[reader->n - 1];
    size_t n = 0;
    if (reader->is_base64)
        return blame_array(of, decode(reader, of, text, strlen(text), err), err);
    TRY(blame_array(of, parse_numbers(text, &of->array.value, &n, err), err));
    return blame_array(of, finish_array(of, n, err), err);
}

/* Decodes what is appended: behind the first '_' after the element's end. */
static Status decode_appended(Reader *reader, Err *err)
{
    const char *from = NULL, *end_of_file = reader->bytes + reader->size;
    if (reader->appended) {
        from = memchr(reader->bytes + reader->appended, '>', reader->size - reader->appended);
        from = from ? memchr(from, '_', (size_t)(end_of_file - from)) : NULL;
    }
    for (size_t i = 0; i < reader->n; i++) {
        Array *of = &reader->array[i];
        if (!of->is_appended)
            continue;
        size_t left = from ? (size_t)(end_of_file - from) - 1 : 0;
        Status status = of->offset < left
                            ? decode(reader, of, from + 1 + of->offset, left - of->offset, err)
                            : err_set(err, STATUS_INPUT,
                                      "it is said to be at byte %zu of the appended data, which "
                                      "has %zu",
                                      of->offset, left);
        if (blame_array(of, status, err) == STATUS_INPUT)
            err_prefix(err, "%s: ", reader->name);
        TRY(status);
    }
    return STATUS_OK;
}

/* ---- the pieces ------------------------------------------------------------------------------ */

static Array *find_array(const Reader *reader, size_t piece, Section section, const char *name)
{
    for (size_t i = 0; i < reader->n; i++) {
        Array *of = &reader->array[i];
        if (of->piece == piece && of->section == section &&
            (!name || strcasecmp(of->array.name, name) == 0))
            return of;
    }
    return NULL;
}

/* The points of the first piece are moved, those of others appended. */
static Status add_points(const Reader *reader, size_t piece, VtkData *data, Err *err)
{
    Array *of = find_array(reader, piece, POINTS, NULL);
    if (!of || !of->array.value)
        return STATUS_OK;
    if (of->array.components != 3)
        return err_set(err, STATUS_INPUT, "points have %zu coordinates; they must have 3",
                       of->array.components);
    size_t n = data->n_points + of->array.n;
    if (!data->point) {
        data->point = of->array.value;
        of->array.value = NULL;
        data->points_capacity = 3 * n;
    } else {
        TRY(mem_reserve(&data->point, &data->points_capacity, 3 * n, sizeof *data->point, "points",
                        err));
        memcpy(data->point + 3 * data->n_points, of->array.value,
               3 * of->array.n * sizeof *data->point);
    }
    data->n_points = n;
    return STATUS_OK;
}

/* Of an array that has been used. */
static void release_values(Array *of)
{
    free(of->array.value);
    of->array.value = NULL;
}

static Status add_cells(const Reader *reader, size_t piece, VtkData *data, size_t first_point,
                        Err *err)
{
    static const struct {
        Section section;
        int type;
    } kinds[] = {
        {VERTS, VTK_POLY_VERTEX}, {LINES, VTK_POLY_LINE}, {POLYS, 0}, {STRIPS, 0}, {CELLS, 0}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        Array *corners = find_array(reader, piece, kinds[k].section, "connectivity");
        Array *ends = find_array(reader, piece, kinds[k].section, "offsets");
        const Array *types = find_array(reader, piece, CELLS, "types");
        if (!corners || !ends)
            continue;
        bool has_types = kinds[k].section == CELLS;
        if (has_types && (!types || types->array.n != ends->array.n))
            return err_set(err, STATUS_INPUT, "cells have no types, or not as many");
        const VtkCells cells = {.corner = corners->array.value,
                                .end = ends->array.value,
                                .type = has_types ? types->array.value : NULL,
                                .n = ends->array.n,
                                .n_corners = corners->array.n,
                                .of = kinds[k].type};
        TRY(vtk_add_cells(data, &cells, first_point, err));
        release_values(corners);
        release_values(ends);
    }
    return STATUS_OK;
}

/* Appends the values of an array of a later piece to those of the first. */
static Status append_values(VtkArray *to, const VtkArray *more, Err *err)
{
    size_t n = to->n * to->components, added = more->n * more->components, capacity = n;
    if (!to->value && !more->value) /* text, which is left out */
        return STATUS_OK;
    if (to->components != more->components || !to->value || !more->value)
        return err_set(err, STATUS_INPUT, "the array '%.60s' differs from piece to piece",
                       to->name);
    TRY(mem_reserve(&to->value, &capacity, n + added, sizeof *to->value, "values", err));
    memcpy(to->value + n, more->value, added * sizeof *to->value);
    to->n += more->n;
    return STATUS_OK;
}

/* Moves the arrays of a section to `arrays`. */
static Status move_arrays(Reader *reader, size_t piece, Section section, VtkArrays *arrays,
                          Err *err)
{
    for (size_t i = 0; i < reader->n; i++) {
        Array *of = &reader->array[i];
        if (of->piece != piece || of->section != section)
            continue;
        VtkArray *before = NULL;
        for (size_t k = 0; piece > 1 && section != FIELD_DATA && k < arrays->n; k++)
            if (strcmp(arrays->array[k].name, of->array.name) == 0)
                before = &arrays->array[k];
        if (before) {
            TRY(append_values(before, &of->array, err));
        } else {
            VtkArray moved = of->array;
            of->array = (VtkArray){0};
            TRY(vtk_add_array(arrays, &moved, err));
        }
    }
    return STATUS_OK;
}

/* Arrays before the first piece are the file's. */
static Status join_pieces(Reader *reader, VtkData *data, Err *err)
{
    for (size_t piece = 0; piece <= reader->pieces; piece++) {
        size_t first_point = data->n_points;
        TRY(add_points(reader, piece, data, err));
        TRY(add_cells(reader, piece, data, first_point, err));
        TRY(move_arrays(reader, piece, POINT_DATA, &data->of_points, err));
        TRY(move_arrays(reader, piece, CELL_DATA, &data->of_cells, err));
        TRY(move_arrays(reader, piece, FIELD_DATA, &data->of_file, err));
    }
    return STATUS_OK;
}

bool vtp_detect(const char *start)
{
    return xml_begins(start, "VTKFile");
}

Status vtp_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static const XmlHandlers handlers = {begin, end};
    Reader reader = {.name = graph->name, .bytes = bytes, .size = size};
    VtkData data = {0};
    Status status = STATUS_OK;
    TRY_GOTO(xml_read(graph->name, bytes, size, &handlers, &reader, err));
    TRY_GOTO(decode_appended(&reader, err));
    status = join_pieces(&reader, &data, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", graph->name);
    if (status == STATUS_OK)
        status = vtk_to_graph(&data, graph, err);
done:
    for (size_t i = 0; i < reader.n; i++)
        vtk_release_array(&reader.array[i].array);
    free(reader.array);
    vtk_release(&data);
    return status;
}
