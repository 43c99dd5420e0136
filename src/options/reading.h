/* Reads the trees that commands take as input: the options for reading, and the notes and warnings
 * about the tree that was read. */
#ifndef CORCAST_OPTIONS_READING_H
#define CORCAST_OPTIONS_READING_H

#include "base/base.h"
#include "options/options.h"
#include "tree/tree.h"
#include "treeio/treeio.h"

extern const OptionTable reading_table; /* sets a ReadOptions */

/* Reads a tree by the options of reading_table. If `path` is parsed->given_name, copies the tree in
 * memory.
 *
 * Sends notes about loops that were cut, radii that were replaced, ends that nearly touch, and a
 * unit that would suit the radii better than the unit used.
 *
 * reading  receives facts about the file; release it with reading_release. NULL: not wanted.
 * Errors   as tree_read_as; STATUS_INPUT for a network with links if Command.trees_only is set;
 *          STATUS_USAGE for an option of reading if the tree is in memory. */
MUST_CHECK Status reading_tree(const Parsed *parsed, const char *path, Tree *tree,
                               TreeReading *reading, Err *err);
/* Reads a tree from the bytes of a file, by the same options and with the same notes. Errors:
 * as tree_read_bytes. */
MUST_CHECK Status reading_tree_bytes(const Parsed *parsed, const MemoryFile *file, Tree *tree,
                                     Err *err);

/* Fails if the tree is a network with links: "PATH: the network has loops, and WHAT needs a tree;
 * ...". Errors: STATUS_INPUT. */
MUST_CHECK Status reading_refuse_loops(const Tree *tree, const char *path, const char *what,
                                       Err *err);

#endif
