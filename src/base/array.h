/* Growable arrays: an array of any type with its length and capacity.
 *
 * ARRAY is a struct; a module names it or uses it as a field:
 *
 *     typedef ARRAY(Vec3) Path;
 *     Path path = {0};
 *     TRY_GOTO(ARRAY_PUSH(&path, "points of a path", err, vec3(0, 0, 0)));
 *     ARRAY_RELEASE(&path);
 *
 * The macros evaluate `array` more than once. `what` names the items, in the plural, in the message
 * of STATUS_MEMORY. */
#ifndef CORCAST_BASE_ARRAY_H
#define CORCAST_BASE_ARRAY_H

#include "base/memory.h"
#include <stdlib.h>

/* A struct with `n` items of a type; `items` is owned. Zeroed: empty. */
#define ARRAY(type)                                                                                \
    struct {                                                                                       \
        type *items;                                                                               \
        size_t n, capacity;                                                                        \
    }

/* Allocates space for `more` items after the last item; does not change `n`. The capacity at least
 * doubles, so that appending one item costs O(1) on average. Evaluates to a Status. Errors:
 * STATUS_MEMORY; the array is then unchanged. */
#define ARRAY_RESERVE(array, more, what, err)                                                      \
    mem_reserve(&(array)->items, &(array)->capacity, (array)->n + (more), sizeof *(array)->items,  \
                what, err)

/* Appends an item, the last argument. Evaluates to a Status. Errors: STATUS_MEMORY; the item is
 * then not evaluated. */
#define ARRAY_PUSH(array, what, err, ...)                                                          \
    (ARRAY_RESERVE(array, 1, what, err) == STATUS_OK                                               \
         ? ((array)->items[(array)->n++] = (__VA_ARGS__), STATUS_OK)                               \
         : STATUS_MEMORY)

/* Frees the items and leaves an empty array. */
#define ARRAY_RELEASE(array)                                                                       \
    (free((array)->items), (array)->items = NULL, (array)->n = (array)->capacity = 0)

#endif
