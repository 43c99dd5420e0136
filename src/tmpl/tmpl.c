/* One pass from '$' to '$'. The expansion grows in a Text of its own, so that a failing template
 * leaves the caller's text alone. Values are few, so a linear search finds them. */
#include "tmpl/tmpl.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct Expansion {
    const char *path;
    const TmplValue *values;
    bool *used; /* owned; one for each value */
    size_t n;
    Text text; /* owned */
} Expansion;

static bool is_name_char(char c, bool first)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           (!first && c >= '0' && c <= '9');
}

/* The length of the name at the start of `chars`, 0 when none stands there. */
static size_t name_length(const char *chars)
{
    size_t length = 0;
    while (is_name_char(chars[length], length == 0))
        length++;
    return length;
}

/* Appends what the '$' at `dollar` stands for; *next is the first character after it. */
static Status expand_one(Expansion *self, const char *dollar, int line, const char **next, Err *err)
{
    if (dollar[1] == '$') {
        text_append(&self->text, "$", 1);
        *next = dollar + 2;
        return STATUS_OK;
    }
    const char *name = dollar + 2;
    size_t length = dollar[1] == '{' ? name_length(name) : 0;
    if (length == 0 || name[length] != '}')
        return err_set(err, STATUS_INPUT,
                       "%s:%d: '$' starts neither ${name} nor $$, which stands for one '$'",
                       self->path, line);
    for (size_t i = 0; i < self->n; i++) {
        const TmplValue *value = &self->values[i];
        if (strlen(value->name) == length && memcmp(value->name, name, length) == 0) {
            text_puts(&self->text, value->text);
            self->used[i] = true;
            *next = name + length + 1;
            return STATUS_OK;
        }
    }
    return err_set(err, STATUS_INPUT, "%s:%d: ${%.*s} is not a value this template is given",
                   self->path, line, (int)length, name);
}

static Status expand_all(Expansion *self, const char *source, Err *err)
{
    int line = 1;
    for (const char *at = source; *at;) {
        size_t plain = strcspn(at, "$");
        text_append(&self->text, at, plain);
        for (size_t i = 0; i < plain; i++)
            line += at[i] == '\n';
        at += plain;
        if (*at)
            TRY(expand_one(self, at, line, &at, err));
    }
    for (size_t i = 0; i < self->n; i++)
        if (!self->used[i])
            return err_set(err, STATUS_INPUT, "%s: the template never uses ${%s}", self->path,
                           self->values[i].name);
    return text_check(&self->text, err);
}

Status tmpl_load(Tmpl *tmpl, const char *path, Err *err)
{
    static const FileForm form = {.name = "a template", .most_bytes = 1e7, .is_text = true};
    Tmpl loaded = {0};
    size_t size = 0;
    Status status = file_read(path, &form, &loaded.source, &size, err);
    if (status == STATUS_OK)
        status = mem_strdup(&loaded.path, path, err);
    if (status == STATUS_OK)
        *tmpl = loaded;
    else
        tmpl_release(&loaded);
    return status;
}

void tmpl_release(Tmpl *tmpl)
{
    free(tmpl->path);
    free(tmpl->source);
    *tmpl = (Tmpl){0};
}

Status tmpl_apply(const Tmpl *tmpl, const TmplValue *values, size_t n, Text *out, Err *err)
{
    Expansion self = {.path = tmpl->path, .values = values, .n = n};
    Status status = mem_calloc(&self.used, n, sizeof *self.used, "template values", err);
    if (status == STATUS_OK)
        status = expand_all(&self, tmpl->source, err);
    if (status == STATUS_OK) {
        text_add(out, &self.text);
        status = text_check(out, err);
    }
    text_release(&self.text);
    free(self.used);
    return status;
}

Status tmpl_expand(const char *path, const TmplValue *values, size_t n, Text *out, Err *err)
{
    Tmpl tmpl;
    TRY(tmpl_load(&tmpl, path, err));
    Status status = tmpl_apply(&tmpl, values, n, out, err);
    tmpl_release(&tmpl);
    return status;
}
