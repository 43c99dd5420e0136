/* Collects the points and lines of a network while a file is read. Points, lines and values are
 * stored as they are added. graph_build makes the tree when all of them are known. */
#include "tree/graph_parts.h"
#include "tree/tree.h"

#include <stdlib.h>
#include <string.h>

/* Limit of points and of lines. 32-bit code in graph_build.c stores numbers + 1, and up to two
 * entries per line. */
enum { MOST_ELEMENTS = 0x7fffffff };

void graph_release(Graph *graph)
{
    for (size_t k = 0; k < graph->n_columns; k++) {
        free(graph->column[k].name);
        free(graph->column[k].unit);
        free(graph->column[k].value);
    }
    free(graph->point);
    free(graph->line);
    free(graph->column);
    free(graph->join);
    meta_release(&graph->meta);
    *graph = (Graph){0};
}

Status graph_blame(const Graph *graph, GraphElement of, size_t record, Status status, Err *err)
{
    const TreeBuilder named = {.name = graph->name,
                               .record =
                                   of == GRAPH_POINTS ? graph->point_record : graph->line_record};
    return builder_blame(&named, record, status, err);
}

static Status check_count(size_t n, const char *what, Err *err)
{
    if (n < MOST_ELEMENTS)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "there are more than %d %s", MOST_ELEMENTS, what);
}

Status graph_point(Graph *graph, const GraphPoint *point, Err *err)
{
    if (!vec3_finite(point->position))
        return err_set(err, STATUS_INPUT, "the position is not finite");
    if (point->id < 0 || point->id > TREE_MAX_ID)
        return err_set(err, STATUS_INPUT, "the id is '%lld'; it must be an integer from 1 to %d",
                       (long long)point->id, TREE_MAX_ID);
    double radius = point->radius;
    TRY(reading_radius(graph->options, &radius, err));
    TRY(check_count(graph->n_points, "points", err));
    TRY(mem_reserve(&graph->point, &graph->points_capacity, graph->n_points + 1,
                    sizeof *graph->point, "points", err));
    graph->point[graph->n_points] = *point;
    graph->point[graph->n_points++].radius = radius;
    return STATUS_OK;
}

Status graph_line(Graph *graph, const GraphLine *line, Err *err)
{
    double radius = line->radius;
    TRY(reading_radius(graph->options, &radius, err));
    TRY(check_count(graph->n_lines, "lines", err));
    TRY(mem_reserve(&graph->line, &graph->lines_capacity, graph->n_lines + 1, sizeof *graph->line,
                    "lines", err));
    graph->line[graph->n_lines] = *line;
    graph->line[graph->n_lines++].radius = radius;
    return STATUS_OK;
}

Status graph_join(Graph *graph, size_t a, size_t b, Err *err)
{
    TRY(mem_reserve(&graph->join, &graph->joins_capacity, graph->n_joins + 1, sizeof *graph->join,
                    "joins", err));
    graph->join[graph->n_joins++] = (GraphJoin){a, b};
    return STATUS_OK;
}

Status graph_column(Graph *graph, GraphElement of, const char *name, const char *unit,
                    size_t *column, Err *err)
{
    if (!*name)
        return err_set(err, STATUS_INPUT, "a column has no name");
    if (graph->n_columns == BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "there are more than %d columns", BUILDER_MAX_COLUMNS);
    for (size_t k = 0; k < graph->n_columns; k++)
        if (graph->column[k].of == of && strcmp(graph->column[k].name, name) == 0)
            return err_set(err, STATUS_INPUT, "two columns are called '%.40s'", name);
    GraphColumn made = {.of = of};
    Status status = STATUS_OK;
    TRY_GOTO(mem_strdup(&made.name, name, err));
    TRY_GOTO(mem_strdup(&made.unit, unit, err));
    TRY_GOTO(mem_reserve(&graph->column, &graph->columns_capacity, graph->n_columns + 1,
                         sizeof made, "columns", err));
    *column = graph->n_columns;
    graph->column[graph->n_columns++] = made;
    return STATUS_OK;
done:
    free(made.name);
    free(made.unit);
    return status;
}

Status graph_value(Graph *graph, size_t column_number, size_t at, double value, Err *err)
{
    GraphColumn *column = &graph->column[column_number];
    TRY(mem_reserve(&column->value, &column->capacity, at + 1, sizeof *column->value,
                    "values of a column", err));
    while (column->n <= at)
        column->value[column->n++] = (double)NAN;
    column->value[at] = value;
    return STATUS_OK;
}
