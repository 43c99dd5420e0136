/* What a file calls its nodes and segments, "12" or "IN1", and their numbers. */
#ifndef CORCAST_TREEIO_NAMES_H
#define CORCAST_TREEIO_NAMES_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>

/* Begin with {.what = "node"}; release with names_release. */
typedef struct Names {
    const char *what; /* the things are called in sentences */
    struct Name *slot;
    size_t n, slots;
} Names;

void names_release(Names *names);

/* Gives the thing of this name its number. The text (zero-terminated) is borrowed, and a whole
 * number in it loses its fraction, "12.0", in place. O(1) amortised. STATUS_INPUT, without file and
 * line, when another thing has the name; `record` is where this one stands. */
MUST_CHECK Status names_add(Names *names, char *text, size_t number, size_t record, Err *err);

/* The number of the thing of this name, in *number. STATUS_INPUT, without file and line, when there
 * is none. */
MUST_CHECK Status names_find(const Names *names, char *text, size_t *number, Err *err);

#endif
