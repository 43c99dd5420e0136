/* What vessels look like, whatever their shape and from wherever they are seen: colours and their
 * meaning, and finish. Colours are linear RGB. */
#ifndef CORCAST_SCENE_APPEARANCE_H
#define CORCAST_SCENE_APPEARANCE_H

#include "image/image.h"
#include <stdint.h>

typedef struct Rgb {
    float r, g, b;
} Rgb;

/* A colour on the way from one to another, at a part of it in [0, 1]. */
static inline Rgb rgb_mixed(Rgb from, Rgb to, double part)
{
    return (Rgb){(float)((double)from.r + ((double)to.r - (double)from.r) * part),
                 (float)((double)from.g + ((double)to.g - (double)from.g) * part),
                 (float)((double)from.b + ((double)to.b - (double)from.b) * part)};
}

/* POV-Ray's finish; METHODS section 3. */
typedef struct Finish {
    float ambient, diffuse, brilliance, phong, phong_size, specular, roughness;
} Finish;

/* Constant once made [stage_appearance]; fits every Geometry of the tree that it was made for, as
 * segments have the same numbers in all of them. */
typedef struct Appearance {
    Finish finish;
    Rgb color;         /* of all segments, if `colors` is NULL */
    Rgb *colors;       /* owned; one for each segment, by its number; or NULL */
    double *values;    /* owned; what `colors` stand for, NAN where there is none; or NULL */
    ColorScale scale;  /* what `colors` mean; its map is owned; zeroed without `colors` */
    char *name, *unit; /* of the scale; owned */
    size_t n_values;
    ScaleOutside outside; /* of the segments drawn */
    double *places;       /* owned; of the values on the scale, where colours blend; or NULL */
    ColorRamp *ramp;      /* owned; that they blend on; or NULL */
    char *said;  /* owned; what `colors` mean, for people: "wss 3.70 to 54.1 Pa, of ..."; or NULL */
    bool fitted; /* the range is that of values, and nobody's choice */
    /* Where colours change with time: `colors` and `values` are frame after frame of n_segments
     * each, and these are those of the first one. */
    double *time; /* owned; of each frame, upwards; NULL without frames */
    size_t n_frames, n_segments;
} Appearance;

void appearance_release(Appearance *appearance);

/* What vessels look like in a frame, from 0 on: borrowed from the appearance, and not to be
 * released. O(1). */
Appearance appearance_frame(const Appearance *appearance, size_t frame);

/* The linear colour of a place on the scale, where colours blend. */
Rgb appearance_blended(const Appearance *appearance, double place);

static inline Rgb appearance_color(const Appearance *appearance, uint32_t segment)
{
    return appearance->colors ? appearance->colors[segment] : appearance->color;
}

#endif
