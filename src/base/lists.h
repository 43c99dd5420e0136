/* Lists of indices (items), one list per key, in two arrays: compressed sparse rows, built by
 * counting sort.
 *
 * Lists are built in four steps:
 *
 *     TRY_GOTO(indexlists_begin(&lists, n_keys, "segments", err));
 *     for each item:  indexlists_count(&lists, its key);
 *     TRY_GOTO(indexlists_allot(&lists, "segments", err));
 *     for each item:  indexlists_put(&lists, its key, item);
 *
 * Each list holds its items in the order of the calls of indexlists_put. If the keys are in a
 * table, indexlists_sort does all four steps. */
#ifndef CORCAST_BASE_LISTS_H
#define CORCAST_BASE_LISTS_H

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* List i holds items[first[i]] to items[first[i + 1] - 1]. Zeroed: no lists. Lists may be built
 * again; they reuse their memory. */
typedef struct IndexLists {
    uint32_t *first, *items; /* owned */
    size_t n;                /* number of lists */
    size_t first_capacity, item_capacity;
} IndexLists;

void indexlists_release(IndexLists *lists);

/* Begins `n` empty lists. `what` names the items in the error sentence. Errors: STATUS_MEMORY. */
MUST_CHECK Status indexlists_begin(IndexLists *lists, size_t n, const char *what, Err *err);

/* Counts one item of list `key` < lists->n. The count of list i is stored in first[i + 2], so that
 * after the last indexlists_put first[i] is the start of list i. */
static inline void indexlists_count(IndexLists *lists, size_t key)
{
    lists->first[key + 2]++;
}

/* Allocates space for all items that were counted. Errors: STATUS_MEMORY, also for more than
 * UINT32_MAX items. */
MUST_CHECK Status indexlists_allot(IndexLists *lists, const char *what, Err *err);

/* Appends an item to list `key`. Must be called as often for each key as indexlists_count was. */
static inline void indexlists_put(IndexLists *lists, size_t key, uint32_t item)
{
    lists->items[lists->first[key + 1]++] = item;
}

/* The keys of items: item i has the keys keys[i * per_item] to keys[(i + 1) * per_item - 1], for
 * example the three vertices of triangle i. */
typedef struct ItemKeys {
    const uint32_t *keys; /* borrowed */
    size_t n_items, per_item;
} ItemKeys;

/* Builds, for each of `n` keys, the list of the items that have the key, in rising order. An item
 * that has a key twice is listed twice. Errors: STATUS_MEMORY. Cost: O(n + n_items * per_item). */
MUST_CHECK Status indexlists_sort(IndexLists *lists, size_t n, ItemKeys keys, const char *what,
                                  Err *err);

/* Returns the length of list i. */
static inline uint32_t indexlists_length(const IndexLists *lists, size_t i)
{
    return lists->first[i + 1] - lists->first[i];
}

/* Returns the index of the first of `n` rows whose key is `key`; n if there is none. Each row has
 * `size` bytes and begins with its key, a uint32_t. The rows are sorted by key. Cost: O(log n). */
static inline size_t sorted_find_row(const void *rows, size_t n, size_t size, uint32_t key)
{
    size_t low = 0, high = n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (*(const uint32_t *)((const char *)rows + middle * size) < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n && *(const uint32_t *)((const char *)rows + low * size) == key ? low : n;
}

/* Returns the index of `value` in an array of n rising values; n if the array does not have it.
 * Cost: O(log n). */
size_t sorted_find(const uint32_t *sorted, size_t n, uint32_t value);

/* Returns true if list i holds the item. The items of the list must rise. Cost: O(log length). */
bool indexlists_hold(const IndexLists *lists, size_t i, uint32_t item);

#endif
