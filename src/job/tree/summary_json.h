/* Parts of JSON reports about trees that several operations share. */
#ifndef CORCAST_JOB_TREE_SUMMARY_JSON_H
#define CORCAST_JOB_TREE_SUMMARY_JSON_H

#include "derive/derive.h"

/* Returns a summary as a JSON object: a new reference, or NULL if memory runs out. */
json_t *summary_json(const TreeSummary *summary);

/* Returns the pairs of terminals [tree/pairs.h] as a JSON array: a new reference, or NULL if memory
 * runs out or the pairs cannot be read. An item is the array [id, id, distance of the two nodes in
 * mm]. Returns JSON null if the tree has no pairs. */
json_t *pairs_json(const Tree *tree);

#endif
