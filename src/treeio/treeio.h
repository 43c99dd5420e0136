/* The public header of the module treeio: reads and writes arterial trees in files.
 *
 *     Tree tree = {0};
 *     TRY(tree_read(&tree, "tree.swc", err));
 *     TRY(tree_write(&tree, "tree.vtp", err));
 *     tree_release(&tree);
 *
 * The extension of a path selects the format. The table in treeio.c lists the formats, and each
 * format has a source file of its own. docs/FORMATS.md describes the files. Some formats hold
 * trees; others hold networks of points and lines, which the reader turns into a tree.
 *
 * Rules of every text format: a line ends with LF, CR or CRLF. A line that starts with '#' is a
 * comment. A comment "key: value" whose key is in meta_rows sets Tree.meta; other comments are
 * stored as remarks. Node ids in a Tree start at 1, because 0 means "no segment" in id planes. If
 * the ids in a file start at 0, the reader adds 1 to each.
 *
 * The functions may run on several threads at once, on different trees and files. */
#ifndef CORCAST_TREEIO_TREEIO_H
#define CORCAST_TREEIO_TREEIO_H

#include "base/base.h"
#include "tree/tree.h"
#include "treeio/series/values.h" // IWYU pragma: export

/* ---- formats ---- */

/* Returns true if `path` has the extension of a tree format, in upper or lower case, or is "-". */
bool tree_format_known(const char *path);
/* Checks that a tree can be written to `path`: some formats can only be read. Does not touch the
 * file. Errors: STATUS_USAGE, with the list of the extensions that can be written. */
MUST_CHECK Status tree_format_check(const char *path, Err *err);

/* The data of a tree that a format cannot store. */
typedef struct TreeLosses {
    bool types;          /* Tree.type */
    bool flow_shares;    /* Tree.flow_share */
    bool terminal_flow;  /* the metadata key terminal_flow */
    bool root_values;    /* values at roots, in columns whose other values are stored */
    bool root_radii;     /* radii of roots that differ from the radius of their thickest segment */
    bool isolated_roots; /* roots without segments */
    bool link_radii; /* radii of nodes with a link [Tree.link] that differ from the radius of the
                      * node that the link names */
    size_t columns;  /* number of columns for which tree_format_stores returns false */
    size_t merged;   /* number of nodes at the position of an earlier node. The format identifies
                      * nodes by position, so a reader would merge the two nodes */
} TreeLosses;
/* Finds the data that would be lost if `tree` were written to `path`. Does not write. Errors:
 * STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status tree_format_losses(const char *path, const Tree *tree, TreeLosses *out, Err *err);
/* Returns true if the format of `path` can store `column`. Also returns true if `path` has no known
 * extension. */
bool tree_format_stores(const char *path, const TreeColumn *column);

/* A row of the list of formats. The strings are static. */
typedef struct TreeFormat {
    const char *name;        /* "SWC" */
    const char *extension;   /* the main extension, "swc" */
    const char *description; /* one line */
} TreeFormat;
/* Sets *out to format `i`, counted from 0. Returns false, and leaves *out unchanged, if there are
 * no more formats. Format 0 is the format of standard output. */
bool tree_format_at(size_t i, TreeFormat *out);
/* Appends all main extensions as a list in a sentence: ".swc, .vtp or .csv". */
void tree_format_list(Text *text);

/* ---- reading ---- */

/* Reads a tree.
 *
 * tree     receives the tree; release it with tree_release. Nodes are in the order of the file,
 *          except that a parent that comes later moves to just before its first child.
 * path     the file. Its extension selects the format. "-" is standard input, whose format is
 *          recognized by its first bytes.
 * Errors   STATUS_USAGE for an unknown extension. STATUS_INPUT, with file and line, for a wrong
 *          number of fields, a value that is not a number or is out of range, a duplicate id, an
 *          unknown parent, a cycle, a metadata key with a bad value or with two values, a flow
 *          share given twice or to an unknown node, flow shares that contradict terminal_flow, and
 *          a file without nodes. STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status tree_read(Tree *tree, const char *path, Err *err);

/* Reads a tree with options, and reports what the reader found and assumed.
 *
 * options  such as the unit of the file. NULL: the defaults.
 * reading  receives the report; release it with reading_release. NULL: no report is wanted.
 * Errors   those of tree_read and graph_build; STATUS_USAGE for an option that does not apply to
 *          the file's format, and for an unknown options->format. */
MUST_CHECK Status tree_read_as(Tree *tree, const char *path, const ReadOptions *options,
                               TreeReading *reading, Err *err);

/* Reads a tree from the bytes of a file in memory, as tree_read_as does. The extension of
 * file->name selects the format. Errors: those of tree_read_as; STATUS_USAGE for a PVD file,
 * because it refers to other files. */
MUST_CHECK Status tree_read_bytes(Tree *tree, const MemoryFile *file, const ReadOptions *options,
                                  TreeReading *reading, Err *err);

/* ---- writing ---- */

/* Writes the metadata of a tree, then its nodes in array order. Every number reads back as the same
 * double. Leaves out the data that tree_format_losses reports. "-" is standard output. After an
 * error no file is left, and an existing file is unchanged.
 *
 * Errors   those of tree_format_check; STATUS_INPUT for a tree that tree_check refuses, for links
 *          in a format that stores none, and for a tree without segments in a format that stores
 *          only segments; STATUS_IO, STATUS_MEMORY. */
MUST_CHECK Status tree_write(const Tree *tree, const char *path, Err *err);

/* Appends to `out` the bytes that tree_write would write to `path`. Errors: those of tree_write. */
MUST_CHECK Status tree_write_bytes(const Tree *tree, const char *path, Text *out, Err *err);

/* Writes a tree with time series [tree/series.h] for ParaView: one file per time, and an index. For
 * the path "tree.pvd", the files are tree_0001.vtp, tree_0002.vtp and so on, and tree.pvd is the
 * index, which is written last. In each file, the values of a series at one time are a column with
 * the name of the series.
 *
 * Errors   STATUS_INPUT, without the file's name, if the tree has no series, or series with
 *          different times; those of tree_write. */
MUST_CHECK Status tree_write_time_steps(const Tree *tree, const char *path, Err *err);
/* Counts the files that tree_write_time_steps would write besides the index. Errors: those of
 * tree_write_time_steps. */
MUST_CHECK Status tree_count_time_steps(const Tree *tree, size_t *n, Err *err);
/* Makes the path of the file of time `step`, counted from 0; `path` is the path of the index. The
 * caller frees *out. Errors: STATUS_MEMORY. */
MUST_CHECK Status tree_time_step_path(const char *path, size_t step, char **out, Err *err);

#endif
