/* Parts of reports about trees that several operations have in common. */
#ifndef CORCAST_JOB_TREE_SUMMARY_JSON_H
#define CORCAST_JOB_TREE_SUMMARY_JSON_H

#include "derive/derive.h"

/* Returns a summary as a JSON object. New reference, or NULL if memory runs out. */
json_t *summary_json(const TreeSummary *summary);

/* Returns the pairs of terminals [tree/pairs.h] as an array; an item is the two ids and the
 * distance of the nodes in mm. Returns JSON null if the tree has no pairs. New reference, or NULL
 * if memory runs out. */
json_t *pairs_json(const Tree *tree);

#endif
