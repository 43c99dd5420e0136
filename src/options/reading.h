/* Reading trees: the options of every command that takes one, and what is said of what was read. */
#ifndef CORCAST_OPTIONS_READING_H
#define CORCAST_OPTIONS_READING_H

#include "base/base.h"
#include "options/options.h"
#include "tree/tree.h"
#include "treeio/treeio.h"

extern const OptionTable reading_table; /* sets a ReadOptions */

/* Reads a tree as the options say, or copies the tree in memory that stands in for the first
 * operand.
 *
 * Notes tell where loops were cut, which radii were replaced, which ends nearly touch, and which
 * unit the radii look like if it is another than the one used.
 *
 * path     parsed->operands[0] for the first operand.
 * reading  receives what was found; release it with reading_release. NULL: not wanted.
 * Errors   as tree_read_as; STATUS_USAGE for an option of reading if the tree is in memory. */
MUST_CHECK Status reading_tree(const Parsed *parsed, const char *path, Tree *tree,
                               TreeReading *reading, Err *err);
/* Reads a tree from the bytes of a file as the options say, with the notes of reading_tree. Errors:
 * as tree_read_bytes. */
MUST_CHECK Status reading_tree_bytes(const Parsed *parsed, const TreeBytes *file, Tree *tree,
                                     Err *err);

/* What was found, as lines of `info` and as JSON. */
void reading_print(const TreeReading *reading);
json_t *reading_json(const TreeReading *reading);

#endif
