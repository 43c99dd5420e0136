/* Divides the terminals among the trees of a forest that grow at the same time.
 *
 * Each tree has a quota: its number of terminals at the end. Growth runs in rounds [round.h].
 * Before a round, forest_limit sets how many terminals each tree may get, so that all trees
 * approach their quotas at the same rate. The round counts the limits down. Afterwards forest_count
 * adds the new terminals. */
#ifndef CORCAST_GROW_FOREST_H
#define CORCAST_GROW_FOREST_H

#include "base/base.h"

/* The arrays have one number per tree and are owned. */
typedef struct Forest {
    size_t trees;     /* number of trees */
    size_t terminals; /* number of terminals of all trees at the end of growth */
    size_t *quota;    /* number of terminals of the tree at the end of growth */
    size_t *has;      /* number of terminals of the tree at the beginning of this round */
    size_t *limit;    /* number of terminals that the tree may still get in this round */
    size_t *grant;    /* value of `limit` at the beginning of this round */
} Forest;

/* Sets the quotas: divides `terminals` among the trees in proportion to `share`, rounded by the
 * largest remainder method. Every tree gets at least one terminal.
 *
 * share      per tree: its weight, above 0.
 * terminals  at least `trees`.
 * forest     release it with forest_release, also after an error.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status forest_init(Forest *forest, size_t trees, const double *share, size_t terminals,
                              Err *err);
/* Frees the arrays and zeroes *forest, which may be zeroed before. */
void forest_release(Forest *forest);

/* Sets the limits of the next round. `terminals` is the present number of terminals of the forest.
 * As long as a tree lacks terminals, at least one such tree may get more. */
void forest_limit(Forest *forest, size_t terminals);

/* Adds to `has` of each tree the terminals that it got in the last round: grant - limit. */
void forest_count(Forest *forest);

#endif
