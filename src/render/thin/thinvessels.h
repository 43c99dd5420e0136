/* Draws thin vessels: those that are narrower than the spacing of samples. A thin vessel
 * contributes to a pixel in proportion to the area that it covers [render/tile/thincells.h]. */
#ifndef CORCAST_RENDER_THINVESSELS_H
#define CORCAST_RENDER_THINVESSELS_H

#include "base/base.h"
#include "render/job.h"
#include "render/light/occluders.h"
#include "render/light/offpixel.h"
#include "render/tile/thincells.h"

/* The thin vessels of a geometry in one view, and the light that reaches them. */
typedef struct ThinVessels {
    const Geometry *whole;  /* borrowed */
    Camera camera;          /* a copy of the caller's camera */
    ThinLayer layer;        /* has no colors before thinvessels_color */
    uint32_t *piece_strips; /* per piece: index of its strip; owned */
    OffPixelPoints lights;  /* shading points of the pieces; no lights before offpixel_init */
    float *ambient;         /* per piece: ambient visibility, 0 to 1; owned. NULL: all are 1. */
} ThinVessels;

/* Widths on the picture, pixels. */
typedef struct ThinWidths {
    double below_px;     /* narrower vessels are thin */
    double min_width_px; /* so are these, and are drawn this wide; 0: at their true widths */
} ThinWidths;

/* Finds the vessels that are narrower than one of the two widths in this view. Triangles are never
 * thin, and neither is a vessel with an end behind a perspective camera.
 *
 * whole     borrowed.
 * thin      receives the vessels; release it with thinvessels_release.
 * Errors    STATUS_MEMORY.
 * Cost      O(n); the result does not depend on `threads`. */
MUST_CHECK Status thinvessels_find(const Geometry *whole, const Camera *camera, ThinWidths widths,
                                   int threads, ThinVessels *thin, Err *err);
void thinvessels_release(ThinVessels *thin);

/* Finds the ambient visibility of the pieces, by `drawing->params->occlusion` occlusion directions.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status thinvessels_find_ambient(const Drawing *drawing, const OccluderSet *occluders,
                                           ThinVessels *thin, Err *err);

/* Sets the colors of pieces whose strips may touch the drawing's band. Uses thin->lights and
 * thin->ambient as they are now. */
void thinvessels_color(const Drawing *drawing, const ThinVessels *thin);

/* Points thin->lights to the shading points of the pieces; it has no lights yet. */
void thinvessels_init_lights(ThinVessels *thin);

/* Draws the vessels over the colors of a frame that has depths along the rays. The frame has the
 * drawing's band, one sample per pixel. Errors: STATUS_MEMORY. */
MUST_CHECK Status thinvessels_draw(const Drawing *drawing, const ThinVessels *thin, Frame *frame,
                                   Err *err);

#endif
