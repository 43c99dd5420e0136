/* Draws legends of color scales, and scale bars.
 *
 * The legend is laid out in coordinates along and across the color bar. The function page_point
 * converts them to positions on the page, so that vertical and horizontal bars share their code.
 * Lengths are multiples of the text size. */
#include "figure/fonts.h"
#include "figure/items.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The legend that is being built. Lengths are mm. */
typedef struct LegendLayout {
    FigurePage *page;
    const FigureLegend *legend;
    double em; /* size of the text */
    double length;
} LegendLayout;

/* Sizes in multiples of the text size: width of the bar, length of a tick, space between a tick and
 * its label, length of a pointed end. Then the width of a tick in mm, a line of 0.5 pt, which print
 * still shows. The bar is a little wider than a line of text is high; the other proportions were
 * chosen by their look. Numbers of this file that are multiplied by `em` are multiples of the text
 * size as well. */
static const double bar_ems = 1.1, tick_ems = 0.25, gap_ems = 0.3, point_ems = 0.9, line_mm = 0.18;

/* Converts a position along and across the bar to a point of the page. A vertical bar begins at its
 * lower end. */
static FigurePoint page_point(const LegendLayout *layout, double along, double across)
{
    return layout->legend->horizontal ? (FigurePoint){along, across}
                                      : (FigurePoint){across, -along};
}

/* Returns the box of the part of the bar between two positions along it. */
static FigureBox box_of(const LegendLayout *layout, double from, double to)
{
    FigurePoint a = page_point(layout, from, 0), b = page_point(layout, to, bar_ems * layout->em);
    return (FigureBox){fmin(a.x, b.x), fmin(a.y, b.y), fmax(a.x, b.x), fmax(a.y, b.y)};
}

static void put_text(const LegendLayout *layout, const char *text, double x, double y,
                     FigureAlign align)
{
    const FigureText line = {.text = text,
                             .x = x,
                             .y = y,
                             .size_pt = layout->legend->size_pt,
                             .align = align,
                             .color = layout->legend->ink};
    figure_add_text(layout->page, &line);
}

/* Adds a label beside or below the bar, centred on a position along the bar. */
static void put_label(const LegendLayout *layout, double along, double across, const char *text)
{
    FigurePoint at = page_point(layout, along, across);
    double capitals = FONT_CAPITALS * layout->em;
    if (layout->legend->horizontal)
        put_text(layout, text, at.x, at.y + capitals, ALIGN_CENTER);
    else
        put_text(layout, text, at.x, at.y + capitals / 2, ALIGN_LEFT);
}

/* Returns the smallest number of decimals, at most 6, with which rounding changes no number by more
 * than 1/100 of the smallest gap. The numbers are ascending. For one number, 1/100 of its size
 * replaces the gap. */
static int decimals_of(const double *values, int n)
{
    double gap = n > 1 ? HUGE_VAL : fabs(values[0]) / 100;
    for (int i = 1; i < n; i++)
        gap = fmin(gap, values[i] - values[i - 1]);
    for (int decimals = 0; decimals < 6; decimals++) {
        bool enough = true;
        double unit = elementary_pow(10, -decimals);
        for (int i = 0; i < n && enough; i++)
            enough = fabs(values[i] - round(values[i] / unit) * unit) <= gap / 100;
        if (enough)
            return decimals;
    }
    return 6;
}

/* Adds a line at the bar, `along` mm from its begin and `ems` em long. */
static void put_tick_line(const LegendLayout *layout, double along, double ems)
{
    double begin = bar_ems * layout->em, end = begin + ems * layout->em;
    const FigurePoint line[] = {page_point(layout, along, begin), page_point(layout, along, end)};
    figure_add_line(layout->page, line, 2, false, line_mm, layout->legend->ink);
}

static void put_tick(const LegendLayout *layout, double along, const char *label)
{
    put_tick_line(layout, along, tick_ems);
    put_label(layout, along, (bar_ems + tick_ems + gap_ems) * layout->em, label);
}

/* Returns the power of ten that is factored out of numbers with absolute values up to `largest`; 0
 * if the numbers are written in full, which takes up to five digits, or three zeros after the
 * point. */
static int common_power(double largest)
{
    return largest >= 1e5 || (largest > 0 && largest < 1e-3)
               ? (int)floor(elementary_log10(largest) + 1e-9)
               : 0;
}

/* Adds the common power of ten, above the numbers of a vertical bar or to the right of a horizontal
 * bar. */
static void put_power(const LegendLayout *layout, int power)
{
    const double em = layout->em, across = (bar_ems + tick_ems + gap_ems) * em;
    const bool horizontal = layout->legend->horizontal;
    char digits[READABLE_SIZE], factor[READABLE_SIZE + 2];
    snprintf(factor, sizeof factor, "\xC3\x97%s", power_readable(power, digits));
    if (horizontal)
        put_text(layout, factor, layout->length + (point_ems + 0.5) * em,
                 (bar_ems + FONT_CAPITALS) / 2 * em, ALIGN_LEFT);
    else
        put_text(layout, factor, across, -layout->length - 0.9 * em, ALIGN_LEFT);
}

/* Adds ticks at ascending values of a linear scale. All labels have the same number of decimals. */
static void put_linear_ticks(const LegendLayout *layout, const double *values, const double *along,
                             int n)
{
    double scaled[FIGURE_TICKS + COLORSCALE_MAX_BOUNDS];
    const int power = common_power(fmax(fabs(values[0]), fabs(values[n - 1])));
    for (int i = 0; i < n; i++)
        scaled[i] = power < 0 ? values[i] * elementary_pow(10, -power)
                              : values[i] / elementary_pow(10, power);
    const int decimals = decimals_of(scaled, n);
    for (int i = 0; i < n; i++) {
        char label[64];
        snprintf(label, sizeof label, "%s%.*f", scaled[i] < 0 ? "\xE2\x88\x92" : "", decimals,
                 fabs(scaled[i]));
        put_tick(layout, along[i], label);
    }
    if (power)
        put_power(layout, power);
}

/* Writes a number of a logarithmic scale. With `powers`, a power of ten is written as 10 with an
 * exponent. */
static const char *log_number(double value, int digits, bool powers, char out[READABLE_SIZE])
{
    const double power = round(elementary_log10(value));
    if (powers && fabs(elementary_log10(value) - power) < 1e-9)
        return power_readable((int)power, out);
    return number_readable(value, digits, out);
}

/* Returns true if the powers of ten of a logarithmic scale are written with exponents: if the range
 * goes below 0.001 or above 10000, up to rounding. */
static bool has_powers(const ColorScale *scale)
{
    return scale->range[0] < 0.999e-3 || scale->range[1] > 1.001e4;
}

/* Adds a labelled tick for each value. */
static void put_ticks(const LegendLayout *layout, const double *values, const double *along, int n)
{
    const ColorScale *scale = layout->legend->scale;
    if (!scale->log && n > 0)
        put_linear_ticks(layout, values, along, n);
    for (int i = 0; i < n && scale->log; i++)
        put_tick(layout, along[i],
                 log_number(values[i], 4, has_powers(scale), (char[READABLE_SIZE]){0}));
}

/* Adds unlabelled short ticks: at 1 to 9 times each power of ten if a power takes at least 2.5 text
 * sizes, so that the last two ticks are 0.1 text sizes apart; else only at the powers, if these are
 * 0.3 text sizes apart; else none. */
static void put_minor_ticks(const LegendLayout *layout)
{
    const ColorScale *scale = layout->legend->scale;
    const double low = elementary_log10(scale->range[0]), high = elementary_log10(scale->range[1]);
    const double decade_ems = layout->length / (high - low) / layout->em;
    const int digits = decade_ems > 2.5 ? 9 : decade_ems > 0.3 ? 1 : 0;
    for (int power = (int)floor(low); power < high; power++)
        for (int digit = 1; digit <= digits; digit++) {
            const double at = (power + elementary_log10(digit) - low) / (high - low);
            if (at > 0 && at < 1)
                put_tick_line(layout, at * layout->length, tick_ems / 2);
        }
}

/* Returns half of the length along the bar that a label needs, including the gap to the next label:
 * the height of a line of text, 1.15 text sizes, or the width of the label and half a text size. */
static double half_length(const LegendLayout *layout, const char *label)
{
    const FigureLegend *legend = layout->legend;
    if (!legend->horizontal)
        return 0.575 * layout->em;
    return (figure_text_width(layout->page->fonts, label, legend->size_pt, false) +
            0.5 * layout->em) /
           2;
}

/* Adds labelled ticks at both ends of a logarithmic bar and at the round values. The label of a
 * round value is left out if it would touch another label. */
static void put_log_ticks(const LegendLayout *layout, const double *ticks, int n)
{
    const ColorScale *scale = layout->legend->scale;
    const double slack = 1e-9 * layout->length;
    const bool powers = has_powers(scale);
    char label[READABLE_SIZE], end[2][READABLE_SIZE];
    for (int i = 0; i < 2; i++)
        log_number(scale->range[i], 3, powers, end[i]);
    put_tick(layout, 0, end[0]);
    double taken = half_length(layout, end[0]);
    for (int i = 0; i < n; i++) {
        const double along = layout->length * colorscale_position(scale, ticks[i]);
        const double half = half_length(layout, log_number(ticks[i], 3, powers, label));
        const bool fits =
            along >= taken + half && along + half <= layout->length - half_length(layout, end[1]);
        taken = fits ? along + half : taken;
        if (fits)
            put_tick(layout, along, label);
        else if (along > slack && along < layout->length - slack)
            put_tick_line(layout, along, tick_ems);
    }
    put_tick(layout, layout->length, end[1]);
    put_minor_ticks(layout);
}

/* Adds the pointed end beyond the bar for values outside the range. */
static void put_pointed_end(const LegendLayout *layout, double from, double to,
                            const float linear[3])
{
    double width = bar_ems * layout->em;
    const FigurePoint corner[] = {page_point(layout, from, 0), page_point(layout, from, width),
                                  page_point(layout, to, width / 2)};
    figure_add_shape(layout->page, corner, 3, figure_color(linear));
}

/* Adds a pointed end at each end of the bar beyond which there are values. The positions -1 and 2
 * are outside any range, so they have the colors of such values. */
static void put_pointed_ends(const LegendLayout *layout)
{
    const FigureLegend *legend = layout->legend;
    double gap = 0.12 * layout->em, point = point_ems * layout->em;
    float color[3];
    if (legend->outside.below) {
        colorscale_at(legend->scale, -1, color);
        put_pointed_end(layout, -gap, -gap - point, color);
    }
    if (legend->outside.above) {
        colorscale_at(legend->scale, 2, color);
        put_pointed_end(layout, layout->length + gap, layout->length + gap + point, color);
    }
}

/* Adds a continuous bar with its ticks: as many as there is space for, from 2 to 8. `pitch` is the
 * space for a tick in text sizes; labels side by side need more than labels below each other. */
static void put_ramp(const LegendLayout *layout)
{
    const FigureLegend *legend = layout->legend;
    FigureColor stops[FIGURE_STOPS];
    double ticks[FIGURE_TICKS], along[FIGURE_TICKS];
    for (int i = 0; i < FIGURE_STOPS; i++) {
        float color[3];
        colorscale_at(legend->scale, (double)i / (FIGURE_STOPS - 1), color);
        stops[i] = figure_color(color);
    }
    figure_add_ramp(layout->page, box_of(layout, 0, layout->length), !legend->horizontal, stops);
    const double pitch = legend->horizontal && !legend->scale->log ? 2.9 : 2.2;
    int max_ticks = (int)fmin(fmax(layout->length / pitch / layout->em, 2), 8);
    int n = figure_ticks(legend->scale, max_ticks, legend->integers, ticks);
    for (int i = 0; i < n; i++)
        along[i] = layout->length * colorscale_position(legend->scale, ticks[i]);
    if (legend->scale->log && legend->scale->range[0] < legend->scale->range[1])
        put_log_ticks(layout, ticks, n);
    else
        put_ticks(layout, ticks, along, n);
    put_pointed_ends(layout);
}

/* Returns the value between class step - 1 and class `step`. Without bounds, step 0 and step
 * `classes` give the ends of the range. */
static double bound_of(const ColorScale *scale, int step)
{
    if (scale->n_bounds)
        return scale->bounds[step - 1];
    double part = (double)step / scale->classes, low = scale->range[0], high = scale->range[1];
    return scale->log ? low * elementary_pow(high / low, part) : low + part * (high - low);
}

/* Adds classes as boxes of equal length, and numbers at the bounds between them. Bounds are skipped
 * at equal intervals if there is too little space. A scale with a range also has numbers at its
 * ends. */
static void put_classes(const LegendLayout *layout)
{
    const ColorScale *scale = layout->legend->scale;
    int steps = colorscale_steps(scale), n = 0;
    double each = layout->length / steps;
    double values[COLORSCALE_MAX_BOUNDS + 2], along[COLORSCALE_MAX_BOUNDS + 2];
    double pitch = (layout->legend->horizontal ? 2.9 : 1.2) * layout->em;
    int apart = (int)fmax(ceil(pitch / each), steps / COLORSCALE_MAX_BOUNDS + 1);
    for (int i = 0; i < steps; i++) {
        float color[3];
        bool is_under = scale->n_bounds && i == 0, is_over = scale->n_bounds && i == steps - 1;
        colorscale_step_color(scale, i, color);
        if (is_under || is_over)
            colorscale_at(scale, is_under ? -HUGE_VAL : HUGE_VAL, color);
        figure_add_box(layout->page, box_of(layout, i * each, (i + 1) * each), figure_color(color));
    }
    for (int i = scale->n_bounds ? 1 : 0; i <= steps - (scale->n_bounds ? 1 : 0); i += apart) {
        values[n] = bound_of(scale, i);
        along[n++] = i * each;
    }
    put_ticks(layout, values, along, n);
    if (!scale->n_bounds)
        put_pointed_ends(layout);
}

/* Adds a square of one color with its label. */
static void put_swatch(const LegendLayout *layout, double from, const float linear[3],
                       const char *label)
{
    double side = bar_ems * layout->em;
    figure_add_box(layout->page, box_of(layout, from, from + side), figure_color(linear));
    put_label(layout, from + side / 2, side + gap_ems * layout->em, label);
}

/* Adds a swatch for each integer of the range, at most one per color. In a vertical legend the
 * lowest integer is at the top. Returns the length of all swatches. */
static double put_integers(const LegendLayout *layout)
{
    const ColorScale *scale = layout->legend->scale;
    double first = scale->range[0], values = scale->range[1] - first + 1;
    int n = (int)fmin(values, (double)scale->map.n);
    double pitch = (layout->legend->horizontal ? 2.2 : 1.35) * layout->em;
    for (int i = 0; i < n; i++) {
        char label[64];
        float color[3];
        colorscale_linear(scale, first + i, color);
        snprintf(label, sizeof label, "%.0f%s", first + i,
                 i + 1 == n && values > n ? "\xE2\x80\xA6" : "");
        put_swatch(layout, (layout->legend->horizontal ? i : n - 1 - i) * pitch, color, label);
    }
    return n * pitch;
}

/* Adds a swatch for each value of legend->swatches. In a vertical legend the first value is at the
 * bottom. Returns the length of all swatches. */
static double put_listed(const LegendLayout *layout)
{
    const FigureLegend *legend = layout->legend;
    const int n = legend->n_swatches;
    double widest = 0;
    char label[READABLE_SIZE];
    for (int i = 0; i < n; i++)
        widest = fmax(widest, figure_text_width(layout->page->fonts,
                                                number_readable(legend->swatches[i], 6, label),
                                                legend->size_pt, false));
    const double pitch =
        legend->horizontal ? fmax(1.7 * layout->em, widest + 0.6 * layout->em) : 1.35 * layout->em;
    for (int i = 0; i < n; i++) {
        float color[3];
        colorscale_linear(legend->scale, legend->swatches[i], color);
        put_swatch(layout, i * pitch, color, number_readable(legend->swatches[i], 6, label));
    }
    return n * pitch;
}

/* Adds a swatch for values that have no position on the scale, if there are any: beyond the bar and
 * the space for a pointed end. */
static void put_none(const LegendLayout *layout)
{
    const FigureLegend *legend = layout->legend;
    float color[3];
    if (!legend->outside.none)
        return;
    colorscale_linear(legend->scale, (double)NAN, color);
    double beyond = (point_ems + bar_ems + 1.2) * layout->em;
    put_swatch(layout, legend->horizontal ? layout->length + beyond : -beyond, color, "no value");
}

/* Adds the title above the other items of the legend. If the title of a vertical bar is wide, its
 * unit is put on a second line. */
static void put_title(const LegendLayout *layout, size_t first)
{
    const FigureLegend *legend = layout->legend;
    const char *unit = strrchr(legend->title, '(');
    double width = figure_text_width(layout->page->fonts, legend->title, legend->size_pt, false);
    double y = figure_bounds(layout->page, first).top - 0.75 * layout->em;
    bool two = unit && unit > legend->title && !legend->horizontal && width > 7.5 * layout->em;
    if (two)
        put_text(layout, unit, 0, y, ALIGN_LEFT);
    Text name = TEXT_INIT;
    text_append(&name, legend->title, two ? (size_t)(unit - legend->title) : strlen(legend->title));
    if (text_chars(&name))
        put_text(layout, text_chars(&name), 0, two ? y - 1.15 * layout->em : y, ALIGN_LEFT);
    else
        layout->page->failed = true;
    text_release(&name);
}

void figure_add_legend(FigurePage *page, const FigureLegend *legend)
{
    const size_t first = page->n;
    LegendLayout layout = {.page = page,
                           .legend = legend,
                           .em = legend->size_pt * MM_PER_POINT,
                           .length = legend->length_mm};
    if (legend->n_swatches > 0)
        layout.length = put_listed(&layout);
    else if (colorscale_selects_by_integer(legend->scale))
        layout.length = put_integers(&layout);
    else if (colorscale_steps(legend->scale))
        put_classes(&layout);
    else
        put_ramp(&layout);
    put_none(&layout);
    put_title(&layout, first);
    figure_mark_solid(page, first);
}

void figure_add_scale_bar(FigurePage *page, double length_mm, const char *label, double size_pt,
                          FigureColor ink)
{
    const double em = size_pt * MM_PER_POINT, thick = 0.22 * em;
    const FigureText text = {.text = label,
                             .x = length_mm / 2,
                             .y = -0.35 * em,
                             .size_pt = size_pt,
                             .align = ALIGN_CENTER,
                             .color = ink};
    const size_t first = page->n;
    figure_add_box(page, (FigureBox){0, 0, length_mm, thick}, ink);
    figure_add_text(page, &text);
    figure_mark_solid(page, first);
}
