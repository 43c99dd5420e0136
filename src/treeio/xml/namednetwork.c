/* Lines are kept by the names of their ends until all points are there. */
#include "treeio/xml/namednetwork.h"

#include "treeio/comments.h"

#include <stdlib.h>
#include <string.h>

typedef struct NamedLine {
    char *end[2]; /* names */
    size_t record;
} NamedLine;

void namednetwork_release(NamedNetwork *network)
{
    names_release(&network->names);
    slabs_release(&network->texts);
    attributes_release(&network->of_points);
    attributes_release(&network->of_lines);
    free(network->line);
    vtk_release(&network->data);
    *network = (NamedNetwork){0};
}

static Status keep(NamedNetwork *network, const char *text, char **out, Err *err)
{
    *out = slabs_text(&network->texts, text);
    return *out ? STATUS_OK : mem_out_of("for", "names of nodes", err);
}

Status namednetwork_point(NamedNetwork *network, const char *name, size_t record, Err *err)
{
    char *kept;
    TRY(keep(network, name, &kept, err));
    TRY(names_add(&network->names, kept, network->of_points.n, record, err));
    attributes_add(&network->of_points);
    return STATUS_OK;
}

Status namednetwork_line(NamedNetwork *network, const char *from, const char *to, size_t record,
                         Err *err)
{
    NamedLine line = {.record = record};
    TRY(keep(network, from, &line.end[0], err));
    TRY(keep(network, to, &line.end[1], err));
    TRY(mem_reserve(&network->line, &network->lines_capacity, network->n_lines + 1, sizeof line,
                    "lines", err));
    network->line[network->n_lines++] = line;
    attributes_add(&network->of_lines);
    return STATUS_OK;
}

static Status find_ends(NamedNetwork *network, const Graph *graph, Err *err)
{
    for (size_t i = 0; i < network->n_lines; i++) {
        double corner[2];
        for (int k = 0; k < 2; k++) {
            size_t number;
            Status status = names_find(&network->names, network->line[i].end[k], &number, err);
            if (status == STATUS_INPUT)
                err_prefix(err, "%s:%zu: ", graph->name, network->line[i].record);
            TRY(status);
            corner[k] = (double)number;
        }
        TRY(vtk_add_line(&network->data, i, corner, 2, 0, err));
    }
    network->data.n_cells = network->n_lines;
    return STATUS_OK;
}

Status namednetwork_known(NamedNetwork *network, const char *comments, Err *err)
{
    VtkArray array = {.text_size = *comments ? strlen(comments) + 1 : 0};
    Status status = STATUS_OK;
    TRY_GOTO(mem_strdup(&array.name, VTK_KNOWN, err));
    TRY_GOTO(mem_strdup(&array.text, comments, err));
    for (char *rest = array.text; text_line(&rest);)
        ;
    return vtk_add_array(&network->data.of_file, &array, err);
done:
    vtk_release_array(&array);
    return status;
}

void namednetwork_put_known(const TreeMeta *meta, Text *text)
{
    Text line = TEXT_INIT;
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);) {
        text_escaped(text, text_chars(&line));
        text_puts(text, "\n");
    }
    text_release(&line);
}

static void drop_array(VtkArrays *arrays, const char *name)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (strcmp(arrays->array[i].name, name) == 0) {
            vtk_release_array(&arrays->array[i]);
            memmove(&arrays->array[i], &arrays->array[i + 1],
                    (--arrays->n - i) * sizeof *arrays->array);
            return;
        }
}

Status namednetwork_to_graph(NamedNetwork *network, const char *const axes[3], Graph *graph,
                             Err *err)
{
    VtkData *data = &network->data;
    data->n_points = network->of_points.n;
    TRY(attributes_take(&network->of_points, &data->of_points, err));
    TRY(attributes_take(&network->of_lines, &data->of_cells, err));
    if (data->of_file.n > 0)
        drop_array(&data->of_cells, "radius");
    TRY(find_ends(network, graph, err));
    TRY(attributes_to_places(data, axes, graph->name, err));
    graph->point_record = "node";
    graph->line_record = "edge";
    return vtk_to_graph(data, graph, err);
}
