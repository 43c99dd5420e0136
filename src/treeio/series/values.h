/* Reads values of segments from a file that is not the tree's own. The values become columns of the
 * tree. docs/FIELDS.md describes such files. */
#ifndef CORCAST_TREEIO_VALUES_H
#define CORCAST_TREEIO_VALUES_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* Splits "FILE:COLUMN" or "FILE". FILE is a CSV file or a result folder of svOneDSolver.
 *
 * path     receives the length of the path.
 * column   receives the column after the path, borrowed from `text`; NULL if there is none.
 * Returns  false if the text names no such file. */
bool values_parse(const char *text, size_t *path, const char **column);

/* Reads values of the tree's segments, by their ids, into columns of the tree. They replace columns
 * of the same name. Segments without a row get NAN.
 *
 * column   the column or series [tree/series.h] to read. NULL: all columns are read.
 * name     receives the name of what was read (owned). NULL: it is not wanted. With `name` and
 *          without `column`, the file must hold one column, one series, or one column per frame.
 *          Columns per frame become a series that is named after the file.
 * Errors   STATUS_INPUT, with file and line, if no column is called id or name; an id belongs to no
 *          segment, or occurs twice; a value is not a number; frames are missing; no column is
 *          called `column`; or there are more than BUILDER_MAX_COLUMNS columns. STATUS_MEMORY.
 *
 * After an error the tree may have some of the new columns. */
MUST_CHECK Status tree_read_values(Tree *tree, const char *path, const char *column, char **name,
                                   Err *err);

/* Reads the columns id and flow (ml/min) of a CSV. The flow that leaves the tree at each node
 * replaces the tree's flow shares. The sum of these flows replaces the tree's inlet flow.
 *
 * Errors   as tree_read_values; also STATUS_INPUT if a flow is below 0, or no flow is above 0. */
MUST_CHECK Status tree_read_flows(Tree *tree, const char *path, Err *err);

#endif
