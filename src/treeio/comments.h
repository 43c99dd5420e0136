/* What is known of a tree as comments "key: value" of a text file, which programs that do not know
 * them skip. */
#ifndef CORCAST_TREEIO_COMMENTS_H
#define CORCAST_TREEIO_COMMENTS_H

#include "tree/tree.h"

/* What follows "name:" and blanks in a comment; NULL when it does not begin so. */
const char *comment_value(const char *comment, const char *name);

/* Sets the key of a comment "key: value", or keeps the comment as a remark; `comment` is what
 * follows the '#'. STATUS_INPUT, without file and line, as meta_parse. */
MUST_CHECK Status comment_read(TreeMeta *meta, const char *comment, Err *err);

/* Likewise, but leaves out what is no key: of formats whose files explain themselves in comments.
 */
MUST_CHECK Status comment_read_key(TreeMeta *meta, const char *comment, Err *err);

/* The next of all that is known, as comment_read takes it, in *line; false behind the last. Begin
 * with {.meta = meta}. */
bool comments_next(MetaWalk *walk, Text *line);

/* Appends all that is known, one comment per line. Leaves out comments that begin with a name of
 * `except` and a colon, because they mean something else in the format. A list of names ends with
 * NULL; `except` may be NULL. */
void comments_put(const TreeMeta *meta, const char *const *except, Text *text);

#endif
