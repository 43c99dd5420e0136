/* The door of the room tmpl: strict expansion of text templates. */
#ifndef CORCAST_TMPL_TMPL_H
#define CORCAST_TMPL_TMPL_H

#include "base/base.h"
#include <stdbool.h>

/* What ${name} stands for. Both are borrowed and zero-terminated. */
typedef struct TmplValue {
    const char *name; /* letters, digits and '_', not starting with a digit */
    const char *text; /* put in as it stands: never expanded again */
} TmplValue;

/* A template read from a file, for expanding many times. */
typedef struct Tmpl {
    char *path, *source; /* owned */
} Tmpl;

/* STATUS_INPUT when the file is missing or no text. Release with tmpl_release. */
MUST_CHECK Status tmpl_load(Tmpl *tmpl, const char *path, Err *err);
void tmpl_release(Tmpl *tmpl);

/* Appends the template to `out`, with every ${name} replaced by the text of that name and every
 * $$ by one $. Any other $ is an error, and so are a name that `values` lacks and a value that the
 * template never uses, so that a template and its caller cannot drift apart. STATUS_INPUT names
 * file, line and name; `out` is unchanged on failure. */
MUST_CHECK Status tmpl_apply(const Tmpl *tmpl, const TmplValue *values, size_t n, Text *out,
                             Err *err);

/* What stands for ${name} and is appended as it is made, for what is too long to be held whole. */
typedef struct TmplPart {
    const char *name;
    Status (*put)(Text *out, void *context, Err *err);
    void *context;
} TmplPart;

/* As tmpl_apply, for a text that may have a stream, with parts beside the values. When a part fails
 * `out` holds what came before it; of all other failures it holds nothing. */
MUST_CHECK Status tmpl_stream(const Tmpl *tmpl, const TmplValue *values, size_t n,
                              const TmplPart *parts, size_t n_parts, Text *out, Err *err);

/* Loads, applies once and releases. */
MUST_CHECK Status tmpl_expand(const char *path, const TmplValue *values, size_t n, Text *out,
                              Err *err);

/* ---- pages of markup -------------------------------------------------------------------------
 */

/* What fills a template of HTML or SVG in: a text for each of its names. Begin with {0}. */
typedef struct Markup {
    struct {
        const char *name; /* borrowed */
        bool markup;      /* put in as it stands; else escaped */
        Text text;
    } parts[48];
    size_t n;
} Markup;

/* A new, empty part for the caller to fill with text, or with markup. Borrowed. */
Text *markup_text(Markup *self, const char *name);
Text *markup_raw(Markup *self, const char *name);
void markup_release(Markup *self);
/* Appends the template `file` of the folder `templates`, filled in, and releases the parts, on
 * failure, too. STATUS_INPUT as tmpl_apply. */
MUST_CHECK Status markup_put(Markup *self, const char *templates, const char *file, Text *out,
                             Err *err);
/* As markup_put, for a text that may have a stream, with parts that are appended as they are made.
 * On failure `out` is as tmpl_stream leaves it. */
MUST_CHECK Status markup_stream(Markup *self, const char *templates, const char *file,
                                const TmplPart *parts, size_t n_parts, Text *out, Err *err);

#endif
