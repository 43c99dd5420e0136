/* Reads values of segments from a file of their own into columns of their tree. docs/FIELDS.md
 * describes such files. */
#ifndef CORCAST_TREEIO_VALUES_H
#define CORCAST_TREEIO_VALUES_H

#include "base/base.h"
#include "tree/tree.h"
#include <stdbool.h>

/* Splits "FILE:COLUMN" or "FILE". FILE is a CSV or a folder that svOneDSolver has written.
 *
 * path     receives the length of the path.
 * column   receives the column after the path, borrowed from `text`; NULL if there is none.
 * Returns  false if the text names no such file. */
bool values_parse(const char *text, size_t *path, const char **column);

/* Reads values of the tree's segments, by their ids, into columns of the tree. They replace columns
 * of the same name. Segments without a row get NAN.
 *
 * column   only this column is read, or the columns of the series of this name [tree/series.h].
 * NULL: all. name     receives the name of what was read (owned). Without `column`, all columns
 * must then be one thing: a column, a series, or one column per frame, which become a series named
 * after the file. NULL: not wanted. Errors   STATUS_INPUT, with file and line, if no column is
 * called id or name, an id is no segment's or is given twice, a value is no number, frames are
 * missing, no column is called `column`, or there are more than BUILDER_MAX_COLUMNS. STATUS_MEMORY
 * if the machine cannot hold them. After an error the tree may have some of the columns. */
MUST_CHECK Status tree_read_values(Tree *tree, const char *path, const char *column, char **name,
                                   Err *err);

/* Reads the columns id and flow (ml/min) of a CSV. The flow that leaves the tree at each node
 * replaces the tree's flow shares, and their sum replaces its flow through the inlet. Errors: as
 * tree_read_values; STATUS_INPUT for a flow below 0, or if no flow is above 0. */
MUST_CHECK Status tree_read_flows(Tree *tree, const char *path, Err *err);

#endif
