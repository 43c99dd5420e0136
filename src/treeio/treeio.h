/* The public header of treeio: reads and writes trees in files. The table in treeio.c lists the
 * formats; each is one file beside it. docs/FORMATS.md describes the files.
 *
 * Rules of every text format: a line ends with LF, CR or CRLF. A line that starts with '#' is a
 * comment, wherever it stands. A comment "key: value" with a key of meta_rows sets Tree.meta; other
 * comments are kept as remarks. Ids of a tree start at 1, because 0 means "nothing" in id planes.
 * If the ids of a file start at 0, they are read one higher. */
#ifndef CORCAST_TREEIO_TREEIO_H
#define CORCAST_TREEIO_TREEIO_H

#include "base/base.h"
#include "tree/tree.h"
#include "treeio/series/values.h" // IWYU pragma: export

/* ---- formats ---- */

/* Returns true if a path has the extension of a tree format, in any case, or is "-". */
bool tree_format_known(const char *path);
/* Checks that a tree can be written to such a path. Errors: STATUS_USAGE, with the list of
 * extensions. */
MUST_CHECK Status tree_format_check(const char *path, Err *err);

/* What a tree holds and the format of a path cannot hold. */
typedef struct TreeLosses {
    bool types, flow_shares, terminal_flow;
    bool root_values;    /* values of roots in columns whose other values are written */
    bool root_radii;     /* radii of roots that differ from the thickest segment there */
    bool isolated_roots; /* roots without segments */
    size_t columns;      /* number of columns that tree_format_stores denies */
    size_t merged;       /* number of nodes at the position of others; a reader makes one of them */
} TreeLosses;
/* Finds what is lost when a tree is written to such a path. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status tree_format_losses(const char *path, const Tree *tree, TreeLosses *out, Err *err);
/* Returns true if the format of a path can hold a column. */
bool tree_format_stores(const char *path, const TreeColumn *column);

/* Returns the name ("SWC"), the chief extension ("swc") or the description of format `i`, from 0
 * on; NULL after the last. Format 0 is written to standard output. */
const char *tree_format_name(size_t i);
const char *tree_format_extension(size_t i);
const char *tree_format_description(size_t i);
/* Appends the keywords of all formats that a file of this name may have, one per line. "-" may be
 * of any format. */
void tree_format_keywords(const char *path, Text *text);
/* Appends all chief extensions as a sentence lists them: ".swc or .csv". */
void tree_format_list(Text *text);

/* ---- reading ---- */

/* Reads a tree.
 *
 * path     the extension decides the format. The format of standard input, "-", is recognized by
 *          its first bytes.
 * tree     receives the tree; release it with tree_release. Nodes are in the order of the file,
 *          except that a parent which the file names later moves to just before its first child.
 * Errors   STATUS_USAGE for an unknown extension. STATUS_INPUT, with file and line, for a wrong
 *          number of fields, a value that is no number or out of range, a duplicate id, an unknown
 *          parent, a cycle, a key with a bad value or with two values, a flow share given twice or
 *          to no node, flow shares that terminal_flow contradicts, and a file without nodes.
 *          STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status tree_read(Tree *tree, const char *path, Err *err);

/* Reads a tree as the options say, and reports what was found.
 *
 * options  NULL: none.
 * reading  receives the report; release it with reading_release. May be NULL.
 * Errors   as tree_read and graph_build; STATUS_USAGE for an option that the file's format does not
 *          take, and for an unknown format. */
MUST_CHECK Status tree_read_as(Tree *tree, const char *path, const ReadOptions *options,
                               TreeReading *reading, Err *err);

/* Reads a tree from the bytes of a file, as tree_read_as does. Errors: also STATUS_USAGE for an
 * index of other files (PVD). */
MUST_CHECK Status tree_read_bytes(Tree *tree, const MemoryFile *file, const ReadOptions *options,
                                  TreeReading *reading, Err *err);

/* ---- writing ---- */

/* Writes the metadata of a tree, then its nodes in array order. Every number reads back as the same
 * double. Leaves out what tree_format_losses reports. Errors: as tree_format_check; STATUS_INPUT
 * for a tree that tree_check refuses, or without segments in a format that holds segments alone;
 * STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status tree_write(const Tree *tree, const char *path, Err *err);

/* Appends what tree_write would write to such a path. Errors: as tree_write. */
MUST_CHECK Status tree_write_text(const Tree *tree, const char *path, Text *out, Err *err);

/* Writes a tree whose columns are series [tree/series.h] as an index for ParaView, P.pvd, and one
 * file per moment, P_0001.vtp, ..., whose columns have the names of their series. The index is
 * written last. Errors: STATUS_INPUT, without the file's name, if the tree has no series, or series
 * of different times; as tree_write. */
MUST_CHECK Status tree_write_moments(const Tree *tree, const char *path, Err *err);
/* Counts the moments. Errors: as tree_write_moments. */
MUST_CHECK Status tree_count_moments(const Tree *tree, size_t *n, Err *err);
/* Makes the path of the file of a moment, from 0 on, in *out (owned). Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_moment_path(const char *path, size_t moment, char **out, Err *err);

#endif
