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

void put_paint(Text *text, const Scene *scene, uint32_t segment)
{
    text_printf(text, "%u,", scene->geometry.ids[segment]);
    if (scene->appearance.colors)
        put_color(text, scene->appearance.colors[segment]);
    else
        text_puts(text, "Vessel_Color");
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
