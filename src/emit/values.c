/* Collects the values that replace the keys of a template, and expands templates.
 *
 * The templates are programs in languages that have their own rules of quoting. The texts are
 * therefore inserted unchanged [markup_raw]. */
#include "emit/values.h"

#include <assert.h>
#include <string.h>

Text *add_value(Values *values, const char *name)
{
    Text *text = markup_raw(&values->texts, name);
    text->digits = values->digits;
    return text;
}

void add_number(Values *values, const char *name, double value)
{
    text_number(add_value(values, name), value);
}

void add_float(Values *values, const char *name, float value)
{
    put_text(add_value(values, name), "%f", (double)value);
}

void add_count(Values *values, const char *name, size_t count)
{
    text_printf(add_value(values, name), "%zu", count);
}

void add_flag(Values *values, const char *name, bool value)
{
    text_puts(add_value(values, name), value ? "1" : "0");
}

void add_quoted(Values *values, const char *name, const char *chars)
{
    Text *text = add_value(values, name), line = TEXT_INIT;
    text_put_line(&line, chars);
    const char *at = text_chars(&line);
    text_puts(text, at ? "\"" : NULL);
    for (; at && *at; at++) {
        text_puts(text, *at == '"' || *at == '\\' ? "\\" : "");
        text_append(text, at, 1);
    }
    text_puts(text, "\"");
    text_release(&line);
}

void add_word(Values *values, const char *name, const char *file, const char *quotes)
{
    Text clean = TEXT_INIT, quoted = TEXT_INIT;
    text_put_line(&clean, file);
    const char *chars = text_chars(&clean);
    bool plain = chars && !strpbrk(chars, " ;=#'&");
    text_puts(&quoted, plain ? "" : quotes);
    text_puts(&quoted, chars);
    text_puts(&quoted, plain ? "" : quotes);
    text_put_shell_word(add_value(values, name), text_chars(&quoted));
    text_release(&clean);
    text_release(&quoted);
}

void add_file(Values *values, const char *file, const char *extension, const char *quotes)
{
    const char *dot = strrchr(file, '.');
    Text made = TEXT_INIT;
    text_append(&made, file, dot ? (size_t)(dot - file) : strlen(file));
    text_puts(&made, extension);
    text_put_line(add_value(values, "file"), file);
    add_word(values, "input", file, quotes);
    add_word(values, "output", text_chars(&made), quotes);
    text_release(&made);
}

void add_source(Values *values, const EmitParams *params)
{
    text_put_line(add_value(values, "description"), params->description);
    text_puts(add_value(values, "generator"), params->generator);
    text_puts(add_value(values, "command"), params->command);
}

void add_about(Values *values, const EmitParams *params, Box box, Vec3 origin)
{
    add_source(values, params);
    Text *extent = add_value(values, "extent");
    text_printf(extent, "%.4g to %.4g, %.4g to %.4g, %.4g to %.4g mm", box.low.x, box.high.x,
                box.low.y, box.high.y, box.low.z, box.high.z);
    if (origin.x != 0 || origin.y != 0 || origin.z != 0)
        text_printf(extent, ", about <%.15g,%.15g,%.15g> of the tree", origin.x, origin.y,
                    origin.z);
}

void add_finish(Values *values, const Finish *finish)
{
    add_float(values, "ambient", finish->ambient);
    add_float(values, "diffuse", finish->diffuse);
    add_float(values, "brilliance", finish->brilliance);
    add_float(values, "phong", finish->phong);
    add_float(values, "phong_size", finish->phong_size);
    add_float(values, "specular", finish->specular);
    add_float(values, "roughness", finish->roughness);
}

void add_part(Values *values, const char *name, TmplPut *put, const void *context)
{
    assert(values->n_parts < PARTS_MAX);
    values->part[values->n_parts++] = (TmplPart){name, put, context};
}

static Status put_items(Text *out, const void *context, Err *err)
{
    const ValueList *list = context;
    for (size_t i = 0; i < list->n; i++)
        list->put(out, list->context, i);
    return text_check(out, err);
}

void add_list(Values *values, const char *name, PutItem *put, const void *context, size_t n)
{
    ValueList *list = &values->list[values->n_parts];
    add_part(values, name, put_items, list);
    *list = (ValueList){put, context, n};
}

Status load_templates(Tmpl *templates, const EmitParams *params, const char *const *paths, size_t n,
                      Err *err)
{
    for (size_t i = 0; i < n; i++)
        TRY(tmpl_load(&templates[i], params->templates, paths[i], err));
    return STATUS_OK;
}

void release_templates(Tmpl *templates, size_t n)
{
    for (size_t i = 0; i < n; i++)
        tmpl_release(&templates[i]);
}

Status values_expand(Values *values, const EmitParams *params, const char *name, Text *out,
                     Err *err)
{
    return markup_stream(&values->texts, params->templates, name, values->part, values->n_parts,
                         out, err);
}

Status put_template(const EmitParams *params, const char *name, Text *out, Err *err)
{
    Values none = {0};
    return values_expand(&none, params, name, out, err);
}
