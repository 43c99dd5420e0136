/* Writes the macros for colors that blend where vessels blend.
 *
 * Where colors blend, POV-Ray computes the mean position on the scale at a point, by functions that
 * povray_cells.c and povray_blob.c write, and maps the position to a color as colorscale_at does.
 * POV-Ray's own blending of the textures of a blob is not used: it weights colors by the strengths
 * of single components, including components with a negative strength. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

bool povray_has_several_paints(const PovrayGeometry *geometry)
{
    return geometry->params->ids || geometry->scene->appearance.colors;
}

bool povray_blends(const PovrayGeometry *geometry)
{
    const Scene *scene = geometry->scene;
    return scene->appearance.positions && model_has(scene->geometry.model, MODEL_FIELD);
}

void put_scale_position(Text *text, const ColorScale *scale)
{
    char low[NUMBER_TEXT_SIZE], width[NUMBER_TEXT_SIZE];
    const double *range = scale->range;
    number_text_rounded(range[0], text->digits, low);
    number_text_rounded(scale->log ? elementary_log(range[1]) - elementary_log(range[0])
                                   : range[1] - range[0],
                        text->digits, width);
    if (colorscale_selects_by_integer(scale))
        text_puts(text, "x");
    else if (!(range[1] > range[0]))
        text_printf(text, "x - (%s) + 0.5", low);
    else if (scale->log)
        text_printf(text, "ln(max(x, %s) / %s) / %s", low, low, width);
    else
        text_printf(text, "(x - (%s)) / %s", low, width);
}

static void put_bounds(Text *text, const ColorScale *scale)
{
    text_puts(text, "(0.5");
    for (int i = 0; i < scale->n_bounds; i++)
        put_text(text, " + select(x - (%n), 0, 1)", colorscale_bound(scale, i));
    text_printf(text, ") / %d", scale->n_bounds + 1);
}

/* A class is mapped to the centre of its step in the color map, because POV-Ray rounds the ends of
 * steps to single precision. */
void put_value_map(Text *text, const ColorScale *scale)
{
    char slack[NUMBER_TEXT_SIZE];
    const int n = colorscale_steps(scale);
    number_text_rounded(colorscale_tolerance(scale), text->digits, slack);
    if (scale->n_bounds)
        put_bounds(text, scale);
    else if (colorscale_selects_by_integer(scale))
        text_printf(text, "(mod(mod(floor(x) - 1, %d) + %d, %d) + 0.5) / %d", n, n, n, n);
    else if (n > 0)
        text_printf(text, "(0.5 + min(max(floor((x + %s) * %d), 0), %d)) / %d", slack, n, n - 1, n);
    else
        text_puts(text, "min(max(x, 0), 1)");
}

static void put_own(Text *text, const ScaleColor *own)
{
    const float grey = srgb_decode(0.5f);
    put_text(text, "<%c>",
             own->given ? (Rgb){own->rgb[0], own->rgb[1], own->rgb[2]} : (Rgb){grey, grey, grey});
}

static bool all_are_known(const Appearance *appearance)
{
    for (size_t i = 0; i < appearance->n_values; i++)
        if (isnan(appearance->positions[i]))
            return false;
    return true;
}

Status put_blend_macros(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    const Appearance *appearance = &geometry->scene->appearance;
    const ColorScale *scale = &appearance->scale;
    const double never = 1e30; /* beyond every value, and a number that POV-Ray reads */
    Values values = {.digits = geometry->params->digits};
    if (!povray_blends(geometry))
        return text_check(out, err);
    if (appearance->n_frames > 0)
        return err_set(err, STATUS_USAGE,
                       "`color_blend`: colors that change with time cannot blend in a POV-Ray "
                       "scene; choose one time with `moment`");
    add_number(&values, "lowest", scale->under.given ? colorscale_lowest(scale) : -never);
    add_number(&values, "highest", scale->over.given ? colorscale_highest(scale) : never);
    add_flag(&values, "own", scale->under.given || scale->over.given || !all_are_known(appearance));
    put_own(add_value(&values, "under"), &scale->under);
    put_own(add_value(&values, "over"), &scale->over);
    put_own(add_value(&values, "none"), &scale->none);
    return values_expand(&values, geometry->params, "povray/blend.inc", out, err);
}
