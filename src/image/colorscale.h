/* Color scales: map the values of a quantity, such as pressures in mmHg, to colors. Included by the
 * public header image.h.
 *
 * A scale maps a value in two steps. colorscale_position maps the value to a position: 0 and 1 are
 * the ends of the range. colorscale_at maps the position to a color, in linear RGB. There are three
 * kinds of scales: continuous; with classes, each of one color; and scales whose values are
 * integers that select the colors of a separate map in turn [colorscale_selects_by_integer]. */
#ifndef CORCAST_IMAGE_COLORSCALE_H
#define CORCAST_IMAGE_COLORSCALE_H

#include "base/base.h"
#include "image/colormap.h"

/* A color for values that the map does not cover. If `given` is false, the default applies. */
typedef struct ScaleColor {
    bool given;
    float rgb[3]; /* linear */
} ScaleColor;

enum { COLORSCALE_MAX_BOUNDS = 64 };

typedef struct ColorScale {
    const char *name; /* of the quantity, borrowed; NULL: there is no scale */
    const char *unit; /* borrowed; "" for pure numbers */
    double range[2];  /* values at the ends of the map, ascending; above 0 with `log` */
    bool log;         /* the map is linear in the logarithm of the value */
    int classes;      /* N >= 2: N equal classes of one color each; else continuous */
    /* Bounds of classes, ascending. They replace `classes`: n bounds make n + 1 classes, the first
     * below bounds[0] and the last from bounds[n - 1] on. */
    double bounds[COLORSCALE_MAX_BOUNDS];
    int n_bounds;           /* 0: there are none */
    ScaleColor under, over; /* of values below and above the range, or all bounds; default: the
                             * colors of the ends */
    ScaleColor none;        /* of values that cannot be shown; default: middle grey */
    Colormap map;           /* owned by the maker of the scale */
} ColorScale;

/* Returns the position of a value on the scale: 0 and 1 at the ends of the range, and beyond them
 * for values outside the range. Returns 0.5 at the value of a range without width. Returns NAN for
 * a value that cannot be shown: NAN and, with `log`, values not above 0. */
double colorscale_position(const ColorScale *scale, double value);
/* Returns the tolerance of positions: a position this far below a bound of two classes is on the
 * bound, and one this far outside the range is in the range. A mean of positions that are all on a
 * bound may be rounded to either side, so every comparison with a bound allows for it. */
double colorscale_tolerance(const ColorScale *scale);
/* Returns the position where the class above bounds[i] begins, slack included. */
double colorscale_bound(const ColorScale *scale, int i);
/* Return the positions between which values have neither the color `under` nor the color `over`.
 * Both include the slack. */
double colorscale_lowest(const ColorScale *scale);
double colorscale_highest(const ColorScale *scale);

/* Sets the range to the minimum and maximum of the `n` values that the scale can show: those that
 * are finite and, with `log`, above 0. Returns false, and sets nothing, if there are none. */
bool colorscale_fit(ColorScale *scale, const double *values, size_t n);

/* Computes two percentiles, percent[k] in 0 .. 100, of the values that the scale can show,
 * interpolated between neighbours; NAN if it can show none. Errors: STATUS_MEMORY. Cost:
 * O(n log n). */
MUST_CHECK Status colorscale_percentiles(const ColorScale *scale, const double *values, size_t n,
                                         const double percent[2], double out[2], Err *err);

/* Numbers of values below and above the range, and of values that cannot be shown. */
typedef struct ScaleOutside {
    size_t below, above, none;
} ScaleOutside;
ScaleOutside colorscale_outside(const ColorScale *scale, const double *values, size_t n);

/* Returns the number of separate colors of the scale, which its bounds, its classes or a separate
 * map determine; 0 if the scale is continuous. */
int colorscale_steps(const ColorScale *scale);
/* Computes the color, in linear RGB, of separate color `step`, counted from 0. The classes of a
 * continuous map are spread over the whole map, including its ends. */
void colorscale_step_color(const ColorScale *scale, int step, float rgb[3]);

/* Returns true if integers select the colors of a separate map, from 1 on, modulo the number of
 * colors. */
bool colorscale_selects_by_integer(const ColorScale *scale);

/* Computes the color, in linear RGB, at a position. Not for scales of which
 * colorscale_selects_by_integer is true. A position on a bound, or up to colorscale_tolerance below
 * the bound, belongs to the class above. */
void colorscale_at(const ColorScale *scale, double place, float rgb[3]);
/* Computes the color, in linear RGB, of a value on any scale. */
void colorscale_linear(const ColorScale *scale, double value, float rgb[3]);

/* A continuous color map in the form of POV-Ray: linear colors at equidistant positions from 0 to
 * 1, interpolated between them. */
enum { COLORRAMP_ENTRIES = 256 };
typedef struct ColorRamp {
    float position[COLORRAMP_ENTRIES];
    float rgb[COLORRAMP_ENTRIES][3];
} ColorRamp;

void colorramp_init(ColorRamp *ramp, const Colormap *map);
/* Computes what colorscale_at computes, but interpolates between the entries of `ramp`, as POV-Ray
 * does. colorramp_init must have filled `ramp` from scale->map. */
void colorscale_on_ramp(const ColorScale *scale, const ColorRamp *ramp, double place, float rgb[3]);

/* Appends "wss 3.70 to 54.1 Pa". */
void colorscale_put_range(const ColorScale *scale, Text *text);

#endif
