/* The templates in templates/report hold all markup; what is put into them is escaped here, in one
 * place, unless the caller says that it is markup already. */
#include "verify/html.h"

#include "tmpl/tmpl.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void text_rounded(Text *out, double value, const char *unit)
{
    bool whole = (value == floor(value) && fabs(value) < 1e15) || fabs(value) >= 1000;
    size_t length = strlen(unit);
    if (isinf(value))
        text_puts(out, "∞");
    else if (whole)
        text_printf(out, "%.0f", value);
    else
        text_printf(out, "%.*g", fabs(value - 1) < 0.0005 ? 6 : 3, value); /* nearly 1 is not 1 */
    if (length == 0)
        return;
    if (value == 1 && unit[length - 1] == 's')
        length--;
    text_puts(out, " ");
    text_append(out, unit, length);
}

Text *html_text(HtmlParts *self, const char *name)
{
    assert(self->n < sizeof self->parts / sizeof *self->parts);
    self->parts[self->n].name = name;
    self->parts[self->n].markup = false;
    return &self->parts[self->n++].text;
}

Text *html_markup(HtmlParts *self, const char *name)
{
    Text *text = html_text(self, name);
    self->parts[self->n - 1].markup = true;
    return text;
}

void html_release(HtmlParts *self)
{
    for (size_t i = 0; i < self->n; i++)
        text_release(&self->parts[i].text);
    self->n = 0;
}

static void escape(Text *text)
{
    Text escaped = TEXT_INIT;
    text_escaped(&escaped, text_chars(text));
    text_release(text);
    *text = escaped;
}

Status html_put(HtmlParts *self, const char *templates, const char *file, Text *out, Err *err)
{
    TmplValue values[sizeof self->parts / sizeof *self->parts];
    char *path;
    for (size_t i = 0; i < self->n; i++) {
        if (!self->parts[i].markup)
            escape(&self->parts[i].text);
        values[i] = (TmplValue){self->parts[i].name, text_chars(&self->parts[i].text)};
    }
    Status status = file_join(templates, file, &path, err);
    if (status == STATUS_OK) {
        status = tmpl_expand(path, values, self->n, out, err);
        free(path);
    }
    html_release(self);
    return status;
}
