/* The door of the room treeio: trees in files, in one of the formats of the table in treeio.c, of
 * which each is one file beside it. docs/FORMATS.md says what a file holds.
 *
 * Of every text format: line ends are LF, CR or CRLF; a line that starts with '#' is a comment,
 * wherever it stands. A comment "key: value" with a key of meta_rows sets Tree.meta; all others are
 * kept as remarks. Ids of a tree start at 1, as 0 means "nothing" in id planes; ids of a file that
 * start at 0 are read one higher. */
#ifndef CORCAST_TREEIO_TREEIO_H
#define CORCAST_TREEIO_TREEIO_H

#include "base/base.h"
#include "tree/tree.h"
#include "treeio/series/values.h" // IWYU pragma: export

/* Whether a path has the extension of a tree format, in capitals or not, or is "-". */
bool tree_format_known(const char *path);
/* STATUS_USAGE, saying which there are, unless a tree can be written to such a path. */
MUST_CHECK Status tree_format_check(const char *path, Err *err);
/* What a tree holds and the format of a path has no place for. */
typedef struct TreeLosses {
    bool types, flow_shares, terminal_flow;
    bool root_values; /* in columns, although those are not lost */
    bool root_radii;  /* which are not those of the thickest segments that leave the roots */
    bool lone_roots;  /* roots without segments */
    size_t columns;   /* those that tree_format_keeps denies */
    size_t merged;    /* nodes where others lie, of which a reader makes one */
} TreeLosses;
/* O(n); STATUS_MEMORY. */
MUST_CHECK Status tree_format_losses(const char *path, const Tree *tree, TreeLosses *out, Err *err);
/* Of a format that has no place for columns as such: whether it has one for this. */
bool tree_format_keeps(const char *path, const TreeColumn *column);
/* Name ("SWC"), chief extension ("swc") and description of format `i`, from 0 on; NULL after the
 * last. The first is written to standard output. */
const char *tree_format_name(size_t i);
const char *tree_format_extension(size_t i);
const char *tree_format_description(size_t i);
/* Appends the keywords of all formats that a file of this name may have, one per line. "-" may be of any
 * format. */
void tree_format_keywords(const char *path, Text *text);
/* Appends all chief extensions as a reader says them: ".swc or .csv". */
void tree_format_list(Text *text);

/* Reads the tree in *tree (owned; tree_release), parents first and otherwise in file order: an
 * ancestor that the file names later moves to just before its first descendant. The format is that
 * of the extension; that of standard input, "-", is recognised by its first bytes. STATUS_USAGE for
 * an unknown extension; STATUS_INPUT, naming file and line, for a wrong field count, a value that
 * is no number or out of range, a duplicate id, an unknown parent, a cycle, a key of bad value or
 * given twice with different values, a flow share given twice or to what is no node, flow shares
 * that terminal_flow contradicts, and for a file without nodes. */
MUST_CHECK Status tree_read(Tree *tree, const char *path, Err *err);

/* Likewise, as the options say (NULL: nothing), and says what was found in *reading (owned;
 * reading_release; may be NULL). STATUS_USAGE, naming it, for an option that the file's format does
 * not take, and for a format that there is not; STATUS_INPUT also as graph_build. */
MUST_CHECK Status tree_read_as(Tree *tree, const char *path, const ReadOptions *options,
                               TreeReading *reading, Err *err);

/* Writes what is known of the tree, then its nodes in array order; every number reads back to the
 * same double. What tree_format_losses says is left out. STATUS_USAGE as
 * tree_format_check, STATUS_INPUT for a tree that tree_check refuses, or that has no segments where
 * the format holds segments alone. */
MUST_CHECK Status tree_write(const Tree *tree, const char *path, Err *err);

/* Appends what tree_write would write to such a path to *out. As tree_write. */
MUST_CHECK Status tree_write_text(const Tree *tree, const char *path, Text *out, Err *err);

/* Writes a tree whose columns are series [tree/series.h] as an index for ParaView, P.pvd, and a
 * file for each moment, P_0001.vtp, ..., in which the columns have the names of their series. The
 * index comes last. STATUS_INPUT, naming no file, when the tree has no series, or some of different
 * times; else as tree_write. */
MUST_CHECK Status tree_write_moments(const Tree *tree, const char *path, Err *err);
/* How many moments there are. Errors likewise. */
MUST_CHECK Status tree_count_moments(const Tree *tree, size_t *n, Err *err);
/* The file of a moment, from 0 on, in *out (owned). */
MUST_CHECK Status tree_moment_path(const char *path, size_t moment, char **out, Err *err);

#endif
