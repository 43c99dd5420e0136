/* Derived fields as columns of their tree, for files. */
#ifndef CORCAST_JOB_TREE_FIELD_COLUMNS_H
#define CORCAST_JOB_TREE_FIELD_COLUMNS_H

#include "base/base.h"
#include "tree/tree.h"

/* Adds the fields of a list, "flow,wss", to the tree's columns. "all" are those that can be derived
 * and that files of trees do not hold anyway; those that lack what they need are named on standard
 * error, unless `quiet`. What the tree has a column of stays that. STATUS_USAGE for an unknown
 * name, STATUS_INPUT when a field of the list lacks what it needs. */
MUST_CHECK Status field_columns_add(Tree *tree, const TreeMeta *said, const char *list, bool quiet,
                                    Err *err);

#endif
