/* The template is expanded twice. The first pass writes nothing and finds all errors, so that a
 * wrong template leaves the caller's text unchanged. There are few values, so a linear search finds
 * them. */
#include "tmpl/tmpl.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct TmplExpansion {
    const char *path;
    const TmplValue *values;
    const TmplPart *parts;
    size_t n, n_parts;
    bool *used; /* owned; one for each value, then one for each part */
    Text *out;  /* NULL in the first pass */
} TmplExpansion;

static bool is_name_char(char c, bool first)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           (!first && c >= '0' && c <= '9');
}

/* Returns the length of the name at the start of `chars`; 0 if there is none. */
static size_t name_length(const char *chars)
{
    size_t length = 0;
    while (is_name_char(chars[length], length == 0))
        length++;
    return length;
}

static bool is_name(const char *name, const char *chars, size_t length)
{
    return strlen(name) == length && memcmp(name, chars, length) == 0;
}

/* Appends the value or part with this name. *found becomes false if there is none. */
static Status put_named(TmplExpansion *self, const char *name, size_t length, bool *found, Err *err)
{
    *found = true;
    for (size_t i = 0; i < self->n; i++) {
        if (!is_name(self->values[i].name, name, length))
            continue;
        self->used[i] = true;
        if (self->out)
            text_puts(self->out, self->values[i].text);
        return STATUS_OK;
    }
    for (size_t i = 0; i < self->n_parts; i++) {
        const TmplPart *part = &self->parts[i];
        if (!is_name(part->name, name, length))
            continue;
        self->used[self->n + i] = true;
        return self->out ? part->put(self->out, part->context, err) : STATUS_OK;
    }
    *found = false;
    return STATUS_OK;
}

/* Appends the replacement of the '$' at `dollar`. *next becomes the first character after it. */
static Status expand_one(TmplExpansion *self, const char *dollar, int line, const char **next,
                         Err *err)
{
    if (dollar[1] == '$') {
        if (self->out)
            text_append(self->out, "$", 1);
        *next = dollar + 2;
        return STATUS_OK;
    }
    const char *name = dollar + 2;
    size_t length = dollar[1] == '{' ? name_length(name) : 0;
    if (length == 0 || name[length] != '}')
        return err_set(err, STATUS_INPUT,
                       "%s:%d: '$' must begin ${name} or $$, which gives one '$'", self->path,
                       line);
    bool found;
    TRY(put_named(self, name, length, &found, err));
    *next = name + length + 1;
    if (found)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s:%d: no value is given for ${%.*s}", self->path, line,
                   (int)length, name);
}

static Status expand_all(TmplExpansion *self, const char *source, Err *err)
{
    int line = 1;
    for (const char *at = source; *at;) {
        size_t plain = strcspn(at, "$");
        if (self->out)
            text_append(self->out, at, plain);
        for (size_t i = 0; i < plain; i++)
            line += at[i] == '\n';
        at += plain;
        if (*at)
            TRY(expand_one(self, at, line, &at, err));
    }
    return STATUS_OK;
}

static Status check_used(const TmplExpansion *self, Err *err)
{
    for (size_t i = 0; i < self->n + self->n_parts; i++)
        if (!self->used[i])
            return err_set(err, STATUS_INPUT, "%s: the template never uses ${%s}", self->path,
                           i < self->n ? self->values[i].name : self->parts[i - self->n].name);
    return STATUS_OK;
}

Status tmpl_load(Tmpl *tmpl, const char *path, Err *err)
{
    static const FileForm form = {.name = "a template", .most_bytes = 1e7, .is_text = true};
    Tmpl loaded = {0};
    size_t size = 0;
    Status status;
    TRY_GOTO(file_read(path, &form, &loaded.source, &size, err));
    TRY_GOTO(mem_strdup(&loaded.path, path, err));
    *tmpl = loaded;
    return STATUS_OK;
done:
    tmpl_release(&loaded);
    return status;
}

void tmpl_release(Tmpl *tmpl)
{
    free(tmpl->path);
    free(tmpl->source);
    *tmpl = (Tmpl){0};
}

Status tmpl_stream(const Tmpl *tmpl, const TmplValue *values, size_t n, const TmplPart *parts,
                   size_t n_parts, Text *out, Err *err)
{
    TmplExpansion self = {
        .path = tmpl->path, .values = values, .parts = parts, .n = n, .n_parts = n_parts};
    Status status;
    TRY_GOTO(mem_calloc(&self.used, n + n_parts, sizeof *self.used, "template values", err));
    TRY_GOTO(expand_all(&self, tmpl->source, err));
    TRY_GOTO(check_used(&self, err));
    self.out = out;
    TRY_GOTO(expand_all(&self, tmpl->source, err));
    status = text_check(out, err);
done:
    free(self.used);
    return status;
}

Status tmpl_apply(const Tmpl *tmpl, const TmplValue *values, size_t n, Text *out, Err *err)
{
    return tmpl_stream(tmpl, values, n, NULL, 0, out, err);
}

Status tmpl_expand(const char *path, const TmplValue *values, size_t n, Text *out, Err *err)
{
    Tmpl tmpl;
    TRY(tmpl_load(&tmpl, path, err));
    Status status = tmpl_apply(&tmpl, values, n, out, err);
    tmpl_release(&tmpl);
    return status;
}
