/* Reads networks of Secomb's programs (network.dat), as GreensV4 reads them: six lines about the
 * tissue, and three tables of segments, nodes and boundary nodes. Before each table, one line
 * states the number of its rows and one names its columns. Text after the numbers of a row is a
 * remark. Diameters and coordinates are in um. Flow is negative if it runs from the second node to
 * the first. */
#include "treeio/formats.h"
#include "treeio/text/dialect.h"

enum { HEADER_LINES = 6 };

enum { SEGMENTS, NODES, BOUNDARY, TABLES };

/* Fields that decide about directions and inlets. */
enum { FLOW = 5, BOUNDARY_TYPE = 1, BOUNDARY_VALUE = 2 };

/* The table whose rows are read. */
typedef struct SecombState {
    size_t table;
    int32_t left; /* number of rows to come; 0: the line that states the number of rows */
} SecombState;

static Status direct_segment(DialectReader *reader, DialectRow *row, Err *err)
{
    double flow = 0;
    char *from = row->from;
    (void)reader, (void)err;
    if (row->count > FLOW)
        number_parse(row->field[FLOW], &flow);
    row->segment.is_directed = flow != 0;
    if (flow < 0) {
        row->from = row->to;
        row->to = from;
    }
    return STATUS_OK;
}

/* Boundary type 2 prescribes the flow, which enters the network if it is positive. */
static Status find_inlet(DialectReader *reader, DialectRow *row, Err *err)
{
    double type = 0, value = 0;
    (void)err;
    number_parse(row->field[BOUNDARY_TYPE], &type);
    number_parse(row->field[BOUNDARY_VALUE], &value);
    if (type == 2 && value > 0)
        reader->graph->point[row->element].is_inlet = true;
    return STATUS_OK;
}

static const DialectSection tables[TABLES] = {
    [SEGMENTS] = {"segments", "a row of the segments", 5, 0, GRAPH_LINES, direct_segment},
    [NODES] = {"nodes", "a row of the nodes", 4, 0, GRAPH_POINTS, NULL},
    [BOUNDARY] = {"boundary nodes", "a row of the boundary nodes", 3, 0, GRAPH_POINTS, find_inlet},
};

static const DialectField fields[] = {
    {SEGMENTS, 1, FIELD_NUMBER, "type", "", false},
    {SEGMENTS, 2, FIELD_FROM, "node", "", false},
    {SEGMENTS, 3, FIELD_TO, "node", "", false},
    {SEGMENTS, 4, FIELD_DIAMETER, "diameter", "", false},
    {SEGMENTS, FLOW, FIELD_NUMBER, "flow", "nl/min", false},
    {SEGMENTS, 6, FIELD_NUMBER, "hematocrit", "", false},
    {NODES, 0, FIELD_POINT, "node", "", false},
    {NODES, 1, FIELD_POSITION, "coordinate", "", false},
    {BOUNDARY, 0, FIELD_OF_POINT, "node", "", false},
    {BOUNDARY, BOUNDARY_TYPE, FIELD_NUMBER, "boundary type", "", false},
    {BOUNDARY, BOUNDARY_VALUE, FIELD_NUMBER, "boundary value", "", false},
    {BOUNDARY, 3, FIELD_NUMBER, "boundary hematocrit", "", false},
};

/* Counts the rows of each table, and passes over the line that names its columns. */
static Status choose_table(DialectReader *reader, DialectRow *row, bool *is_row, Err *err)
{
    SecombState *state = reader->own;
    char what[64];
    *is_row = state->left > 0;
    reader->section = state->table;
    if (*is_row) {
        state->table += --state->left == 0;
        return STATUS_OK;
    }
    if (state->table == TABLES)
        return STATUS_OK;
    snprintf(what, sizeof what, "number of %s", tables[state->table].title);
    TRY(field_integer(what, row->field[0], 0, TREE_MAX_ID, &state->left, err));
    state->table += state->left == 0;
    reader->skip = 1;
    return STATUS_OK;
}

static const Dialect dialect = {.section = tables,
                                .n_sections = TABLES,
                                .field = fields,
                                .n_fields = sizeof fields / sizeof *fields,
                                .none = "*",
                                .choose = choose_table};

Status secomb_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    SecombState state = {0};
    DialectReader reader = {.dialect = &dialect,
                            .graph = graph,
                            .own = &state,
                            .skip = HEADER_LINES,
                            .points = {.what = "node"}};
    Status status = STATUS_OK;
    graph->unit = LENGTH_UM;
    TRY_GOTO(dialect_read(&reader, bytes, size, err));
    if (state.table < BOUNDARY)
        TRY_GOTO(err_set(err, STATUS_INPUT, "%s: the file ends before all %s were read",
                         graph->name, tables[state.table].title));
    TRY_GOTO(dialect_add_segments(&reader, err));
    TRY_GOTO(reading_note(graph->reading, err,
                          "radii are half the diameters; flow runs from a segment's first node to "
                          "its second, and enters at boundary nodes of type 2"));
done:
    dialect_release(&reader);
    return status;
}
