/* The colors of vessels, the values that the colors show, and the finish of the surface. An
 * Appearance is independent of the shape of the vessels and of the view. stage_appearance
 * [stage/stage.h] builds it. Colors are linear RGB. */
#ifndef CORCAST_SCENE_APPEARANCE_H
#define CORCAST_SCENE_APPEARANCE_H

#include "image/image.h"
#include <stdint.h>

typedef struct Rgb {
    float r, g, b;
} Rgb;

/* Interpolates linearly between two colors: returns `from` if `fraction` is 0, `to` if it is 1. */
static inline Rgb rgb_mixed(Rgb from, Rgb to, double fraction)
{
    return (Rgb){(float)((double)from.r + ((double)to.r - (double)from.r) * fraction),
                 (float)((double)from.g + ((double)to.g - (double)from.g) * fraction),
                 (float)((double)from.b + ((double)to.b - (double)from.b) * fraction)};
}

/* The parameters of POV-Ray's `finish` [METHODS section 3]. */
typedef struct Finish {
    float ambient, diffuse, brilliance, phong, phong_size, specular, roughness;
} Finish;

/* The appearance of the segments of a tree. Does not change after stage_appearance has built it. It
 * fits every Geometry of the same tree, because a segment has the same index in all of them. All
 * pointers are owned. */
typedef struct Appearance {
    Finish finish;
    Rgb color;            /* color of all segments if `colors` is NULL */
    Rgb *colors;          /* per segment index: its color; NULL: all segments have `color` */
    double *values;       /* per segment index: the value that its color shows, or NAN; NULL: no
                           * values */
    ColorScale scale;     /* maps values to colors; zeroed if `colors` is NULL */
    char *name, *unit;    /* name and unit of the field that the scale shows, such as "wss" and
                           * "Pa" */
    size_t n_values;      /* number of elements of `values`, NAN or not, in all frames together */
    ScaleOutside outside; /* counts of the drawn segments, over all frames, whose value is outside
                           * the scale */
    double *positions;    /* per segment index: position of its value on the scale
                           * [colorscale_position]. Set by stage_blend if colors change smoothly
                           * where segments meet: positions are interpolated there, and `ramp` gives
                           * the color. NULL: each segment has one color */
    ColorRamp *ramp;      /* color by position; NULL if `positions` is NULL */
    char *meaning;        /* legend in words: "wss 3.70 to 54.1 Pa, of ..."; NULL: none */
    bool fitted;          /* true: the range of the scale was computed from values; false: it was
                           * specified */
    /* The frames of an appearance that changes with time. `colors`, `values`, `positions` and
     * `radius_factors` then hold n_frames blocks of n_segments entries. */
    double *time;    /* per frame: its time, ascending, in the unit of the field's times; NULL:
                      * nothing changes with time */
    size_t n_frames; /* 0: nothing changes with time */
    size_t n_segments;
    /* per frame and segment index: the factor of the segment's radius in a picture of pulsating
     * vessels; NULL: radii do not change */
    double *radius_factors;
} Appearance;

/* Frees the arrays and zeroes *appearance. */
void appearance_release(Appearance *appearance);

/* Returns the appearance in frame `frame`, counted from 0, as an appearance without frames. `frame`
 * must be below n_frames; it is ignored if n_frames is 0. The result borrows from `appearance` and
 * must not be released. O(1). */
Appearance appearance_frame(const Appearance *appearance, size_t frame);

/* Returns the color at a position on the scale. `positions` and `ramp` must not be NULL. */
Rgb appearance_blended(const Appearance *appearance, double position);

/* Returns the color of a segment, given by its index. */
static inline Rgb appearance_color(const Appearance *appearance, uint32_t segment)
{
    return appearance->colors ? appearance->colors[segment] : appearance->color;
}

#endif
