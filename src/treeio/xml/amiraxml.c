/* Reads Amira's spatial graph as a workbook of Excel's XML. The first row of a worksheet names its
 * columns. The worksheet Points has one point per row, with its position and its thickness, which
 * is the radius. The worksheet Segments has one polyline per row, with the ids of its points.
 * Segments that meet have end points of their own at one position, so the worksheet Nodes is not
 * needed. Segments have no direction. */
#include "treeio/formats.h"
#include "treeio/xml.h"
#include "treeio/xml/namednetwork.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The maximum number of columns of a worksheet in Excel 2003, whose format this is. */
enum { MAX_COLUMNS = 256 };

typedef struct WorkbookReader {
    NamedNetwork network;
    Slabs texts;
    bool is_read;    /* the worksheet is Points or Segments */
    GraphElement of; /* what its rows are */
    bool in_row;
    size_t row, column;       /* the current cell, from 0 on */
    char *title[MAX_COLUMNS]; /* per column: borrowed from `texts`, or NULL */
} WorkbookReader;

static void begin_worksheet(WorkbookReader *reader, const char *name)
{
    bool is_points = name && strcasecmp(name, "Points") == 0;
    reader->is_read = is_points || (name && strcasecmp(name, "Segments") == 0);
    reader->of = is_points ? GRAPH_POINTS : GRAPH_LINES;
    reader->row = 0;
    memset(reader->title, 0, sizeof reader->title);
}

/* A cell states its column if cells before it are left out. */
static Status begin_cell(WorkbookReader *reader, const XmlElement *element, Err *err)
{
    const char *index = xml_attribute(element, "Index");
    long long number;
    if (!index)
        return STATUS_OK;
    if (!integer_parse(index, 1, MAX_COLUMNS, &number))
        return err_set(err, STATUS_INPUT, "the Index of a cell is '%.40s'; it must be 1 to %d",
                       index, MAX_COLUMNS);
    reader->column = (size_t)number - 1;
    return STATUS_OK;
}

/* Handles a start tag: of a worksheet, a row or a cell. */
static Status begin(void *context, Xml *xml, const XmlElement *element, Err *err)
{
    WorkbookReader *reader = context;
    if (strcmp(element->name, "Worksheet") == 0)
        begin_worksheet(reader, xml_attribute(element, "Name"));
    if (strcmp(element->name, "Cell") == 0)
        return begin_cell(reader, element, err);
    if (strcmp(element->name, "Row") != 0)
        return STATUS_OK;
    reader->in_row = true;
    reader->column = 0;
    if (reader->row == 0 || !reader->is_read)
        return STATUS_OK;
    return namednetwork_begin(&reader->network, reader->of, xml_line(xml), err);
}

/* Reads a cell of a row after the titles. */
static Status read_value(WorkbookReader *reader, const char *title, char *text, size_t line,
                         Err *err)
{
    double value;
    if (reader->of == GRAPH_LINES && strcasecmp(title, "Point IDs") == 0) {
        for (char *id; (id = text_field(&text));)
            TRY(namednetwork_add_end(&reader->network, id, err));
        return STATUS_OK;
    }
    if (reader->of == GRAPH_POINTS && strcasecmp(title, "Point ID") == 0)
        return namednetwork_name(&reader->network, text, line, err);
    return number_parse(text, &value)
               ? namednetwork_set(&reader->network, reader->of, title, value, err)
               : STATUS_OK;
}

static Status end_cell(WorkbookReader *reader, char *text, size_t line, Err *err)
{
    if (!reader->is_read || !reader->in_row)
        return STATUS_OK;
    if (reader->column >= MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "a row has more than %d cells, the maximum", MAX_COLUMNS);
    char **title = &reader->title[reader->column];
    if (reader->row > 0)
        return *title ? read_value(reader, *title, text, line, err) : STATUS_OK;
    *title = slabs_text(&reader->texts, text);
    return *title ? STATUS_OK : mem_out_of("for", "titles", err);
}

static Status end(void *context, Xml *xml, const char *name, char *text, Err *err)
{
    WorkbookReader *reader = context;
    if (strcmp(name, "Data") == 0)
        return end_cell(reader, text, xml_line(xml), err);
    reader->column += strcmp(name, "Cell") == 0;
    if (strcmp(name, "Row") == 0) {
        reader->in_row = false;
        reader->row++;
    }
    return STATUS_OK;
}

Status amiraxml_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    static const XmlHandlers handlers = {begin, end};
    static const char *const axes[] = {"X Coord", "Y Coord", "Z Coord"};
    WorkbookReader reader = {.network = namednetwork_new("point", size)};
    Status status = STATUS_OK;
    graph->line_record = "segment";
    graph->unit = LENGTH_UM;
    TRY_GOTO(xml_read(graph->name, bytes, size, &handlers, &reader, err));
    TRY_GOTO(namednetwork_to_graph(&reader.network, axes, graph, err));
done:
    slabs_release(&reader.texts);
    namednetwork_release(&reader.network);
    return status;
}

bool amiraxml_detect(const char *start)
{
    return xml_begins(start, "Workbook");
}
