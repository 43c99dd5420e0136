/* Names and texts stand in arrays of their own because a value's text may still grow when the next
 * one is added; the pointers to the characters are taken last. */
#include "emit/values.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

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

void add_file(Values *values, const char *file)
{
    const char *dot = strrchr(file, '.');
    Text stem = TEXT_INIT;
    text_append(&stem, file, dot ? (size_t)(dot - file) : strlen(file));
    text_put_line(add_value(values, "file"), file);
    text_put_line(add_value(values, "stem"), text_chars(&stem));
    text_release(&stem);
}

void add_about(Values *values, const EmitParams *params, Box box, Vec3 origin)
{
    text_put_line(add_value(values, "description"), params->description);
    text_puts(add_value(values, "generator"), params->generator);
    text_puts(add_value(values, "command"), params->command);
    Text *extent = add_value(values, "extent");
    text_printf(extent, "%.4g to %.4g, %.4g to %.4g, %.4g to %.4g mm", box.low.x, box.high.x,
                box.low.y, box.high.y, box.low.z, box.high.z);
    if (origin.x != 0 || origin.y != 0 || origin.z != 0)
        text_printf(extent, ", about <%.15g,%.15g,%.15g> of the tree", origin.x, origin.y,
                    origin.z);
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
