/* Stores a tree's metadata in the comments of a text file: "# root_pressure: 100". Other programs
 * skip the comments.
 *
 * TreeMeta [tree/meta.h] has a value per known key, and a list of remarks. A comment "key: value"
 * whose key is known sets the value. Any other comment is a remark. Readers call comment_read for
 * each comment, and writers call comments_put once. */
#ifndef CORCAST_TREEIO_COMMENTS_H
#define CORCAST_TREEIO_COMMENTS_H

#include "tree/tree.h"

/* Returns the part of `comment` after "name:" and blanks, or NULL if the comment does not begin
 * with "name:". */
const char *comment_value(const char *comment, const char *name);

/* Reads "key: value" into *meta, or stores the text as a remark if the key is unknown. Errors:
 * those of meta_parse, without file and line; STATUS_MEMORY. */
MUST_CHECK Status comment_store(TreeMeta *meta, const char *text, Err *err);
/* Reads a comment from after its '#', without one blank that may follow. Otherwise like
 * comment_store. */
MUST_CHECK Status comment_read(TreeMeta *meta, const char *comment, Err *err);
/* Reads a comment as comment_read does, but does not store remarks. For formats whose files explain
 * themselves in comments. */
MUST_CHECK Status comment_read_key(TreeMeta *meta, const char *comment, Err *err);

/* Writes the next key with its value, or the next remark, into *line, in the form that
 * comment_store reads. Returns false after the last one. Begin with *walk = {.meta = meta}. */
bool comments_next(MetaWalk *walk, Text *line);

/* Appends all metadata, one comment "# ..." per line.
 *
 * except   names that end with NULL. Comments that begin with one of them and a colon are left out,
 *          because the format gives them another meaning. NULL: all comments are written. */
void comments_put(const TreeMeta *meta, const char *const *except, Text *text);

#endif
