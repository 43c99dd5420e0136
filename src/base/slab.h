/* Memory for many small pieces that are freed together, taken from few large ones. */
#ifndef CORCAST_BASE_SLAB_H
#define CORCAST_BASE_SLAB_H

#include <stddef.h>

/* Zeroed when it holds nothing. */
typedef struct Slabs {
    struct Slab *last; /* the one in use, and those before it */
    size_t used, size; /* bytes of the one in use */
} Slabs;

/* Takes `size` bytes, a multiple of 4, aligned to 4 and of any content; where a new slab is needed
 * it has `slab` bytes or more. NULL when there is no memory. Valid until slabs_release. */
void *slabs_take(Slabs *slabs, size_t size, size_t slab);
/* A copy of `text`, or NULL when there is no memory. Valid until slabs_release. */
char *slabs_text(Slabs *slabs, const char *text);
void slabs_release(Slabs *slabs);

#endif
