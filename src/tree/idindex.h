/* Finds rows by their ids. Takes memory for the rows, not for the largest id. */
#ifndef CORCAST_TREE_IDINDEX_H
#define CORCAST_TREE_IDINDEX_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Zeroed: empty; release with idindex_release. */
typedef struct IdIndex {
    uint32_t *table;       /* per id up to `last`: row + 1, 0 for none; NULL: ids have wide gaps */
    struct IdEntry *entry; /* otherwise: all rows, by id and then by row */
    size_t n;              /* rows */
    int32_t last;          /* largest id */
    bool has_twins;        /* two rows have one id */
} IdIndex;

void idindex_release(IdIndex *index);

/* Indexes `n` rows whose ids are 0 or more; rows with the id 0 are left out. STATUS_MEMORY. Cost:
 * O(n log n). */
MUST_CHECK Status idindex_make(IdIndex *index, const int32_t *id, size_t n, Err *err);

/* Returns the first row of this id, + 1; 0 if there is none. */
size_t idindex_find(const IdIndex *index, int32_t id);

#endif
