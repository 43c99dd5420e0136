/* Color scales: map the values of a quantity, such as pressures in mmHg, to colors. Included by the
 * public header image.h.
 *
 * A scale maps a value in two steps. colorscale_position maps the value to a position: 0 and 1 are
 * the ends of the range. colorscale_at maps the position to a color, in linear RGB. There are three
 * kinds of scales:
 *
 * - A continuous scale interpolates the colors of its map.
 * - A scale with classes has one color per class.
 * - A scale with a qualitative map and without classes maps integers to the colors of the map
 *   [colorscale_selects_by_integer]. A map is qualitative if Colormap.separate is true.
 *
 * A value can be shown if it is not NAN and, on a logarithmic scale, above 0. An infinite value can
 * be shown: it is outside the range. */
#ifndef CORCAST_IMAGE_COLORSCALE_H
#define CORCAST_IMAGE_COLORSCALE_H

#include "base/base.h"
#include "image/colormap.h"

/* A color for values outside the range. If `given` is false, the default that ColorScale states is
 * used. */
typedef struct ScaleColor {
    bool given;
    float rgb[3]; /* linear */
} ScaleColor;

enum {
    COLORSCALE_MAX_BOUNDS = 64
}; /* maximum number of bounds; reason of the value not recorded */

/* A color scale. */
typedef struct ColorScale {
    const char *name; /* name of the quantity; borrowed; NULL: there is no scale */
    const char *unit; /* unit of the quantity; borrowed; "" for pure numbers */
    double range[2];  /* values at the ends of the map, ascending; above 0 with `log` */
    bool log;         /* the map is linear in the logarithm of the value */
    int classes;      /* 2 or more: number of classes, which divide the range into equal widths;
                       * below 2: no classes */
    /* Bounds between classes, ascending. They replace `classes`: n bounds make n + 1 classes. The
     * first class is below bounds[0], the last class begins at bounds[n - 1]. */
    double bounds[COLORSCALE_MAX_BOUNDS];
    int n_bounds;           /* number of bounds; 0: `classes` applies */
    ScaleColor under, over; /* colors of values below and above the range; default: the colors of
                             * the ends of the map. With bounds, they replace the colors of the
                             * first and of the last class; default: no replacement */
    ScaleColor none; /* color of values that cannot be shown; default: middle grey, 0.5 in sRGB */
    Colormap map;    /* released by the code that fills the scale */
} ColorScale;

/* Returns the position of a value on the scale: 0 and 1 at the ends of the range, less than 0 or
 * more than 1 for values outside. If both ends of the range are equal, the position is 0.5 +
 * value - range[0], of logarithms with `log`. Returns NAN for a value that cannot be shown. */
double colorscale_position(const ColorScale *scale, double value);
/* Returns the tolerance of positions: 1e-6; if both ends of the range are equal, 1e-6 of their
 * value, or of its logarithm. A position at most this far below a bound of two classes counts as on
 * the bound. A position at most this far outside the range counts as in the range.
 *
 * Reason: callers compute positions as weighted means. Rounding can move the mean of positions that
 * all lie on a bound to either side of the bound. */
double colorscale_tolerance(const ColorScale *scale);
/* Returns the position at which the class above bounds[i] begins: the position of the bound minus
 * the tolerance. */
double colorscale_bound(const ColorScale *scale, int i);
/* Return the lowest and the highest position that has neither the color `under` nor the color
 * `over`. Without bounds: 0 minus the tolerance, and 1 plus the tolerance. With bounds: the
 * positions at which the second and the last class begin [colorscale_bound]; the upper end is then
 * exclusive. */
double colorscale_lowest(const ColorScale *scale);
double colorscale_highest(const ColorScale *scale);

/* Sets the range to the smallest and the largest of the values that are finite and can be shown.
 * Returns false, and sets nothing, if there are no such values. `n` is the number of all values. */
bool colorscale_fit(ColorScale *scale, const double *values, size_t n);

/* Computes two percentiles of the values that are finite and can be shown. out[k] is the percentile
 * percent[k], 0 to 100, interpolated linearly between the neighbouring values. Both are NAN if
 * there are no such values. Errors: STATUS_MEMORY. Cost: O(n log n). */
MUST_CHECK Status colorscale_percentiles(const ColorScale *scale, const double *values, size_t n,
                                         const double percent[2], double out[2], Err *err);

/* Counts of values outside the range. */
typedef struct ScaleOutside {
    size_t below, above; /* values that have the colors `under` and `over` */
    size_t none;         /* values that cannot be shown */
} ScaleOutside;

/* Counts the values among `n` values that are outside the range. */
ScaleOutside colorscale_outside(const ColorScale *scale, const double *values, size_t n);

/* Returns the number of discrete colors of the scale: n_bounds + 1, or `classes`, or the number of
 * colors of a qualitative map. Returns 0 if the scale is continuous. */
int colorscale_steps(const ColorScale *scale);
/* Computes discrete color `step`, 0 <= step < colorscale_steps, in linear RGB. A qualitative map
 * gives its own colors. A continuous map is sampled at equidistant positions: color 0 at position
 * 0, the last color at position 1. */
void colorscale_step_color(const ColorScale *scale, int step, float rgb[3]);

/* Returns true if the scale maps integers to the colors of a qualitative map. */
bool colorscale_selects_by_integer(const ColorScale *scale);

/* Computes the color, in linear RGB, at a position of a scale for which
 * colorscale_selects_by_integer is false. A position on a bound, or at most colorscale_tolerance
 * below the bound, belongs to the class above the bound. NAN has the color `none`. */
void colorscale_at(const ColorScale *scale, double position, float rgb[3]);
/* Computes the color, in linear RGB, of a value on any scale. If colorscale_selects_by_integer, a
 * map of n colors gives 1 the first color, n the last, n + 1 again the first, and 0 the last. Other
 * values are rounded down to an integer. An infinite value has the first color. */
void colorscale_linear(const ColorScale *scale, double value, float rgb[3]);

/* A continuous color map in the form that POV-Ray uses: linear colors at COLORRAMP_ENTRIES
 * equidistant positions from 0 to 1, interpolated between them. */
enum { COLORRAMP_ENTRIES = 256 };
typedef struct ColorRamp {
    float position[COLORRAMP_ENTRIES];
    float rgb[COLORRAMP_ENTRIES][3];
} ColorRamp;

/* Samples the map at the positions of the ramp, as colormap_linear does. */
void colorramp_init(ColorRamp *ramp, const Colormap *map);
/* Computes what colorscale_at computes, but interpolates between the entries of `ramp`, as POV-Ray
 * does. colorramp_init must have filled `ramp` from scale->map. */
void colorscale_on_ramp(const ColorScale *scale, const ColorRamp *ramp, double position,
                        float rgb[3]);

/* Appends the name, the range and the unit, such as "wss 3.70 to 54.1 Pa". */
void colorscale_put_range(const ColorScale *scale, Text *text);

#endif
