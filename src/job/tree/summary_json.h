/* What `info --json` and studies say of a tree. */
#ifndef CORCAST_JOB_TREE_SUMMARY_JSON_H
#define CORCAST_JOB_TREE_SUMMARY_JSON_H

#include "derive/derive.h"

/* New reference; NULL when memory ran out. */
json_t *summary_json(const TreeSummary *summary);

/* The tree's pairs [tree/pairs.h], of each both ids and the distance of the nodes, mm; null where
 * the tree says none. Likewise. */
json_t *pairs_json(const Tree *tree);

#endif
