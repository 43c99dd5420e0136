/* Points and lines as they are; every array that means nothing else becomes a column, one of
 * several components several columns. */
#include "treeio/formats.h"
#include "treeio/vtk/vtkmeaning.h"

#include <math.h>
#include <stdlib.h>

static Status add_points(const VtkMeaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    const VtkArray *radius = meaning->of == GRAPH_POINTS ? meaning->radius : NULL;
    for (size_t i = 0; i < data->n_points; i++) {
        const GraphPoint point = {
            .position = vtk_position(data, i),
            .radius = radius ? meaning->factor * radius->value[i] : (double)NAN,
            .is_inlet = meaning->inlet && meaning->inlet->value[i] == meaning->inlet_value,
            .record = i};
        TRY(graph_blame(graph, GRAPH_POINTS, i, graph_point(graph, &point, err), err));
    }
    return STATUS_OK;
}

static Status add_lines(const VtkMeaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    const VtkArray *radius = meaning->of == GRAPH_LINES ? meaning->radius : NULL;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++) {
            const GraphLine line = {
                .a = (size_t)data->corner[k - 1],
                .b = (size_t)data->corner[k],
                .radius = radius ? meaning->factor * radius->value[data->cell[i]] : (double)NAN,
                .is_directed = data->is_directed,
                .is_part = data->end[i] - at > 2,
                .record = data->cell[i]};
            TRY(graph_blame(graph, GRAPH_LINES, line.record, graph_line(graph, &line, err), err));
        }
    return STATUS_OK;
}

/* Sets a column of lines to one component of an array of cells, or one of points likewise. */
static Status add_values(const VtkData *data, Graph *graph, const VtkArray *array, GraphElement of,
                         size_t component, size_t column, Err *err)
{
    const double *value = array->value + component;
    if (of == GRAPH_POINTS) {
        for (size_t i = 0; i < data->n_points; i++)
            TRY(graph_value(graph, column, i, value[i * array->components], err));
        return STATUS_OK;
    }
    size_t number = 0;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++)
            TRY(graph_value(graph, column, number++, value[data->cell[i] * array->components],
                            err));
    return STATUS_OK;
}

static Status add_column(const VtkData *data, Graph *graph, const VtkArray *array, GraphElement of,
                         size_t component, Err *err)
{
    char *title = NULL;
    Text text = TEXT_INIT;
    text_put_line(&text, array->name);
    if (array->components > 1)
        text_printf(&text, "_%zu", component);
    Status status = text_take(&text, &title, err);
    size_t column;
    if (status == STATUS_OK) {
        const char *unit = csv_unit(title);
        status = graph_column(graph, of, title, unit, &column, err);
    }
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", graph->name);
    if (status == STATUS_OK)
        status = add_values(data, graph, array, of, component, column, err);
    text_release(&text);
    free(title);
    return status;
}

static Status add_columns(const VtkMeaning *meaning, const VtkData *data, Graph *graph,
                          GraphElement of, Err *err)
{
    enum { MOST_COMPONENTS = 16 };
    const VtkArrays *arrays = of == GRAPH_POINTS ? &data->of_points : &data->of_cells;
    for (size_t i = 0; i < arrays->n; i++) {
        const VtkArray *array = &arrays->array[i];
        if (vtk_is_used(meaning, array))
            continue;
        if (!array->value || array->components > MOST_COMPONENTS) {
            TRY(reading_note(graph->reading, err, "the array '%.60s' is left out: it is %s",
                             array->name, array->value ? "of too many components" : "of text"));
            continue;
        }
        for (size_t k = 0; k < array->components; k++)
            TRY(add_column(data, graph, array, of, k, err));
    }
    return STATUS_OK;
}

static Status check_sizes(const VtkData *data, const Graph *graph, Err *err)
{
    for (size_t i = 0, line = 0; i < data->n_corners; i++) {
        while (data->end[line] <= i)
            line++;
        double point = data->corner[i];
        if (!(point >= 0 && point < (double)data->n_points && point == floor(point)))
            return graph_blame(graph, GRAPH_LINES, data->cell[line],
                               err_set(err, STATUS_INPUT,
                                       "it names point %g; there are %zu points, numbered from 0 "
                                       "on",
                                       point, data->n_points),
                               err);
    }
    const VtkArrays *const both[] = {&data->of_points, &data->of_cells};
    const size_t counts[] = {data->n_points, data->n_cells};
    for (int of = 0; of < 2; of++)
        for (size_t i = 0; i < both[of]->n; i++)
            if (!both[of]->array[i].text && both[of]->array[i].n != counts[of])
                return err_set(err, STATUS_INPUT, "%s: the array '%.60s' has %zu values for %zu %s",
                               graph->name, both[of]->array[i].name, both[of]->array[i].n,
                               counts[of], of ? "cells" : "points");
    return STATUS_OK;
}

Status vtk_to_graph(const VtkData *data, Graph *graph, Err *err)
{
    VtkMeaning meaning;
    graph->point_record = graph->point_record ? graph->point_record : "point";
    graph->line_record = graph->line_record ? graph->line_record : "cell";
    TRY(check_sizes(data, graph, err));
    if (data->n_lines == 0 && !vtk_find_known(data))
        return err_set(err, STATUS_INPUT, "%s: there are no lines in it%s", graph->name,
                       data->n_cells ? ", only other cells" : "");
    TRY(vtk_find_meaning(&meaning, data, graph, err));
    if (meaning.id)
        return vtk_to_tree(&meaning, data, graph, err);
    TRY(vtk_tell_meaning(&meaning, data, graph, err));
    TRY(add_points(&meaning, data, graph, err));
    TRY(add_lines(&meaning, data, graph, err));
    TRY(add_columns(&meaning, data, graph, GRAPH_POINTS, err));
    return add_columns(&meaning, data, graph, GRAPH_LINES, err);
}
