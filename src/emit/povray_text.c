/* Numbers are printed with the digits that read back to the same double, or float, and in the form
 * that takes POV-Ray's parser least time: no blanks, no zeros that change nothing. */
#include "emit/povray_text.h"

void put_vector(Text *text, Vec3 v)
{
    /* Adding 0 turns -0 into 0. */
    text_puts(text, "<");
    text_number(text, v.x + 0);
    text_puts(text, ",");
    text_number(text, v.y + 0);
    text_puts(text, ",");
    text_number(text, v.z + 0);
    text_puts(text, ">");
}

void put_color(Text *text, Rgb color)
{
    char r[NUMBER_TEXT_SIZE], g[NUMBER_TEXT_SIZE], b[NUMBER_TEXT_SIZE];
    text_printf(text, "<%s,%s,%s>", number_text_float(color.r, r), number_text_float(color.g, g),
                number_text_float(color.b, b));
}

/* A value in few digits, which are for the artist's own textures. */
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
    text_printf(text, "%u,%d,", params->scene->geometry.ids[segment],
                params->anatomy ? params->anatomy->order[segment] : 0);
    if (!appearance->colors) {
        text_puts(text, "0,0");
        return;
    }
    put_value(text, appearance->values[segment]);
    text_puts(text, ",");
    put_color(text, appearance->colors[segment]);
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
