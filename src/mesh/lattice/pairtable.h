/* A hash table from 64-bit keys to 32-bit numbers, for points of lattices and edges of meshes. */
#ifndef CORCAST_MESH_LATTICE_PAIRTABLE_H
#define CORCAST_MESH_LATTICE_PAIRTABLE_H

#include "base/base.h"
#include <stdint.h>

typedef struct PairSlot {
    uint64_t key; /* UINT64_MAX: free */
    uint32_t value;
} PairSlot;

/* Zeroed, and made ready by pairtable_begin. Release with pairtable_release. */
typedef struct PairTable {
    PairSlot *slots; /* owned */
    size_t count, size, capacity;
    int shift; /* 64 less the binary logarithm of the size */
} PairTable;

void pairtable_release(PairTable *table);
/* Empties the table, with room for `expected` keys before it grows; keeps what memory it has. */
MUST_CHECK Status pairtable_begin(PairTable *table, size_t expected, Err *err);

/* Where the value of a key is kept, in *value (borrowed until the next call); *is_new tells that it
 * was put there now, as 0. O(1). */
MUST_CHECK Status pairtable_place(PairTable *table, uint64_t key, uint32_t **value, bool *is_new,
                                  Err *err);
/* NULL when the key is not there. */
uint32_t *pairtable_find(const PairTable *table, uint64_t key);

/* The key of two numbers, the same whatever their order. */
static inline uint64_t pair_key(uint32_t a, uint32_t b)
{
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

#endif
