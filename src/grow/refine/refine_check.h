/* Checks whether a tree can be refined, before anything is changed. */
#ifndef CORCAST_GROW_REFINE_REFINE_CHECK_H
#define CORCAST_GROW_REFINE_REFINE_CHECK_H

#include "grow/grow.h"

/* Checks that parameters, tree and domain are as refine_tree [grow.h] requires. `domain` may be
 * NULL: vessels may be anywhere. Errors: STATUS_USAGE for parameters, STATUS_INPUT for a tree that
 * cannot be refined; STATUS_MEMORY. */
MUST_CHECK Status refine_check(const RefineParams *params, const Domain *domain, const Tree *tree,
                               Err *err);

#endif
