/* Names and texts stand in arrays of their own because a value's text may still grow when the next
 * one is added; the pointers to the characters are taken last. */
#include "emit/values.h"

#include <assert.h>
#include <stdlib.h>

Text *add_value(Values *values, const char *name)
{
    assert(values->n < VALUES_MAX);
    Text *text = &values->text[values->n];
    values->value[values->n++].name = name;
    return text;
}

void add_number(Values *values, const char *name, double value)
{
    text_number(add_value(values, name), value);
}

void add_float(Values *values, const char *name, float value)
{
    char number[NUMBER_TEXT_SIZE];
    text_puts(add_value(values, name), number_text_float(value, number));
}

void add_flag(Values *values, const char *name, bool value)
{
    text_puts(add_value(values, name), value ? "1" : "0");
}

void add_part(Values *values, const char *name, Status (*put)(Text *, void *, Err *), void *context)
{
    assert(values->n_parts < PARTS_MAX);
    values->part[values->n_parts++] = (TmplPart){name, put, context};
}

Status load_template(Tmpl *template, const EmitParams *params, const char *name, Err *err)
{
    char *path = NULL;
    TRY(file_join(params->templates, name, &path, err));
    Status status = tmpl_load(template, path, err);
    free(path);
    return status;
}

Status values_expand(Values *values, const EmitParams *params, const char *name, Text *out,
                     Err *err)
{
    Tmpl template = {0};
    Status status = load_template(&template, params, name, err);
    for (size_t i = 0; i < values->n; i++)
        values->value[i].text = text_chars(&values->text[i]);
    if (status == STATUS_OK)
        status = tmpl_stream(&template, values->value, values->n, values->part, values->n_parts,
                             out, err);
    tmpl_release(&template);
    for (size_t i = 0; i < values->n; i++)
        text_release(&values->text[i]);
    return status;
}
