/* Appends the parts of POV-Ray's texts that several writers need: paints, lists, linear functions
 * and matrices.
 *
 * Numbers have the fewest digits that read back to the same double or float. Expressions have the
 * form that POV-Ray parses fastest: no blanks and no terms that are 0. */
#include "emit/povray_text.h"

#include "emit/puttext.h"

/* Appends a value with few digits. Values are used only by textures that a user writes. */
static void put_value(Text *text, double value)
{
    if (isfinite(value))
        text_printf(text, "%.6g", value);
    else
        text_puts(text, "Value_None");
}

void put_paint(Text *text, const EmitParams *params, uint32_t segment)
{
    const Appearance *appearance = &params->scene->appearance;
    put_text(text, "%u,%d,", params->scene->geometry.ids[segment],
             params->anatomy ? params->anatomy->order[segment] : 0);
    if (!appearance->colors) {
        text_puts(text, "0,0");
    } else if (appearance->n_frames > 0) {
        put_text(text, "Frame_Values[%u],Frame_Colors[%u]", segment, segment);
    } else {
        put_value(text, appearance->values[segment]);
        put_text(text, ",<%c>", appearance->colors[segment]);
    }
}

static void put_list_end(Text *text, size_t i, size_t n)
{
    enum { A_LINE = 8 }; /* items */
    text_puts(text, i + 1 == n ? " }\n" : i % A_LINE == A_LINE - 1 ? ",\n" : ",");
}

void put_frame(Text *text, const Appearance *frame)
{
    size_t n = frame->n_segments;
    text_printf(text, "#declare Frame_Values = array[%zu] { ", n);
    for (size_t i = 0; i < n; i++) {
        put_value(text, frame->values[i]);
        put_list_end(text, i, n);
    }
    text_printf(text, "#declare Frame_Colors = array[%zu] { ", n);
    for (size_t i = 0; i < n; i++) {
        put_text(text, "<%c>", frame->colors[i]);
        put_list_end(text, i, n);
    }
    if (!frame->radius_factors)
        return;
    text_printf(text, "#declare Frame_Widths = array[%zu] { ", n);
    for (size_t i = 0; i < n; i++) {
        put_text(text, "%n", frame->radius_factors[i]);
        put_list_end(text, i, n);
    }
}

void put_linear(Text *text, const Linear *linear)
{
    static const char *const factors[] = {"x*", "y*", "z*", ""};
    bool first = true;
    for (int i = 0; i < 4; i++) {
        double k = linear->k[i];
        if (k == 0)
            continue;
        text_puts(text, k < 0 ? "-" : first ? "" : "+");
        text_puts(text, factors[i]);
        text_number(text, fabs(k));
        first = false;
    }
}

void put_matrix_arrays(Text *text, size_t n)
{
    text_printf(text, "#declare Vs=array[%zu]\n#declare Ve=array[%zu]\n", n, n);
}

Status put_matrix(Text *text, const Tmpl *matrix, char which, uint32_t number,
                  const Linear *const columns[3], Err *err)
{
    Text name = TEXT_INIT, numbers = {.digits = text->digits};
    text_printf(&name, "V%c[%u]", which, number);
    for (int i = 0; i < 12; i++) {
        text_puts(&numbers, i ? "," : "");
        text_number(&numbers, columns[i % 3]->k[i / 3] + 0);
    }
    const TmplValue values[] = {{"name", text_chars(&name)}, {"numbers", text_chars(&numbers)}};
    Status status = tmpl_apply(matrix, values, 2, text, err);
    text_release(&name);
    text_release(&numbers);
    return status;
}

void put_column(Text *text, char which, uint32_t number, const char *point, char column)
{
    text_printf(text, "V%c[%u](%s).%c", which, number, point, column);
}
