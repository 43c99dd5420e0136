/* Collects a network whose lines name their points, as GXL and GraphML do.
 *
 * Points and lines fill a VtkData. Lines store the names of their points until the end of the file,
 * because a point may come after its lines. */
#include "treeio/xml/namednetwork.h"

#include "treeio/comments.h"
#include <stdlib.h>
#include <string.h>

NamedNetwork namednetwork_new(const char *what, size_t file_size)
{
    return (NamedNetwork){.file_size = file_size, .names = {.what = what}};
}

void namednetwork_release(NamedNetwork *network)
{
    names_release(&network->names);
    slabs_release(&network->texts);
    ARRAY_RELEASE(&network->lines);
    ARRAY_RELEASE(&network->point_names);
    vtk_release(&network->data);
}

Status namednetwork_begin(NamedNetwork *network, GraphElement of, size_t record, Err *err)
{
    if (of == GRAPH_LINES)
        TRY(ARRAY_PUSH(&network->lines, "lines", err, (NamedLine){network->point_names.n, record}));
    network->data.n_points += of == GRAPH_POINTS;
    network->data.n_cells += of == GRAPH_LINES;
    return STATUS_OK;
}

static Status copy(NamedNetwork *network, const char *text, char **out, Err *err)
{
    *out = slabs_text(&network->texts, text);
    return *out ? STATUS_OK : mem_out_of("for", "names", err);
}

Status namednetwork_name(NamedNetwork *network, const char *name, size_t record, Err *err)
{
    char *kept;
    TRY(copy(network, name, &kept, err));
    network->last = kept;
    return names_add(&network->names, kept, network->data.n_points - 1, record, err);
}

Status namednetwork_add_end(NamedNetwork *network, const char *name, Err *err)
{
    char *kept;
    TRY(copy(network, name, &kept, err));
    TRY(ARRAY_PUSH(&network->point_names, "points of lines", err, kept));
    network->lines.items[network->lines.n - 1].names_end = network->point_names.n;
    return STATUS_OK;
}

Status namednetwork_edge(NamedNetwork *network, const char *from, const char *to, size_t record,
                         Err *err)
{
    TRY(namednetwork_begin(network, GRAPH_LINES, record, err));
    TRY(namednetwork_add_end(network, from, err));
    return namednetwork_add_end(network, to, err);
}

Status namednetwork_set(NamedNetwork *network, GraphElement of, const char *name, double value,
                        Err *err)
{
    VtkData *data = &network->data;
    size_t n = of == GRAPH_POINTS ? data->n_points : data->n_cells;
    return vtk_set_number(&data->arrays[of], name, n - 1, value, network->file_size, err);
}

/* ---- metadata -------------------------------------------------------------------------------- */

Status namednetwork_set_metadata(NamedNetwork *network, const char *comments, Err *err)
{
    VtkArray array = {.text_size = *comments ? strlen(comments) + 1 : 0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_strdup(&array.name, VTK_METADATA, err));
    TRY_GOTO(mem_strdup(&array.text, comments, err));
    for (char *rest = array.text; text_line(&rest);)
        ;
    return vtk_add_array(&network->data.arrays[VTK_OF_FILE], &array, err);
done:
    vtk_release_array(&array);
    return status;
}

void namednetwork_put_metadata(const TreeMeta *meta, Text *text)
{
    Text line = TEXT_INIT;
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);) {
        text_escaped(text, text_chars(&line));
        text_puts(text, "\n");
    }
    text_release(&line);
}

/* ---- the graph ------------------------------------------------------------------------------- */

/* Adds line `i`, whose names begin at `from`. `corner` has space for its points. */
static Status add_line(NamedNetwork *network, size_t i, size_t from, double *corner, Err *err)
{
    size_t n = network->lines.items[i].names_end - from;
    for (size_t k = 0; k < n; k++) {
        size_t point;
        TRY(names_find(&network->names, network->point_names.items[from + k], &point, err));
        corner[k] = (double)point;
    }
    if (n < 2)
        return err_set(err, STATUS_INPUT, "the segment has %zu end points; it must have two", n);
    return vtk_add_line(&network->data, i, corner, n, 0, err);
}

static Status add_lines(NamedNetwork *network, const Graph *graph, Err *err)
{
    double *corner = NULL;
    TRY(mem_calloc(&corner, network->point_names.n, sizeof *corner, "points of lines", err));
    Status status = STATUS_OK;
    for (size_t i = 0, from = 0; i < network->lines.n && status == STATUS_OK; i++) {
        status = add_line(network, i, from, corner, err);
        if (status == STATUS_INPUT)
            err_prefix(err, "%s:%zu: ", graph->name, network->lines.items[i].record);
        from = network->lines.items[i].names_end;
    }
    free(corner);
    return status;
}

Status namednetwork_to_graph(NamedNetwork *network, const char *const axes[3], Graph *graph,
                             Err *err)
{
    VtkData *data = &network->data;
    TRY(vtk_fill_up(&data->arrays[GRAPH_POINTS], data->n_points, network->file_size, err));
    TRY(vtk_fill_up(&data->arrays[GRAPH_LINES], data->n_cells, network->file_size, err));
    TRY(add_lines(network, graph, err));
    TRY(vtk_detach_positions(data, axes, graph->name, err));
    return vtk_to_graph(data, graph, err);
}
