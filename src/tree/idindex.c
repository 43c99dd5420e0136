/* Finds the row of an id in constant or logarithmic time.
 *
 * Most files have ids with few gaps. A table with an entry per id is then fastest. But a file of
 * two rows may have the ids 1 and 100000000. If the table would have more than WIDEST_GAPS entries
 * per row and SHORT_TABLE more, a list sorted by id replaces it. The table then takes at most 64
 * bytes per row, as much as a node, and 256 kB more. Larger values would take more memory; smaller
 * ones would use the slower list more often. */
#include "tree/idindex.h"

#include <stdlib.h>

typedef struct IdEntry {
    int32_t id;
    uint32_t row; /* 1 + the row */
} IdEntry;

void idindex_release(IdIndex *index)
{
    free(index->table);
    free(index->entry);
    *index = (IdIndex){0};
}

static int by_id(const void *a, const void *b)
{
    const IdEntry *one = a, *other = b;
    if (one->id != other->id)
        return one->id < other->id ? -1 : 1;
    return one->row < other->row ? -1 : one->row > other->row;
}

Status idindex_make(IdIndex *index, const int32_t *id, size_t n, Err *err)
{
    enum { WIDEST_GAPS = 16, SHORT_TABLE = 1 << 16 };
    IdIndex made = {.n = n};
    for (size_t i = 0; i < n; i++)
        made.last = id[i] > made.last ? id[i] : made.last;
    if ((size_t)made.last <= WIDEST_GAPS * n + SHORT_TABLE) {
        TRY(mem_calloc(&made.table, (size_t)made.last + 1, sizeof *made.table,
                       "table entries for ids", err));
        for (size_t i = n; i-- > 0;) {
            made.has_duplicates = made.has_duplicates || made.table[id[i]] > 0;
            made.table[id[i]] = id[i] ? (uint32_t)i + 1 : 0;
        }
    } else {
        TRY(mem_calloc(&made.entry, n, sizeof *made.entry, "entries for ids", err));
        for (size_t i = 0; i < n; i++)
            made.entry[i] = (IdEntry){id[i], (uint32_t)i + 1};
        qsort(made.entry, n, sizeof *made.entry, by_id);
        for (size_t i = 1; i < n; i++)
            made.has_duplicates = made.has_duplicates || (made.entry[i].id > 0 &&
                                                          made.entry[i].id == made.entry[i - 1].id);
    }
    *index = made;
    return STATUS_OK;
}

size_t idindex_find(const IdIndex *index, int32_t id)
{
    if (id < 1 || id > index->last)
        return 0;
    if (index->table)
        return index->table[id];
    const size_t first =
        sorted_find_row(index->entry, index->n, sizeof *index->entry, (uint32_t)id);
    return first < index->n ? index->entry[first].row : 0;
}
