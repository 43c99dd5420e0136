/* All pairs among many things whose boxes meet. */
#ifndef CORCAST_MESH_PROOF_BOXPAIRS_H
#define CORCAST_MESH_PROOF_BOXPAIRS_H

#include "base/base.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct FloatBox {
    float low[3], high[3];
} FloatBox;

static inline bool floatbox_meets(const FloatBox *a, const FloatBox *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
           b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

typedef struct BoxPairs {
    uint32_t count; /* things that follow each other should be near each other */
    FloatBox (*box)(uint32_t item, const void *context);
    /* Told of each pair once, in any order, a < b; from several threads at once. */
    void (*found)(uint32_t a, uint32_t b, int worker, void *context);
    void *context; /* of both */
    int threads;
} BoxPairs;

/* Expected O(n log n + pairs) for things whose boxes mostly do not meet; 7 bytes a thing. */
MUST_CHECK Status boxpairs_find(const BoxPairs *pairs, Err *err);

#endif
