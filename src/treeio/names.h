/* The names that a file gives to its nodes and segments, such as "12" or "IN1". */
#ifndef CORCAST_TREEIO_NAMES_H
#define CORCAST_TREEIO_NAMES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

/* Begin with {.what = "node"}; release with names_release. */
typedef struct Names {
    const char *what; /* what the things are called in errors */
    KeyMap first;     /* per hash of a name: an index in `name` + 1 */
    ARRAY(struct Name) name;
} Names;

void names_release(Names *names);

/* Gives a thing a name and an index. O(1) on average.
 *
 * text     borrowed. An integer in it loses its fraction, "12.0", in place.
 * record   the line of the file, for errors.
 * Errors   STATUS_INPUT, without file and line, if another thing has the name; STATUS_MEMORY. */
MUST_CHECK Status names_add(Names *names, char *text, size_t index, size_t record, Err *err);

/* Finds the index of the thing of this name. `text` is changed as by names_add. Errors:
 * STATUS_INPUT, without file and line, if there is none. */
MUST_CHECK Status names_find(const Names *names, char *text, size_t *index, Err *err);

#endif
