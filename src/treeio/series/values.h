/* Reads values of segments, such as pressures, from a file other than the tree's file. Part of the
 * public header of treeio.
 *
 * The values become columns of the tree: one number per node, for the segment that ends there. A
 * file is a CSV with a column of segment ids, or a result folder of svOneDSolver. docs/FIELDS.md
 * describes the files. */
#ifndef CORCAST_TREEIO_SERIES_VALUES_H
#define CORCAST_TREEIO_SERIES_VALUES_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* Splits "FILE:COLUMN" or "FILE", where FILE is a CSV file or a result folder of svOneDSolver.
 *
 * path_length  receives the length of FILE in characters.
 * column       receives COLUMN, borrowed from `text`; NULL if there is no COLUMN.
 * Returns      false, and sets nothing, if FILE is neither. */
bool values_parse(const char *text, size_t *path_length, const char **column);

/* Reads values of the tree's segments into columns of the tree. The ids in the file identify the
 * segments: a row has the id of the node at which its segment ends. A new column replaces a column
 * of the same name. Segments without any row get NAN. If the file has a column `time`, in the unit
 * of that column, a segment has one row per time.
 *
 * column   the column or time series [tree/series.h] to read. NULL: all columns.
 * name     receives the name of the column or series that was read; the caller frees it. NULL: not
 *          wanted. If `name` is not NULL and `column` is NULL, the file must hold one column
 *          ("id,wss"), one series ("id,time,wss" or "id,wss_0,wss_0.1"), or one column per time
 *          ("id,0,0.1"), which becomes a series named after the file.
 * Errors   STATUS_IO. STATUS_INPUT, with file and line, if no column is called id or, in a result
 *          folder, name; an id belongs to no segment, or occurs twice; a value is not a number; a
 *          segment has rows for some of the times only; no column is called `column`; or there are
 *          more than BUILDER_MAX_COLUMNS columns. STATUS_MEMORY. After an error the tree may have
 *          some of the new columns. */
MUST_CHECK Status tree_read_values(Tree *tree, const char *path, const char *column, char **name,
                                   Err *err);

/* Reads the columns id and flow (ml/min) of a CSV. The flow that leaves the tree at each node
 * replaces the tree's flow shares; it is 0 at nodes without a row. The sum of these flows replaces
 * the tree's inlet flow.
 *
 * Errors   as tree_read_values; also STATUS_INPUT if a flow is below 0, or no flow is above 0. */
MUST_CHECK Status tree_read_flows(Tree *tree, const char *path, Err *err);

#endif
