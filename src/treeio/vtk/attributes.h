/* Points or lines with numbers under names, any of them here and there: what XML calls attributes,
 * as the arrays of VTK's data. */
#ifndef CORCAST_TREEIO_ATTRIBUTES_H
#define CORCAST_TREEIO_ATTRIBUTES_H

#include "treeio/vtk/vtkdata.h"

/* Zeroed: none. The arrays are released with the VtkData that they are handed to, or by
 * attributes_release. */
typedef struct Attributes {
    VtkArrays arrays;
    size_t *capacity; /* of the values of each array; owned */
    size_t n_capacities, capacities;
    size_t n;         /* elements so far */
    size_t next;      /* the array that is likely asked for next */
    size_t file_size; /* in bytes, which bounds how many numbers the arrays may hold */
    double numbers;   /* of all arrays so far */
} Attributes;

void attributes_release(Attributes *attributes);

/* Begins the next element. */
static inline void attributes_add(Attributes *attributes)
{
    attributes->n++;
}

/* Sets a number of the element begun last. O(arrays) at worst, O(1) where elements have their
 * numbers in the same order. STATUS_INPUT, without file and line, when there are more than
 * BUILDER_MAX_COLUMNS names. */
MUST_CHECK Status attributes_set(Attributes *attributes, const char *name, double value, Err *err);

/* Hands the arrays over to *arrays, NAN where nothing was set, and leaves none. */
MUST_CHECK Status attributes_take(Attributes *attributes, VtkArrays *arrays, Err *err);

/* Makes the arrays of points of these names the places of the points, x, y and z; without the third
 * z is 0. STATUS_INPUT, with the file's name, when a point lacks one. */
MUST_CHECK Status attributes_to_places(VtkData *data, const char *const axes[3], const char *name,
                                       Err *err);

#endif
