/* VMV, the files of VessMorphoVis: sections between "$NAME_BEGIN" and "$NAME_END". $PARAM says how
 * many there are of each thing, $VERT_LIST has a vertex a line, its number, position, radius and
 * sometimes one more value, $STRANDS_LIST a polyline of vertices a line, behind its number, and
 * $RADIUS_SIMULATION and the like one row of values a vertex, a value a time step. VessMorphoVis
 * announces steps also of sections that it does not write, and Ultraliser puts a '$' before the
 * names of parameters, too.
 *
 * VessMorphoVis writes strands away from the root. A file in which every vertex is entered by one
 * line at most is taken to be written so; in any other, the order of a strand means nothing. */
#include "treeio/branches.h"
#include "treeio/comments.h"
#include "treeio/formats.h"
#include "treeio/names.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum Section {
    NONE,
    PARAMETERS,
    VERTICES,
    STRANDS,
    RADIUS,
    FLOW,
    PRESSURE,
    SECTIONS
} Section;

static const struct {
    const char *name;
    const char *series; /* what the column of a time step is called, before its number */
    const char *steps;
} sections[SECTIONS] = {
    [PARAMETERS] = {.name = "PARAM"},
    [VERTICES] = {.name = "VERT_LIST"},
    [STRANDS] = {.name = "STRANDS_LIST"},
    [RADIUS] = {"RADIUS_SIMULATION", "radius", "time steps of radii"},
    [FLOW] = {"FLOW_SIMULATION", "flow", "time steps of flows"},
    [PRESSURE] = {"PRESSURE_SIMULATION", "pressure", "time steps of pressures"},
};

enum { VERTEX_FIELDS = 5, MAX_VERTEX_FIELDS = 6 };

/* The values of all vertices at all time steps. */
typedef struct TimeSteps {
    size_t column; /* of the first step; those of the others follow */
    size_t steps, rows;
    int32_t said; /* as the parameters say how many steps there are; -1: they do not */
} TimeSteps;

typedef struct Reader {
    Graph *graph;
    Section section;
    int32_t vertices, strands; /* as the parameters say; -1: they do not */
    size_t n_strands;
    Names names; /* of the vertices */
    bool has_value;
    size_t value; /* the column of what stands behind the radius */
    TimeSteps series[SECTIONS];
} Reader;

static Status read_parameter(Reader *reader, char *line, Err *err)
{
    const char *name = text_field(&line), *value = text_field(&line);
    if (!name || !value)
        return STATUS_OK;
    if (strcasecmp(name, "NUM_VERTS") == 0)
        return field_whole(name, value, 0, INT32_MAX, &reader->vertices, err);
    if (strcasecmp(name, "NUM_STRANDS") == 0)
        return field_whole(name, value, 0, INT32_MAX, &reader->strands, err);
    for (int section = RADIUS; section < SECTIONS; section++) {
        size_t length = strlen(sections[section].name);
        if (strncasecmp(name, sections[section].name, length) == 0 &&
            strcasecmp(name + length, "_TIME_STEPS") == 0)
            return field_whole(name, value, 0, INT32_MAX, &reader->series[section].said, err);
    }
    return STATUS_OK;
}

static Status read_vertex(Reader *reader, char *line, size_t number, Err *err)
{
    Graph *graph = reader->graph;
    char *field[MAX_VERTEX_FIELDS];
    size_t count = fields_cut(line, field, MAX_VERTEX_FIELDS);
    GraphPoint point = {.record = number};
    double *const coordinate[] = {&point.position.x, &point.position.y, &point.position.z};
    if (count < VERTEX_FIELDS || count > MAX_VERTEX_FIELDS)
        return err_set(err, STATUS_INPUT,
                       "the vertex has %zu fields; it has its number, three coordinates, a radius "
                       "and at most one value",
                       count);
    TRY(names_add(&reader->names, field[0], graph->n_points, number, err));
    for (size_t i = 0; i < 3; i++)
        TRY(field_number("coordinate", field[1 + i], -HUGE_VAL, coordinate[i], err));
    TRY(field_radius(graph->options, "radius", field[4], &point.radius, err));
    TRY(graph_point(graph, &point, err));
    if (count == VERTEX_FIELDS)
        return STATUS_OK;
    double value;
    if (!reader->has_value)
        TRY(graph_column(graph, GRAPH_POINTS, "value", "", &reader->value, err));
    reader->has_value = true;
    TRY(field_value("value", field[VERTEX_FIELDS], &value, err));
    return graph_value(graph, reader->value, graph->n_points - 1, value, err);
}

static Status read_strand(Reader *reader, char *line, size_t number, Err *err)
{
    size_t before = 0, count = 0;
    text_field(&line);
    for (char *field; (field = text_field(&line)); count++) {
        size_t vertex;
        TRY(names_find(&reader->names, field, &vertex, err));
        if (count > 0)
            TRY(graph_line(reader->graph,
                           &(GraphLine){.a = before,
                                        .b = vertex,
                                        .radius = (double)NAN,
                                        .is_directed = true,
                                        .record = number},
                           err));
        before = vertex;
    }
    if (count < 2)
        return err_set(err, STATUS_INPUT, "a strand has two vertices or more; this has %zu", count);
    reader->n_strands++;
    return STATUS_OK;
}

/* As many columns as the row has values. */
static Status add_steps(Reader *reader, const char *row, Err *err)
{
    TimeSteps *series = &reader->series[reader->section];
    for (;; series->steps++) {
        char name[64];
        size_t column;
        row += strspn(row, TEXT_BLANKS);
        if (!*row)
            return STATUS_OK;
        row += strcspn(row, TEXT_BLANKS);
        snprintf(name, sizeof name, "%s_%zu", sections[reader->section].series, series->steps);
        TRY(graph_column(reader->graph, GRAPH_POINTS, name, "", &column, err));
        if (series->steps == 0)
            series->column = column;
    }
}

/* The values of one vertex; the first row says how many steps there are. */
static Status read_values(Reader *reader, char *line, Err *err)
{
    TimeSteps *series = &reader->series[reader->section];
    size_t count = 0;
    if (series->rows == reader->graph->n_points)
        return err_set(err, STATUS_INPUT,
                       "there are more rows than vertices, of which there are %zu", series->rows);
    if (series->rows == 0)
        TRY(add_steps(reader, line, err));
    for (char *field; (field = text_field(&line)); count++) {
        double value;
        TRY(field_value("value", field, &value, err));
        if (count < series->steps)
            TRY(graph_value(reader->graph, series->column + count, series->rows, value, err));
    }
    series->rows++;
    if (count == series->steps)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "the row has %zu value%s; the first has %zu", count,
                   count == 1 ? "" : "s", series->steps);
}

/* "$NAME_BEGIN" or "$NAME_END". */
static Status change_section(Reader *reader, const char *line, Err *err)
{
    const char *name = line + 1 + strspn(line + 1, TEXT_BLANKS);
    for (int section = PARAMETERS; section < SECTIONS; section++) {
        size_t length = strlen(sections[section].name);
        if (strncasecmp(name, sections[section].name, length) != 0)
            continue;
        const char *edge = name + length;
        reader->section = strcasecmp(edge, "_BEGIN") == 0 ? (Section)section : NONE;
        if (reader->section != NONE || strcasecmp(edge, "_END") == 0)
            return STATUS_OK;
    }
    return err_set(err, STATUS_INPUT, "'%.40s' begins or ends no section of VMV", line);
}

static Status read_line(void *context, size_t number, char *line, Err *err)
{
    Reader *reader = context;
    line = text_trim(line);
    if (*line == '#')
        return comment_read(&reader->graph->meta, line + 1, err);
    TRY(fields_check_commas(line, err));
    if (reader->section == PARAMETERS && strncasecmp(line, "$NUM_", 5) == 0)
        line++;
    if (*line == '$')
        return change_section(reader, line, err);
    if (!*line)
        return STATUS_OK;
    switch (reader->section) {
    case NONE:
        if (reader->n_strands > 0) /* behind the end */
            return STATUS_OK;
        return err_set(err, STATUS_INPUT, "'%.40s' stands in no section of VMV", line);
    case PARAMETERS:
        return read_parameter(reader, line, err);
    case VERTICES:
        return read_vertex(reader, line, number, err);
    case STRANDS:
        return read_strand(reader, line, number, err);
    default:
        return read_values(reader, line, err);
    }
}

static Status check_count(const Reader *reader, const char *what, int32_t said, size_t found,
                          Err *err)
{
    if (said < 0 || (size_t)said == found)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s: the file says %d %s and has %zu", reader->graph->name,
                   said, what, found);
}

static Status check_counts(const Reader *reader, Err *err)
{
    TRY(check_count(reader, "vertices", reader->vertices, reader->graph->n_points, err));
    TRY(check_count(reader, "strands", reader->strands, reader->n_strands, err));
    for (int section = RADIUS; section < SECTIONS; section++) {
        const TimeSteps *series = &reader->series[section];
        if (series->rows > 0)
            TRY(check_count(reader, sections[section].steps, series->said, series->steps, err));
        if (series->rows > 0 && series->rows != reader->graph->n_points)
            return err_set(err, STATUS_INPUT, "%s: %s has %zu rows for %zu vertices",
                           reader->graph->name, sections[section].name, series->rows,
                           reader->graph->n_points);
    }
    return STATUS_OK;
}

/* Takes the direction off all lines where two of them enter one vertex. */
static Status judge_directions(Graph *graph, Err *err)
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
    (void)size;
    Reader reader = {.graph = graph, .vertices = -1, .strands = -1, .names = {.what = "vertex"}};
    graph->unit = LENGTH_UM;
    graph->is_named = true;
    for (int section = RADIUS; section < SECTIONS; section++)
        reader.series[section].said = -1;
    Status status = lines_read(graph->name, bytes, read_line, &reader, err);
    if (status == STATUS_OK)
        status = check_counts(&reader, err);
    names_release(&reader.names);
    return status == STATUS_OK ? judge_directions(graph, err) : status;
}

/* ---- writing --------------------------------------------------------------------------------- */

static void put_um(double mm, Text *text)
{
    text_puts(text, " ");
    text_number(text, length_from_mm(mm, LENGTH_UM));
}

static void put_vertex(const Tree *tree, size_t i, Text *text)
{
    text_printf(text, "%zu", i + 1);
    put_um(tree->position[i].x, text);
    put_um(tree->position[i].y, text);
    put_um(tree->position[i].z, text);
    put_um(tree->radius_mm[i], text);
    text_puts(text, "\n");
}

static void put_strands(const Tree *tree, const Branches *branches, Text *text)
{
    for (size_t k = 0, at = 0; k < branches->n; k++) {
        text_printf(text, "%zu %d", k + 1, tree->parent[branches->node[at]] + 1);
        for (; at < branches->end[k]; at++)
            text_printf(text, " %d", branches->node[at] + 1);
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
