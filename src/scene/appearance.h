/* The appearance of vessels, which depends neither on geometry nor on view: colors, what they
 * stand for, and finish. Colors are linear RGB. */
#ifndef CORCAST_SCENE_APPEARANCE_H
#define CORCAST_SCENE_APPEARANCE_H

#include "image/image.h"
#include <stdint.h>

typedef struct Rgb {
    float r, g, b;
} Rgb;

/* Returns the linear mixture of two colors: `from` if part is 0, `to` if part is 1. */
static inline Rgb rgb_mixed(Rgb from, Rgb to, double part)
{
    return (Rgb){(float)((double)from.r + ((double)to.r - (double)from.r) * part),
                 (float)((double)from.g + ((double)to.g - (double)from.g) * part),
                 (float)((double)from.b + ((double)to.b - (double)from.b) * part)};
}

/* The parameters of POV-Ray's `finish` [METHODS section 3]. */
typedef struct Finish {
    float ambient, diffuse, brilliance, phong, phong_size, specular, roughness;
} Finish;

/* Immutable once made [stage_appearance]. It fits every Geometry of the same tree, because a
 * segment has the same index in all of them. All pointers are owned. */
typedef struct Appearance {
    Finish finish;
    Rgb color;         /* color of all segments if `colors` is NULL */
    Rgb *colors;       /* per segment index; NULL: all have `color` */
    double *values;    /* per segment index: the value its color stands for, or NAN; NULL: none */
    ColorScale scale;  /* from values to colors; zeroed if `colors` is NULL */
    char *name, *unit; /* of the field that the scale shows: "wss", "Pa" */
    size_t n_values;   /* number of entries of `values`, in all frames */
    ScaleOutside outside; /* number of drawn segments whose value is outside the scale */
    double *positions;    /* per segment index: the value's position on the scale, if colors
                           * blend [stage_blend]; else NULL */
    ColorRamp *ramp;      /* the colors that positions are mapped to, if colors blend; else NULL */
    char *meaning; /* the meaning of the colors in words: "wss 3.70 to 54.1 Pa, of ..."; or NULL */
    bool fitted;   /* the range of the scale was computed from values, and not specified */
    /* If colors change with time, `colors`, `values` and `positions` hold n_frames frames one
     * after another, of n_segments entries each. */
    double *time; /* per frame: its time, rising; NULL: colors do not change */
    size_t n_frames, n_segments;
    /* Per segment index and frame, as `values`: the factor of the radius in a picture of beating
     * vessels; NULL: the vessels do not beat. */
    double *widths;
} Appearance;

/* Frees the arrays and zeroes *appearance. */
void appearance_release(Appearance *appearance);

/* Returns the appearance in frame `frame`. The result borrows from `appearance` and must not be
 * released. O(1). */
Appearance appearance_frame(const Appearance *appearance, size_t frame);

/* Returns the linear color at a position on the scale. Requires that colors blend. */
Rgb appearance_blended(const Appearance *appearance, double position);

/* Returns the linear color of a segment, given by its index. */
static inline Rgb appearance_color(const Appearance *appearance, uint32_t segment)
{
    return appearance->colors ? appearance->colors[segment] : appearance->color;
}

#endif
