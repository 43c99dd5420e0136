/* Fills templates of HTML and SVG. A template holds all markup of its page. Inserted texts are
 * escaped here, in one place, unless the caller states that they are markup. */
#include "tmpl/tmpl.h"

#include <assert.h>

Text *markup_text(Markup *self, const char *name)
{
    assert(self->n < sizeof self->parts / sizeof *self->parts);
    self->parts[self->n].name = name;
    self->parts[self->n].markup = false;
    return &self->parts[self->n++].text;
}

Text *markup_raw(Markup *self, const char *name)
{
    Text *text = markup_text(self, name);
    self->parts[self->n - 1].markup = true;
    return text;
}

void markup_release(Markup *self)
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

Status markup_stream(Markup *self, const char *templates, const char *file, const TmplPart *parts,
                     size_t n_parts, Text *out, Err *err)
{
    TmplValue values[sizeof self->parts / sizeof *self->parts];
    Tmpl tmpl = {0};
    Status status;
    for (size_t i = 0; i < self->n; i++) {
        if (!self->parts[i].markup)
            escape(&self->parts[i].text);
        values[i] = (TmplValue){self->parts[i].name, text_chars(&self->parts[i].text)};
    }
    TRY_GOTO(tmpl_load(&tmpl, templates, file, err));
    status = tmpl_stream(&tmpl, values, self->n, parts, n_parts, out, err);
done:
    tmpl_release(&tmpl);
    markup_release(self);
    return status;
}

Status markup_put(Markup *self, const char *templates, const char *file, Text *out, Err *err)
{
    return markup_stream(self, templates, file, NULL, 0, out, err);
}
