/* Reads VTK's XML, of poly data or of unstructured grids. The element around an array defines the
 * use of the array: points, cells, or values of either. Numbers inside the document are read with
 * their element. Numbers in the element AppendedData need not be XML, so they are read after the
 * document. At the end, the points, cells and arrays of all pieces are joined. */
#include "treeio/cursor.h"
#include "treeio/formats.h"
#include "treeio/vtk/vtkdata.h"
#include "treeio/vtk/vtpbytes.h"
#include "treeio/xml.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The elements that hold arrays: those of VtkData.arrays, points, and cells of each kind. */
enum { SECTION_POINTS = VTK_ELEMENTS, SECTION_CELLS, SECTIONS = SECTION_CELLS + VTK_CELL_KINDS };

static const char *section_name(size_t section)
{
    static const char *const names[SECTION_CELLS] = {[GRAPH_POINTS] = "PointData",
                                                     [GRAPH_LINES] = "CellData",
                                                     [VTK_OF_FILE] = "FieldData",
                                                     [SECTION_POINTS] = "Points"};
    return section < SECTION_CELLS ? names[section] : vtk_cell_kinds[section - SECTION_CELLS].xml;
}

/* An array of the file. */
typedef struct XmlArray {
    VtkArray array; /* has its values already unless is_appended */
    VtkType type;
    bool is_appended;
    size_t offset; /* of the first byte in the appended data */
    size_t section, piece;
    double max_numbers; /* maximum count of numbers [max_numbers_of] */
} XmlArray;

typedef struct VtpReader {
    const char *name, *bytes;
    size_t size;
    VtpCoding coding;
    ARRAY(XmlArray) arrays;
    size_t pieces;
    double points, cells;         /* of the current piece; 0 before the first piece */
    double all_points, all_cells; /* of the pieces so far */
    double taken;                 /* bytes of memory for the numbers of all arrays so far */
    bool in_array;                /* the text of the current element is numbers */
    bool is_base64;               /* these numbers, or the appended data, are in base64 */
    size_t appended;              /* position of the appended data; 0: there are none */
} VtpReader;

/* ---- elements -------------------------------------------------------------------------------- */

/* Values of the attribute `compressor`. */
static const char *const packings[VTP_PACKINGS] = {
    [VTP_PLAIN] = "", [VTP_ZLIB] = "vtkZLibDataCompressor", [VTP_LZ4] = "vtkLZ4DataCompressor"};

/* Returns the value of an attribute, or "" if the element has none of this name. */
static const char *attribute_or_empty(const XmlElement *element, const char *name)
{
    const char *value = xml_attribute(element, name);
    return value ? value : "";
}

/* Reads the outermost element: the kind of dataset, the byte order and the compression. */
static Status read_file_element(VtpReader *reader, const XmlElement *element, Err *err)
{
    const char *type = attribute_or_empty(element, "type");
    const char *compressor = attribute_or_empty(element, "compressor");
    if (strcmp(type, "PolyData") != 0 && strcmp(type, "UnstructuredGrid") != 0)
        return err_set(err, STATUS_INPUT,
                       "the file has the type '%.40s'; it must be PolyData or UnstructuredGrid",
                       type);
    int packing = VTP_PLAIN;
    while (packing < VTP_PACKINGS && strcmp(packings[packing], compressor) != 0)
        packing++;
    if (packing == VTP_PACKINGS)
        return err_set(err, STATUS_INPUT, "the compressor is %.60s; it must be %s or %s",
                       compressor, packings[VTP_ZLIB], packings[VTP_LZ4]);
    reader->coding = (VtpCoding){
        .is_big_endian = strcmp(attribute_or_empty(element, "byte_order"), "BigEndian") == 0,
        .packing = (VtpPacking)packing,
        .header_size = strcmp(attribute_or_empty(element, "header_type"), "UInt64") == 0 ? 8 : 4};
    return STATUS_OK;
}

/* Reads a count from 0 to `most`; *out is `otherwise` if the element has no such attribute. */
static Status read_whole(const XmlElement *element, const char *name, long long most,
                         size_t otherwise, size_t *out, Err *err)
{
    const char *text = xml_attribute(element, name);
    long long number = (long long)otherwise;
    if (text && !integer_parse(text, 0, most, &number))
        return err_set(err, STATUS_INPUT, "%s is '%.40s'; it must be an integer up to %lld", name,
                       text, most);
    *out = (size_t)number;
    return STATUS_OK;
}

/* Begins a piece: reads its counts, and checks them against the size of the file. */
static Status begin_piece(VtpReader *reader, const XmlElement *element, Err *err)
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

/* Returns the maximum count of numbers, or bytes of text, of an array. Arrays of points and cells
 * have one tuple per element. The file does not state the length of other arrays. Their limit, a
 * million and a hundred per point and cell, exceeds the length of any known file. */
static double max_numbers_of(const VtpReader *reader, const XmlArray *of)
{
    double components = (double)of->array.components;
    if (of->type != VTK_TEXT && (of->section == SECTION_POINTS || of->section == GRAPH_POINTS))
        return reader->points * components;
    if (of->type != VTK_TEXT && of->section == GRAPH_LINES)
        return reader->cells * components;
    return fmin(100 * (reader->points + reader->cells) + 1e6, 2 * max_elements(reader->size));
}

/* Begins an array: reads its attributes, and bounds its length. */
static Status begin_array(VtpReader *reader, size_t section, const XmlElement *element, Err *err)
{
    enum { MAX_COMPONENTS = 1000 };
    const char *type = NULL, *format = attribute_or_empty(element, "format");
    XmlArray made = {.section = section, .piece = reader->pieces};
    TRY(xml_require_attribute(element, "type", &type, err));
    TRY(vtk_find_type(NAMING_XML, type, NULL, &made.type, err));
    made.is_appended = strcmp(format, "appended") == 0;
    reader->is_base64 = strcmp(format, "binary") == 0;
    TRY(read_whole(element, "NumberOfComponents", MAX_COMPONENTS, 1, &made.array.components, err));
    TRY(read_whole(element, "offset", INT64_MAX, 0, &made.offset, err));
    if (made.array.components == 0)
        made.array.components = 1;
    made.max_numbers = max_numbers_of(reader, &made);
    TRY(ARRAY_RESERVE(&reader->arrays, 1, "arrays", err));
    TRY(mem_strdup(&made.array.name, attribute_or_empty(element, "Name"), err));
    reader->arrays.items[reader->arrays.n++] = made;
    reader->in_array = !made.is_appended;
    return STATUS_OK;
}

static bool is_array_element(const char *name)
{
    return strcmp(name, "DataArray") == 0 || strcmp(name, "Array") == 0;
}

/* Handles a start tag. The document is parsed up to the appended data, which need not be XML. */
static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    VtpReader *reader = context;
    if (xml_depth(xml) == 0) {
        if (strcmp(element->name, "VTKFile") != 0)
            return err_set(err, STATUS_INPUT,
                           "the outermost element is <%.40s>; it must be <VTKFile>", element->name);
        return read_file_element(reader, element, err);
    }
    if (strcmp(element->name, "Piece") == 0)
        return begin_piece(reader, element, err);
    if (strcmp(element->name, "AppendedData") == 0) {
        reader->is_base64 = strcmp(attribute_or_empty(element, "encoding"), "raw") != 0;
        reader->appended = xml_offset(xml);
        xml_stop(xml);
        return STATUS_OK;
    }
    for (size_t section = 0; is_array_element(element->name) && section < SECTIONS; section++)
        if (strcmp(section_name(section), xml_ancestor(xml, 1)) == 0)
            return begin_array(reader, section, element, err);
    return STATUS_OK;
}

/* ---- values ---------------------------------------------------------------------------------- */

/* Reads the numbers of a text that stand between blanks. */
static Status parse_numbers(VtkArray *array, char *text, size_t *n, Err *err)
{
    static const char blanks[] = " \t\r\n";
    for (char *at = text + strspn(text, blanks), *next; *at; at = next) {
        char *end = at + strcspn(at, blanks);
        next = end + strspn(end, blanks);
        *end = '\0';
        TRY(mem_reserve(&array->value, &array->capacity, *n + 1, sizeof *array->value,
                        "numbers of an array", err));
        if (!number_parse(at, &array->value[*n]))
            return err_set(err, STATUS_INPUT, "'%.40s' is not a number%s", at,
                           decimal_comma_hint(at));
        ++*n;
    }
    return STATUS_OK;
}

/* Converts an array of `n` numbers, the codes of characters, to text. */
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

/* Finishes an array that has `n` numbers. */
static Status finish_array(XmlArray *of, size_t n, Err *err)
{
    if (of->type == VTK_TEXT)
        return to_text(&of->array, n, err);
    of->array.n = n / of->array.components;
    if (n % of->array.components != 0)
        return err_set(err, STATUS_INPUT,
                       "it has %zu numbers, which is not a multiple of its %zu components", n,
                       of->array.components);
    return STATUS_OK;
}

/* Decodes an array that begins at `from`; the text or the file ends at `end`. */
static Status decode(VtpReader *reader, XmlArray *of, const char *from, const char *end, Err *err)
{
    VtpBytes got;
    const VtpSource source = {.name = reader->name,
                              .file_size = reader->size,
                              .coding = reader->coding,
                              .is_base64 = reader->is_base64,
                              .from = from,
                              .end = end,
                              .max_numbers = of->max_numbers,
                              .number_size = vtk_type_size(of->type),
                              .taken = reader->taken};
    TRY(vtp_decode(&source, &got, err));
    size_t n = got.size / source.number_size;
    reader->taken += (double)n * sizeof *of->array.value;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&of->array.value, n, sizeof *of->array.value, "numbers", err));
    vtk_numbers(of->type, reader->coding.is_big_endian, got.bytes, n, of->array.value);
    status = finish_array(of, n, err);
done:
    free(got.decoded);
    return status;
}

static Status blame_array(const XmlArray *of, Status status, Err *err)
{
    if (status == STATUS_INPUT)
        err_prefix(err, "the array '%.60s' of %s: ", of->array.name, section_name(of->section));
    return status;
}

static Status read_values(VtpReader *reader, XmlArray *of, char *text, Err *err)
{
    size_t n = 0;
    if (reader->is_base64)
        return decode(reader, of, text, text + strlen(text), err);
    TRY(parse_numbers(&of->array, text, &n, err));
    return finish_array(of, n, err);
}

static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    (void)xml;
    VtpReader *reader = context;
    if (!reader->in_array || !is_array_element(name))
        return STATUS_OK;
    reader->in_array = false;
    XmlArray *of = &reader->arrays.items[reader->arrays.n - 1];
    return blame_array(of, read_values(reader, of, text, err), err);
}

/* Decodes the appended arrays. Their data begin after the first '_' that follows the start tag. */
static Status decode_appended(VtpReader *reader, Err *err)
{
    const char *from = NULL, *end_of_file = reader->bytes + reader->size;
    if (reader->appended) {
        from = memchr(reader->bytes + reader->appended, '>', reader->size - reader->appended);
        from = from ? memchr(from, '_', (size_t)(end_of_file - from)) : NULL;
    }
    size_t size = from ? (size_t)(end_of_file - from) - 1 : 0;
    for (size_t i = 0; i < reader->arrays.n; i++) {
        XmlArray *of = &reader->arrays.items[i];
        if (!of->is_appended)
            continue;
        Status status = of->offset < size
                            ? decode(reader, of, from + 1 + of->offset, end_of_file, err)
                            : err_set(err, STATUS_INPUT,
                                      "its offset is %zu, but the appended data has only %zu bytes",
                                      of->offset, size);
        if (blame_array(of, status, err) == STATUS_INPUT)
            err_prefix(err, "%s: ", reader->name);
        TRY(status);
    }
    return STATUS_OK;
}

/* ---- pieces ---------------------------------------------------------------------------------- */

/* Returns the array of a section of a piece that has this name (NULL: any), or NULL. Case does not
 * matter. */
static XmlArray *find_array(const VtpReader *reader, size_t piece, size_t section, const char *name)
{
    for (size_t i = 0; i < reader->arrays.n; i++) {
        XmlArray *of = &reader->arrays.items[i];
        if (of->piece == piece && of->section == section &&
            (!name || strcasecmp(of->array.name, name) == 0))
            return of;
    }
    return NULL;
}

/* Adds the points of a piece. The array of the first piece is moved, to save a copy; the points of
 * later pieces are appended. */
static Status add_points(const VtpReader *reader, size_t piece, VtkData *data, Err *err)
{
    XmlArray *of = find_array(reader, piece, SECTION_POINTS, NULL);
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

/* Adds the cells of a piece, of all kinds. */
static Status add_cells(const VtpReader *reader, size_t piece, VtkData *data, size_t first_point,
                        Err *err)
{
    for (size_t k = 0; k < VTK_CELL_KINDS; k++) {
        const VtkCellKind *kind = &vtk_cell_kinds[k];
        XmlArray *corners = find_array(reader, piece, SECTION_CELLS + k, "connectivity");
        XmlArray *ends = find_array(reader, piece, SECTION_CELLS + k, "offsets");
        const XmlArray *types =
            kind->has_types ? find_array(reader, piece, SECTION_CELLS + k, "types") : NULL;
        if (!corners || !ends)
            continue;
        if (kind->has_types && (!types || types->array.n != ends->array.n))
            return err_set(err, STATUS_INPUT, "cells must have exactly one type each");
        const VtkCells cells = {.corner = corners->array.value,
                                .end = ends->array.value,
                                .type = types ? types->array.value : NULL,
                                .n = ends->array.n,
                                .n_corners = corners->array.n};
        TRY(vtk_add_cells(data, &cells, kind, first_point, err));
        vtk_release_array(&corners->array);
        vtk_release_array(&ends->array);
    }
    return STATUS_OK;
}

/* Appends the values of an array of a later piece to the same array of the first piece. Text is
 * ignored. */
static Status append_values(VtkArray *to, const VtkArray *more, Err *err)
{
    size_t n = to->n * to->components, added = more->n * more->components, capacity = n;
    if (!to->value && !more->value)
        return STATUS_OK;
    if (to->components != more->components || !to->value || !more->value)
        return err_set(err, STATUS_INPUT,
                       "the array '%.60s' must have the same components in all pieces", to->name);
    TRY(mem_reserve(&to->value, &capacity, n + added, sizeof *to->value, "values", err));
    memcpy(to->value + n, more->value, added * sizeof *to->value);
    to->n += more->n;
    return STATUS_OK;
}

/* Moves the arrays of elements of a kind to data->arrays. */
static Status move_arrays(VtpReader *reader, size_t piece, size_t section, VtkData *data, Err *err)
{
    VtkArrays *arrays = &data->arrays[section];
    for (size_t i = 0; i < reader->arrays.n; i++) {
        XmlArray *of = &reader->arrays.items[i];
        if (of->piece != piece || of->section != section)
            continue;
        VtkArray *before =
            piece > 1 && section != VTK_OF_FILE ? vtk_find_array(arrays, of->array.name) : NULL;
        if (before) {
            TRY(append_values(before, &of->array, err));
            continue;
        }
        VtkArray moved = of->array;
        of->array = (VtkArray){0};
        TRY(vtk_add_array(arrays, &moved, err));
    }
    return STATUS_OK;
}

/* Joins all pieces. Piece 0 stands for the arrays of the file, which come before the first piece.
 */
static Status join_pieces(VtpReader *reader, VtkData *data, Err *err)
{
    for (size_t piece = 0; piece <= reader->pieces; piece++) {
        size_t first_point = data->n_points;
        TRY(add_points(reader, piece, data, err));
        TRY(add_cells(reader, piece, data, first_point, err));
        for (size_t section = 0; section < VTK_ELEMENTS; section++)
            TRY(move_arrays(reader, piece, section, data, err));
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
    VtpReader reader = {.name = graph->name, .bytes = bytes, .size = size};
    VtkData data = {0};
    Status status = STATUS_OK;
    TRY_GOTO(xml_read(graph->name, bytes, size, &handlers, &reader, err));
    TRY_GOTO(decode_appended(&reader, err));
    status = join_pieces(&reader, &data, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", graph->name);
    TRY_GOTO(status);
    TRY_GOTO(vtk_to_graph(&data, graph, err));
done:
    for (size_t i = 0; i < reader.arrays.n; i++)
        vtk_release_array(&reader.arrays.items[i].array);
    ARRAY_RELEASE(&reader.arrays);
    vtk_release(&data);
    return status;
}
