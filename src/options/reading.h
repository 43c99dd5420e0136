/* Reads the trees that commands take as input, by the options of reading_table. Notes and warnings
 * about a tree go to the message receiver of the command, Common.talk. */
#ifndef CORCAST_OPTIONS_READING_H
#define CORCAST_OPTIONS_READING_H

#include "base/base.h"
#include "options/options.h"
#include "tree/tree.h"
#include "treeio/treeio.h"

extern const OptionTable reading_table; /* sets a ReadOptions */

/* Reads a tree by the options of reading_table (parsed->reading). If `path` is the pointer
 * parsed->given_name, it stands for a tree in memory: copies the tree that was passed to
 * parsed_give.
 *
 * Sends notes about loops that were cut, radii that were replaced, ends that nearly touch, and a
 * unit that would fit the radii better than the unit used.
 *
 * tree     receives the tree; release it with tree_release.
 * reading  receives facts about the file; release it with reading_release. NULL: not wanted.
 * Errors   STATUS_USAGE for an unknown extension, and for an option of reading_table that does not
 *          apply to the format of the file, or to a tree in memory; STATUS_INPUT, with file and
 *          line, for a malformed file, and for a network with links if Command.trees_only is true;
 *          STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status reading_tree(const Parsed *parsed, const char *path, Tree *tree,
                               TreeReading *reading, Err *err);
/* Reads a tree from the bytes of a file in memory, by the same options and with the same notes as
 * reading_tree. Errors: STATUS_USAGE, STATUS_INPUT and STATUS_MEMORY, as for reading_tree. */
MUST_CHECK Status reading_tree_bytes(const Parsed *parsed, const MemoryFile *file, Tree *tree,
                                     Err *err);

/* Fails if the tree is a network with links (segments that close loops): "PATH: the network has
 * loops, and WHAT needs a tree; ...". Errors: STATUS_INPUT. */
MUST_CHECK Status reading_refuse_loops(const Tree *tree, const char *path, const char *what,
                                       Err *err);

#endif
