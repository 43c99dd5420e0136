/* Makes and joins intervals of colors. Widths and slopes are those of the sRGB curve, because
 * differences of colors are seen there. */
#include "answer/interval.h"

#include <math.h>

ColorInterval interval_of_scene(const AnswerPlan *plan)
{
    ColorInterval interval;
    for (int c = 0; c < 3; c++) {
        interval.low[c] = plan->least[c];
        interval.high[c] = plan->most[c];
    }
    return interval;
}

ColorInterval interval_of_background(const AnswerPlan *plan)
{
    const Rgb color = plan->scene->view.background;
    const double r = rgb_channel(color, 0), g = rgb_channel(color, 1), b = rgb_channel(color, 2);
    return (ColorInterval){{r, g, b}, {r, g, b}};
}

/* Comparisons with NaN are false. A bound that is NaN therefore keeps its value of
 * interval_of_scene. */
ColorInterval interval_of_form(const AnswerPlan *plan, const FormColor *color)
{
    ColorInterval interval = interval_of_scene(plan);
    for (int c = 0; c < 3; c++) {
        const double low = form_low(color->channels[c]), high = form_high(color->channels[c]);
        if (low > interval.low[c])
            interval.low[c] = low;
        if (high < interval.high[c])
            interval.high[c] = high;
    }
    return interval;
}

void interval_include(ColorInterval *interval, const ColorInterval *other)
{
    for (int c = 0; c < 3; c++) {
        interval->low[c] = box_min(interval->low[c], other->low[c]);
        interval->high[c] = box_max(interval->high[c], other->high[c]);
    }
}

static double srgb(double linear)
{
    const double v = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    return v <= 0.0031308 ? 12.92 * v : 1.055 * elementary_pow(v, 1 / 2.4) - 0.055;
}

double interval_width(const ColorInterval *interval)
{
    double width = 0;
    for (int c = 0; c < 3; c++)
        width = box_max(width, srgb(interval->high[c]) - srgb(interval->low[c]));
    return width;
}

void interval_slopes(const ColorInterval *interval, double slopes[3])
{
    for (int c = 0; c < 3; c++) {
        const double v = 0.5 * (interval->low[c] + interval->high[c]);
        slopes[c] = v <= 0.0031308 ? 12.92 : 1.055 / 2.4 * elementary_pow(v, 1 / 2.4 - 1);
    }
}
