/* Checks whether a tree can be refined, before anything is changed. */
#ifndef CORCAST_GROW_REFINE_REFINE_CHECK_H
#define CORCAST_GROW_REFINE_REFINE_CHECK_H

#include "grow/grow.h"

/* Checks parameters, tree and domain as refine_tree requires. Errors: STATUS_USAGE or STATUS_INPUT,
 * with a sentence that states what is not accepted; STATUS_MEMORY. */
MUST_CHECK Status refine_check(const RefineParams *params, const Domain *domain, const Tree *tree,
                               Err *err);

#endif
