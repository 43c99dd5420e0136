/* Reading trees: the options of every command that takes one, and what is said of what was read. */
#ifndef CORCAST_OPTIONS_READING_H
#define CORCAST_OPTIONS_READING_H

#include "base/base.h"
#include "options/options.h"
#include "tree/tree.h"
#include "treeio/treeio.h"

extern const OptionTable reading_table; /* sets a ReadOptions */

/* Reads a tree as the options say. If `path` is parsed->given_name, copies the tree in memory.
 *
 * Notes tell where loops were cut, which radii were replaced, which ends nearly touch, and which
 * unit the radii look like if it is another than the one used.
 *
 * reading  receives what was found; release it with reading_release. NULL: not wanted.
 * Errors   as tree_read_as; STATUS_INPUT for a network with links if Command.trees_only is set;
 *          STATUS_USAGE for an option of reading if the tree is in memory. */
MUST_CHECK Status reading_tree(const Parsed *parsed, const char *path, Tree *tree,
                               TreeReading *reading, Err *err);
/* Reads a tree from the bytes of a file as the options say, with the notes of reading_tree. Errors:
 * as tree_read_bytes. */
MUST_CHECK Status reading_tree_bytes(const Parsed *parsed, const MemoryFile *file, Tree *tree,
                                     Err *err);

/* Refuses a network with links: "PATH: the network has loops, and WHAT needs a tree; ...". Errors:
 * STATUS_INPUT. */
MUST_CHECK Status reading_refuse_loops(const Tree *tree, const char *path, const char *what,
                                       Err *err);

#endif
