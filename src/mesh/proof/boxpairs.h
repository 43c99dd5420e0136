/* Finds all pairs of items whose bounding boxes overlap, among many items. Used to find segments
 * that are near each other and triangles that cross.
 *
 * The caller fills a BoxPairs with a function that returns the box of an item and a function that
 * is called for each pair, and calls boxpairs_find. */
#ifndef CORCAST_MESH_PROOF_BOXPAIRS_H
#define CORCAST_MESH_PROOF_BOXPAIRS_H

#include "base/base.h"
#include <stdbool.h>
#include <stdint.h>

/* A box with sides parallel to the axes, in single precision, mm. */
typedef struct FloatBox {
    float low[3], high[3];
} FloatBox;

/* Returns true if the boxes overlap. Boxes that only touch count as overlapping. */
static inline bool floatbox_meets(const FloatBox *a, const FloatBox *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
           b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

/* Spreads the bits of a coordinate for a Morton code: returns x with two zero bits after each of
 * its lowest 21 bits. Callers number their items by Morton code, so that items with near indices
 * are near in space, which makes boxpairs_find faster. */
static inline uint64_t morton_spread(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

/* The items whose pairs are searched for. */
typedef struct BoxPairs {
    uint32_t count; /* number of items. The search is faster if items with near indices are near in
                     * space. */
    /* Returns the box of an item. Several threads call it at the same time. */
    FloatBox (*box)(uint32_t item, const void *context);
    /* Receives each pair of items whose boxes overlap: once, with a < b, in no particular order.
     * Several threads call it at the same time. `worker` is the index of the calling thread, from 0
     * to (number of threads) - 1. */
    void (*found)(uint32_t a, uint32_t b, int worker, void *context);
    void *context; /* passed to both functions */
    int threads;   /* maximum number of threads; 0: threads_available() [base/threads.h] */
} BoxPairs;

/* Calls `found` for each pair of items whose boxes overlap. Allocates about 7 bytes per item.
 *
 * Errors  STATUS_MEMORY.
 * Cost    O(n log n + p) expected for n items and p pairs, if most boxes overlap few others. */
MUST_CHECK Status boxpairs_find(const BoxPairs *pairs, Err *err);

#endif
