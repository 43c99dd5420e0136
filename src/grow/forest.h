/* How the terminals are shared among trees that grow side by side. */
#ifndef CORCAST_GROW_FOREST_H
#define CORCAST_GROW_FOREST_H

#include "base/base.h"

typedef struct Forest {
    size_t trees, terminals;
    size_t *quota; /* terminals of each tree in the end */
    size_t *has;   /* and so far */
    size_t *limit; /* how many more each may get in the round at hand; the round takes off what it
                      got */
    size_t *grant; /* the limit that the round began with */
} Forest;

/* `terminals`, not fewer than trees, go to the trees in proportion to `share`, rounded by largest
 * remainders, at least one to each. */
MUST_CHECK Status forest_init(Forest *forest, size_t trees, const double *share, size_t terminals,
                              Err *err);
void forest_release(Forest *forest);

/* Sets the limits when there are so many terminals, so that no tree gets far ahead of its share of
 * the terminals there are. Some tree that lacks terminals is always allowed more. */
void forest_limit(Forest *forest, size_t terminals);

/* To be called after a round: adds what was taken off the limits to `has`. */
void forest_count(Forest *forest);

#endif
