/* Maps the names that a file gives to its nodes or segments, such as "12" or "IN1", to indices.
 *
 *     Names names = {.what = "node"};
 *     TRY(names_add(&names, "IN1", 0, line, err));    // "IN1" is node 0
 *     TRY(names_find(&names, "IN1", &index, err));
 *     names_release(&names); */
#ifndef CORCAST_TREEIO_NAMES_H
#define CORCAST_TREEIO_NAMES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

/* Begin with {.what = "node"}; release with names_release. */
typedef struct Names {
    const char *what; /* the word for a named element in errors: "node"; borrowed */
    KeyMap heads; /* from a hash to 1 + the position in `name` of the last name with this hash */
    ARRAY(struct Name) name;
} Names;

void names_release(Names *names);

/* Adds a name for an index.
 *
 * text     the name; borrowed until names_release. "12.0", an integer with a fraction of zeros, is
 *          shortened to "12" in place, so that both spellings are the same name.
 * line     the line of the file, for errors.
 * Errors   STATUS_INPUT, without file and line, if the name was added before; STATUS_MEMORY.
 * Cost     O(1) on average. */
MUST_CHECK Status names_add(Names *names, char *text, size_t index, size_t line, Err *err);

/* Finds the index of a name. `text` may be shortened in place, as in names_add. Errors:
 * STATUS_INPUT, without file and line, if the name was not added. */
MUST_CHECK Status names_find(const Names *names, char *text, size_t *index, Err *err);

#endif
