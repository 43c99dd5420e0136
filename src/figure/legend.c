/* The bar is laid out in coordinates along and across itself, and turned upwards or to the right at
 * the end, so that both directions share their code. All lengths are multiples of the text size. */
#include "figure/fonts.h"
#include "figure/items.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The legend that is being built; mm. */
typedef struct LegendLayout {
    FigurePage *page;
    const FigureLegend *legend;
    double em; /* size of the text */
    double length;
} LegendLayout;

static const double bar_ems = 1.1, tick_ems = 0.25, gap_ems = 0.3, point_ems = 0.9, line_mm = 0.18;

/* Returns a position on the page. A bar that points upwards begins at its lower end. */
static FigurePoint place(const LegendLayout *layout, double along, double across)
{
    return layout->legend->horizontal ? (FigurePoint){along, across}
                                      : (FigurePoint){across, -along};
}

static FigureBox box_of(const LegendLayout *layout, double from, double to)
{
    FigurePoint a = place(layout, from, 0), b = place(layout, to, bar_ems * layout->em);
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

/* Adds a label beside or below the bar, centred on a position along it. */
static void put_label(const LegendLayout *layout, double along, double across, const char *text)
{
    FigurePoint at = place(layout, along, across);
    double capitals = FONT_CAPITALS * layout->em;
    if (layout->legend->horizontal)
        put_text(layout, text, at.x, at.y + capitals, ALIGN_CENTER);
    else
        put_text(layout, text, at.x, at.y + capitals / 2, ALIGN_LEFT);
}

/* Appends a number with `decimals` decimals, or, if it is large or small, with its power of ten. */
static void put_number(double value, int decimals, Text *text)
{
    char digits[64];
    bool plain = value == 0 || (fabs(value) < 1e6 && fabs(value) >= 1e-4);
    if (plain)
        snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    else
        snprintf(digits, sizeof digits, "%.3g", fabs(value));
    text_puts(text, value < 0 ? "\xE2\x88\x92" : "");
    text_puts(text, digits);
}

/* Returns the number of decimals with which ascending numbers are off by at most a hundredth of the
 * smallest gap, or a single number by a hundredth of its value. */
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

static void put_tick(const LegendLayout *layout, double along, const char *label)
{
    double begin = bar_ems * layout->em, end = begin + tick_ems * layout->em;
    const FigurePoint line[] = {place(layout, along, begin), place(layout, along, end)};
    figure_add_line(layout->page, line, 2, false, line_mm, layout->legend->ink);
    put_label(layout, along, end + gap_ems * layout->em, label);
}

/* Adds a tick for each value. On a logarithmic scale each number has decimals of its own. */
static void put_ticks(const LegendLayout *layout, const double *values, const double *along, int n)
{
    int decimals = decimals_of(values, n);
    for (int i = 0; i < n; i++) {
        Text label = TEXT_INIT;
        bool own = layout->legend->scale->log;
        put_number(values[i], own ? decimals_of(&values[i], 1) : decimals, &label);
        if (text_chars(&label))
            put_tick(layout, along[i], text_chars(&label));
        else
            layout->page->failed = true;
        text_release(&label);
    }
}

/* Adds the pointed end beyond the bar for values outside the range. */
static void put_point(const LegendLayout *layout, double from, double to, const float linear[3])
{
    double width = bar_ems * layout->em;
    const FigurePoint corner[] = {place(layout, from, 0), place(layout, from, width),
                                  place(layout, to, width / 2)};
    figure_add_shape(layout->page, corner, 3, figure_color(linear));
}

static void put_points(const LegendLayout *layout)
{
    const FigureLegend *legend = layout->legend;
    double gap = 0.12 * layout->em, point = point_ems * layout->em;
    float color[3];
    if (legend->outside.below) {
        colorscale_at(legend->scale, -1, color);
        put_point(layout, -gap, -gap - point, color);
    }
    if (legend->outside.above) {
        colorscale_at(legend->scale, 2, color);
        put_point(layout, layout->length + gap, layout->length + gap + point, color);
    }
}

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
    int most =
        (int)fmin(fmax(layout->length / (legend->horizontal ? 2.9 : 2.2) / layout->em, 2), 8);
    int n = figure_ticks(legend->scale, most, legend->integers, ticks);
    for (int i = 0; i < n; i++)
        along[i] = layout->length * colorscale_position(legend->scale, ticks[i]);
    put_ticks(layout, ticks, along, n);
    put_points(layout);
}

/* Returns the value at the lower bound of an inner class. */
static double bound_of(const ColorScale *scale, int step)
{
    if (scale->n_bounds)
        return scale->bounds[step - 1];
    double part = (double)step / scale->classes, low = scale->range[0], high = scale->range[1];
    return scale->log ? low * elementary_pow(high / low, part) : low + part * (high - low);
}

/* Adds classes of equal length, and numbers at the bounds between them as far as there is space; a
 * range also has numbers at its ends. */
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
        put_points(layout);
}

static void put_swatch(const LegendLayout *layout, double from, const float linear[3],
                       const char *label)
{
    double side = bar_ems * layout->em;
    figure_add_box(layout->page, box_of(layout, from, from + side), figure_color(linear));
    put_label(layout, from + side / 2, side + gap_ems * layout->em, label);
}

/* Adds a swatch for each integer of the range, the highest first, or as many as there are colors.
 * Returns the length of the bar. */
static double put_counts(const LegendLayout *layout)
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

/* Adds the title above everything else: one line, or the unit on a second line if the title is
 * wide. */
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
    if (colorscale_selects_by_integer(legend->scale))
        layout.length = put_counts(&layout);
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
