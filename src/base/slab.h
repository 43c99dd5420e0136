/* An arena: memory for many small blocks that are freed together. The arena takes memory from the
 * system in a few large pieces, the slabs. */
#ifndef CORCAST_BASE_SLAB_H
#define CORCAST_BASE_SLAB_H

#include <stddef.h>

/* An arena. Zeroed: empty. */
typedef struct Slabs {
    struct Slab *last; /* the current slab, linked to the slabs before it; owned */
    size_t used, size; /* bytes in use, and size in bytes, of the current slab */
} Slabs;

/* Allocates a block of `size` bytes, which must be a multiple of 4. The block is aligned to 4 bytes
 * and uninitialized; it is valid until slabs_release. If the block does not fit into the current
 * slab, a new slab of at least `min_slab_size` bytes is allocated. Returns NULL if memory runs
 * out. */
void *slabs_alloc(Slabs *slabs, size_t size, size_t min_slab_size);
/* Copies a string into the arena. The copy is valid until slabs_release. Returns NULL if memory
 * runs out. */
char *slabs_text(Slabs *slabs, const char *text);
/* Frees all blocks and empties the arena. */
void slabs_release(Slabs *slabs);

#endif
