/* Amira's spatial graph as a workbook of Excel's XML: the worksheet Points has a point a row, with
 * its place and thickness, which is the radius, and Segments has a polyline a row, through the
 * points of a list of ids. Ends of segments are points of their own each, which lie at one place
 * where segments meet; so the worksheet Nodes has nothing to add. The first row of a worksheet
 * names its columns. Segments have no direction. */
#include "treeio/formats.h"
#include "treeio/names.h"
#include "treeio/vtk/attributes.h"
#include "treeio/xml.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_COLUMNS = 256 };

typedef enum Sheet { SHEET_POINTS, SHEET_SEGMENTS, SHEET_OTHER } Sheet;

typedef struct Reader {
    const char *name; /* of the file */
    Slabs texts;
    Sheet sheet;
    size_t row, column;        /* of the worksheet, from 0 on; the cell that is read */
    char *title[MOST_COLUMNS]; /* of the columns; of texts, NULL where there is none */
    Names points;              /* by their ids */
    Attributes of_points, of_segments;
    char **list;  /* of each segment: the ids of its points; of texts */
    size_t *line; /* of each segment, in the file */
    size_t n_lists, lists_capacity, lines_capacity;
    VtkData data;
} Reader;

static Sheet sheet_of(const char *name)
{
    if (name && strcasecmp(name, "Points") == 0)
        return SHEET_POINTS;
    return name && strcasecmp(name, "Segments") == 0 ? SHEET_SEGMENTS : SHEET_OTHER;
}

static void begin_sheet(Reader *reader, const XmlElement *element)
{
    reader->sheet = sheet_of(xml_attribute(element, "Name"));
    reader->row = 0;
    memset(reader->title, 0, sizeof reader->title);
}

/* A cell may say its place, if some before it are left out. */
static Status begin_cell(Reader *reader, const XmlElement *element, Err *err)
{
    const char *index = xml_attribute(element, "Index");
    long long number;
    if (!index)
        return STATUS_OK;
    if (!integer_parse(index, 1, MOST_COLUMNS, &number))
        return err_set(err, STATUS_INPUT, "the Index of a cell is '%.40s'; it may be 1 to %d",
                       index, MOST_COLUMNS);
    reader->column = (size_t)number - 1;
    return STATUS_OK;
}

/* A row of values: an element. */
static Status begin_element(Reader *reader, size_t line, Err *err)
{
    if (reader->sheet == SHEET_POINTS)
        attributes_add(&reader->of_points);
    if (reader->sheet != SHEET_SEGMENTS)
        return STATUS_OK;
    attributes_add(&reader->of_segments);
    TRY(mem_reserve(&reader->list, &reader->lists_capacity, reader->n_lists + 1,
                    sizeof *reader->list, "segments", err));
    TRY(mem_reserve(&reader->line, &reader->lines_capacity, reader->n_lists + 1,
                    sizeof *reader->line, "segments", err));
    reader->line[reader->n_lists] = line;
    reader->list[reader->n_lists++] = NULL;
    return STATUS_OK;
}

static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    Reader *reader = context;
    if (strcmp(element->name, "Worksheet") == 0)
        begin_sheet(reader, element);
    if (strcmp(element->name, "Cell") == 0)
        return begin_cell(reader, element, err);
    if (strcmp(element->name, "Row") != 0)
        return STATUS_OK;
    reader->column = 0;
    return reader->row > 0 ? begin_element(reader, xml_line(xml), err) : STATUS_OK;
}

static Status take_title(Reader *reader, const char *text, Err *err)
{
    reader->title[reader->column] = slabs_text(&reader->texts, text);
    return reader->title[reader->column] ? STATUS_OK : mem_out_of("for", "titles", err);
}

static Status take_value(Reader *reader, const char *title, char *text, size_t line, Err *err)
{
    bool of_point = reader->sheet == SHEET_POINTS;
    double value;
    if (!of_point && strcasecmp(title, "Point IDs") == 0) {
        char **list = &reader->list[reader->n_lists - 1];
        *list = slabs_text(&reader->texts, text);
        return *list ? STATUS_OK : mem_out_of("for", "segments", err);
    }
    if (of_point && strcasecmp(title, "Point ID") == 0) {
        char *id = slabs_text(&reader->texts, text);
        if (!id)
            return mem_out_of("for", "points", err);
        return names_add(&reader->points, id, reader->of_points.n - 1, line, err);
    }
    if (!number_parse(text, &value))
        return STATUS_OK;
    return attributes_set(of_point ? &reader->of_points : &reader->of_segments, title, value, err);
}

static Status end_cell(Reader *reader, char *text, size_t line, Err *err)
{
    if (reader->sheet == SHEET_OTHER)
        return STATUS_OK;
    if (reader->column >= MOST_COLUMNS)
        return err_set(err, STATUS_INPUT, "a row has more than %d cells", MOST_COLUMNS);
    if (reader->row == 0)
        return take_title(reader, text, err);
    const char *title = reader->title[reader->column];
    return title ? take_value(reader, title, text, line, err) : STATUS_OK;
}

static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    Reader *reader = context;
    if (strcmp(name, "Data") == 0)
        return end_cell(reader, text, xml_line(xml), err);
    reader->column += strcmp(name, "Cell") == 0;
    reader->row += strcmp(name, "Row") == 0;
    return STATUS_OK;
}

/* The line of segment `i` through the points of its list, of which there may be `most`. */
static Status add_line(Reader *reader, size_t i, double *corner, Err *err)
{
    size_t n = 0;
    for (char *at = reader->list[i], *id; at && (id = text_field(&at));) {
        size_t number;
        TRY(names_find(&reader->points, id, &number, err));
        corner[n++] = (double)number;
    }
    if (n < 2)
        return err_set(err, STATUS_INPUT, "the segment has %zu of its points; it must have two", n);
    return vtk_add_line(&reader->data, i, corner, n, 0, err);
}

static Status add_lines(Reader *reader, Err *err)
{
    double *corner = NULL;
    size_t capacity = 0;
    Status status = STATUS_OK;
    for (size_t i = 0; i < reader->n_lists && status == STATUS_OK; i++) {
        size_t most = reader->list[i] ? strlen(reader->list[i]) : 0;
        status = mem_reserve(&corner, &capacity, most + 1, sizeof *corner, "segments", err);
        if (status == STATUS_OK)
            status = add_line(reader, i, corner, err);
        if (status == STATUS_INPUT)
            err_prefix(err, "%s:%zu: ", reader->name, reader->line[i]);
    }
    free(corner);
    return status;
}

static Status to_graph(Reader *reader, Graph *graph, Err *err)
{
    static const char *const axes[] = {"X Coord", "Y Coord", "Z Coord"};
    VtkData *data = &reader->data;
    data->n_points = reader->of_points.n;
    data->n_cells = reader->n_lists;
    TRY(add_lines(reader, err));
    TRY(attributes_take(&reader->of_points, &data->of_points, err));
    TRY(attributes_take(&reader->of_segments, &data->of_cells, err));
    TRY(attributes_to_places(data, axes, graph->name, err));
    graph->line_record = "segment";
    graph->unit = LENGTH_UM;
    return vtk_to_graph(data, graph, err);
}

Status amiraxml_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static const XmlHandlers handlers = {begin, end};
    Reader reader = {.name = graph->name,
                     .sheet = SHEET_OTHER,
                     .points = {.what = "point"},
                     .of_points = {.file_size = size},
                     .of_segments = {.file_size = size}};
    Status status = xml_read(graph->name, bytes, size, &handlers, &reader, err);
    if (status == STATUS_OK)
        status = to_graph(&reader, graph, err);
    slabs_release(&reader.texts);
    names_release(&reader.points);
    attributes_release(&reader.of_points);
    attributes_release(&reader.of_segments);
    free(reader.list);
    free(reader.line);
    vtk_release(&reader.data);
    return status;
}

bool amiraxml_detect(const char *start)
{
    return xml_begins(start, "Workbook");
}
