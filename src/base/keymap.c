/* A hash table from 64-bit keys to 32-bit values: open addressing with linear probing. At most half
 * of the slots are in use, so a search looks at few of them. The first slot of a search is given by
 * the upper bits of the product of the key and the golden ratio, which depend on all bits of the
 * key [Knuth, The Art of Computer Programming, volume 3, section 6.4]. */
#include "base/keymap.h"

#include "base/memory.h"
#include <stdlib.h>

/* Slots of the smallest map: 4 kB, so that small maps do not have to grow. */
enum { LEAST_SLOTS = 256 };

void keymap_release(KeyMap *map)
{
    free(map->slots);
    *map = (KeyMap){0};
}

Status keymap_begin(KeyMap *map, size_t expected, const char *what, Err *err)
{
    size_t size = LEAST_SLOTS;
    while (size < 2 * expected)
        size *= 2;
    TRY(mem_reserve(&map->slots, &map->capacity, size, sizeof *map->slots, what, err));
    memset(map->slots, 0xff, size * sizeof *map->slots);
    map->count = 0;
    map->size = size;
    map->shift = __builtin_clzll(size) + 1;
    map->what = what;
    return STATUS_OK;
}

Status keymap_grow(KeyMap *map, Err *err)
{
    KeyMap larger = {0};
    TRY(keymap_begin(&larger, map->size, map->what, err));
    larger.count = map->count;
    for (size_t i = 0; i < map->size; i++)
        if (map->slots[i].key != KEYMAP_NO_KEY)
            *keymap_slot(&larger, map->slots[i].key) = map->slots[i];
    free(map->slots);
    *map = larger;
    return STATUS_OK;
}
