/* How the terminals are shared among trees that grow side by side. */
#ifndef CORCAST_GROW_FOREST_H
#define CORCAST_GROW_FOREST_H

#include "base/base.h"

typedef struct Forest {
    size_t trees, terminals;
    /* By tree: */
    size_t *quota; /* terminals at the end of growth */
    size_t *has;   /* terminals at the beginning of this round */
    size_t *limit; /* terminals that it may still get in this round, which counts it down */
    size_t *grant; /* the limit that this round began with */
} Forest;

/* `terminals`, not fewer than trees, go to the trees in proportion to `share`, rounded by largest
 * remainders, at least one to each. */
MUST_CHECK Status forest_init(Forest *forest, size_t trees, const double *share, size_t terminals,
                              Err *err);
void forest_release(Forest *forest);

/* Sets the limits of the next round, before which the forest has `terminals` terminals, so that no
 * tree gets far ahead of its share of them. At least one tree that lacks terminals may get more. */
void forest_limit(Forest *forest, size_t terminals);

/* To be called after a round: adds to `has` what the round counted down from `limit`. */
void forest_count(Forest *forest);

#endif
