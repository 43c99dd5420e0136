/* A value's place on the map is linear between the ends of the range, of values or of their
 * logarithms. */
#include "image/colorscale.h"

#include <math.h>

/* NAN where the scale cannot show the value. */
static double scaled(const ColorScale *scale, double value)
{
    return scale->log ? (value > 0 ? log(value) : (double)NAN) : value;
}

bool colorscale_fit(ColorScale *scale, const double *values, size_t n)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(scaled(scale, values[i])))
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

/* The place on the map of the class that a fraction of the range lies in. */
static double place_of_class(double fraction, int classes)
{
    double number = floor(fraction * classes);
    return fmin(number, classes - 1) / (classes - 1);
}

void colorscale_linear(const ColorScale *scale, double value, float rgb[3])
{
    double low = scaled(scale, scale->range[0]), high = scaled(scale, scale->range[1]);
    double width = high - low, above = scaled(scale, value) - low;
    double fraction = width > 0 ? above / width : above + 0.5;
    if (scale->classes >= 2 && !isnan(fraction))
        fraction = place_of_class(fraction, scale->classes);
    colormap_linear(&scale->map, fraction, rgb);
}
