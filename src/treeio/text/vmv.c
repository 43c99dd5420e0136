/* Reads and writes VMV, the files of VessMorphoVis. A section stands between "$NAME_BEGIN" and
 * "$NAME_END". $PARAM states counts. $VERT_LIST has one vertex per line: its number, position,
 * radius, and possibly one more value. $STRANDS_LIST has one polyline per line: its number, then
 * its vertices. $RADIUS_SIMULATION and similar sections have one row per vertex, with one value per
 * time step. $PARAM may state time steps of sections that are missing. Ultraliser also puts a '$'
 * before the names of parameters.
 *
 * VessMorphoVis writes strands away from the root. The lines are taken as directed if at most one
 * of them enters each vertex. Otherwise the order of a strand has no meaning. */
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/text/dialect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The sections. The sections from RADIUS on are time series. */
enum { PARAMETERS, VERTICES, STRANDS, RADIUS, FLOW, PRESSURE, SECTIONS };

/* Per time series: the name of its columns, before the number of the time step, and the name of its
 * steps in errors. */
static const struct {
    const char *column, *steps;
} series_names[SECTIONS] = {
    [RADIUS] = {"radius", "time steps of radii"},
    [FLOW] = {"flow", "time steps of flows"},
    [PRESSURE] = {"pressure", "time steps of pressures"},
};

/* The values of all vertices at all time steps. */
typedef struct TimeSteps {
    size_t column; /* index of the first step's column; the columns of later steps follow */
    size_t steps, rows;
    int32_t stated; /* number of steps that the parameters state; -1: none */
} TimeSteps;

typedef struct VmvState {
    int32_t vertices, strands; /* numbers that the parameters state; -1: none */
    size_t n_strands;
    TimeSteps series[SECTIONS];
} VmvState;

/* Notes a count that $PARAM states. */
static Status read_parameter(DialectReader *reader, DialectRow *row, Err *err)
{
    VmvState *state = reader->own;
    const char *name = row->field[0], *value = row->count > 1 ? row->field[1] : NULL;
    if (!value)
        return STATUS_OK;
    if (strcasecmp(name, "NUM_VERTS") == 0)
        return field_integer(name, value, 0, INT32_MAX, &state->vertices, err);
    if (strcasecmp(name, "NUM_STRANDS") == 0)
        return field_integer(name, value, 0, INT32_MAX, &state->strands, err);
    for (size_t section = RADIUS; section < SECTIONS; section++) {
        const char *title = reader->dialect->section[section].title;
        if (strncasecmp(name, title, strlen(title)) == 0 &&
            strcasecmp(name + strlen(title), "_TIME_STEPS") == 0)
            return field_integer(name, value, 0, INT32_MAX, &state->series[section].stated, err);
    }
    return STATUS_OK;
}

/* Adds the lines of a strand. */
static Status read_strand(DialectReader *reader, DialectRow *row, Err *err)
{
    VmvState *state = reader->own;
    GraphLine line = row->segment;
    for (size_t k = 1; k < row->count; k++) {
        TRY(names_find(&reader->points, row->field[k], &line.b, err));
        if (k > 1)
            TRY(graph_line(reader->graph, &line, err));
        line.a = line.b;
    }
    if (row->count < 3)
        return err_set(err, STATUS_INPUT, "the strand has %zu vertices; it must have two or more",
                       row->count - 1);
    state->n_strands++;
    return STATUS_OK;
}

/* Adds one column per time step. */
static Status add_steps(DialectReader *reader, TimeSteps *series, size_t n, Err *err)
{
    for (; series->steps < n; series->steps++) {
        char name[64];
        size_t column;
        snprintf(name, sizeof name, "%s_%zu", series_names[reader->section].column, series->steps);
        TRY(graph_column(reader->graph, GRAPH_POINTS, name, "", &column, err));
        series->column = column - series->steps;
    }
    return STATUS_OK;
}

/* Reads the values of one vertex. The first row shows how many time steps there are. */
static Status read_values(DialectReader *reader, DialectRow *row, Err *err)
{
    VmvState *state = reader->own;
    TimeSteps *series = &state->series[reader->section];
    if (series->rows == reader->graph->n_points)
        return err_set(err, STATUS_INPUT, "there are more rows than the %zu vertices",
                       series->rows);
    if (series->rows == 0)
        TRY(add_steps(reader, series, row->count, err));
    if (row->count != series->steps)
        return err_set(err, STATUS_INPUT, "the row has %zu value%s; the first row has %zu",
                       row->count, row->count == 1 ? "" : "s", series->steps);
    for (size_t k = 0; k < row->count; k++) {
        double value;
        TRY(field_value("value", row->field[k], &value, err));
        TRY(graph_value(reader->graph, series->column + k, series->rows, value, err));
    }
    series->rows++;
    return STATUS_OK;
}

static const DialectSection sections[SECTIONS] = {
    [PARAMETERS] = {"PARAM", "a parameter", 0, 0, GRAPH_LINES, read_parameter},
    [VERTICES] = {"VERT_LIST", "a vertex (number, three coordinates, radius, at most one value)", 5,
                  6, GRAPH_POINTS, NULL},
    [STRANDS] = {"STRANDS_LIST", "a strand", 0, 0, GRAPH_LINES, read_strand},
    [RADIUS] = {"RADIUS_SIMULATION", "a row", 0, 0, GRAPH_LINES, read_values},
    [FLOW] = {"FLOW_SIMULATION", "a row", 0, 0, GRAPH_LINES, read_values},
    [PRESSURE] = {"PRESSURE_SIMULATION", "a row", 0, 0, GRAPH_LINES, read_values},
};

static const DialectField fields[] = {
    {VERTICES, 0, FIELD_POINT, "vertex", "", false},
    {VERTICES, 1, FIELD_POSITION, "coordinate", "", false},
    {VERTICES, 4, FIELD_RADIUS, "radius", "", false},
    {VERTICES, 5, FIELD_VALUE, "value", "", false},
};

static Status read_comment(Graph *graph, const char *comment, Err *err)
{
    return comment_read(&graph->meta, comment, err);
}

/* Reads "NAME_BEGIN" or "NAME_END", which follows a '$'. */
static Status change_section(DialectReader *reader, const char *title, Err *err)
{
    for (size_t section = 0; section < SECTIONS; section++) {
        size_t length = strlen(sections[section].title);
        if (strncasecmp(title, sections[section].title, length) != 0)
            continue;
        bool begins = strcasecmp(title + length, "_BEGIN") == 0;
        reader->section = begins ? section : SECTIONS;
        if (begins || strcasecmp(title + length, "_END") == 0)
            return STATUS_OK;
    }
    return err_set(err, STATUS_INPUT, "'$%.40s' does not begin or end a section of a VMV file",
                   title);
}

/* Finds the section of a line. Text outside all sections is accepted after the first strand. */
static Status choose_section(DialectReader *reader, DialectRow *row, bool *is_row, Err *err)
{
    const VmvState *state = reader->own;
    const char *first = row->field[0];
    if (reader->section == PARAMETERS && strncasecmp(first, "$NUM_", 5) == 0)
        first = ++row->field[0];
    *is_row = *first != '$' && reader->section < SECTIONS;
    if (*first == '$')
        return change_section(reader, first[1] || row->count == 1 ? first + 1 : row->field[1], err);
    if (*is_row || state->n_strands > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "'%.40s' is outside all sections of the VMV file", first);
}

static const Dialect dialect = {.section = sections,
                                .n_sections = SECTIONS,
                                .field = fields,
                                .n_fields = sizeof fields / sizeof *fields,
                                .comment = read_comment,
                                .choose = choose_section};

/* ---- checks ---------------------------------------------------------------------------------- */

static Status check_count(const Graph *graph, const char *what, int32_t stated, size_t found,
                          Err *err)
{
    if (stated < 0 || (size_t)stated == found)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: the file states %d %s, but has %zu", graph->name, stated,
                   what, found);
}

/* Compares the stated counts with what was read. */
static Status check_counts(const Graph *graph, const VmvState *state, Err *err)
{
    TRY(check_count(graph, "vertices", state->vertices, graph->n_points, err));
    TRY(check_count(graph, "strands", state->strands, state->n_strands, err));
    for (size_t section = RADIUS; section < SECTIONS; section++) {
        const TimeSteps *series = &state->series[section];
        if (series->rows > 0)
            TRY(check_count(graph, series_names[section].steps, series->stated, series->steps,
                            err));
        if (series->rows > 0 && series->rows != graph->n_points)
            return err_set(err, STATUS_INPUT, "%s: %s has %zu rows for %zu vertices", graph->name,
                           sections[section].title, series->rows, graph->n_points);
    }
    return STATUS_OK;
}

/* Makes all lines undirected if two of them enter one vertex. */
static Status check_directions(Graph *graph, Err *err)
{
    bool *entered = NULL, directed = true;
    TRY(mem_calloc(&entered, graph->n_points, sizeof *entered, "vertices", err));
    for (size_t i = 0; i < graph->n_lines; i++) {
        directed = directed && !entered[graph->line[i].b];
        entered[graph->line[i].b] = true;
    }
    free(entered);
    for (size_t i = 0; i < graph->n_lines; i++)
        graph->line[i].is_directed = directed;
    return STATUS_OK;
}

Status vmv_read(Graph *graph, char *bytes, size_t size, Err *err)
{
    VmvState state = {.vertices = -1, .strands = -1};
    DialectReader reader = {
        .dialect = &dialect, .graph = graph, .own = &state, .points = {.what = "vertex"}};
    Status status = STATUS_OK;
    graph->unit = LENGTH_UM;
    graph->is_named = true;
    for (size_t section = RADIUS; section < SECTIONS; section++)
        state.series[section].stated = -1;
    TRY_GOTO(dialect_read(&reader, bytes, size, err));
    TRY_GOTO(check_counts(graph, &state, err));
    TRY_GOTO(check_directions(graph, err));
done:
    dialect_release(&reader);
    return status;
}

/* ---- writing --------------------------------------------------------------------------------- */

static void put_um(double mm, Text *text)
{
    text_puts(text, " ");
    text_number(text, length_from_mm(mm, LENGTH_UM));
}

/* Appends the vertex of node i. A node with a link is the same point as another node, so its vertex
 * is put in the middle of its segment: the vertex carries the segment's radius, and makes the
 * segment differ from another segment between the same two nodes. */
static void put_vertex(const Tree *tree, size_t i, Text *text)
{
    Vec3 at = tree->position[i];
    if (tree_has_link(tree, i))
        at = vec3_scale(vec3_add(tree->position[tree->parent[i]], at), 0.5);
    text_printf(text, "%zu", i + 1);
    put_um(at.x, text);
    put_um(at.y, text);
    put_um(at.z, text);
    put_um(tree->radius_mm[i], text);
    text_puts(text, "\n");
}

static void put_strands(const Tree *tree, const Branches *branches, Text *text)
{
    for (size_t k = 0, at = 0; k < branches->n; k++) {
        text_printf(text, "%zu %d", k + 1, tree->parent[branches->node[at]] + 1);
        for (; at < branches->end[k]; at++) {
            size_t i = (size_t)branches->node[at];
            text_printf(text, " %zu", i + 1);
            if (tree_has_link(tree, i))
                text_printf(text, " %d", tree->link[i] + 1);
        }
        text_puts(text, "\n");
    }
}

Status vmv_write(const Tree *tree, Text *text, Err *err)
{
    Branches branches;
    TRY(branches_find(tree, &branches, err));
    comments_put(&tree->meta, NULL, text);
    text_printf(text,
                "$PARAM_BEGIN\nNUM_VERTS %zu\nNUM_STRANDS %zu\nNUM_ATTRIB_PER_VERT 4\n"
                "$PARAM_END\n\n$VERT_LIST_BEGIN\n",
                tree->n, branches.n);
    for (size_t i = 0; i < tree->n; i++)
        put_vertex(tree, i, text);
    text_puts(text, "$VERT_LIST_END\n\n$STRANDS_LIST_BEGIN\n");
    put_strands(tree, &branches, text);
    text_puts(text, "$STRANDS_LIST_END\n");
    branches_release(&branches);
    return STATUS_OK;
}

bool vmv_detect(const char *start)
{
    return *text_first_row(start) == '$';
}
