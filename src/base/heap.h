/* A binary heap: a priority queue whose first item has the lowest key.
 *
 *     Heap heap = {0};
 *     TRY_GOTO(heap_push(&heap, (HeapItem){key, tie, value}, "points", err));
 *     while (heap.n > 0)
 *         use(heap_pop(&heap));          (by rising key)
 *     ARRAY_RELEASE(&heap);
 *
 * Items with equal keys are ordered by `tie`. If no two items are equal in both numbers, the
 * order in which they leave the heap does not depend on the order in which they were added. Keys
 * are not NaN. */
#ifndef CORCAST_BASE_HEAP_H
#define CORCAST_BASE_HEAP_H

#include "base/array.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct HeapItem {
    double key;
    uint32_t tie;   /* orders items with equal keys */
    uint32_t value; /* data of the caller; does not change the order */
} HeapItem;

/* A heap; items[0] has the lowest key. Zeroed: empty. Release it with ARRAY_RELEASE. */
typedef ARRAY(HeapItem) Heap;

/* Returns true if item a leaves the heap before item b. */
static inline bool heap_is_before(HeapItem a, HeapItem b)
{
    return a.key != b.key ? a.key < b.key : a.tie < b.tie;
}

/* Puts `item` into the subtree below position `hole`, which is empty. Used by heap_order and
 * heap_pop. */
static inline void heap_sift_down(Heap *heap, size_t hole, HeapItem item)
{
    HeapItem *items = heap->items;
    for (size_t child; (child = 2 * hole + 1) < heap->n; hole = child) {
        child += child + 1 < heap->n && heap_is_before(items[child + 1], items[child]);
        if (!heap_is_before(items[child], item))
            break;
        items[hole] = items[child];
    }
    items[hole] = item;
}

/* Makes a heap of heap->n items, which are in any order. Cost: O(n). */
static inline void heap_order(Heap *heap)
{
    for (size_t i = heap->n / 2; i-- > 0;)
        heap_sift_down(heap, i, heap->items[i]);
}

/* Adds an item. `what` names the items in the error sentence. Errors: STATUS_MEMORY. Cost: O(log
 * n). */
MUST_CHECK static inline Status heap_push(Heap *heap, HeapItem item, const char *what, Err *err)
{
    TRY(ARRAY_RESERVE(heap, 1, what, err));
    size_t at = heap->n++;
    for (; at > 0 && heap_is_before(item, heap->items[(at - 1) / 2]); at = (at - 1) / 2)
        heap->items[at] = heap->items[(at - 1) / 2];
    heap->items[at] = item;
    return STATUS_OK;
}

/* Removes and returns the first item. The heap must not be empty. Cost: O(log n). */
static inline HeapItem heap_pop(Heap *heap)
{
    HeapItem first = heap->items[0];
    HeapItem last = heap->items[--heap->n];
    if (heap->n > 0)
        heap_sift_down(heap, 0, last);
    return first;
}

#endif
