/* Finds the meaning of an array by its plain name: the name in lower case, without blanks, other
 * signs and a unit in brackets. A table lists the names that programs for vessels give to radii and
 * diameters, best first. If an array of cells and an array of points have the same name, the array
 * of cells is used, because a segment is a cell. In a file that corcast wrote, arrays are found by
 * their exact names. */
#include "treeio/vtk/vtkmeaning.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLAIN_SIZE = 64 };

static void to_plain(const char *name, char out[PLAIN_SIZE])
{
    size_t n = 0, length = strcspn(name, "[(");
    for (size_t i = 0; i < length && n + 1 < PLAIN_SIZE; i++)
        if (isalnum((unsigned char)name[i]))
            out[n++] = (char)tolower((unsigned char)name[i]);
    out[n] = '\0';
}

static bool has_plain_name(const VtkArray *array, const char *plain)
{
    char name[PLAIN_SIZE];
    to_plain(array->name, name);
    return strcmp(name, plain) == 0;
}

static bool is_scalar(const VtkArray *array)
{
    return array->value && array->components == 1;
}

/* Returns the array of scalars of this plain name (or exact name), or NULL. */
static const VtkArray *find_scalars(const VtkArrays *arrays, const char *name, bool exact)
{
    for (size_t i = 0; i < arrays->n; i++) {
        const VtkArray *array = &arrays->array[i];
        if (is_scalar(array) &&
            (exact ? strcmp(array->name, name) == 0 : has_plain_name(array, name)))
            return array;
    }
    return NULL;
}

/* ---- radii ----------------------------------------------------------------------------------- */

/* Plain names of radii and then of diameters, best first. */
static const char *const radius_names[] = {
    "radius",
    "maximuminscribedsphereradius",
    "vesselradius",
    "segmentradius",
    "edgeradius",
    "radii",
    "radiusavg",
    "avgradius",
    "meanradius",
    "noderadius",
    "radiusmm",
    "radiusum",
    "rad",
    "r",
    "thickness",
    "diameter",
    "vesseldiameter",
    "diameters",
    "diametermm",
    "diam",
};
enum { N_RADIUS_NAMES = sizeof radius_names / sizeof *radius_names };

/* Uses the array of cells with this name or, if there is none, the array of points. Returns false
 * if there is neither. */
static bool take_radius(VtkMeaning *meaning, const VtkData *data, const char *name, bool exact)
{
    char plain[PLAIN_SIZE];
    to_plain(name, plain);
    const VtkArray *of_cells = find_scalars(&data->arrays[GRAPH_LINES], name, exact);
    meaning->radius = of_cells ? of_cells : find_scalars(&data->arrays[GRAPH_POINTS], name, exact);
    meaning->radius_element = of_cells ? GRAPH_LINES : GRAPH_POINTS;
    meaning->radius_factor = strstr(plain, "diam") ? 0.5 : 1;
    return meaning->radius != NULL;
}

/* Appends the first names of arrays of scalars, and counts all of them in *n. */
static void put_names(const VtkArrays *arrays, const char *of, Text *text, size_t *n)
{
    enum { SHOWN = 12 };
    for (size_t i = 0; i < arrays->n; i++)
        if (is_scalar(&arrays->array[i]) && (*n)++ < SHOWN) {
            text_puts(text, *n > 1 ? ", '" : "'");
            text_put_line(text, arrays->array[i].name);
            text_printf(text, "' of %ss", of);
        }
}

/* Refuses a file without radii. The sentence is `what`, then a list of the arrays. */
static Status refuse_radius(const VtkData *data, const Graph *graph, const char *what, Err *err)
{
    Text names = TEXT_INIT;
    size_t n = 0;
    put_names(&data->arrays[GRAPH_POINTS], graph->point_record, &names, &n);
    put_names(&data->arrays[GRAPH_LINES], graph->line_record, &names, &n);
    Status status = text_check(&names, err);
    if (status == STATUS_OK)
        status = err_set(err, STATUS_INPUT, "%s: %s; %s%.600s", graph->name, what,
                         n ? "the arrays with one number per element are "
                           : "no array has one number per element",
                         text_chars(&names));
    text_release(&names);
    return status;
}

/* Finds the array of radii: the one that the option names, or the one with the best known name. */
static Status find_radius(VtkMeaning *meaning, const VtkData *data, const Graph *graph, Err *err)
{
    const char *wanted = graph->options ? graph->options->radius_array : NULL;
    for (size_t i = 0; !wanted && i < N_RADIUS_NAMES; i++)
        if (take_radius(meaning, data, radius_names[i], false))
            return STATUS_OK;
    if (!wanted && graph->options && graph->options->radius_mm > 0)
        return STATUS_OK;
    if (!wanted)
        return refuse_radius(
            data, graph,
            "no array has the name of a radius; name one with `radius_array`, or set `radius`",
            err);
    char what[160];
    snprintf(what, sizeof what, "there is no array '%.60s' of one number for each point or cell",
             wanted);
    return take_radius(meaning, data, wanted, true) ? STATUS_OK
                                                    : refuse_radius(data, graph, what, err);
}

/* ---- inlets, and trees of corcast ------------------------------------------------------------ */

/* Finds an array that marks inlets. Inlets are the points with the largest value of the array; the
 * array must also have another value. */
static void find_inlets(VtkMeaning *meaning, const VtkData *data)
{
    static const char *const names[] = {"root", "inlet", "isinlet", "nodeisinput"};
    for (size_t i = 0; i < sizeof names / sizeof *names && !meaning->inlet; i++) {
        const VtkArray *array = find_scalars(&data->arrays[GRAPH_POINTS], names[i], false);
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

const VtkArray *vtk_find_metadata(const VtkData *data)
{
    const VtkArrays *arrays = &data->arrays[VTK_OF_FILE];
    for (size_t i = 0; i < arrays->n; i++)
        if (!arrays->array[i].value && strcmp(arrays->array[i].name, VTK_METADATA) == 0)
            return &arrays->array[i];
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

/* Recognizes a file that corcast wrote: it has ids, radii, metadata as text, and arrays of one
 * component. */
static void find_tree(VtkMeaning *meaning, const VtkData *data)
{
    const VtkArrays *points = &data->arrays[GRAPH_POINTS];
    const VtkArray *id = find_scalars(points, "id", true);
    const VtkArray *radius = find_scalars(points, "radius", true);
    if (!vtk_find_metadata(data) || !radius || !id || !are_ids(id) || !are_columns(points) ||
        !are_columns(&data->arrays[GRAPH_LINES]))
        return;
    *meaning =
        (VtkMeaning){.radius = radius,
                     .radius_element = GRAPH_POINTS,
                     .radius_factor = 1,
                     .id = id,
                     .type = find_scalars(points, "type", true),
                     .flow_share = find_scalars(points, "flow_share", true),
                     .cell_radius = find_scalars(&data->arrays[GRAPH_LINES], "radius", true)};
    for (int of = GRAPH_POINTS; of <= GRAPH_LINES; of++)
        meaning->link[of] = find_scalars(&data->arrays[of], "link_id", true);
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

Status vtk_note_assumptions(const VtkMeaning *meaning, const VtkData *data, const Graph *graph,
                            Err *err)
{
    TreeReading *reading = graph->reading;
    bool one = data->not_lines == 1;
    if (meaning->radius)
        TRY(reading_note(reading, err, "radius is %sthe %s array '%.60s'",
                         meaning->radius_factor == 1 ? "" : "half of ",
                         meaning->radius_element == GRAPH_POINTS ? graph->point_record
                                                                 : graph->line_record,
                         meaning->radius->name));
    if (meaning->inlet)
        TRY(reading_note(reading, err, "inlets are the points whose '%.60s' is %g",
                         meaning->inlet->name, meaning->inlet_value));
    if (data->not_lines > 0)
        TRY(reading_note(reading, err, "%zu cell%s no line%s left out", data->not_lines,
                         one ? " is" : "s are", one ? " and is" : "s and are"));
    return STATUS_OK;
}

bool vtk_has_meaning(const VtkMeaning *meaning, const VtkArray *array)
{
    char plain[PLAIN_SIZE] = "";
    if (meaning->radius)
        to_plain(meaning->radius->name, plain);
    if (array == meaning->radius || array == meaning->id || array == meaning->type ||
        array == meaning->flow_share || array == meaning->cell_radius ||
        array == meaning->link[GRAPH_POINTS] || array == meaning->link[GRAPH_LINES])
        return true;
    return *plain && !meaning->id && array->components == 1 && has_plain_name(array, plain);
}

/* ---- names ----------------------------------------------------------------------------------- */

bool vtk_is_own(const char *name)
{
    static const char *const own[] = {"radius", "id", "type", "flow_share", "link_id"};
    size_t length = strlen(name);
    while (length > 0 && name[length - 1] == '_')
        length--;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strlen(own[i]) == length && strncmp(own[i], name, length) == 0)
            return true;
    return false;
}

void vtk_put_column_name(const TreeColumn *column, Text *text)
{
    text_put_line(text, column->name);
    if (vtk_is_own(column->name))
        text_puts(text, "_");
    if (!*column->unit)
        return;
    text_puts(text, " [");
    text_put_line(text, column->unit);
    text_puts(text, "]");
}
