/* Stores a tree's metadata in the comments of a text file: "# root_pressure: 100". Other programs
 * skip the comments.
 *
 * TreeMeta [tree/meta.h] has a value per known key, and a list of remarks. A comment "key: value"
 * whose key is known sets the value. Any other comment is a remark. Readers call comment_read for
 * each comment. Writers call comments_put once. */
#ifndef CORCAST_TREEIO_COMMENTS_H
#define CORCAST_TREEIO_COMMENTS_H

#include "tree/tree.h"

/* Returns the value of a comment "name: value", a pointer into `comment`; NULL if the comment does
 * not begin with `name` and a colon. */
const char *comment_value(const char *comment, const char *name);

/* Reads a line of metadata. A line "key: value" with a known key sets the value in *meta; any other
 * text is stored as a remark. Errors: those of meta_parse, without file and line; STATUS_MEMORY. */
MUST_CHECK Status metadata_read_line(TreeMeta *meta, const char *text, Err *err);
/* Reads a comment as metadata_read_line does. `comment` begins after the '#'; one blank at its
 * start is skipped. */
MUST_CHECK Status comment_read(TreeMeta *meta, const char *comment, Err *err);
/* Reads a comment as comment_read does, but does not store remarks. This serves formats that repeat
 * comments in every file, such as headings. */
MUST_CHECK Status comment_read_key_only(TreeMeta *meta, const char *comment, Err *err);

/* Replaces *line by the next line of metadata, in the form that metadata_read_line reads. Returns
 * false after the last line. Begin with *walk = {.meta = meta}. If memory runs out, text_check
 * reports it. */
bool comments_next(MetaWalk *walk, Text *line);

/* Appends all metadata to `text`, one comment "# ..." per line. If memory runs out, text_check
 * reports it.
 *
 * except   list of names, terminated by NULL. Comments that begin with one of these names and a
 *          colon are left out, because the format gives them another meaning. NULL: an empty list.
 */
void comments_put(const TreeMeta *meta, const char *const *except, Text *text);

#endif
