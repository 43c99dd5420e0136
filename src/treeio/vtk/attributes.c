/* An array is filled up with NAN when a later element has a number, and at the end. */
#include "treeio/vtk/attributes.h"

#include "treeio/formats.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void attributes_release(Attributes *attributes)
{
    for (size_t i = 0; i < attributes->arrays.n; i++)
        vtk_release_array(&attributes->arrays.array[i]);
    free(attributes->arrays.array);
    free(attributes->capacity);
    *attributes = (Attributes){0};
}

static Status add_array(Attributes *attributes, const char *name, size_t *number, Err *err)
{
    VtkArray made = {.components = 1};
    if (attributes->arrays.n == BUILDER_MAX_COLUMNS)
        return err_set(err, STATUS_INPUT, "there are more than %d names of numbers",
                       BUILDER_MAX_COLUMNS);
    TRY(mem_reserve(&attributes->capacity, &attributes->capacities, attributes->arrays.n + 1,
                    sizeof *attributes->capacity, "arrays", err));
    attributes->capacity[attributes->arrays.n] = 0;
    TRY(mem_strdup(&made.name, name, err));
    *number = attributes->arrays.n;
    return vtk_add_array(&attributes->arrays, &made, err);
}

static Status find_array(Attributes *attributes, const char *name, size_t *number, Err *err)
{
    const VtkArrays *arrays = &attributes->arrays;
    for (size_t i = 0; i < arrays->n; i++) {
        size_t at = (attributes->next + i) % arrays->n;
        if (strcmp(arrays->array[at].name, name) == 0) {
            *number = at;
            return STATUS_OK;
        }
    }
    return add_array(attributes, name, number, err);
}

/* Fills array number `number` up to `n` values, of which the last is `value`, the others NAN. */
static Status fill(Attributes *attributes, size_t number, size_t n, double value, Err *err)
{
    VtkArray *array = &attributes->arrays.array[number];
    attributes->numbers += n > array->n ? (double)(n - array->n) : 0;
    TRY(check_unpacked(attributes->numbers * sizeof *array->value, attributes->file_size, err));
    TRY(mem_reserve(&array->value, &attributes->capacity[number], n, sizeof *array->value,
                    "values of an array", err));
    while (array->n < n)
        array->value[array->n++] = (double)NAN;
    if (n > 0)
        array->value[n - 1] = value;
    return STATUS_OK;
}

Status attributes_set(Attributes *attributes, const char *name, double value, Err *err)
{
    size_t number = 0;
    TRY(find_array(attributes, name, &number, err));
    attributes->next = number + 1 < attributes->arrays.n ? number + 1 : 0;
    return fill(attributes, number, attributes->n, value, err);
}

Status attributes_take(Attributes *attributes, VtkArrays *arrays, Err *err)
{
    for (size_t i = 0; i < attributes->arrays.n; i++)
        if (attributes->arrays.array[i].n < attributes->n)
            TRY(fill(attributes, i, attributes->n, (double)NAN, err));
    *arrays = attributes->arrays;
    attributes->arrays = (VtkArrays){0};
    attributes_release(attributes);
    return STATUS_OK;
}

/* Takes the array of this name out of those of the points; NULL when there is none. */
static double *take_axis(VtkArrays *arrays, const char *name)
{
    for (size_t i = 0; name && i < arrays->n; i++) {
        if (strcmp(arrays->array[i].name, name) != 0)
            continue;
        double *value = arrays->array[i].value;
        arrays->array[i].value = NULL;
        vtk_release_array(&arrays->array[i]);
        memmove(&arrays->array[i], &arrays->array[i + 1],
                (--arrays->n - i) * sizeof *arrays->array);
        return value;
    }
    return NULL;
}

Status attributes_to_places(VtkData *data, const char *const axes[3], const char *name, Err *err)
{
    double *axis[3] = {NULL, NULL, NULL};
    Status status = STATUS_OK;
    TRY(mem_calloc(&data->point, 3 * data->n_points, sizeof *data->point, "points", err));
    for (int k = 0; k < 3; k++)
        axis[k] = take_axis(&data->of_points, axes[k]);
    for (size_t i = 0; i < data->n_points && status == STATUS_OK; i++)
        for (int k = 0; k < 3; k++) {
            double value = axis[k] ? axis[k][i] : k == 2 ? 0 : (double)NAN;
            data->point[3 * i + (size_t)k] = value;
            if (isnan(value))
                status = err_set(err, STATUS_INPUT, "%s: point %zu of %zu has no place", name,
                                 i + 1, data->n_points);
        }
    for (int k = 0; k < 3; k++)
        free(axis[k]);
    return status;
}
