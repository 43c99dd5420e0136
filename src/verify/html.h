/* Pages from text: numbers for people, and the templates of a page; private to the
 * room verify. */
#ifndef CORCAST_VERIFY_HTML_H
#define CORCAST_VERIFY_HTML_H

#include "base/base.h"
#include <stdbool.h>

/* Appends a number for people, to three digits but for counts, and its unit, "level" of 1. */
void text_rounded(Text *out, double value, const char *unit);

/* What fills a template in: a text for each of its names. Begin with {0}. */
typedef struct HtmlParts {
    struct {
        const char *name; /* borrowed */
        bool markup;      /* put in as it stands; else escaped */
        Text text;
    } parts[48];
    size_t n;
} HtmlParts;

/* A new, empty part for the caller to fill with text, or with markup. Borrowed. */
Text *html_text(HtmlParts *self, const char *name);
Text *html_markup(HtmlParts *self, const char *name);
void html_release(HtmlParts *self);
/* Appends the template `file` of the folder `templates`, filled in, and releases the parts, on
 * failure, too. STATUS_INPUT as tmpl_apply. */
MUST_CHECK Status html_put(HtmlParts *self, const char *templates, const char *file, Text *out,
                           Err *err);

#endif
