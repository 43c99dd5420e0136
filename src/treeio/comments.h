/* A tree's metadata as comments "key: value" of a text file. Programs that do not know the keys
 * skip them. */
#ifndef CORCAST_TREEIO_COMMENTS_H
#define CORCAST_TREEIO_COMMENTS_H

#include "tree/tree.h"

/* Returns what follows "name:" and blanks in a comment, or NULL if the comment does not begin so.
 */
const char *comment_value(const char *comment, const char *name);

/* Sets the key of a text "key: value", or keeps the text as a remark. Errors: STATUS_INPUT, without
 * file and line, as meta_parse; STATUS_MEMORY. */
MUST_CHECK Status comment_store(TreeMeta *meta, const char *text, Err *err);
/* As comment_store, for what follows the '#' of a comment. One blank after the '#' is left out. */
MUST_CHECK Status comment_read(TreeMeta *meta, const char *comment, Err *err);
/* As comment_read, but leaves out remarks, for formats whose files explain themselves in comments.
 */
MUST_CHECK Status comment_read_key(TreeMeta *meta, const char *comment, Err *err);

/* Writes the next of all keys and remarks into *line, as comment_store takes it. Returns false
 * after the last. Begin with {.meta = meta}. */
bool comments_next(MetaWalk *walk, Text *line);

/* Appends all that is known, one comment per line. Leaves out comments that begin with a name of
 * `except` and a colon, because they mean something else in the format. A list of names ends with
 * NULL; `except` may be NULL. */
void comments_put(const TreeMeta *meta, const char *const *except, Text *text);

#endif
