/* A refined arbor becomes a Tree again. */
#ifndef CORCAST_GROW_REFINE_RESULT_H
#define CORCAST_GROW_REFINE_RESULT_H

#include "grow/refine/refine_arbor.h"
#include "tree/tree.h"

/* Gives *tree, from which the arbor was made, the arbor's places and connections and the radii that
 * follow. STATUS_INFEASIBLE when a radius is beyond the range of a double; *tree is then
 * unchanged. */
MUST_CHECK Status result_write(const Arbor *arbor, Tree *tree, Err *err);

#endif
