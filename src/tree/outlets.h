/* How the flow through a tree parts among its terminals, where that is not what its file says. Each
 * of these takes the place of the tree's flow shares. */
#ifndef CORCAST_TREE_OUTLETS_H
#define CORCAST_TREE_OUTLETS_H

#include "base/base.h"

typedef struct Tree Tree;

/* The same for all. */
void tree_set_flow_equal(Tree *tree);
/* As their radii to the power of gamma, as Murray's law has it all over a tree that keeps to it.
 * STATUS_INPUT, naming no file, when no terminal has a radius. */
MUST_CHECK Status tree_set_flow_by_radius(Tree *tree, double gamma, Err *err);
/* As share[n] of the nodes (owned from then on), each finite and not negative. */
void tree_set_flow_shares(Tree *tree, double *share);

#endif
