/* Finds rows of a file, such as nodes, by their ids. The index takes O(rows) memory, even if the
 * largest id is much larger than the number of rows. */
#ifndef CORCAST_TREE_IDINDEX_H
#define CORCAST_TREE_IDINDEX_H

#include "base/base.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* An index of rows by their ids. Zeroed: empty; release with idindex_release. */
typedef struct IdIndex {
    uint32_t *table; /* per id up to `last`: row + 1; 0: no row. NULL if the ids have wide gaps;
                      * `entry` is then used */
    struct IdEntry *entry; /* all rows, sorted by id and then by row; NULL if `table` is used */
    size_t n;              /* number of rows, including rows with the id 0 */
    int32_t last;          /* largest id */
    bool has_duplicates;   /* at least two rows have the same id */
} IdIndex;

void idindex_release(IdIndex *index);

/* Indexes `n` rows. id[i] >= 0 is the id of row i; rows with the id 0 are left out. Release *index
 * with idindex_release. Errors: STATUS_MEMORY. Cost: O(n log n). */
MUST_CHECK Status idindex_make(IdIndex *index, const int32_t *id, size_t n, Err *err);

/* Returns 1 + the index of the first row with this id; 0 if no row has the id. Cost: O(1), or O(log
 * n) if the ids have wide gaps. */
size_t idindex_find(const IdIndex *index, int32_t id);

#endif
