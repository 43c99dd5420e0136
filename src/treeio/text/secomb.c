/* Networks of Secomb's programs (network.dat), as GreensV4 reads them: six lines about the tissue,
 * and three tables, each behind a line that says how many rows it has and one that names its
 * columns: segments, nodes, boundary nodes. What follows the numbers of a line is a remark.
 * Diameters are in um, as coordinates are; flow is negative where it runs from the second node to
 * the first. Segments are kept until the nodes that they name are there. */
#include "treeio/formats.h"
#include "treeio/names.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_LINES = 6, MAX_FIELDS = 100 };

typedef enum Table { SEGMENTS, NODES, BOUNDARY, TABLES } Table;

static const struct {
    const char *rows, *count;
    size_t fewest; /* numbers in a row */
} tables[TABLES] = {[SEGMENTS] = {"segments", "number of segments", 5},
                    [NODES] = {"nodes", "number of nodes", 4},
                    [BOUNDARY] = {"boundary nodes", "number of boundary nodes", 3}};

/* Columns of the segments and of the boundary nodes: where in a row, what they are called. */
typedef struct NetworkColumn {
    Table table;
    size_t field;
    const char *name, *unit;
} NetworkColumn;

static const NetworkColumn columns[] = {{SEGMENTS, 1, "type", ""},
                                        {SEGMENTS, 5, "flow", "nl/min"},
                                        {SEGMENTS, 6, "hematocrit", ""},
                                        {BOUNDARY, 1, "boundary type", ""},
                                        {BOUNDARY, 2, "boundary value", ""}};

enum { N_COLUMNS = sizeof columns / sizeof *columns };

typedef struct Segment {
    char *from, *to; /* borrowed from the text */
    double diameter, flow;
    size_t line;
} Segment;

typedef struct Reader {
    Graph *graph;
    Table table;
    size_t skip;  /* lines that come before what is read next */
    int32_t left; /* rows of the table; -1: not said yet */
    Segment *segment;
    size_t n_segments, capacity;
    Names nodes;
} Reader;

static Status put_values(Reader *reader, size_t at, char *const *field, size_t count, Err *err)
{
    for (size_t k = 0; k < N_COLUMNS; k++) {
        double value;
        if (columns[k].table != reader->table || columns[k].field >= count ||
            strcmp(field[columns[k].field], "*") == 0)
            continue;
        TRY(field_number(columns[k].name, field[columns[k].field], -HUGE_VAL, &value, err));
        TRY(graph_value(reader->graph, k, at, value, err));
    }
    return STATUS_OK;
}

static Status read_segment(Reader *reader, char *const *field, size_t count, size_t line, Err *err)
{
    Segment segment = {.from = field[2], .to = field[3], .line = line};
    TRY(field_radius(reader->graph->options, "diameter", field[4], &segment.diameter, err));
    if (count > 5 && strcmp(field[5], "*") != 0)
        TRY(field_number("flow", field[5], -HUGE_VAL, &segment.flow, err));
    TRY(mem_reserve(&reader->segment, &reader->capacity, reader->n_segments + 1,
                    sizeof *reader->segment, "segments", err));
    reader->segment[reader->n_segments] = segment;
    return put_values(reader, reader->n_segments++, field, count, err);
}

static Status read_node(Reader *reader, char *const *field, size_t line, Err *err)
{
    GraphPoint point = {.radius = (double)NAN, .record = line};
    double *const coordinate[] = {&point.position.x, &point.position.y, &point.position.z};
    for (size_t i = 0; i < 3; i++)
        TRY(field_number("coordinate", field[1 + i], -HUGE_VAL, coordinate[i], err));
    TRY(names_add(&reader->nodes, field[0], reader->graph->n_points, line, err));
    return graph_point(reader->graph, &point, err);
}

/* Boundary type 2 prescribes the flow, which enters the network where it is positive. */
static Status read_boundary(Reader *reader, char *const *field, size_t count, Err *err)
{
    size_t node;
    double type, value;
    TRY(names_find(&reader->nodes, field[0], &node, err));
    TRY(field_number("boundary type", field[1], -HUGE_VAL, &type, err));
    TRY(field_number("boundary value", field[2], -HUGE_VAL, &value, err));
    if (type == 2 && value > 0)
        reader->graph->point[node].is_inlet = true;
    return put_values(reader, node, field, count, err);
}

static Status read_row(Reader *reader, char *const *field, size_t count, size_t line, Err *err)
{
    if (count < tables[reader->table].fewest)
        return err_set(err, STATUS_INPUT, "the row of the %s has %zu fields; it has at least %zu",
                       tables[reader->table].rows, count, tables[reader->table].fewest);
    switch (reader->table) {
    case SEGMENTS:
        return read_segment(reader, field, count, line, err);
    case NODES:
        return read_node(reader, field, line, err);
    default:
        return read_boundary(reader, field, count, err);
    }
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    Reader *reader = context;
    char *field[MAX_FIELDS];
    if (reader->skip > 0) {
        reader->skip--;
        return STATUS_OK;
    }
    TRY(fields_check_commas(line, err));
    size_t count = fields_cut(line, field, MAX_FIELDS);
    if (reader->left == 0) {
        reader->table++;
        reader->left = -1;
    }
    if (count == 0 || reader->table == TABLES)
        return STATUS_OK;
    if (reader->left > 0) {
        reader->left--;
        return read_row(reader, field, count, number, err);
    }
    reader->skip = 1;
    return field_whole(tables[reader->table].count, field[0], 0, TREE_MAX_ID, &reader->left, err);
}

static Status add_segment(const Reader *reader, const Segment *segment, Err *err)
{
    GraphLine line = {.radius = segment->diameter / 2,
                      .is_directed = segment->flow != 0,
                      .record = segment->line};
    bool turned = segment->flow < 0;
    TRY(names_find(&reader->nodes, segment->from, turned ? &line.b : &line.a, err));
    TRY(names_find(&reader->nodes, segment->to, turned ? &line.a : &line.b, err));
    return graph_line(reader->graph, &line, err);
}

static Status add_segments(const Reader *reader, Err *err)
{
    Graph *graph = reader->graph;
    if (reader->table < BOUNDARY && reader->left != 0)
        return err_set(err, STATUS_INPUT, "%s: the file ends before all its %s are there",
                       graph->name, tables[reader->table].rows);
    for (size_t i = 0; i < reader->n_segments; i++) {
        const Segment *segment = &reader->segment[i];
        TRY(graph_blame(graph, GRAPH_LINES, segment->line, add_segment(reader, segment, err), err));
    }
    return reading_note(graph->reading, err,
                        "radii are half the diameters of the file; flow is from the first node of "
                        "a segment to the second, and enters at boundary nodes of type 2");
}

Status secomb_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    (void)size;
    size_t column;
    Reader reader = {.graph = graph, .skip = HEADER_LINES, .left = -1, .nodes = {.what = "node"}};
    graph->unit = LENGTH_UM;
    for (size_t k = 0; k < N_COLUMNS; k++)
        TRY(graph_column(graph, columns[k].table == SEGMENTS ? GRAPH_LINES : GRAPH_POINTS,
                         columns[k].name, columns[k].unit, &column, err));
    Status status = lines_read(graph->name, bytes, read_line, &reader, err);
    if (status == STATUS_OK)
        status = add_segments(&reader, err);
    free(reader.segment);
    names_release(&reader.nodes);
    return status;
}
