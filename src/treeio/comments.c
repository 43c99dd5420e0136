/* Reads and writes the metadata of a tree as comments of a text file, one line "key: value" per
 * value.
 *
 * A comment "key: value" is found by the table of keys [tree/meta.h]. comment_read drops the one
 * blank that comments_put writes after '#', so that a remark stays the same when a file is read and
 * written again. */
#include "treeio/comments.h"

#include "treeio/formats.h"
#include <string.h>

const char *comment_value(const char *comment, const char *name)
{
    comment += strspn(comment, TEXT_BLANKS);
    size_t length = strlen(name);
    if (strncmp(comment, name, length) != 0)
        return NULL;
    comment += length;
    comment += strspn(comment, TEXT_BLANKS);
    return *comment == ':' ? comment + 1 + strspn(comment + 1, TEXT_BLANKS) : NULL;
}

/* Returns the value of a comment "key: value", and sets *key. Returns NULL if the comment has no
 * known key. */
static const char *key_value(const char *comment, MetaKey *key)
{
    const char *name = comment + strspn(comment, TEXT_BLANKS);
    *key = meta_find(name, strcspn(name, ":" TEXT_BLANKS));
    return *key == META_KEYS ? NULL : comment_value(name, meta_rows[*key].name);
}

Status metadata_read_line(TreeMeta *meta, const char *comment, Err *err)
{
    MetaKey key;
    const char *value = key_value(comment, &key);
    return value ? meta_parse(meta, key, value, err) : meta_add_text(meta, META_KEYS, comment, err);
}

Status comment_read(TreeMeta *meta, const char *comment, Err *err)
{
    return metadata_read_line(meta, comment + (*comment == ' '), err);
}

Status comment_read_key_only(TreeMeta *meta, const char *comment, Err *err)
{
    MetaKey key;
    const char *value = key_value(comment, &key);
    return value ? meta_parse(meta, key, value, err) : STATUS_OK;
}

bool comments_next(MetaWalk *walk, Text *line)
{
    MetaLine at;
    if (!meta_walk(walk, &at))
        return false;
    text_clear(line);
    if (at.key != META_KEYS)
        text_printf(line, "%s: ", meta_rows[at.key].name);
    if (at.text)
        text_puts(line, at.text);
    else
        meta_put_value(walk->meta, at.key, line);
    return true;
}

/* Returns true if the comment begins with one of the names and a colon. */
static bool begins_with_one(const char *comment, const char *const *names)
{
    for (; names && *names; names++)
        if (comment_value(comment, *names))
            return true;
    return false;
}

void comments_put(const TreeMeta *meta, const char *const *except, Text *text)
{
    Text line = TEXT_INIT;
    for (MetaWalk walk = {.meta = meta}; comments_next(&walk, &line);) {
        const char *chars = text_chars(&line);
        if (chars && begins_with_one(chars, except))
            continue;
        text_puts(text, chars && *chars ? "# " : "#");
        text_puts(text, chars);
        text_puts(text, "\n");
    }
    text_release(&line);
}
