/* Finds all pairs among many items whose boxes meet. */
#ifndef CORCAST_MESH_PROOF_BOXPAIRS_H
#define CORCAST_MESH_PROOF_BOXPAIRS_H

#include "base/base.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct FloatBox {
    float low[3], high[3];
} FloatBox;

/* Returns true if the boxes have a point in common, faces included. */
static inline bool floatbox_meets(const FloatBox *a, const FloatBox *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
           b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

typedef struct BoxPairs {
    uint32_t count; /* number of items; it is faster if neighbours in order are near in space */
    FloatBox (*box)(uint32_t item, const void *context); /* returns an item's box */
    /* Called once for each pair, in any order, with a < b; by several threads at once. */
    void (*found)(uint32_t a, uint32_t b, int worker, void *context);
    void *context; /* of both functions */
    int threads;   /* 0: all processors */
} BoxPairs;

/* Calls `found` for each pair of items whose boxes meet. Uses 7 bytes per item. Errors:
 * STATUS_MEMORY. O(n log n + pairs) expected, if most boxes do not meet. */
MUST_CHECK Status boxpairs_find(const BoxPairs *pairs, Err *err);

#endif
