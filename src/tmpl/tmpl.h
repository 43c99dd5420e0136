/* The public header of the module tmpl: strict expansion of text templates. */
#ifndef CORCAST_TMPL_TMPL_H
#define CORCAST_TMPL_TMPL_H

#include "base/base.h"
#include <stdbool.h>

/* The replacement of ${name}. Both members are borrowed and zero-terminated. */
typedef struct TmplValue {
    const char *name; /* letters, digits and '_', not starting with a digit */
    const char *text; /* inserted unchanged: it is not expanded again */
} TmplValue;

/* A template that was read from a file and can be expanded many times. */
typedef struct Tmpl {
    char *path, *source; /* owned */
} Tmpl;

/* Reads a template. Release it with tmpl_release. Errors: STATUS_INPUT if the file is missing or is
 * not text; STATUS_MEMORY. */
MUST_CHECK Status tmpl_load(Tmpl *tmpl, const char *path, Err *err);
void tmpl_release(Tmpl *tmpl);

/* Appends the template to `out`, with every ${name} replaced by the text of that name and every
 * $$ by one $.
 *
 * Errors   STATUS_INPUT, naming file, line and name, for any other $, for a name that `values`
 *          lacks, and for a value that the template does not use, so that a template and its caller
 *          always agree; STATUS_MEMORY. On failure `out` is unchanged. */
MUST_CHECK Status tmpl_apply(const Tmpl *tmpl, const TmplValue *values, size_t n, Text *out,
                             Err *err);

/* The replacement of ${name} by text that is appended while it is made, because it may be too long
 * for memory. */
typedef struct TmplPart {
    const char *name;
    Status (*put)(Text *out, void *context, Err *err);
    void *context;
} TmplPart;

/* As tmpl_apply, with parts beside the values, for a text that may have a stream. If a part fails,
 * `out` has the text before that part. */
MUST_CHECK Status tmpl_stream(const Tmpl *tmpl, const TmplValue *values, size_t n,
                              const TmplPart *parts, size_t n_parts, Text *out, Err *err);

/* Reads a template and expands it once, as tmpl_apply. */
MUST_CHECK Status tmpl_expand(const char *path, const TmplValue *values, size_t n, Text *out,
                              Err *err);

/* ---- pages of markup ------------------------------------------------------------------------- */

/* The values of a template of HTML or SVG: a text for each name. Initialise with {0}. */
typedef struct Markup {
    struct {
        const char *name; /* borrowed */
        bool markup;      /* inserted unchanged; else escaped */
        Text text;
    } parts[48];
    size_t n;
} Markup;

/* Add an empty value and return its text, which the caller fills with plain text, or with markup.
 * The text is borrowed. */
Text *markup_text(Markup *self, const char *name);
Text *markup_raw(Markup *self, const char *name);
void markup_release(Markup *self);
/* Appends the expanded template `file` of the folder `templates`. Releases the values, also on
 * failure. Errors as tmpl_apply. */
MUST_CHECK Status markup_put(Markup *self, const char *templates, const char *file, Text *out,
                             Err *err);
/* As markup_put, with parts beside the values, for a text that may have a stream. On failure `out`
 * is as tmpl_stream leaves it. */
MUST_CHECK Status markup_stream(Markup *self, const char *templates, const char *file,
                                const TmplPart *parts, size_t n_parts, Text *out, Err *err);

#endif
