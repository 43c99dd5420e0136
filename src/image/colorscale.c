/* The position of a value on the map is linear between the ends of the range, in values or in their
 * logarithms. On a scale that is not continuous, the value selects one of a few steps instead. */
#include "image/colorscale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the value or its logarithm; NAN if the scale cannot show it. */
static double scaled(const ColorScale *scale, double value)
{
    return scale->log ? (value > 0 ? elementary_log(value) : (double)NAN) : value;
}

/* Returns true if the value may set the ends of the range. */
static bool counts(const ColorScale *scale, double value)
{
    return isfinite(scaled(scale, value));
}

bool colorscale_fit(ColorScale *scale, const double *values, size_t n)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        if (!counts(scale, values[i]))
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

static double percentile(const double *sorted, size_t n, double percent)
{
    if (n == 0)
        return (double)NAN;
    double place = percent / 100 * (double)(n - 1);
    size_t low = (size_t)place, next = low + 1 < n ? low + 1 : low;
    return sorted[low] + (sorted[next] - sorted[low]) * (place - (double)low);
}

Status colorscale_percentiles(const ColorScale *scale, const double *values, size_t n,
                              const double percent[2], double out[2], Err *err)
{
    double *sorted;
    size_t count = 0;
    TRY(mem_calloc(&sorted, n, sizeof *sorted, "values", err));
    for (size_t i = 0; i < n; i++)
        if (counts(scale, values[i]))
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

/* Large compared with the rounding of a mean of positions, about 1e-15, and too small to be
 * visible. Positions in a range without width have the unit of the value. */
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

static bool is_below(const ColorScale *scale, double place)
{
    return place < colorscale_lowest(scale);
}

/* A value on a bound belongs to the class above. */
static bool is_above(const ColorScale *scale, double place)
{
    double highest = colorscale_highest(scale);
    return scale->n_bounds ? place >= highest : place > highest;
}

ScaleOutside colorscale_outside(const ColorScale *scale, const double *values, size_t n)
{
    ScaleOutside outside = {0};
    for (size_t i = 0; i < n; i++) {
        double place = colorscale_position(scale, values[i]);
        outside.none += isnan(place);
        outside.below += is_below(scale, place);
        outside.above += is_above(scale, place);
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

/* Returns the step of a place on a scale that has classes or bounds. */
static int step_at(const ColorScale *scale, double place)
{
    int step = 0;
    if (!scale->n_bounds) {
        double part = place + colorscale_tolerance(scale);
        return (int)fmin(fmax(floor(part * scale->classes), 0), scale->classes - 1);
    }
    while (step < scale->n_bounds && colorscale_bound(scale, step) <= place)
        step++;
    return step;
}

/* Returns the special color of a position; NULL if it has none. */
static const ScaleColor *own_color(const ColorScale *scale, double place)
{
    const ScaleColor *own = isnan(place)             ? &scale->none
                            : is_below(scale, place) ? &scale->under
                            : is_above(scale, place) ? &scale->over
                                                     : NULL;
    return own && own->given ? own : NULL;
}

/* Returns true, and stores the color, if the position has a special color or is on a step. */
static bool take_step(const ColorScale *scale, double place, float rgb[3])
{
    const ScaleColor *own = own_color(scale, place);
    if (own) {
        memcpy(rgb, own->rgb, sizeof own->rgb);
        return true;
    }
    if (isnan(place) || (!scale->n_bounds && scale->classes < 2))
        return false;
    colorscale_step_color(scale, step_at(scale, place), rgb);
    return true;
}

void colorscale_at(const ColorScale *scale, double place, float rgb[3])
{
    if (!take_step(scale, place, rgb))
        colormap_linear(&scale->map, place, rgb);
}

void colorramp_init(ColorRamp *ramp, const Colormap *map)
{
    for (int i = 0; i < COLORRAMP_ENTRIES; i++) {
        double place = i / (COLORRAMP_ENTRIES - 1.0);
        ramp->position[i] = (float)place;
        colormap_linear(map, place, ramp->rgb[i]);
    }
}

void colorscale_on_ramp(const ColorScale *scale, const ColorRamp *ramp, double place, float rgb[3])
{
    if (take_step(scale, place, rgb))
        return;
    if (isnan(place)) {
        colormap_linear(&scale->map, place, rgb);
        return;
    }
    place = fmin(fmax(place, 0), 1);
    int i = (int)(place * (COLORRAMP_ENTRIES - 1));
    i -= i > 0 && place <= (double)ramp->position[i];
    i = i < COLORRAMP_ENTRIES - 2 ? i : COLORRAMP_ENTRIES - 2;
    double low = (double)ramp->position[i],
           part = (place - low) / ((double)ramp->position[i + 1] - low);
    for (int c = 0; c < 3; c++) {
        double a = (double)ramp->rgb[i][c], b = (double)ramp->rgb[i + 1][c];
        rgb[c] = (float)(a + part * (b - a));
    }
}

/* Returns the step of a value on a separate map. */
static size_t number_of(const ColorScale *scale, double value)
{
    double n = (double)scale->map.n, number = fmod(floor(value) - 1, n);
    return isfinite(number) ? (size_t)(number < 0 ? number + n : number) : 0;
}

void colorscale_linear(const ColorScale *scale, double value, float rgb[3])
{
    double place = colorscale_position(scale, value);
    if (colorscale_selects_by_integer(scale) && !isnan(place) && !own_color(scale, place))
        colormap_color(&scale->map, number_of(scale, value), rgb);
    else
        colorscale_at(scale, place, rgb);
}

/* Appends a value with three digits, zeros included, or as an integer if it is one. */
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
