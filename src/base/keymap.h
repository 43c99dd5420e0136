/* A hash table from 64-bit keys to 32-bit values.
 *
 * Call keymap_begin first, then keymap_put and keymap_find. A key is any number except
 * KEYMAP_NO_KEY, for example the index of a lattice point, a pair of indices, or a hash. Different
 * objects may have equal hashes; the value of such a key should lead to a list of objects, which
 * the caller compares. Keys are never removed, and cannot be listed. */
#ifndef CORCAST_BASE_KEYMAP_H
#define CORCAST_BASE_KEYMAP_H

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define KEYMAP_NO_KEY UINT64_MAX

typedef struct KeySlot {
    uint64_t key; /* KEYMAP_NO_KEY: the slot is free */
    uint32_t value;
} KeySlot;

/* The table. Zero it before keymap_begin. */
typedef struct KeyMap {
    KeySlot *slots;   /* owned */
    size_t count;     /* number of keys */
    size_t size;      /* number of slots of the table, free or not, a power of two */
    size_t capacity;  /* number of allocated slots */
    int shift;        /* 64 - log2(size) */
    const char *what; /* names the keys in errors; borrowed */
} KeyMap;

/* Empties the map, and makes space for `expected` keys; more keys may be added. Reuses the memory
 * of a map that was used before. `what` names the keys in the sentence of STATUS_MEMORY; borrowed.
 */
MUST_CHECK Status keymap_begin(KeyMap *map, size_t expected, const char *what, Err *err);
void keymap_release(KeyMap *map);

/* Doubles the number of slots. Used by keymap_put. */
MUST_CHECK Status keymap_grow(KeyMap *map, Err *err);

/* Returns the slot that holds `key`, or the free slot where the key belongs. The factor, 2^64
 * divided by the golden ratio, spreads nearby keys (Fibonacci hashing). */
static inline KeySlot *keymap_slot(const KeyMap *map, uint64_t key)
{
    size_t at = (size_t)(key * 0x9e3779b97f4a7c15u >> map->shift);
    while (map->slots[at].key != key && map->slots[at].key != KEYMAP_NO_KEY)
        at = (at + 1) & (map->size - 1);
    return &map->slots[at];
}

/* Returns the value of `key` (borrowed until the next keymap_put), or NULL if the key is not in the
 * map. O(1). */
static inline uint32_t *keymap_find(const KeyMap *map, uint64_t key)
{
    KeySlot *slot = keymap_slot(map, key);
    return slot->key == KEYMAP_NO_KEY ? NULL : &slot->value;
}

/* Finds the value of `key`, or adds the key with the value 0. At least half of the slots stay free.
 * O(1) on average.
 *
 * value    receives a pointer to the value, borrowed until the next keymap_put.
 * is_new   receives true if the key was added.
 * Errors   STATUS_MEMORY; the map is then unchanged. */
MUST_CHECK static inline Status keymap_put(KeyMap *map, uint64_t key, uint32_t **value,
                                           bool *is_new, Err *err)
{
    if (2 * map->count >= map->size)
        TRY(keymap_grow(map, err));
    KeySlot *slot = keymap_slot(map, key);
    *is_new = slot->key == KEYMAP_NO_KEY;
    if (*is_new) {
        *slot = (KeySlot){key, 0};
        map->count++;
    }
    *value = &slot->value;
    return STATUS_OK;
}

/* Returns the key of an unordered pair of indices, which are not both UINT32_MAX. */
static inline uint64_t key_of_pair(uint32_t a, uint32_t b)
{
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

/* Returns a hash of n numbers, which is not KEYMAP_NO_KEY. The bits are hashed, so 0 and -0 count
 * as different numbers. */
static inline uint64_t key_of_numbers(const double *numbers, size_t n)
{
    uint64_t hash = n;
    for (size_t i = 0; i < n; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash & (KEYMAP_NO_KEY >> 1);
}

#endif
