/* An array is what it is by its plain name [vtk_plain_name]: the names of the table of radii are
 * those that programs of vessels use, best first; of equal ones the array of cells is taken, as a
 * segment is a cell. A file that the program wrote is read by its own names alone. */
#include "treeio/vtk/vtkmeaning.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLAIN_SIZE = 64 };

static bool has_plain_name(const VtkArray *array, const char *plain)
{
    char name[PLAIN_SIZE];
    vtk_plain_name(array->name, name, sizeof name);
    return strcmp(name, plain) == 0;
}

/* The array of one number a tuple that has this plain name; NULL when there is none. */
static const VtkArray *find_plain(const VtkArrays *arrays, const char *plain)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (arrays->array[i].value && arrays->array[i].components == 1 &&
            has_plain_name(&arrays->array[i], plain))
            return &arrays->array[i];
    return NULL;
}

static const VtkArray *find_exact(const VtkArrays *arrays, const char *name)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (arrays->array[i].value && arrays->array[i].components == 1 &&
            strcmp(arrays->array[i].name, name) == 0)
            return &arrays->array[i];
    return NULL;
}

/* Plain names of radii, and of diameters, best first. */
static const char *const radius_names[] = {
    "radius",       "maximuminscribedsphereradius",
    "vesselradius", "segmentradius",
    "edgeradius",   "radii",
    "radiusavg",    "avgradius",
    "meanradius",   "noderadius",
    "radiusmm",     "radiusum",
    "rad",          "r",
    "thickness",
};
static const char *const diameter_names[] = {"diameter", "vesseldiameter", "diameters",
                                             "diametermm", "diam"};

static bool take_radius(VtkMeaning *meaning, const VtkData *data, const char *plain, double factor)
{
    const VtkArray *of_cells = find_plain(&data->of_cells, plain);
    const VtkArray *of_points = find_plain(&data->of_points, plain);
    meaning->radius = of_cells ? of_cells : of_points;
    meaning->of = of_cells ? GRAPH_LINES : GRAPH_POINTS;
    meaning->factor = factor;
    return meaning->radius != NULL;
}

static void put_names(const VtkArrays *arrays, const char *of, Text *text, size_t *n)
{
    enum { SHOWN = 12 };
    for (size_t i = 0; i < arrays->n; i++)
        if (arrays->array[i].value && arrays->array[i].components == 1 && (*n)++ < SHOWN) {
            text_puts(text, *n > 1 ? ", '" : "'");
            text_put_line(text, arrays->array[i].name);
            text_printf(text, "' of %ss", of);
        }
}

/* The sentence is `what`, then the list of arrays that there are. */
static Status refuse_radius(const VtkData *data, const Graph *graph, const char *what, Err *err)
{
    Text names = TEXT_INIT;
    size_t n = 0;
    put_names(&data->of_points, graph->point_record, &names, &n);
    put_names(&data->of_cells, graph->line_record, &names, &n);
    Status status = text_check(&names, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_INPUT, "%s: %s; %s%.600s", graph->name, what,
                         n ? "its arrays of one number are " : "it has no array of one number",
                         text_chars(&names));
    text_release(&names);
    return status;
}

static Status find_radius(VtkMeaning *meaning, const VtkData *data, const Graph *graph, Err *err)
{
    const char *said = graph->options ? graph->options->radius_array : NULL;
    for (size_t i = 0; !said && i < sizeof radius_names / sizeof *radius_names; i++)
        if (take_radius(meaning, data, radius_names[i], 1))
            return STATUS_OK;
    for (size_t i = 0; !said && i < sizeof diameter_names / sizeof *diameter_names; i++)
        if (take_radius(meaning, data, diameter_names[i], 0.5))
            return STATUS_OK;
    if (!said && graph->options && graph->options->radius_mm > 0)
        return STATUS_OK;
    if (!said)
        return refuse_radius(data, graph,
                             "no array is called a radius, `radius_array` names none, and `radius` "
                             "gives none",
                             err);
    char plain[PLAIN_SIZE], what[160];
    vtk_plain_name(said, plain, sizeof plain);
    const VtkArray *of_cells = find_exact(&data->of_cells, said);
    meaning->radius = of_cells ? of_cells : find_exact(&data->of_points, said);
    meaning->of = of_cells ? GRAPH_LINES : GRAPH_POINTS;
    meaning->factor = strstr(plain, "diam") ? 0.5 : 1;
    snprintf(what, sizeof what, "there is no array '%.60s' of one number for each point or cell",
             said);
    return meaning->radius ? STATUS_OK : refuse_radius(data, graph, what, err);
}

/* Inlets have the largest value of an array of this name, if it has others. */
static void find_inlets(VtkMeaning *meaning, const VtkData *data)
{
    static const char *const names[] = {"root", "inlet", "isinlet", "nodeisinput"};
    for (size_t i = 0; i < sizeof names / sizeof *names && !meaning->inlet; i++) {
        const VtkArray *array = find_plain(&data->of_points, names[i]);
        double low = HUGE_VAL, high = 0;
        for (size_t k = 0; array && k < array->n; k++) {
            low = fmin(low, array->value[k]);
            high = fmax(high, array->value[k]);
        }
        if (array && low < high) {
            meaning->inlet = array;
            meaning->inlet_value = high;
        }
    }
}

const VtkArray *vtk_find_known(const VtkData *data)
{
    for (size_t i = 0; i < data->of_file.n; i++)
        if (!data->of_file.array[i].value && strcmp(data->of_file.array[i].name, VTK_KNOWN) == 0)
            return &data->of_file.array[i];
    return NULL;
}

static bool are_ids(const VtkArray *array)
{
    for (size_t i = 0; i < array->n; i++)
        if (!(array->value[i] >= 1 && array->value[i] <= TREE_MAX_ID &&
              array->value[i] == floor(array->value[i])))
            return false;
    return true;
}

static bool are_columns(const VtkArrays *arrays)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (arrays->array[i].components != 1)
            return false;
    return true;
}

/* A file of the program's own has ids, radii, what is known as text, and one number an array. */
static void find_tree(VtkMeaning *meaning, const VtkData *data)
{
    const VtkArray *id = find_exact(&data->of_points, "id");
    const VtkArray *radius = find_exact(&data->of_points, "radius");
    if (!vtk_find_known(data) || !radius || !id || !are_ids(id) || !are_columns(&data->of_points) ||
        !are_columns(&data->of_cells))
        return;
    *meaning = (VtkMeaning){.radius = radius,
                            .of = GRAPH_POINTS,
                            .factor = 1,
                            .id = id,
                            .type = find_exact(&data->of_points, "type"),
                            .share = find_exact(&data->of_points, "flow_share")};
}

Status vtk_find_meaning(VtkMeaning *meaning, const VtkData *data, const Graph *graph, Err *err)
{
    *meaning = (VtkMeaning){0};
    find_tree(meaning, data);
    if (meaning->id)
        return STATUS_OK;
    TRY(find_radius(meaning, data, graph, err));
    find_inlets(meaning, data);
    return STATUS_OK;
}

Status vtk_tell_meaning(const VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                        Err *err)
{
    TreeReading *reading = graph->reading;
    if (meaning->radius)
        TRY(reading_note(reading, err, "radius is %sthe %s array '%.60s'",
                         meaning->factor == 1 ? "" : "half of ",
                         meaning->of == GRAPH_POINTS ? graph->point_record : graph->line_record,
                         meaning->radius->name));
    if (meaning->inlet)
        TRY(reading_note(reading, err, "inlets are the points whose '%.60s' is %g",
                         meaning->inlet->name, meaning->inlet_value));
    if (data->not_lines > 0)
        TRY(reading_note(reading, err, "%zu cell%s no line%s left out", data->not_lines,
                         data->not_lines == 1 ? " is" : "s are",
                         data->not_lines == 1 ? " and is" : "s and are"));
    return STATUS_OK;
}

bool vtk_is_used(const VtkMeaning *meaning, const VtkArray *array)
{
    char plain[PLAIN_SIZE] = "";
    if (meaning->radius)
        vtk_plain_name(meaning->radius->name, plain, sizeof plain);
    const VtkArray *const used[] = {meaning->radius, meaning->id, meaning->type, meaning->share};
    for (size_t i = 0; i < sizeof used / sizeof *used; i++)
        if (array == used[i])
            return true;
    return *plain && !meaning->id && array->components == 1 && has_plain_name(array, plain);
}
