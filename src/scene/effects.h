/* What is drawn over the shaded picture, or in its place; no picture of POV-Ray has it. Widths are
 * in pixels of the picture, radii those of the vessel in front, colours linear RGB. */
#ifndef CORCAST_SCENE_EFFECTS_H
#define CORCAST_SCENE_EFFECTS_H

#include "base/base.h"
#include "scene/appearance.h"

/* A line along the inside of a vessel's edge: where it ends before the paper, or before another
 * vessel that lies deeper. */
typedef struct Outline {
    double width_px; /* 0: no outlines */
    double radii;  /* the line is at most this wide in radii, so that thin vessels keep a colour */
    double deeper; /* another vessel lies deeper if it is this many radii behind */
    double crease_cosine; /* vessels that touch are parted by a line where the cosine between their
                           * normals is below this; -1: never */
    Rgb color;
} Outline;

/* A gap in the colour of the paper about a vessel in front of another. */
typedef struct Halo {
    double width_px; /* 0: no halos */
    double radii;    /* the gap is at most this wide in radii */
    double deeper;   /* what is this many radii deeper is behind it */
} Halo;

/* The part of the paper's colour that vessels have, rising with their depth along the ray from
 * `nearest` at near_mm to `farthest` at far_mm. */
typedef struct Fade {
    double nearest, farthest; /* in [0, 1]; both 0: vessels do not fade */
    double near_mm, far_mm;   /* near < far, where vessels fade */
} Fade;

/* The light that comes through the vessels [Beer and Lambert]: exp(-per_mm L) of the paper's colour
 * after L mm inside them, and of `color` the rest. */
typedef struct Xray {
    double per_mm; /* 0: no x-ray */
    Rgb color;
} Xray;

typedef struct Effects {
    Outline outline;
    Halo halo;
    Fade fade;
    Xray xray;
} Effects;

/* Appends what there is: "outlines and halos", or nothing. */
void effects_list(const Effects *effects, Text *out);

/* Whether there is any. */
static inline bool effects_present(const Effects *effects)
{
    return effects->outline.width_px > 0 || effects->halo.width_px > 0 ||
           effects->fade.nearest > 0 || effects->fade.farthest > 0 || effects->xray.per_mm > 0;
}

/* Whether there are some that need to know which vessel each sample is of. */
static inline bool effects_have_shape(const Effects *effects)
{
    return effects->outline.width_px > 0 || effects->halo.width_px > 0 || effects->xray.per_mm > 0;
}

/* The part of the paper's colour that a vessel has at a depth. */
static inline double fade_at(const Fade *fade, double depth_mm)
{
    double part = (depth_mm - fade->near_mm) / (fade->far_mm - fade->near_mm);
    part = part < 0 ? 0 : part > 1 ? 1 : part;
    return fade->nearest + (fade->farthest - fade->nearest) * part;
}

#endif
