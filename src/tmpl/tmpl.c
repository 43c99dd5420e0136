/* Expands templates: ${name} stands for a value or a part, and ${?name} ... ${/name} is a section
 * that is shown only if the value is set (${!name}: if it is not).
 *
 * The template is expanded twice. The first pass writes nothing and finds all errors, so that a
 * wrong template leaves the caller's text unchanged. There are few values, so a linear search finds
 * them. */
#include "tmpl/tmpl.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The largest number of sections within each other. Templates use at most two. */
enum { MAX_SECTIONS = 4 };

/* A section that has begun. */
typedef struct TmplSection {
    const char *name; /* borrowed from the template; `length` characters */
    size_t length;
    bool shown; /* it and the sections around it are not left out */
} TmplSection;

typedef struct TmplExpansion {
    const char *path;
    const TmplValue *values;
    const TmplPart *parts;
    size_t n, n_parts;
    bool *used; /* owned; one for each value, then one for each part */
    Text *out;  /* NULL in the first pass */
    TmplSection section[MAX_SECTIONS];
    int n_sections;
} TmplExpansion;

/* Returns true outside of the sections that are left out. */
static bool is_shown(const TmplExpansion *self)
{
    return self->n_sections == 0 || self->section[self->n_sections - 1].shown;
}

/* Returns where the next characters go; NULL if they go nowhere. */
static Text *shown_out(const TmplExpansion *self)
{
    return is_shown(self) ? self->out : NULL;
}

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

/* Returns the value with this name, which then counts as used; NULL if there is none. */
static const TmplValue *use_value(TmplExpansion *self, const char *name, size_t length)
{
    for (size_t i = 0; i < self->n; i++)
        if (is_name(self->values[i].name, name, length)) {
            self->used[i] = true;
            return &self->values[i];
        }
    return NULL;
}

/* Appends the value or part with this name. *found becomes false if there is none. */
static Status put_named(TmplExpansion *self, const char *name, size_t length, bool *found, Err *err)
{
    const TmplValue *value = use_value(self, name, length);
    Text *out = shown_out(self);
    *found = true;
    if (value) {
        if (out)
            text_puts(out, value->text);
        return STATUS_OK;
    }
    for (size_t i = 0; i < self->n_parts; i++) {
        const TmplPart *part = &self->parts[i];
        if (!is_name(part->name, name, length))
            continue;
        self->used[self->n + i] = true;
        return out ? part->put(out, part->context, err) : STATUS_OK;
    }
    *found = false;
    return STATUS_OK;
}

/* Begins the section that is shown if the value is set, for '?', or is not, for '!'. */
static Status begin_section(TmplExpansion *self, char mark, const char *name, size_t length,
                            bool *found, Err *err)
{
    const TmplValue *value = use_value(self, name, length);
    *found = value != NULL;
    if (self->n_sections == MAX_SECTIONS)
        return err_set(err, STATUS_INPUT, "%s: more than %d sections are within each other",
                       self->path, MAX_SECTIONS);
    if (value && !value->text)
        return mem_out_of("for the value of a section of", self->path, err);
    bool is_set = value && *value->text && strcmp(value->text, "0") != 0;
    const bool shown = is_shown(self) && is_set == (mark == '?');
    self->section[self->n_sections++] = (TmplSection){name, length, shown};
    return STATUS_OK;
}

/* Ends the last section that has begun. */
static Status end_section(TmplExpansion *self, const char *name, size_t length, int line, Err *err)
{
    const TmplSection *last = self->n_sections ? &self->section[self->n_sections - 1] : NULL;
    if (!last || last->length != length || memcmp(last->name, name, length) != 0)
        return err_set(err, STATUS_INPUT, "%s:%d: ${/%.*s} ends no section", self->path, line,
                       (int)length, name);
    self->n_sections--;
    return STATUS_OK;
}

/* Appends what ${name} stands for, or begins or ends the section of the name, by `mark`. */
static Status expand_name(TmplExpansion *self, char mark, const char *name, size_t length, int line,
                          Err *err)
{
    bool found = true;
    if (mark == '/')
        return end_section(self, name, length, line, err);
    if (mark)
        TRY(begin_section(self, mark, name, length, &found, err));
    else
        TRY(put_named(self, name, length, &found, err));
    if (found)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT, "%s:%d: there is no value for ${%.*s}", self->path, line,
                   (int)length, name);
}

/* Appends the replacement of the '$' at `dollar`. *next becomes the first character after it. */
static Status expand_one(TmplExpansion *self, const char *dollar, int line, const char **next,
                         Err *err)
{
    if (dollar[1] == '$') {
        if (shown_out(self))
            text_append(self->out, "$", 1);
        *next = dollar + 2;
        return STATUS_OK;
    }
    const char *name = dollar + 2;
    char mark = dollar[1] == '{' && *name && strchr("?!/", *name) ? *name++ : '\0';
    size_t length = dollar[1] == '{' ? name_length(name) : 0;
    if (length == 0 || name[length] != '}')
        return err_set(err, STATUS_INPUT,
                       "%s:%d: '$' must begin ${name} or $$, which gives one '$'", self->path,
                       line);
    *next = name + length + 1;
    return expand_name(self, mark, name, length, line, err);
}

/* Returns true if the '$' at `dollar` begins or ends a section. */
static bool is_section_mark(const char *dollar)
{
    return dollar[1] == '{' && dollar[2] && strchr("?!/", dollar[2]);
}

static Status expand_all(TmplExpansion *self, const char *source, Err *err)
{
    int line = 1;
    for (const char *at = source; *at;) {
        size_t plain = strcspn(at, "$");
        if (shown_out(self))
            text_append(self->out, at, plain);
        for (size_t i = 0; i < plain; i++)
            line += at[i] == '\n';
        at += plain;
        if (!*at)
            break;
        const bool drops_line_end = is_section_mark(at);
        TRY(expand_one(self, at, line, &at, err));
        if (drops_line_end && *at == '\n') {
            at++;
            line++;
        }
    }
    if (self->n_sections == 0)
        return STATUS_OK;
    const TmplSection *open = &self->section[self->n_sections - 1];
    return err_set(err, STATUS_INPUT, "%s: the section of %.*s has no end", self->path,
                   (int)open->length, open->name);
}

static Status check_used(const TmplExpansion *self, Err *err)
{
    for (size_t i = 0; i < self->n + self->n_parts; i++)
        if (!self->used[i])
            return err_set(err, STATUS_INPUT, "%s: the template never uses ${%s}", self->path,
                           i < self->n ? self->values[i].name : self->parts[i - self->n].name);
    return STATUS_OK;
}

Status tmpl_load(Tmpl *tmpl, const char *templates, const char *file, Err *err)
{
    static const FileForm form = {.name = "a template", .most_bytes = 1e7, .is_text = true};
    Tmpl loaded = {0};
    size_t size = 0;
    Status status;
    TRY_GOTO(file_join(templates, file, &loaded.path, err));
    TRY_GOTO(file_read(loaded.path, &form, &loaded.source, &size, err));
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
