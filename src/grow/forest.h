/* Shares the terminals among the trees of a forest that grow side by side.
 *
 * Each tree has a quota: its number of terminals at the end. Growth runs in rounds [round.h].
 * Before a round, forest_limit sets for each tree how many terminals it may get, so that no
 * tree gets far ahead of its share. The round counts the limits down, and forest_count adds
 * the result. */
#ifndef CORCAST_GROW_FOREST_H
#define CORCAST_GROW_FOREST_H

#include "base/base.h"

/* The arrays have one number per tree and are owned. */
typedef struct Forest {
    size_t trees, terminals; /* number of trees; number of terminals of all trees at the end */
    size_t *quota;           /* number of terminals at the end of growth */
    size_t *has;             /* number of terminals at the beginning of this round */
    size_t *limit; /* how many terminals the tree may still get in this round; counted down by the
                    * round */
    size_t *grant; /* the limit at the beginning of this round */
} Forest;

/* Shares `terminals` among the trees in proportion to `share`, rounded by largest remainders. Every
 * tree gets at least one terminal, so there must be as many terminals as trees. Release *forest
 * with forest_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status forest_init(Forest *forest, size_t trees, const double *share, size_t terminals,
                              Err *err);
/* Frees the arrays and zeroes *forest, which may be zeroed before. */
void forest_release(Forest *forest);

/* Sets the limits of the next round, so that no tree gets far ahead of its share. `terminals` is
 * the forest's present number of terminals. At least one tree that lacks terminals may get more. */
void forest_limit(Forest *forest, size_t terminals);

/* Adds to `has` of each tree the number of terminals that it got in the last round: grant - limit.
 */
void forest_count(Forest *forest);

#endif
