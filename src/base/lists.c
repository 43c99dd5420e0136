/* Builds one list of items per key, all in one array, by a counting sort.
 *
 * A counting sort is stable and costs O(items + keys). Arrays are allocated at the size that the
 * first build needs, because most lists are built once. */
#include "base/lists.h"

#include "base/memory.h"
#include <stdlib.h>
#include <string.h>

/* Makes room for `needed` indices, which are not initialised. */
static Status reserve(uint32_t **array, size_t *capacity, size_t needed, const char *what, Err *err)
{
    if (*array && needed <= *capacity)
        return STATUS_OK;
    size_t size = needed < 2 * *capacity ? 2 * *capacity : needed;
    free(*array);
    *array = NULL;
    *capacity = 0;
    TRY(mem_alloc(array, size, sizeof **array, what, err));
    *capacity = size;
    return STATUS_OK;
}

void indexlists_release(IndexLists *lists)
{
    free(lists->first);
    free(lists->items);
    *lists = (IndexLists){0};
}

Status indexlists_begin(IndexLists *lists, size_t n, const char *what, Err *err)
{
    TRY(reserve(&lists->first, &lists->first_capacity, n + 2, what, err));
    memset(lists->first, 0, (n + 2) * sizeof *lists->first);
    lists->n = n;
    return STATUS_OK;
}

Status indexlists_allot(IndexLists *lists, const char *what, Err *err)
{
    uint64_t sum = 0;
    for (size_t i = 2; i < lists->n + 2; i++) {
        sum += lists->first[i];
        lists->first[i] = (uint32_t)sum;
    }
    if (sum > UINT32_MAX)
        return mem_out_of("for", what, err);
    return reserve(&lists->items, &lists->item_capacity, (size_t)sum, what, err);
}

Status indexlists_sort(IndexLists *lists, size_t n, ItemKeys keys, const char *what, Err *err)
{
    TRY(indexlists_begin(lists, n, what, err));
    for (size_t i = 0; i < keys.n_items * keys.per_item; i++)
        indexlists_count(lists, keys.keys[i]);
    TRY(indexlists_allot(lists, what, err));
    for (size_t i = 0; i < keys.n_items; i++)
        for (size_t k = 0; k < keys.per_item; k++)
            indexlists_put(lists, keys.keys[i * keys.per_item + k], (uint32_t)i);
    return STATUS_OK;
}

size_t sorted_find(const uint32_t *sorted, size_t n, uint32_t value)
{
    return sorted_find_row(sorted, n, sizeof *sorted, value);
}

bool indexlists_hold(const IndexLists *lists, size_t i, uint32_t item)
{
    size_t n = indexlists_length(lists, i);
    return sorted_find(lists->items + lists->first[i], n, item) < n;
}
