/* Image effects that show depth: outlines, halos, a graded background and x-ray. The module render
 * adds outlines, halos and the background to the shaded picture; an x-ray replaces the shading.
 * POV-Ray has none of these effects. Lengths are in pixels, or are multiples of a vessel's radius.
 * If two vessels overlap, the multiples refer to the radius of the vessel nearer to the camera.
 * Colors are linear RGB. */
#ifndef CORCAST_SCENE_EFFECTS_H
#define CORCAST_SCENE_EFFECTS_H

#include "base/base.h"
#include "scene/appearance.h"

/* A line along the inside of a vessel's silhouette. It is drawn where the vessel borders on the
 * background, or on another vessel that is farther from the camera. */
typedef struct Outline {
    double width_px;      /* 0: no outlines */
    double radii;         /* maximum width of the line, as a multiple of the vessel's radius, so
                           * that the line does not cover a thin vessel */
    double deeper;        /* minimum difference in depth between the two vessels, as a multiple of
                           * the radius */
    double crease_cosine; /* a line separates two vessels that touch if the cosine of the angle
                           * between their normals is below this; -1: never */
    Rgb color;
} Outline;

/* A gap, in the color of the background, around a vessel that is in front of another vessel. */
typedef struct Halo {
    double width_px; /* 0: no halos */
    double radii;    /* maximum width of the gap, as a multiple of the vessel's radius */
    double deeper;   /* minimum difference in depth between the two vessels, as a multiple of the
                      * radius */
} Halo;

/* A background whose color changes from the center of the picture to its corners. The mixture is
 * linear in the square of the distance from the center. The color of a ground plane is
 * multiplied, per channel, by the background's color there / `center`. */
typedef struct Grade {
    bool present; /* false: the background has one color */
    Rgb center, corners;
} Grade;

/* Absorption of light by the vessels, by the Beer-Lambert law. After L mm inside vessels, the
 * fraction exp(-per_mm * L) of the background's color remains; `color` replaces the rest. */
typedef struct Xray {
    double per_mm; /* 0: no x-ray */
    Rgb color;
} Xray;

/* The effects of one picture. A zeroed Effects has none. */
typedef struct Effects {
    Outline outline;
    Halo halo;
    Grade grade;
    Xray xray;
} Effects;

/* Appends the names of the effects that are on, for a message that POV-Ray lacks them: "outlines
 * and halos". Adds "ambient occlusion" to the list if `occlusion` is true. Appends nothing if none
 * is on. */
void effects_list(const Effects *effects, bool occlusion, Text *out);

/* Returns true if any effect is on. */
static inline bool effects_present(const Effects *effects)
{
    return effects->outline.width_px > 0 || effects->halo.width_px > 0 || effects->grade.present ||
           effects->xray.per_mm > 0;
}

/* Returns true if an effect is on that needs the id of the vessel that each sample shows. */
static inline bool effects_need_ids(const Effects *effects)
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
