/* Numbers are kept as doubles, which hold every index that a file of this size can have; their
 * bytes are put together by shifts, whatever the order, but for the two common types. */
#include "treeio/vtk/vtkdata.h"

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

static void take_numbers(const VtkType *type, bool is_big_endian, const char *bytes, size_t n,
                         double *out)
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

typedef struct Numbers {
    const VtkType *type;
    bool is_big_endian;
    const char *bytes;
    size_t n;
    double *out;
} Numbers;

enum { BLOCK = 1 << 19 /* numbers: two huge pages */ };

static void take_block(size_t index, int worker, void *context)
{
    const Numbers *all = context;
    size_t first = index * BLOCK, left = all->n - first;
    (void)worker;
    take_numbers(all->type, all->is_big_endian, all->bytes + first * all->type->size,
                 left < BLOCK ? left : BLOCK, all->out + first);
}

/* By all processors: the system clears the memory that numbers come to as they do, which takes
 * longer than they. */
void vtk_numbers(const VtkType *type, bool is_big_endian, const char *bytes, size_t n, double *out)
{
    Numbers all = {type, is_big_endian, bytes, n, out};
    threads_for((n + BLOCK - 1) / BLOCK, 0, take_block, &all);
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
