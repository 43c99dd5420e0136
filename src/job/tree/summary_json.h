/* Parts of JSON reports that several operations on trees share. */
#ifndef CORCAST_JOB_TREE_SUMMARY_JSON_H
#define CORCAST_JOB_TREE_SUMMARY_JSON_H

#include "derive/derive.h"

/* Returns a summary of a tree as a JSON object: a new reference, or NULL if memory runs out. */
json_t *summary_json(const TreeSummary *summary);

/* Returns the pairs of terminals [tree/pairs.h] as a JSON array. Each item is the array [id, id,
 * distance of the two nodes in mm]. Returns JSON null if the tree has no pairs. The result is a new
 * reference, or NULL if memory runs out or the pairs in the metadata are malformed. */
json_t *pairs_json(const Tree *tree);

#endif
