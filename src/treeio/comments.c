/* A comment is read by the table of keys, one blank behind its '#' left out. A remark is written as
 * it was read but for that blank, so that what corcast has written once it writes again. */
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

/* The value of a comment "key: value", and its key in *key; NULL when it is none. */
static const char *key_value(const char *comment, MetaKey *key)
{
    const char *name = comment + strspn(comment, TEXT_BLANKS);
    *key = meta_find(name, strcspn(name, ":" TEXT_BLANKS));
    return *key == META_KEYS ? NULL : comment_value(name, meta_rows[*key].name);
}

Status comment_read(TreeMeta *meta, const char *comment, Err *err)
{
    MetaKey key;
    const char *value = key_value(comment, &key);
    if (value)
        return meta_parse(meta, key, value, err);
    return meta_add_text(meta, META_KEYS, comment + (*comment == ' '), err);
}

Status comment_read_key(TreeMeta *meta, const char *comment, Err *err)
{
    MetaKey key;
    const char *value = key_value(comment, &key);
    return value ? meta_parse(meta, key, value, err) : STATUS_OK;
}

Status comments_write(const TreeMeta *meta, FILE *stream, Err *err)
{
    Text value = TEXT_INIT;
    MetaLine line;
    for (MetaWalk walk = {.meta = meta}; meta_walk(&walk, &line);) {
        text_clear(&value);
        if (line.text)
            text_puts(&value, line.text);
        else
            meta_put_value(meta, line.key, &value);
        const char *chars = text_chars(&value);
        if (!chars)
            break;
        if (line.key == META_KEYS)
            fprintf(stream, *chars ? "# %s\n" : "#%s\n", chars);
        else
            fprintf(stream, "# %s: %s\n", meta_rows[line.key].name, chars);
    }
    Status status = text_check(&value, err);
    text_release(&value);
    return status;
}
