/* A refined arbor becomes a Tree again. */
#ifndef CORCAST_GROW_REFINE_RESULT_H
#define CORCAST_GROW_REFINE_RESULT_H

#include "grow/refine/refine_arbor.h"
#include "tree/tree.h"

/* Makes *tree (owned) of the arbor, with all that stays of the tree `was` from which the arbor was
 * made, but the meta, and with the radii that follow. STATUS_INFEASIBLE when a radius is beyond the
 * range of a double. */
MUST_CHECK Status result_make(const Arbor *arbor, const Tree *was, Tree *tree, Err *err);

#endif
