/* Adds the points and lines of a VtkData to a graph. Each array without another meaning becomes a
 * column; an array of several components becomes several columns. */
#include "treeio/formats.h"
#include "treeio/vtk/vtkmeaning.h"

#include <math.h>
#include <stdlib.h>

static Status add_points(const VtkMeaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    const VtkArray *radius = meaning->radius_element == GRAPH_POINTS ? meaning->radius : NULL;
    for (size_t i = 0; i < data->n_points; i++) {
        const GraphPoint point = {
            .position = vtk_position(data, i),
            .radius = radius ? meaning->radius_factor * radius->value[i] : (double)NAN,
            .is_inlet = meaning->inlet && meaning->inlet->value[i] == meaning->inlet_value,
            .record = i};
        TRY(graph_blame(graph, GRAPH_POINTS, i, graph_point(graph, &point, err), err));
    }
    return STATUS_OK;
}

/* Adds a line for each two consecutive points of a polyline. */
static Status add_lines(const VtkMeaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    const VtkArray *radius = meaning->radius_element == GRAPH_LINES ? meaning->radius : NULL;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++) {
            const GraphLine line = {.a = (size_t)data->corner[k - 1],
                                    .b = (size_t)data->corner[k],
                                    .radius = radius ? meaning->radius_factor *
                                                           radius->value[data->cell[i]]
                                                     : (double)NAN,
                                    .is_directed = data->is_directed,
                                    .is_part = data->end[i] - at > 2,
                                    .record = data->cell[i]};
            TRY(graph_blame(graph, GRAPH_LINES, line.record, graph_line(graph, &line, err), err));
        }
    return STATUS_OK;
}

/* ---- columns --------------------------------------------------------------------------------- */

/* Sets column `k` to one component of an array. Lines of a polyline have the value of its cell. */
static Status add_values(Graph *graph, const VtkArray *array, GraphElement of, const double *value,
                         size_t k, Err *err)
{
    size_t n = of == GRAPH_POINTS ? array->n : graph->n_lines;
    for (size_t i = 0; i < n; i++) {
        size_t element = of == GRAPH_POINTS ? i : graph->line[i].record;
        TRY(graph_value(graph, k, i, value[element * array->components], err));
    }
    return STATUS_OK;
}

/* Adds one component of an array as a column. */
static Status add_column(Graph *graph, const VtkArray *array, GraphElement of, size_t component,
                         Err *err)
{
    char *title = NULL;
    size_t column;
    Text text = TEXT_INIT;
    Status status = STATUS_OK;
    text_put_line(&text, array->name);
    if (array->components > 1)
        text_printf(&text, "_%zu", component);
    TRY_GOTO(text_take(&text, &title, err));
    const char *unit = csv_unit(title);
    status = graph_column(graph, of, title, unit, &column, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", graph->name);
    TRY_GOTO(status);
    TRY_GOTO(add_values(graph, array, of, array->value + component, column, err));
done:
    text_release(&text);
    free(title);
    return status;
}

/* Adds the columns of points or of lines. An array of more than 16 components, the number of a 4 x
 * 4 matrix, is left out, because each component would become a column. */
static Status add_columns(const VtkMeaning *meaning, const VtkData *data, Graph *graph,
                          GraphElement of, Err *err)
{
    enum { MAX_COMPONENTS = 16 };
    for (size_t i = 0; i < data->arrays[of].n; i++) {
        const VtkArray *array = &data->arrays[of].array[i];
        bool is_column = array->value && array->components <= MAX_COMPONENTS;
        if (vtk_has_meaning(meaning, array))
            continue;
        if (!is_column)
            TRY(reading_note(graph->reading, err, "the array '%.60s' is left out: it is %s",
                             array->name, array->value ? "of too many components" : "of text"));
        for (size_t k = 0; is_column && k < array->components; k++)
            TRY(add_column(graph, array, of, k, err));
    }
    return STATUS_OK;
}

/* ---- checks ---------------------------------------------------------------------------------- */

/* Checks that all lines refer to existing points. */
static Status check_corners(const VtkData *data, const Graph *graph, Err *err)
{
    for (size_t i = 0, line = 0; i < data->n_corners; i++) {
        double point = data->corner[i];
        while (data->end[line] <= i)
            line++;
        if (!(point >= 0 && point < (double)data->n_points && point == floor(point)))
            return graph_blame(
                graph, GRAPH_LINES, data->cell[line],
                err_set(err, STATUS_INPUT,
                        "it refers to point %g; there are %zu points, counted from 0", point,
                        data->n_points),
                err);
    }
    return STATUS_OK;
}

static Status check_arrays(const VtkArrays *arrays, size_t n, const char *what, const Graph *graph,
                           Err *err)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (!arrays->array[i].text && arrays->array[i].n != n)
            return err_set(err, STATUS_INPUT, "%s: the array '%.60s' has %zu values for %zu %s",
                           graph->name, arrays->array[i].name, arrays->array[i].n, n, what);
    return STATUS_OK;
}

Status vtk_to_graph(const VtkData *data, Graph *graph, Err *err)
{
    VtkMeaning meaning;
    graph->point_record = graph->point_record ? graph->point_record : "point";
    graph->line_record = graph->line_record ? graph->line_record : "cell";
    TRY(check_corners(data, graph, err));
    TRY(check_arrays(&data->arrays[GRAPH_POINTS], data->n_points, "points", graph, err));
    TRY(check_arrays(&data->arrays[GRAPH_LINES], data->n_cells, "cells", graph, err));
    if (data->n_lines == 0 && !vtk_find_metadata(data))
        return err_set(err, STATUS_INPUT, "%s: the file has no lines%s", graph->name,
                       data->n_cells ? ", only other cells" : "");
    TRY(vtk_find_meaning(&meaning, data, graph, err));
    if (meaning.id)
        return vtk_to_tree(&meaning, data, graph, err);
    TRY(vtk_note_assumptions(&meaning, data, graph, err));
    TRY(add_points(&meaning, data, graph, err));
    TRY(add_lines(&meaning, data, graph, err));
    TRY(add_columns(&meaning, data, graph, GRAPH_POINTS, err));
    return add_columns(&meaning, data, graph, GRAPH_LINES, err);
}
