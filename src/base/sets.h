/* Disjoint sets of the indices 0 .. n - 1 (union-find).
 *
 * `parent` is an array of n indices that the caller owns. Initialise it with sets_begin. The parent
 * of an index is a lower index of its set, or the index itself, which is then the representative of
 * the set. The representative is the lowest index of the set, so the result does not depend on the
 * order of the joins. An array that the caller has filled by this rule is allowed in place of
 * sets_begin. A call of sets_find or sets_join costs amortised O(log n). */
#ifndef CORCAST_BASE_SETS_H
#define CORCAST_BASE_SETS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Puts each index into a set of its own. */
static inline void sets_begin(uint32_t *parent, size_t n)
{
    for (size_t i = 0; i < n; i++)
        parent[i] = (uint32_t)i;
}

/* Returns the representative of the set that contains `i`. Shortens the path from `i` to it. */
static inline uint32_t sets_find(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/* Joins the sets of `a` and `b`. Returns false if they were the same set. */
static inline bool sets_join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = sets_find(parent, a);
    b = sets_find(parent, b);
    parent[a > b ? a : b] = a < b ? a : b;
    return a != b;
}

#endif
