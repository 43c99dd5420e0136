/* Open addressing with linear probing, at most half full; multiplication by the golden ratio
 * spreads the keys. */
#include "surface/mesh/pairtable.h"

#include <stdlib.h>
#include <string.h>

static const size_t first_size = 1024;

void pairtable_release(PairTable *table)
{
    free(table->slots);
    *table = (PairTable){0};
}

void pairtable_clear(PairTable *table)
{
    if (table->slots)
        memset(table->slots, 0xff, (table->mask + 1) * sizeof *table->slots);
    table->count = 0;
}

/* The slot that holds the key, or the free one where it belongs. */
static PairSlot *slot_of(const PairTable *table, uint64_t key)
{
    size_t at = (size_t)((key * 0x9e3779b97f4a7c15u) >> 20) & table->mask;
    while (table->slots[at].key != key && table->slots[at].key != UINT64_MAX)
        at = (at + 1) & table->mask;
    return &table->slots[at];
}

static Status grow(PairTable *table, Err *err)
{
    size_t size = table->slots ? 2 * (table->mask + 1) : first_size;
    PairTable larger = {.mask = size - 1, .count = table->count};
    TRY(mem_calloc(&larger.slots, size, sizeof *larger.slots, "points of a junction", err));
    memset(larger.slots, 0xff, size * sizeof *larger.slots);
    for (size_t i = 0; table->slots && i <= table->mask; i++)
        if (table->slots[i].key != UINT64_MAX)
            *slot_of(&larger, table->slots[i].key) = table->slots[i];
    free(table->slots);
    *table = larger;
    return STATUS_OK;
}

Status pairtable_place(PairTable *table, uint64_t key, uint32_t **value, bool *is_new, Err *err)
{
    if (!table->slots || 2 * table->count > table->mask)
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
    if (!table->slots)
        return NULL;
    PairSlot *slot = slot_of(table, key);
    return slot->key == UINT64_MAX ? NULL : &slot->value;
}
