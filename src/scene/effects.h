/* Image effects: outlines, halos, a graded background and x-ray. `render` adds them to the shaded
 * picture or, for an x-ray, draws them in its place. POV-Ray has none of them. Widths are in
 * pixels, radii are those of the nearer vessel, colors are linear RGB. */
#ifndef CORCAST_SCENE_EFFECTS_H
#define CORCAST_SCENE_EFFECTS_H

#include "base/base.h"
#include "scene/appearance.h"

/* A line along the inside of a vessel's edge, where the vessel borders on the background or on
 * another vessel that lies deeper. */
typedef struct Outline {
    double width_px; /* 0: no outlines */
    double radii;    /* maximum width of the line in radii, so that thin vessels keep a color */
    double deeper;   /* another vessel lies deeper if it is this many radii behind */
    double crease_cosine; /* vessels that touch are separated by a line where the cosine between
                           * their normals is below this; -1: never */
    Rgb color;
} Outline;

/* A gap in the background's color around a vessel that is in front of another. */
typedef struct Halo {
    double width_px; /* 0: no halos */
    double radii;    /* maximum width of the gap in radii */
    double deeper;   /* another vessel is behind if it lies this many radii deeper */
} Halo;

/* A background whose color changes from the center of the picture to its corners, linearly with the
 * square of the distance from the center. Colors of a ground plane change by the same factors. */
typedef struct Grade {
    bool present;
    Rgb center, corners;
} Grade;

/* Absorption of light by the vessels [Beer and Lambert]. After L mm in vessels a fraction
 * exp(-per_mm L) of the background's color remains; the rest is `color`. */
typedef struct Xray {
    double per_mm; /* 0: no x-ray */
    Rgb color;
} Xray;

typedef struct Effects {
    Outline outline;
    Halo halo;
    Grade grade;
    Xray xray;
} Effects;

/* Appends the names of the effects that are on, which POV-Ray does not draw: "outlines and halos".
 * Appends nothing if a picture with these effects, and with ambient occlusion if `occlusion`, has
 * none. */
void effects_list(const Effects *effects, bool occlusion, Text *out);

/* Returns true if any effect is on. */
static inline bool effects_present(const Effects *effects)
{
    return effects->outline.width_px > 0 || effects->halo.width_px > 0 || effects->grade.present ||
           effects->xray.per_mm > 0;
}

/* Returns true if an effect is on that needs the vessel of each sample. */
static inline bool effects_have_shape(const Effects *effects)
{
    return effects->outline.width_px > 0 || effects->halo.width_px > 0 || effects->xray.per_mm > 0;
}

/* Returns the background's color at a position, in pixels from the upper left corner of a picture
 * of width x height pixels. */
static inline Rgb grade_at(const Grade *grade, double x, double y, double width, double height)
{
    const double from_x = 2 * x - width, from_y = 2 * y - height;
    const double part = (from_x * from_x + from_y * from_y) / (width * width + height * height);
    return rgb_mixed(grade->center, grade->corners, part);
}

#endif
