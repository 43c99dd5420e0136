/* Allocates many small blocks from large slabs, which are freed together. The slabs are a linked
 * list, newest first. Blocks are cut off the newest slab, from front to back. When a block does not
 * fit, a new slab is allocated, and the rest of the old one stays unused. */
#include "base/slab.h"

#include <stdlib.h>
#include <string.h>

typedef struct Slab {
    struct Slab *next;
    char bytes[];
} Slab;

void *slabs_alloc(Slabs *slabs, size_t size, size_t min_slab_size)
{
    if (!slabs->last || size > slabs->size - slabs->used) {
        size_t wanted = size > min_slab_size ? size : min_slab_size;
        Slab *made = malloc(sizeof *made + wanted);
        if (!made)
            return NULL;
        made->next = slabs->last;
        *slabs = (Slabs){made, 0, wanted};
    }
    void *taken = slabs->last->bytes + slabs->used;
    slabs->used += size;
    return taken;
}

char *slabs_text(Slabs *slabs, const char *text)
{
    enum { TEXT_SLAB = 1 << 16 }; /* bytes: some thousand names */
    size_t size = strlen(text) + 1;
    char *copy = slabs_alloc(slabs, (size + 3) & ~(size_t)3, TEXT_SLAB);
    return copy ? memcpy(copy, text, size) : NULL;
}

void slabs_release(Slabs *slabs)
{
    for (Slab *slab = slabs->last, *next; slab; slab = next) {
        next = slab->next;
        free(slab);
    }
    *slabs = (Slabs){0};
}
