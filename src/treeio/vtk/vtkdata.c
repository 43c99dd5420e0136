/* Holds the points, lines and arrays of a file in VTK's data model, and converts numbers between
 * bytes and doubles.
 *
 * All numbers are stored as doubles, which represent every index of a file exactly. Values are
 * assembled from bytes by shifts, in any byte order. The two most common types in the byte order of
 * the machine are copied, which takes a fraction of the time. */
#include "treeio/vtk/vtkdata.h"

#include "treeio/cursor.h"
#include "treeio/formats.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- types ----------------------------------------------------------------------------------- */

typedef struct VtkTypeRow {
    size_t size; /* of a value, in bytes */
    bool is_float, is_signed;
} VtkTypeRow;

static const VtkTypeRow types[VTK_TYPES] = {
    [VTK_TEXT] = {1, false, false},   [VTK_INT8] = {1, false, true},
    [VTK_UINT8] = {1, false, false},  [VTK_INT16] = {2, false, true},
    [VTK_UINT16] = {2, false, false}, [VTK_INT32] = {4, false, true},
    [VTK_UINT32] = {4, false, false}, [VTK_INT64] = {8, false, true},
    [VTK_UINT64] = {8, false, false}, [VTK_FLOAT] = {4, true, true},
    [VTK_DOUBLE] = {8, true, true},
};

/* The names of types in each format. A type may have several names; the first is written. */
static const struct {
    VtkType type;
    const char *name[NAMINGS]; /* NULL: the format has no such name */
} type_names[] = {
    {VTK_TEXT, {"string", "String"}},
    {VTK_INT8, {"char", "Int8"}},
    {VTK_INT8, {"signed_char"}},
    {VTK_UINT8, {"unsigned_char", "UInt8", "byte"}},
    {VTK_INT16, {"short", "Int16", "short"}},
    {VTK_UINT16, {"unsigned_short", "UInt16", "ushort"}},
    {VTK_INT32, {"int", "Int32", "int"}},
    {VTK_INT32, {"vtkidtype"}}, /* 4 bytes in legacy files, for any size of the writer's ids */
    {VTK_UINT32, {"unsigned_int", "UInt32"}},
    {VTK_INT64, {"long", "Int64", "long"}},
    {VTK_INT64, {"vtktypeint64"}},
    {VTK_UINT64, {"unsigned_long", "UInt64"}},
    {VTK_UINT64, {"vtktypeuint64"}},
    {VTK_FLOAT, {"float", "Float32", "float", "MET_FLOAT"}},
    {VTK_DOUBLE, {"double", "Float64", "double", "MET_DOUBLE"}},
};

enum { N_TYPE_NAMES = sizeof type_names / sizeof *type_names };

VtkType vtk_type_called(VtkNaming naming, const char *name, size_t length)
{
    for (size_t i = 0; i < N_TYPE_NAMES; i++) {
        const char *known = type_names[i].name[naming];
        if (known && strlen(known) == length && strncasecmp(known, name, length) == 0)
            return type_names[i].type;
    }
    return VTK_TYPES;
}

Status vtk_find_type(VtkNaming naming, const char *name, const char *numbers_only, VtkType *type,
                     Err *err)
{
    VtkType found = vtk_type_called(naming, name, strlen(name));
    if (found == VTK_TYPES)
        return err_set(err, STATUS_INPUT, "'%.40s' is not a type of numbers", name);
    if (found == VTK_TEXT && numbers_only)
        return err_set(err, STATUS_INPUT, "%s are strings; they must be numbers", numbers_only);
    *type = found;
    return STATUS_OK;
}

const char *vtk_type_name(VtkNaming naming, VtkType type)
{
    size_t i = 0;
    while (type_names[i].type != type)
        i++;
    return type_names[i].name[naming];
}

size_t vtk_type_size(VtkType type)
{
    return types[type].size;
}

static double number_of_bits(const VtkTypeRow *type, uint64_t bits)
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

/* Converts doubles and 32-bit integers in the byte order of the machine. Returns false for other
 * values. */
static bool take_plain(VtkType type, bool is_big_endian, const char *bytes, size_t n, double *out)
{
    if (is_big_endian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__))
        return false;
    if (type == VTK_DOUBLE) {
        if (n > 0)
            memcpy(out, bytes, n * sizeof *out);
        return true;
    }
    for (size_t i = 0; type == VTK_INT32 && i < n; i++) {
        int32_t number;
        memcpy(&number, bytes + i * sizeof number, sizeof number);
        out[i] = number;
    }
    return type == VTK_INT32;
}

typedef struct VtkValues {
    VtkType type;
    bool is_big_endian;
    const char *bytes;
    size_t n;
    double *out;
} VtkValues;

/* Numbers that a thread converts at once: two huge pages of doubles. */
enum { BLOCK = 1 << 19 };

static void take_block(size_t index, int worker, void *context)
{
    const VtkValues all = *(const VtkValues *)context;
    const VtkTypeRow *type = &types[all.type];
    size_t size = type->size, first = index * BLOCK, left = all.n - first;
    size_t n = left < BLOCK ? left : BLOCK;
    const char *bytes = all.bytes + first * size;
    (void)worker;
    if (take_plain(all.type, all.is_big_endian, bytes, n, all.out + first))
        return;
    for (size_t i = 0; i < n; i++, bytes += size) {
        uint64_t bits = 0;
        for (size_t k = 0; k < size; k++)
            bits = bits << 8 | (unsigned char)bytes[all.is_big_endian ? k : size - 1 - k];
        all.out[first + i] = number_of_bits(type, bits);
    }
}

/* Several threads are worth their start because the system clears the pages of `out` when they are
 * first written, which takes longer than the conversion. */
void vtk_numbers(VtkType type, bool is_big_endian, const char *bytes, size_t n, double *out)
{
    VtkValues all = {type, is_big_endian, bytes, n, out};
    threads_for((n + BLOCK - 1) / BLOCK, 0, take_block, &all);
}

static uint64_t bits_of_number(VtkType type, double number)
{
    float single = (float)number;
    uint32_t low;
    uint64_t bits;
    memcpy(&low, &single, sizeof low);
    memcpy(&bits, &number, sizeof bits);
    if (types[type].is_float)
        return type == VTK_FLOAT ? low : bits;
    return types[type].is_signed ? (uint64_t)(int64_t)number : (uint64_t)number;
}

void vtk_bytes(VtkType type, bool is_big_endian, const double *numbers, size_t n, char *bytes)
{
    size_t size = types[type].size;
    for (size_t i = 0; i < n; i++, bytes += size) {
        uint64_t bits = bits_of_number(type, numbers[i]);
        for (size_t k = 0; k < size; k++, bits >>= 8)
            bytes[is_big_endian ? size - 1 - k : k] = (char)(bits & 0xff);
    }
}

/* ---- arrays ---------------------------------------------------------------------------------- */

void vtk_release_array(VtkArray *array)
{
    free(array->name);
    free(array->value);
    free(array->text);
    *array = (VtkArray){0};
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

VtkArray *vtk_find_array(const VtkArrays *arrays, const char *name)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (strcmp(arrays->array[i].name, name) == 0)
            return &arrays->array[i];
    return NULL;
}

/* Removes the array of this name and releases it. Returns its values (owned), or NULL if there is
 * no such array. `name` may be NULL. */
static double *vtk_detach_values(VtkArrays *arrays, const char *name)
{
    VtkArray *array = name ? vtk_find_array(arrays, name) : NULL;
    if (!array)
        return NULL;
    double *value = array->value;
    array->value = NULL;
    vtk_release_array(array);
    memmove(array, array + 1, (size_t)(arrays->array + --arrays->n - array) * sizeof *array);
    return value;
}

/* Extends an array to at least `n` values with NAN, and sets value n - 1. */
static Status fill(VtkArrays *arrays, VtkArray *array, size_t n, double value, size_t file_size,
                   Err *err)
{
    arrays->n_added += n > array->n ? (double)(n - array->n) : 0;
    TRY(check_unpacked(arrays->n_added * sizeof *array->value, file_size, err));
    TRY(mem_reserve(&array->value, &array->capacity, n, sizeof *array->value, "values of an array",
                    err));
    while (array->n < n)
        array->value[array->n++] = (double)NAN;
    if (n > 0)
        array->value[n - 1] = value;
    return STATUS_OK;
}

/* Moves arrays->next to the array of this name, which is added if there is none. */
static Status find_or_add(VtkArrays *arrays, const char *name, Err *err)
{
    VtkArray made = {.components = 1};
    for (size_t i = 0; i < arrays->n; i++, arrays->next++) {
        arrays->next = arrays->next < arrays->n ? arrays->next : 0;
        if (strcmp(arrays->array[arrays->next].name, name) == 0)
            return STATUS_OK;
    }
    if (arrays->n == BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "there are more than %d names of numbers, the maximum",
                       BUILDER_MAX_COLUMNS);
    arrays->next = arrays->n;
    TRY(mem_strdup(&made.name, name, err));
    return vtk_add_array(arrays, &made, err);
}

Status vtk_set_number(VtkArrays *arrays, const char *name, size_t element, double value,
                      size_t file_size, Err *err)
{
    TRY(find_or_add(arrays, name, err));
    return fill(arrays, &arrays->array[arrays->next++], element + 1, value, file_size, err);
}

Status vtk_fill_up(VtkArrays *arrays, size_t n, size_t file_size, Err *err)
{
    for (size_t i = 0; i < arrays->n; i++)
        if (arrays->array[i].n < n)
            TRY(fill(arrays, &arrays->array[i], n, (double)NAN, file_size, err));
    return STATUS_OK;
}

/* ---- data ------------------------------------------------------------------------------------ */

void vtk_release(VtkData *data)
{
    free(data->point);
    free(data->corner);
    free(data->end);
    free(data->cell);
    for (int of = 0; of < VTK_ELEMENTS; of++) {
        for (size_t i = 0; i < data->arrays[of].n; i++)
            vtk_release_array(&data->arrays[of].array[i]);
        free(data->arrays[of].array);
    }
    *data = (VtkData){0};
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

/* Copies the coordinates of all points. axis[k] is NULL if coordinate k has no array. */
static Status set_positions(VtkData *data, double *const axis[3], const char *name, Err *err)
{
    TRY(mem_calloc(&data->point, 3 * data->n_points, sizeof *data->point, "points", err));
    for (size_t i = 0; i < 3 * data->n_points; i++) {
        const double *of = axis[i % 3];
        data->point[i] = of ? of[i / 3] : i % 3 == 2 ? 0 : (double)NAN;
        if (isnan(data->point[i]))
            return err_set(err, STATUS_INPUT, "%s: point %zu of %zu has no position", name,
                           i / 3 + 1, data->n_points);
    }
    return STATUS_OK;
}

Status vtk_detach_positions(VtkData *data, const char *const axes[3], const char *name, Err *err)
{
    double *axis[3];
    for (int k = 0; k < 3; k++)
        axis[k] = vtk_detach_values(&data->arrays[GRAPH_POINTS], axes[k]);
    Status status = set_positions(data, axis, name, err);
    for (int k = 0; k < 3; k++)
        free(axis[k]);
    return status;
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* VTK's types of cells that are read as lines, or ignored without a note because they are points.
 */
enum { VERTEX = 1, POLY_VERTEX = 2, LINE = 3, POLY_LINE = 4, QUADRATIC_EDGE = 21 };

const VtkCellKind vtk_cell_kinds[VTK_CELL_KINDS] = {
    {"VERTICES", "Verts", POLY_VERTEX, false},
    {"LINES", "Lines", POLY_LINE, false},
    {"POLYGONS", "Polys", 0, false},
    {"TRIANGLE_STRIPS", "Strips", 0, false},
    {"CELLS", "Cells", 0, true},
};

void vtk_release_cells(VtkCells *cells)
{
    free(cells->corner);
    free(cells->end);
    free(cells->type);
    *cells = (VtkCells){0};
}

/* Adds a cell of VTK's type `type`. VTK lists the middle of a quadratic edge last. */
static Status add_cell(VtkData *data, double type, const double *corner, size_t n,
                       size_t first_point, Err *err)
{
    size_t cell = data->n_cells++;
    if (type == QUADRATIC_EDGE && n == 3) {
        const double in_order[] = {corner[0], corner[2], corner[1]};
        return vtk_add_line(data, cell, in_order, n, first_point, err);
    }
    if (type == LINE || type == POLY_LINE)
        return vtk_add_line(data, cell, corner, n, first_point, err);
    data->not_lines += type != VERTEX && type != POLY_VERTEX;
    return STATUS_OK;
}

Status vtk_add_cells(VtkData *data, const VtkCells *cells, const VtkCellKind *kind,
                     size_t first_point, Err *err)
{
    double at = 0;
    for (size_t i = 0; i < cells->n; i++) {
        double end = cells->end[i];
        if (!(end >= at && end <= (double)cells->n_corners && end == floor(end)))
            return err_set(err, STATUS_INPUT,
                           "cell %zu ends at entry %g of the list of point indices; ends must "
                           "increase up to at most %zu",
                           i, end, cells->n_corners);
        const double *corner = end > at ? cells->corner + (size_t)at : NULL;
        TRY(add_cell(data, cells->type ? cells->type[i] : kind->type, corner, (size_t)(end - at),
                     first_point, err));
        at = end;
    }
    return STATUS_OK;
}
