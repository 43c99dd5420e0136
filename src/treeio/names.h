/* Maps the names that a file gives to its nodes or segments, such as "12" or "IN1", to indices.
 *
 *     Names names = {.what = "node"};
 *     TRY(names_add(&names, text, 0, line, err));        // text: "IN1", a field of the file
 *     TRY(names_find(&names, other, &index, err));       // other: "IN1"; index is 0
 *     names_release(&names); */
#ifndef CORCAST_TREEIO_NAMES_H
#define CORCAST_TREEIO_NAMES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

/* Begin with {.what = "node"}; release with names_release. */
typedef struct Names {
    const char *what;    /* the word for a named element in errors: "node"; borrowed */
    KeyMap last_of_hash; /* from a hash to 1 + the position in `entries` of the last name with this
                          * hash; names of one hash are a list [names.c] */
    ARRAY(struct Name) entries;
} Names;

void names_release(Names *names);

/* Adds a name for an index.
 *
 * text     the name; borrowed until names_release. "12.0", an integer with a fraction of zeros, is
 *          shortened to "12" in place, so that both spellings are the same name.
 * line     the line of the file. A later error about the same name states it as the first
 *          definition.
 * Errors   STATUS_INPUT if the name was added before; the sentence does not state the file and its
 *          present line, which the caller adds. STATUS_MEMORY.
 * Cost     O(1) on average. */
MUST_CHECK Status names_add(Names *names, char *text, size_t index, size_t line, Err *err);

/* Finds the index of a name. `text` may be shortened in place, as in names_add. Errors:
 * STATUS_INPUT, without file and line, if the name was not added. */
MUST_CHECK Status names_find(const Names *names, char *text, size_t *index, Err *err);

#endif
