/* Sets how the terminals of a tree share its flow. Each function replaces the flow shares that the
 * tree has from its file [Tree.flow_share], and marks the key terminal_flow as not known. */
#ifndef CORCAST_TREE_OUTLETS_H
#define CORCAST_TREE_OUTLETS_H

#include "base/base.h"

typedef struct Tree Tree;

/* Gives all terminals the same flow: removes the flow shares. */
void tree_set_flow_equal(Tree *tree);
/* Gives each terminal a flow proportional to radius^gamma. In a tree that obeys Murray's law
 * with the exponent gamma, all segments then have flows proportional to radius^gamma. Errors:
 * STATUS_INPUT if no terminal has a radius above 0, with a sentence that does not name the
 * file; STATUS_MEMORY. */
MUST_CHECK Status tree_set_flow_by_radius(Tree *tree, double gamma, Err *err);
/* Sets the flow shares: `share` has an entry per node, finite and >= 0, in any common unit. The
 * tree takes ownership of the array, which was allocated by malloc. NULL: equal flow. */
void tree_set_flow_shares(Tree *tree, double *share);

#endif
