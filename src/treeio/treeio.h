/* The door of the room treeio: trees in files, the format chosen by the file's extension.
 *
 * SWC (.swc; "-" is SWC on standard input or output), one row a node, in mm:
 *
 *     id type x y z radius parent
 *
 * A parent of -1 marks a root; there may be several. What the reader takes: rows in any order, any
 * different ids in 1 .. 16777215, blanks and tabs, CR, LF or CRLF, a byte order mark, whole numbers
 * written as 1.0, steps of length 0, radii of 0. A line that starts with '#' is a header line,
 * wherever it stands; a '#' after a row starts a remark that is not kept. Header lines
 * "key: value" with the keys
 *
 *     seed dimension gamma lambda p_perf_mmHg p_term_mmHg q_perf_ml_min viscosity_cP
 *     viscosity_law hematocrit plasma_viscosity_cP terminal_flow
 *
 * fill TreeHeader, and lines "flow_share: ID SHARE" fill Tree.flow_share, with 0 where no line is;
 * all other lines are kept as they are. Ids that start at 0 are refused, not shifted: 0 means
 * "nothing" in id planes, and ids are what users know their segments by. */
#ifndef CORCAST_TREEIO_TREEIO_H
#define CORCAST_TREEIO_TREEIO_H

#include "base/base.h"
#include "tree/tree.h"

/* Whether the extension of `path` is that of a tree format. */
bool tree_format_known(const char *path);

/* Reads the tree in *tree (owned; tree_release), parents first and otherwise in file order: an
 * ancestor that the file names later moves to just before its first descendant. STATUS_USAGE for an
 * unknown extension; STATUS_INPUT, naming file and line, for a wrong field count, a value that is
 * no number or out of range, a duplicate id, an unknown parent, a cycle, a header key of bad value
 * or given twice with different values, a flow share given twice or to what is no node, flow shares
 * that terminal_flow contradicts, and for a file without rows. */
MUST_CHECK Status tree_read(Tree *tree, const char *path, Err *err);

/* Writes the header, then the rows in array order; every number reads back to the same double. A
 * known "key: value" line is rewritten from its field, and left out when the field is not known;
 * known fields without a line follow the lines, then the flow shares above 0. STATUS_USAGE for an
 * unknown extension, STATUS_INPUT for a tree that tree_check refuses. */
MUST_CHECK Status tree_write(const Tree *tree, const char *path, Err *err);

#endif
