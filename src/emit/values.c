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

/* `name` in `quotes`, which another program reads, as a word of a shell; one line. */
static void put_word(Text *text, const char *name, const char *quotes)
{
    Text clean = TEXT_INIT, quoted = TEXT_INIT;
    text_put_line(&clean, name);
    const char *chars = text_chars(&clean);
    bool plain = chars && !strpbrk(chars, " ;=#'&");
    text_puts(&quoted, plain ? "" : quotes);
    text_puts(&quoted, chars);
    text_puts(&quoted, plain ? "" : quotes);
    text_put_shell_word(text, text_chars(&quoted));
    text_release(&clean);
    text_release(&quoted);
}

void add_word(Values *values, const char *value, const char *name, const char *quotes)
{
    put_word(add_value(values, value), name, quotes);
}

void add_file(Values *values, const char *file, const char *result, const char *quotes)
{
    const char *dot = strrchr(file, '.');
    Text made = TEXT_INIT;
    text_append(&made, file, dot ? (size_t)(dot - file) : strlen(file));
    text_puts(&made, result);
    text_put_line(add_value(values, "file"), file);
    add_word(values, "input", file, quotes);
    add_word(values, "output", text_chars(&made), quotes);
    text_release(&made);
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
