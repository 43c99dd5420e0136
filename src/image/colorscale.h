/* What colours mean: a scale from the values of a quantity to colours. */
#ifndef CORCAST_IMAGE_COLORSCALE_H
#define CORCAST_IMAGE_COLORSCALE_H

#include "base/base.h"
#include "image/colormap.h"

/* A colour of its own for values that the map has none for. */
typedef struct ScaleColor {
    bool given;
    float rgb[3]; /* linear */
} ScaleColor;

enum { COLORSCALE_MOST_BOUNDS = 64 };

typedef struct ColorScale {
    const char *name; /* of the quantity, borrowed; NULL: there is no scale */
    const char *unit; /* borrowed; "" for pure numbers */
    double range[2];  /* values at the ends of the map, ascending; above 0 with `log` */
    bool log;         /* equal steps of the map are equal ratios of values */
    int classes;      /* N >= 2: the range is N equal steps of one colour each; else continuous */
    /* Or classes between bounds, ascending: below the first, from each to the next, and from the
     * last on. */
    double bounds[COLORSCALE_MOST_BOUNDS];
    int n_bounds;           /* 0: there are none */
    ScaleColor under, over; /* of values below and above the range, or all bounds; else the ends' */
    ScaleColor none;        /* of values that cannot be shown; else middle grey */
    Colormap map;           /* owned by who made the scale */
} ColorScale;

/* The place of a value on the scale, 0 and 1 at the ends of the range; NAN for one that cannot be
 * shown, which is NAN or with `log` not above 0. A range without width has 0.5 at its one value. */
double colorscale_place(const ColorScale *scale, double value);
/* Returns how far below a bound of two classes, and how far outside the range, a place still counts
 * as on the bound or in the range. A mean of places that are all on a bound is rounded to either
 * side of the bound; every comparison with a bound allows for this much. */
double colorscale_slack(const ColorScale *scale);
/* Returns the place from which on values belong to the class above bounds[i], slack included. */
double colorscale_bound(const ColorScale *scale, int i);
/* Values between these two places have neither the colour `under` nor the colour `over`. Both
 * include the slack. */
double colorscale_lowest(const ColorScale *scale);
double colorscale_highest(const ColorScale *scale);

/* Sets the range from the least to the greatest of `n` values that the scale can show: finite, and
 * above 0 with `log`. False, and nothing is set, when there is none. */
bool colorscale_fit(ColorScale *scale, const double *values, size_t n);

/* Two percentiles, percent[k] in 0 .. 100, of the values that the scale can show, interpolated
 * between neighbours; NAN when it can show none. O(n log n). STATUS_MEMORY. */
MUST_CHECK Status colorscale_percentiles(const ColorScale *scale, const double *values, size_t n,
                                         const double percent[2], double out[2], Err *err);

/* How many values lie below and above the range, and how many cannot be shown. */
typedef struct ScaleOutside {
    size_t below, above, none;
} ScaleOutside;
ScaleOutside colorscale_outside(const ColorScale *scale, const double *values, size_t n);

/* Into how many colours the scale is cut: by its bounds, its classes, or a separate map; 0: colours
 * run on. */
int colorscale_steps(const ColorScale *scale);
/* The linear colour of a step, from 0 on. Those of a map that runs on are spread over all of it,
 * its ends included. */
void colorscale_step_color(const ColorScale *scale, int step, float rgb[3]);

/* Whether whole numbers count the colours of a separate map, from 1 on, round and round. */
bool colorscale_counts(const ColorScale *scale);

/* Writes the linear colour of a place on a scale that does not count colours. A value on a bound,
 * or up to colorscale_slack below the bound, belongs to the class above. */
void colorscale_at(const ColorScale *scale, double place, float rgb[3]);
/* The linear colour of a value. */
void colorscale_linear(const ColorScale *scale, double value, float rgb[3]);

/* Colours that run on as POV-Ray's colour maps hold them: at places of equal distances from 0 to 1,
 * between which linear colours are interpolated. */
enum { COLORRAMP_ENTRIES = 256 };
typedef struct ColorRamp {
    float place[COLORRAMP_ENTRIES];
    float rgb[COLORRAMP_ENTRIES][3];
} ColorRamp;

void colorramp_init(ColorRamp *ramp, const Colormap *map);
/* As colorscale_at, but of colours that run on the ramp's, which was made of the scale's map. */
void colorscale_on_ramp(const ColorScale *scale, const ColorRamp *ramp, double place, float rgb[3]);

/* Appends "wss 3.70 to 54.1 Pa". */
void colorscale_put_range(const ColorScale *scale, Text *text);

#endif
