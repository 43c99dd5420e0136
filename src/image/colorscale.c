/* Maps the values of a quantity to colors in two steps: value to position, position to color. The
 * position is linear between the ends of the range, in values or in their logarithms: 0 at the
 * lower end, 1 at the upper end. On a continuous scale the color is interpolated in the map; on any
 * other scale the position selects one of a few colors, called steps. */
#include "image/colorscale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the value, or its natural logarithm if the scale is logarithmic; NAN if the scale cannot
 * show the value. */
static double scaled(const ColorScale *scale, double value)
{
    return scale->log ? (value > 0 ? elementary_log(value) : (double)NAN) : value;
}

/* Returns true if colorscale_fit and colorscale_percentiles use the value. */
static bool can_show(const ColorScale *scale, double value)
{
    return isfinite(scaled(scale, value));
}

bool colorscale_fit(ColorScale *scale, const double *values, size_t n)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        if (!can_show(scale, values[i]))
            continue;
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
    }
    if (!(low <= high))
        return false;
    scale->range[0] = low;
    scale->range[1] = high;
    return true;
}

/* Returns a percentile, interpolated linearly between the two nearest values; NAN without
 * values. */
static double percentile(const double *sorted, size_t n, double percent)
{
    if (n == 0)
        return (double)NAN;
    double position = percent / 100 * (double)(n - 1);
    size_t low = (size_t)position, next = low + 1 < n ? low + 1 : low;
    return sorted[low] + (sorted[next] - sorted[low]) * (position - (double)low);
}

Status colorscale_percentiles(const ColorScale *scale, const double *values, size_t n,
                              const double percent[2], double out[2], Err *err)
{
    double *sorted;
    size_t count = 0;
    TRY(mem_calloc(&sorted, n, sizeof *sorted, "values", err));
    for (size_t i = 0; i < n; i++)
        if (can_show(scale, values[i]))
            sorted[count++] = values[i];
    sort_numbers(sorted, count);
    for (int end = 0; end < 2; end++)
        out[end] = percentile(sorted, count, percent[end]);
    free(sorted);
    return STATUS_OK;
}

double colorscale_position(const ColorScale *scale, double value)
{
    double low = scaled(scale, scale->range[0]), high = scaled(scale, scale->range[1]);
    double width = high - low, above = scaled(scale, value) - low;
    return width > 0 ? above / width : above + 0.5;
}

/* The tolerance, 1e-6, is large compared with the rounding error of a mean of positions, about
 * 1e-15, and too small to be visible. A range of width 0 cannot be normalised: its positions have
 * the unit of the value, or of its logarithm, and the tolerance is relative to that. */
double colorscale_tolerance(const ColorScale *scale)
{
    const double part = 1e-6;
    return scale->range[1] > scale->range[0] ? part : part * fabs(scaled(scale, scale->range[0]));
}

double colorscale_bound(const ColorScale *scale, int i)
{
    return colorscale_position(scale, scale->bounds[i]) - colorscale_tolerance(scale);
}

double colorscale_lowest(const ColorScale *scale)
{
    return scale->n_bounds ? colorscale_bound(scale, 0) : -colorscale_tolerance(scale);
}

double colorscale_highest(const ColorScale *scale)
{
    return scale->n_bounds ? colorscale_bound(scale, scale->n_bounds - 1)
                           : 1 + colorscale_tolerance(scale);
}

static bool is_below(const ColorScale *scale, double position)
{
    return position < colorscale_lowest(scale);
}

/* With bounds, a position on the highest bound is above, because a bound belongs to the class above
 * it. Without bounds, the upper end of the range is still in the range. */
static bool is_above(const ColorScale *scale, double position)
{
    double highest = colorscale_highest(scale);
    return scale->n_bounds ? position >= highest : position > highest;
}

ScaleOutside colorscale_outside(const ColorScale *scale, const double *values, size_t n)
{
    ScaleOutside outside = {0};
    for (size_t i = 0; i < n; i++) {
        double position = colorscale_position(scale, values[i]);
        outside.none += isnan(position);
        outside.below += is_below(scale, position);
        outside.above += is_above(scale, position);
    }
    return outside;
}

bool colorscale_selects_by_integer(const ColorScale *scale)
{
    return scale->map.separate && !scale->n_bounds && scale->classes < 2;
}

int colorscale_steps(const ColorScale *scale)
{
    if (scale->n_bounds)
        return scale->n_bounds + 1;
    if (scale->classes >= 2)
        return scale->classes;
    return scale->map.separate ? (int)scale->map.n : 0;
}

void colorscale_step_color(const ColorScale *scale, int step, float rgb[3])
{
    if (scale->map.separate)
        colormap_color(&scale->map, (size_t)step, rgb);
    else
        colormap_linear(&scale->map, (double)step / (colorscale_steps(scale) - 1), rgb);
}

/* Returns the index of the class of a position on a scale that has classes or bounds. */
static int step_at(const ColorScale *scale, double position)
{
    int step = 0;
    if (!scale->n_bounds) {
        double part = position + colorscale_tolerance(scale);
        return (int)fmin(fmax(floor(part * scale->classes), 0), scale->classes - 1);
    }
    while (step < scale->n_bounds && colorscale_bound(scale, step) <= position)
        step++;
    return step;
}

/* Returns the color `under`, `over` or `none` that applies at a position; NULL if none of them
 * applies or the scale does not specify it. */
static const ScaleColor *special_color(const ColorScale *scale, double position)
{
    const ScaleColor *own = isnan(position)             ? &scale->none
                            : is_below(scale, position) ? &scale->under
                            : is_above(scale, position) ? &scale->over
                                                        : NULL;
    return own && own->given ? own : NULL;
}

/* Returns true, and stores the color, if the position has a special color or the scale has classes
 * or bounds. */
static bool take_step(const ColorScale *scale, double position, float rgb[3])
{
    const ScaleColor *own = special_color(scale, position);
    if (own) {
        memcpy(rgb, own->rgb, sizeof own->rgb);
        return true;
    }
    if (isnan(position) || (!scale->n_bounds && scale->classes < 2))
        return false;
    colorscale_step_color(scale, step_at(scale, position), rgb);
    return true;
}

void colorscale_at(const ColorScale *scale, double position, float rgb[3])
{
    if (!take_step(scale, position, rgb))
        colormap_linear(&scale->map, position, rgb);
}

void colorramp_init(ColorRamp *ramp, const Colormap *map)
{
    for (int i = 0; i < COLORRAMP_ENTRIES; i++) {
        double position = i / (COLORRAMP_ENTRIES - 1.0);
        ramp->position[i] = (float)position;
        colormap_linear(map, position, ramp->rgb[i]);
    }
}

void colorscale_on_ramp(const ColorScale *scale, const ColorRamp *ramp, double position,
                        float rgb[3])
{
    if (take_step(scale, position, rgb))
        return;
    if (isnan(position)) {
        colormap_linear(&scale->map, position, rgb);
        return;
    }
    /* Finds the interval of the ramp that contains the position. The entries are floats, so the
     * product may select the interval above; the second line corrects this. */
    position = fmin(fmax(position, 0), 1);
    int i = (int)(position * (COLORRAMP_ENTRIES - 1));
    i -= i > 0 && position <= (double)ramp->position[i];
    i = i < COLORRAMP_ENTRIES - 2 ? i : COLORRAMP_ENTRIES - 2;
    double low = (double)ramp->position[i],
           part = (position - low) / ((double)ramp->position[i + 1] - low);
    for (int c = 0; c < 3; c++) {
        double a = (double)ramp->rgb[i][c], b = (double)ramp->rgb[i + 1][c];
        rgb[c] = (float)(a + part * (b - a));
    }
}

/* Returns the index of the color that the integer below `value` selects on a separate map: 1
 * selects color 0. Returns 0 if `value` is not finite. */
static size_t color_of_integer(const ColorScale *scale, double value)
{
    double n = (double)scale->map.n, number = fmod(floor(value) - 1, n);
    return isfinite(number) ? (size_t)(number < 0 ? number + n : number) : 0;
}

void colorscale_linear(const ColorScale *scale, double value, float rgb[3])
{
    double position = colorscale_position(scale, value);
    if (colorscale_selects_by_integer(scale) && !isnan(position) && !special_color(scale, position))
        colormap_color(&scale->map, color_of_integer(scale, value), rgb);
    else
        colorscale_at(scale, position, rgb);
}

/* Appends a value with three significant digits, including trailing zeros; an integer without
 * decimals. Values that three digits would print with an exponent, below 1e-4 or from 99.95 on, are
 * printed by READABLE. The bytes are the minus sign of typography, U+2212. */
static void put_short(Text *text, double value)
{
    const double size = fabs(value);
    const bool whole = value == floor(value);
    if (whole || size < 1e-4 || size >= 99.95)
        text_puts(text, READABLE(value, whole ? 6 : 3));
    else
        text_printf(text, "%s%#.3g", value < 0 ? "\xE2\x88\x92" : "", size);
}

void colorscale_put_range(const ColorScale *scale, Text *text)
{
    text_printf(text, "%s ", scale->name);
    put_short(text, scale->range[0]);
    text_puts(text, " to ");
    put_short(text, scale->range[1]);
    text_puts(text, *scale->unit ? " " : "");
    text_unit(text, scale->unit);
}
