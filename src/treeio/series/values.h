/* Values of segments in a file of their own, which become columns of their tree. docs/FIELDS.md
 * says what such files hold. */
#ifndef CORCAST_TREEIO_VALUES_H
#define CORCAST_TREEIO_VALUES_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* Splits "FILE:COLUMN" or "FILE", FILE being one that tree_read_values reads, a CSV or a folder
 * that svOneDSolver has written: the length of its path in *path, and the column behind it, NULL
 * without one, in *column (borrowed). False when no such file is named. */
bool values_parse(const char *text, size_t *path, const char **column);

/* Reads values of the tree's segments, by their ids, into columns of the tree, where they take the
 * place of columns of the same name. With a `column`, only the one called so, or those that are the
 * series of this name [tree/series.h]. Else, if `name` is wanted, all columns must be one thing: a
 * single column, a series, or a column a frame, which become a series named after the file. What it
 * is called then is in *name (owned). Without `column` and `name`, all columns become the tree's.
 * What stands in no row is NAN.
 *
 * STATUS_INPUT, naming file and line, when no column is called id or name, an id is no segment's or
 * stands twice, a value is no number, frames are missing, or no column is called `column`; or when
 * there are more than BUILDER_MAX_COLUMNS. STATUS_MEMORY when the machine cannot hold them. The
 * tree may have some of the columns then. */
MUST_CHECK Status tree_read_values(Tree *tree, const char *path, const char *column, char **name,
                                   Err *err);

/* Reads the columns id and flow (ml/min) of a CSV: the flow that leaves the tree at each node takes
 * the place of the tree's flow shares, and their sum of its flow through the inlet. STATUS_INPUT as
 * tree_read_values, and for a flow below 0 or when none is above. */
MUST_CHECK Status tree_read_flows(Tree *tree, const char *path, Err *err);

#endif
