/* Both kinds of files hold points, cells and named arrays of both. An array is what it is by its
 * plain name [vtk_plain_name]: the names of the table of radii are those that programs of vessels
 * use, best first; of equal ones the array of cells is taken, as a segment is a cell. All numbers
 * are kept as doubles, which hold every index that a file of this size can have. */
#include "treeio/vtkdata.h"

#include "treeio/comments.h"
#include "treeio/formats.h"
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- numbers ---- */

static const VtkType types[] = {
    {"char", "Int8", 1, false, true},
    {"signed_char", NULL, 1, false, true},
    {"unsigned_char", "UInt8", 1, false, false},
    {"short", "Int16", 2, false, true},
    {"unsigned_short", "UInt16", 2, false, false},
    {"int", "Int32", 4, false, true},
    {"unsigned_int", "UInt32", 4, false, false},
    {"long", "Int64", 8, false, true},
    {"unsigned_long", "UInt64", 8, false, false},
    {"vtktypeint64", NULL, 8, false, true},
    {"vtktypeuint64", NULL, 8, false, false},
    {"vtkidtype", NULL, 4, false, true}, /* whatever the program that wrote it had */
    {"float", "Float32", 4, true, true},
    {"double", "Float64", 8, true, true},
};

enum { N_TYPES = sizeof types / sizeof *types };

const VtkType *vtk_type_of_legacy(const char *name, size_t length)
{
    for (size_t i = 0; i < N_TYPES; i++)
        if (strlen(types[i].legacy) == length && strncasecmp(types[i].legacy, name, length) == 0)
            return &types[i];
    return NULL;
}

const VtkType *vtk_type_of_xml(const char *name)
{
    for (size_t i = 0; i < N_TYPES; i++)
        if (types[i].xml && strcasecmp(types[i].xml, name) == 0)
            return &types[i];
    return NULL;
}

static double number_of_bits(const VtkType *type, uint64_t bits)
{
    uint32_t low = (uint32_t)bits;
    float single;
    double wide;
    memcpy(&single, &low, sizeof single);
    memcpy(&wide, &bits, sizeof wide);
    if (type->is_float)
        return type->size == 4 ? (double)single : wide;
    if (!type->is_signed)
        return (double)bits;
    int unused = (int)(64 - 8 * type->size);
    return (double)((int64_t)(bits << unused) >> unused);
}

/* The common cases at a fraction of the time: the machine's own order. */
static bool take_plain(const VtkType *type, bool is_big_endian, const char *bytes, size_t n,
                       double *out)
{
    if (is_big_endian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__))
        return false;
    if (type->is_float && type->size == sizeof(double)) {
        if (n > 0)
            memcpy(out, bytes, n * sizeof *out);
        return true;
    }
    if (type->is_float || !type->is_signed || type->size != sizeof(int32_t))
        return false;
    for (size_t i = 0; i < n; i++) {
        int32_t number;
        memcpy(&number, bytes + i * sizeof number, sizeof number);
        out[i] = number;
    }
    return true;
}

void vtk_numbers(const VtkType *type, bool is_big_endian, const char *bytes, size_t n, double *out)
{
    size_t size = type->size;
    if (take_plain(type, is_big_endian, bytes, n, out))
        return;
    for (size_t i = 0; i < n; i++, bytes += size) {
        uint64_t bits = 0;
        for (size_t k = 0; k < size; k++)
            bits = bits << 8 | (unsigned char)bytes[is_big_endian ? k : size - 1 - k];
        out[i] = number_of_bits(type, bits);
    }
}

static uint64_t bits_of_number(const VtkType *type, double number)
{
    float single = (float)number;
    uint32_t low;
    uint64_t bits;
    memcpy(&low, &single, sizeof low);
    memcpy(&bits, &number, sizeof bits);
    if (type->is_float)
        return type->size == 4 ? low : bits;
    return type->is_signed ? (uint64_t)(int64_t)number : (uint64_t)number;
}

void vtk_bytes(const VtkType *type, bool is_big_endian, const double *numbers, size_t n,
               char *bytes)
{
    size_t size = type->size;
    for (size_t i = 0; i < n; i++, bytes += size) {
        uint64_t bits = bits_of_number(type, numbers[i]);
        for (size_t k = 0; k < size; k++, bits >>= 8)
            bytes[is_big_endian ? size - 1 - k : k] = (char)(bits & 0xff);
    }
}

/* ---- data ---- */

void vtk_release_array(VtkArray *array)
{
    free(array->name);
    free(array->value);
    free(array->text);
    *array = (VtkArray){0};
}

static void release_arrays(VtkArrays *arrays)
{
    for (size_t i = 0; i < arrays->n; i++)
        vtk_release_array(&arrays->array[i]);
    free(arrays->array);
}

void vtk_release(VtkData *data)
{
    free(data->point);
    free(data->corner);
    free(data->end);
    free(data->cell);
    release_arrays(&data->of_points);
    release_arrays(&data->of_cells);
    release_arrays(&data->of_file);
    *data = (VtkData){0};
}

Status vtk_add_array(VtkArrays *arrays, VtkArray *array, Err *err)
{
    Status status = mem_reserve(&arrays->array, &arrays->capacity, arrays->n + 1,
                                sizeof *arrays->array, "arrays", err);
    if (status == STATUS_OK)
        arrays->array[arrays->n++] = *array;
    else
        vtk_release_array(array);
    return status;
}

void vtk_release_cells(VtkCells *cells)
{
    free(cells->corner);
    free(cells->end);
    free(cells->type);
    *cells = (VtkCells){0};
}

Status vtk_add_line(VtkData *data, size_t cell, const double *corner, size_t n, size_t first_point,
                    Err *err)
{
    TRY(mem_reserve(&data->corner, &data->corners_capacity, data->n_corners + n,
                    sizeof *data->corner, "points of lines", err));
    TRY(mem_reserve(&data->end, &data->ends_capacity, data->n_lines + 1, sizeof *data->end, "lines",
                    err));
    TRY(mem_reserve(&data->cell, &data->cells_capacity, data->n_lines + 1, sizeof *data->cell,
                    "lines", err));
    for (size_t i = 0; i < n; i++)
        data->corner[data->n_corners++] = corner[i] + (double)first_point;
    data->end[data->n_lines] = data->n_corners;
    data->cell[data->n_lines++] = cell;
    return STATUS_OK;
}

/* A line that is curved in VTK has its middle last. */
static Status add_cell(VtkData *data, double type, const double *corner, size_t n,
                       size_t first_point, Err *err)
{
    size_t cell = data->n_cells++;
    if (type == VTK_QUADRATIC_EDGE && n == 3) {
        const double in_order[] = {corner[0], corner[2], corner[1]};
        return vtk_add_line(data, cell, in_order, n, first_point, err);
    }
    if (type == VTK_LINE || type == VTK_POLY_LINE)
        return vtk_add_line(data, cell, corner, n, first_point, err);
    data->not_lines += type != VTK_VERTEX && type != VTK_POLY_VERTEX;
    return STATUS_OK;
}

Status vtk_add_cells(VtkData *data, const VtkCells *cells, size_t first_point, Err *err)
{
    double at = 0;
    for (size_t i = 0; i < cells->n; i++) {
        double end = cells->end[i];
        if (!(end >= at && end <= (double)cells->n_corners && end == floor(end)))
            return err_set(err, STATUS_INPUT,
                           "cell %zu ends at %g of the numbers of points; ends must rise to at "
                           "most %zu",
                           i, end, cells->n_corners);
        const double *corner = end > at ? cells->corner + (size_t)at : NULL;
        TRY(add_cell(data, cells->type ? cells->type[i] : cells->of, corner, (size_t)(end - at),
                     first_point, err));
        at = end;
    }
    return STATUS_OK;
}

/* ---- names ---- */

void vtk_plain_name(const char *name, char *out, size_t size)
{
    size_t n = 0, length = strcspn(name, "[(");
    for (size_t i = 0; i < length && n + 1 < size; i++)
        if (isalnum((unsigned char)name[i]))
            out[n++] = (char)tolower((unsigned char)name[i]);
    out[n] = '\0';
}

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

bool vtk_is_own(const char *name)
{
    static const char *const own[] = {"radius", "id", "type", "flow_share"};
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

/* ---- what arrays mean ---- */

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

typedef struct Meaning {
    const VtkArray *radius;
    GraphElement of;                   /* that have the radius */
    double factor;                     /* 0.5 of diameters */
    const VtkArray *inlet;             /* of points; NULL: there is none */
    double inlet_value;                /* where the inlets are */
    const VtkArray *id, *type, *share; /* of points, of files that were made of a tree */
} Meaning;

static bool take_radius(Meaning *meaning, const VtkData *data, const char *plain, double factor)
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

/* `what` goes before the list of arrays that there are. */
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

static Status find_radius(Meaning *meaning, const VtkData *data, const Graph *graph, Err *err)
{
    const char *said = graph->options ? graph->options->radius_array : NULL;
    for (size_t i = 0; !said && i < sizeof radius_names / sizeof *radius_names; i++)
        if (take_radius(meaning, data, radius_names[i], 1))
            return STATUS_OK;
    for (size_t i = 0; !said && i < sizeof diameter_names / sizeof *diameter_names; i++)
        if (take_radius(meaning, data, diameter_names[i], 0.5))
            return STATUS_OK;
    if (!said)
        return refuse_radius(data, graph,
                             "no array is called a radius, and `radius_array` names none", err);
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
static void find_inlets(Meaning *meaning, const VtkData *data)
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

/* What the program itself has written of a tree [vtkwrite.c]: lines of text; NULL: nothing. */
static const VtkArray *find_remarks(const VtkData *data)
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

/* A file of the program's own has ids, what is known as text, and one number an array. */
static void find_tree(Meaning *meaning, const VtkData *data)
{
    const VtkArray *id = find_exact(&data->of_points, "id");
    if (meaning->of != GRAPH_POINTS || meaning->factor != 1 || !find_remarks(data) || !id ||
        !are_ids(id) || !are_columns(&data->of_points) || !are_columns(&data->of_cells))
        return;
    meaning->id = id;
    meaning->type = find_exact(&data->of_points, "type");
    meaning->share = find_exact(&data->of_points, "flow_share");
}

static Status find_meaning(Meaning *meaning, const VtkData *data, const Graph *graph, Err *err)
{
    TRY(find_radius(meaning, data, graph, err));
    find_inlets(meaning, data);
    find_tree(meaning, data);
    return STATUS_OK;
}

static Status tell(const Meaning *meaning, const VtkData *data, const Graph *graph, Err *err)
{
    TreeReading *reading = graph->reading;
    TRY(reading_note(reading, err, "radius is %sthe %s array '%.60s'",
                     meaning->factor == 1 ? "" : "half of ",
                     meaning->of == GRAPH_POINTS ? graph->point_record : graph->line_record,
                     meaning->radius->name));
    if (meaning->inlet)
        TRY(reading_note(reading, err, "inlets are the points whose '%.60s' is %g",
                         meaning->inlet->name, meaning->inlet_value));
    if (data->not_lines > 0)
        TRY(reading_note(reading, err, "%zu cells are no lines and are left out", data->not_lines));
    return STATUS_OK;
}

/* Whether an array has become something else than a column; of other programs' files also another
 * of the radius's name, as that of points beside that of cells. */
static bool is_used(const Meaning *meaning, const VtkArray *array)
{
    char plain[PLAIN_SIZE];
    vtk_plain_name(meaning->radius->name, plain, sizeof plain);
    const VtkArray *const used[] = {meaning->radius, meaning->id, meaning->type, meaning->share};
    for (size_t i = 0; i < sizeof used / sizeof *used; i++)
        if (array == used[i])
            return true;
    return !meaning->id && array->components == 1 && has_plain_name(array, plain);
}

/* ---- to the graph ---- */

static Vec3 position_of(const VtkData *data, size_t i)
{
    return (Vec3){data->point[3 * i], data->point[3 * i + 1], data->point[3 * i + 2]};
}

static Status add_points(const Meaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    const VtkArray *radius = meaning->of == GRAPH_POINTS ? meaning->radius : NULL;
    for (size_t i = 0; i < data->n_points; i++) {
        const GraphPoint point = {
            .position = position_of(data, i),
            .radius = radius ? meaning->factor * radius->value[i] : (double)NAN,
            .is_inlet = meaning->inlet && meaning->inlet->value[i] == meaning->inlet_value,
            .record = i};
        TRY(graph_blame(graph, GRAPH_POINTS, i, graph_point(graph, &point, err), err));
    }
    return STATUS_OK;
}

static Status add_lines(const Meaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    const VtkArray *radius = meaning->of == GRAPH_LINES ? meaning->radius : NULL;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++) {
            const GraphLine line = {
                .a = (size_t)data->corner[k - 1],
                .b = (size_t)data->corner[k],
                .radius = radius ? meaning->factor * radius->value[data->cell[i]] : (double)NAN,
                .is_directed = data->is_directed,
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

static Status add_columns(const Meaning *meaning, const VtkData *data, Graph *graph,
                          GraphElement of, Err *err)
{
    enum { MOST_COMPONENTS = 16 };
    const VtkArrays *arrays = of == GRAPH_POINTS ? &data->of_points : &data->of_cells;
    for (size_t i = 0; i < arrays->n; i++) {
        const VtkArray *array = &arrays->array[i];
        if (is_used(meaning, array))
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

/* ---- to a tree ---- */

static Status read_remark(TreeBuilder *builder, const char *line, Err *err)
{
    Text comment = TEXT_INIT;
    text_printf(&comment, " %s", line);
    Status status = text_check(&comment, err);
    if (status == STATUS_OK)
        status = comment_read(&builder->meta, text_chars(&comment), err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", builder->name);
    text_release(&comment);
    return status;
}

static Status read_remarks(const VtkArray *remarks, TreeBuilder *builder, Err *err)
{
    for (size_t at = 0; at < remarks->text_size; at += strlen(remarks->text + at) + 1)
        TRY(read_remark(builder, remarks->text + at, err));
    return STATUS_OK;
}

/* Of each id that there may be: the point and the cell that have the node's values, + 1, and its
 * parent's id; 0 for none. */
typedef struct Nodes {
    uint32_t *point, *cell;
    int32_t *parent;
    size_t n;
} Nodes;

/* A node's values are at the end of the line to it, a root's at its first point. */
static Status find_nodes(const Meaning *meaning, const VtkData *data, const Graph *graph,
                         Nodes *nodes, Err *err)
{
    const double *id = meaning->id->value;
    for (size_t i = data->n_points; i-- > 0;)
        nodes->point[(size_t)id[i]] = (uint32_t)i + 1;
    for (size_t i = 0, at = 0; i < data->n_lines; at = data->end[i++])
        for (size_t k = at + 1; k < data->end[i]; k++) {
            size_t from = (size_t)data->corner[k - 1], to = (size_t)data->corner[k];
            size_t node = (size_t)id[to];
            if (nodes->parent[node])
                return graph_blame(
                    graph, GRAPH_LINES, data->cell[i],
                    err_set(err, STATUS_INPUT, "it leads to node %zu, as another line does", node),
                    err);
            nodes->parent[node] = (int32_t)id[from];
            nodes->point[node] = (uint32_t)to + 1;
            nodes->cell[node] = (uint32_t)data->cell[i] + 1;
        }
    return STATUS_OK;
}

static Status make_nodes(const Meaning *meaning, const VtkData *data, const Graph *graph,
                         Nodes *nodes, Err *err)
{
    for (size_t i = 0; i < meaning->id->n; i++)
        if ((size_t)meaning->id->value[i] > nodes->n)
            nodes->n = (size_t)meaning->id->value[i];
    TRY(mem_calloc(&nodes->point, nodes->n + 1, sizeof *nodes->point, "nodes", err));
    TRY(mem_calloc(&nodes->cell, nodes->n + 1, sizeof *nodes->cell, "nodes", err));
    TRY(mem_calloc(&nodes->parent, nodes->n + 1, sizeof *nodes->parent, "nodes", err));
    return find_nodes(meaning, data, graph, nodes, err);
}

static Status add_node(const Meaning *meaning, const VtkData *data, TreeBuilder *builder,
                       const Nodes *nodes, size_t id, Err *err)
{
    size_t i = nodes->point[id] - 1;
    double type = meaning->type ? meaning->type->value[i] : TREE_VESSEL_TYPE;
    double share = meaning->share ? meaning->share->value[i] : 0;
    if (!(fabs(type) <= INT32_MAX))
        return err_set(err, STATUS_INPUT, "the type is %g, which is no whole number", type);
    const BuilderNode node = {.id = (int64_t)id,
                              .parent = nodes->parent[id] ? nodes->parent[id] : TREE_NO_PARENT,
                              .type = (int32_t)type,
                              .position = position_of(data, i),
                              .radius_mm = meaning->radius->value[i],
                              .record = i};
    TRY(builder_node(builder, &node, err));
    return isnan(share) || share == 0 ? STATUS_OK : builder_share(builder, node.id, share, i, err);
}

/* The arrays that are columns, those of points first; the builder has them in this order. */
typedef struct Columns {
    const VtkArray **array;
    size_t n, of_points;
} Columns;

static Status add_column_of(const VtkArray *array, TreeBuilder *builder, Err *err)
{
    char *title = NULL;
    size_t number;
    TRY(mem_strdup(&title, array->name, err));
    const char *unit = csv_unit(title);
    if (vtk_is_own(title))
        title[strlen(title) - 1] = '\0';
    Status status = builder_column(builder, title, unit, &number, err);
    free(title);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", builder->name);
    return status;
}

static Status list_columns(const Meaning *meaning, const VtkArrays *arrays, TreeBuilder *builder,
                           Columns *columns, Err *err)
{
    for (size_t i = 0; i < arrays->n; i++) {
        const VtkArray *array = &arrays->array[i];
        if (is_used(meaning, array) || !array->value)
            continue;
        TRY(add_column_of(array, builder, err));
        columns->array[columns->n++] = array;
    }
    return STATUS_OK;
}

static Status add_values_of(const Columns *columns, const Nodes *nodes, size_t id,
                            TreeBuilder *builder, Err *err)
{
    for (size_t k = 0; k < columns->n; k++) {
        size_t at = k < columns->of_points ? nodes->point[id] : nodes->cell[id];
        double value = at ? columns->array[k]->value[at - 1] : (double)NAN;
        if (!isnan(value))
            TRY(builder_value(builder, k, value, err));
    }
    return STATUS_OK;
}

static Status add_nodes(const Meaning *meaning, const VtkData *data, TreeBuilder *builder,
                        const Nodes *nodes, Err *err)
{
    Columns columns = {0};
    Status status = STATUS_OK;
    TRY(mem_calloc(&columns.array, data->of_points.n + data->of_cells.n, sizeof(VtkArray *),
                   "columns", err));
    TRY_GOTO(list_columns(meaning, &data->of_points, builder, &columns, err));
    columns.of_points = columns.n;
    TRY_GOTO(list_columns(meaning, &data->of_cells, builder, &columns, err));
    for (size_t id = 1; id <= nodes->n; id++) {
        if (!nodes->point[id])
            continue;
        status = add_node(meaning, data, builder, nodes, id, err);
        TRY_GOTO(builder_blame(builder, nodes->point[id] - 1, status, err));
        TRY_GOTO(add_values_of(&columns, nodes, id, builder, err));
    }
done:
    free(columns.array);
    return status;
}

/* A file of the program's own: points of one id are one node, lines lead away from the root. Nodes
 * are handed over in the order of their ids, which is that of the tree when it was written. */
static Status to_tree(const Meaning *meaning, const VtkData *data, Graph *graph, Err *err)
{
    Nodes nodes = {0};
    TreeBuilder *builder = graph->tree;
    builder->record = graph->point_record;
    TRY(read_remarks(find_remarks(data), builder, err));
    Status status = make_nodes(meaning, data, graph, &nodes, err);
    if (status == STATUS_OK)
        status = add_nodes(meaning, data, builder, &nodes, err);
    free(nodes.point);
    free(nodes.cell);
    free(nodes.parent);
    return status;
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
            if (both[of]->array[i].n != counts[of])
                return err_set(err, STATUS_INPUT, "%s: the array '%.60s' has %zu values for %zu %s",
                               graph->name, both[of]->array[i].name, both[of]->array[i].n,
                               counts[of], of ? "cells" : "points");
    return STATUS_OK;
}

Status vtk_to_graph(const VtkData *data, Graph *graph, Err *err)
{
    Meaning meaning = {0};
    graph->point_record = graph->point_record ? graph->point_record : "point";
    graph->line_record = graph->line_record ? graph->line_record : "cell";
    TRY(check_sizes(data, graph, err));
    if (data->n_lines == 0 && !find_remarks(data))
        return err_set(err, STATUS_INPUT, "%s: there are no lines in it%s", graph->name,
                       data->n_cells ? ", only other cells" : "");
    TRY(find_meaning(&meaning, data, graph, err));
    if (meaning.id)
        return to_tree(&meaning, data, graph, err);
    TRY(tell(&meaning, data, graph, err));
    TRY(add_points(&meaning, data, graph, err));
    TRY(add_lines(&meaning, data, graph, err));
    TRY(add_columns(&meaning, data, graph, GRAPH_POINTS, err));
    return add_columns(&meaning, data, graph, GRAPH_LINES, err);
}
