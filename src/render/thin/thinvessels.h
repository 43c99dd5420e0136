/* Vessels thinner than a pixel, drawn by the part of each pixel that they cover. */
#ifndef CORCAST_RENDER_THINVESSELS_H
#define CORCAST_RENDER_THINVESSELS_H

#include "base/base.h"
#include "image/image.h"
#include "render/job.h"
#include "render/sky/lonelight.h"
#include "scene/scene.h"

/* A vessel as the picture shows it: a strip about a line, in pixels from the left and the top. */
typedef struct ThinStrip {
    float x[2], y[2], depth_mm[2]; /* of both ends of its axis; depth as planes have it */
    float width;                   /* of the vessel, pixels */
    uint32_t vessel;               /* index of its primitive, or of its segment of a field */
    uint32_t run;                  /* the same for vessels that follow one another end to end */
} ThinStrip;

/* The thin vessels of a geometry in one view. */
typedef struct ThinVessels {
    const Geometry *whole; /* borrowed */
    Camera camera;         /* bit by bit as it was given */
    bool *is_thin;         /* owned; by vessel, as strips have it */
    ThinStrip *strips;     /* owned; by rising vessel */
    size_t n;
    double least_px; /* strips are drawn at least so wide; 0: as wide as they are */
    double below_px; /* narrower vessels are thin */
} ThinVessels;

void thinvessels_release(ThinVessels *thin);

/* The vessels of `whole` that the camera sees in front of it narrower than a pixel, or than
 * `least_px` if that is more, in *thin (owned); `whole` is borrowed. At least the widest of all
 * vessels is not among them. Triangles are never thin. Of a `least_px` from 0 to 64. O(n), on so
 * many threads, which do not change the result. STATUS_MEMORY. */
MUST_CHECK Status thinvessels_find(const Geometry *whole, const Camera *camera, double least_px,
                                   int threads, ThinVessels *thin, Err *err);

/* The geometry without the thin vessels, and without balls as thin as they, in *thick (owned):
 * with the ids and the bounds of the whole. O(n log n). STATUS_MEMORY. */
MUST_CHECK Status thinvessels_rest(const ThinVessels *thin, Geometry *thick, Err *err);

/* What asks the lights for the thin vessels: a place of each strip, which borrow *thin, and no
 * lights yet. */
LonePlaces thinvessels_places(const ThinVessels *thin);

/* Draws the thin vessels over the band's colours, where they lie in front of its depths. `lone` has
 * the lights that reach the places of theirs; NULL: nothing casts shadows. STATUS_MEMORY.
 * O(vessels + what they cover). */
MUST_CHECK Status thinvessels_draw(const ThinVessels *thin, const LonePlaces *lone,
                                   const Drawing *drawing, Frame *frame, Err *err);

#endif
