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

/* Writes all that is known, a comment a line, but leaves out comments that begin with one of the
 * names `but` (ends with NULL) and a colon: they mean something else in the format. `but` may be
 * NULL. STATUS_MEMORY. */
MUST_CHECK Status comments_write(const TreeMeta *meta, const char *const *but, FILE *stream,
                                 Err *err);

#endif
