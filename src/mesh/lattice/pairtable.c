/* Open addressing with linear probing, at most half full; the slot is the upper bits of the key's
 * product with the golden ratio, which depend on all of its bits. */
#include "mesh/lattice/pairtable.h"

#include <stdlib.h>
#include <string.h>

static const size_t least_size = 256;

void pairtable_release(PairTable *table)
{
    free(table->slots);
    *table = (PairTable){0};
}

Status pairtable_begin(PairTable *table, size_t expected, Err *err)
{
    size_t size = least_size;
    while (size < 2 * expected)
        size *= 2;
    TRY(mem_reserve(&table->slots, &table->capacity, size, sizeof *table->slots,
                    "points of a junction", err));
    memset(table->slots, 0xff, size * sizeof *table->slots);
    table->count = 0;
    table->size = size;
    table->shift = __builtin_clzll(size) + 1;
    return STATUS_OK;
}

/* The slot that holds the key, or the free one where it belongs. */
static PairSlot *slot_of(const PairTable *table, uint64_t key)
{
    size_t at = (size_t)(key * 0x9e3779b97f4a7c15u >> table->shift);
    while (table->slots[at].key != key && table->slots[at].key != UINT64_MAX)
        at = (at + 1) & (table->size - 1);
    return &table->slots[at];
}

static Status grow(PairTable *table, Err *err)
{
    PairTable larger = {0};
    TRY(pairtable_begin(&larger, table->size, err));
    larger.count = table->count;
    for (size_t i = 0; i < table->size; i++)
        if (table->slots[i].key != UINT64_MAX)
            *slot_of(&larger, table->slots[i].key) = table->slots[i];
    free(table->slots);
    *table = larger;
    return STATUS_OK;
}

Status pairtable_place(PairTable *table, uint64_t key, uint32_t **value, bool *is_new, Err *err)
{
    if (2 * table->count >= table->size)
        TRY(grow(table, err));
    PairSlot *slot = slot_of(table, key);
    *is_new = slot->key == UINT64_MAX;
    if (*is_new) {
        *slot = (PairSlot){key, 0};
        table->count++;
    }
    *value = &slot->value;
    return STATUS_OK;
}

uint32_t *pairtable_find(const PairTable *table, uint64_t key)
{
    PairSlot *slot = slot_of(table, key);
    return slot->key == UINT64_MAX ? NULL : &slot->value;
}
