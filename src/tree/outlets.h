/* Sets the flow shares of a tree [Tree.flow_share], which determine the flow through each terminal.
 * Each function replaces the present flow shares, and marks the key META_TERMINAL_FLOW as not
 * known. */
#ifndef CORCAST_TREE_OUTLETS_H
#define CORCAST_TREE_OUTLETS_H

#include "base/base.h"

typedef struct Tree Tree;

/* Removes the flow shares: all terminals then have the same flow. */
void tree_set_flow_equal(Tree *tree);
/* Sets flow shares proportional to radius^gamma at the terminals. In a tree that obeys Murray's law
 * with the exponent gamma, the flow through every segment is then proportional to radius^gamma.
 * Errors: STATUS_INPUT if no terminal has a radius above 0, with a sentence that does not name the
 * file; STATUS_MEMORY. */
MUST_CHECK Status tree_set_flow_by_radius(Tree *tree, double gamma, Err *err);
/* Sets the flow shares to `share`: per node, finite and >= 0 (not checked), in any common unit; if
 * all are 0, no blood flows. The array must be allocated by malloc; the tree takes ownership of it.
 * NULL: as tree_set_flow_equal. */
void tree_set_flow_shares(Tree *tree, double *share);

#endif
