/* The public header of the module tmpl: strict expansion of text templates.
 *
 * A template is a text file with names in the form ${name}. Expansion replaces each name by a
 * value. It is strict: a name without a value is an error, and so is a value whose name is not in
 * the template. Templates and the program therefore always agree. Markup expands templates of HTML
 * and SVG, and escapes plain text.
 *
 * A section ${?name} ... ${/name} is left out if the value of `name` is "" or "0". A section
 * ${!name} ... ${/name} is left out if the value is anything else. Sections may be nested. A line
 * end directly after one of these marks is always removed.
 *
 *     Tmpl tmpl;                        (out is a Text)
 *     const TmplValue values[] = {{"title", "A tree"}};
 *     TRY(tmpl_load(&tmpl, "templates", "page/page.html", err));
 *     Status status = tmpl_apply(&tmpl, values, 1, &out, err);
 *     tmpl_release(&tmpl); */
#ifndef CORCAST_TMPL_TMPL_H
#define CORCAST_TMPL_TMPL_H

#include "base/base.h"
#include <stdbool.h>

/* The replacement of ${name}. Both members are borrowed and zero-terminated. */
typedef struct TmplValue {
    const char *name; /* letters, digits and '_', not starting with a digit */
    const char *text; /* inserted unchanged: it is not expanded again */
} TmplValue;

/* A template that was read from a file. It can be expanded any number of times. */
typedef struct Tmpl {
    char *path, *source; /* owned */
} Tmpl;

/* Reads the template `file` of the folder `templates`. Release *tmpl with tmpl_release. Errors:
 * STATUS_INPUT, naming the file, if the file is missing or is not text; STATUS_IO, STATUS_MEMORY.
 */
MUST_CHECK Status tmpl_load(Tmpl *tmpl, const char *templates, const char *file, Err *err);
/* Frees the template and zeroes *tmpl. A zeroed Tmpl is allowed. */
void tmpl_release(Tmpl *tmpl);

/* Appends the expanded template to `out`. Replaces every ${name} by the text of that name, and
 * every $$ by one $.
 *
 * values   n values, in any order.
 * Errors   STATUS_INPUT, naming the file and the name, for any other $, for a name that has no
 *          value, for a value whose name is nowhere in the template, and for a section without
 *          beginning or end. `out` is then unchanged. STATUS_MEMORY. */
MUST_CHECK Status tmpl_apply(const Tmpl *tmpl, const TmplValue *values, size_t n, Text *out,
                             Err *err);

/* Appends a text to `out`. Any status other than STATUS_OK ends the expansion of the template. */
typedef Status TmplPut(Text *out, const void *context, Err *err);

/* The replacement of ${name} by a text that a function appends. For texts that may not fit into
 * memory. */
typedef struct TmplPart {
    const char *name; /* borrowed; letters, digits and '_', not starting with a digit */
    TmplPut *put;
    const void *context; /* borrowed; passed to `put` */
} TmplPart;

/* Appends the template to `out`, as tmpl_apply does, with parts in addition to values. `out` may
 * write to a stream. Errors: those of tmpl_apply, and any status that a part returns. If a part
 * fails, `out` has the text before that part. */
MUST_CHECK Status tmpl_stream(const Tmpl *tmpl, const TmplValue *values, size_t n,
                              const TmplPart *parts, size_t n_parts, Text *out, Err *err);

/* ---- values that are collected one by one ---------------------------------------------------- */

/* The values of a template: a text for each name. The capacity of 48 suffices for the largest
 * template; a 49th value fails an assertion in markup_text. Initialise with {0}; release with
 * markup_release, which markup_put and markup_stream call. */
typedef struct Markup {
    struct {
        const char *name; /* borrowed */
        bool markup;      /* true: the text is inserted unchanged; false: it is escaped */
        Text text;
    } parts[48];
    size_t n;
} Markup;

/* Adds an empty value for `name`, which is borrowed, and returns the value's Text, to which the
 * caller appends plain text. Expansion escapes the text for HTML and SVG. The Text is owned by
 * `self`; if memory runs out, it records this, and markup_put reports it. */
Text *markup_text(Markup *self, const char *name);
/* Adds an empty value as markup_text does, for markup or text of another language. Expansion
 * inserts the text unchanged. */
Text *markup_raw(Markup *self, const char *name);
/* Frees all texts and removes all values. */
void markup_release(Markup *self);
/* Appends the expanded template `file` of the folder `templates` to `out`. Releases the values,
 * also on failure. Errors: those of tmpl_load and tmpl_apply; STATUS_MEMORY if a value ran out of
 * memory. */
MUST_CHECK Status markup_put(Markup *self, const char *templates, const char *file, Text *out,
                             Err *err);
/* Appends the expanded template as markup_put does, with parts in addition to values. `out` may
 * write to a stream. Errors and the content of `out` after them: those of tmpl_stream. */
MUST_CHECK Status markup_stream(Markup *self, const char *templates, const char *file,
                                const TmplPart *parts, size_t n_parts, Text *out, Err *err);

#endif
