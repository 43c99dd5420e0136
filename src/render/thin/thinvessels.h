/* Draws thin vessels: vessels so narrow in the picture that the samples of pixels may miss them. A
 * thin vessel is projected to a strip [thincells.h], which is cut into pieces of one color each. A
 * piece contributes to a pixel in proportion to the area of the pixel that it covers.
 *
 *     TRY(thinvessels_find(&geometry, &camera, widths, threads, &thin, err));
 *     TRY(thinvessels_find_ambient(&drawing, &occluders, &thin, err));
 *     thinvessels_color(&drawing, &thin);
 *     TRY(thinvessels_draw(&drawing, &thin, &frame, err));
 *     thinvessels_release(&thin);
 *
 * The second call is needed only if ambient occlusion is on. With shadows, offpixel_init and
 * offpixel_query or offpixel_trace for thin.lights come before the third. */
#ifndef CORCAST_RENDER_THIN_THINVESSELS_H
#define CORCAST_RENDER_THIN_THINVESSELS_H

#include "base/base.h"
#include "render/job.h"
#include "render/light/occlusion.h"
#include "render/light/offpixel.h"
#include "render/tile/thincells.h"

/* The thin vessels of a geometry in one view, and the light that reaches them. */
typedef struct ThinVessels {
    const Geometry *whole;  /* borrowed */
    Camera camera;          /* a copy of the caller's camera */
    ThinLayer layer;        /* the strips; `colors` are set by thinvessels_color */
    uint32_t *piece_strips; /* per piece: index of its strip; owned */
    OffPixelPoints lights; /* shading points of the pieces. If lights cast shadows, the caller fills
                            * their n_visible [offpixel.h] before thinvessels_color */
    float *ambient;        /* per piece: ambient visibility, 0 to 1; owned. NULL: all are 1. */
} ThinVessels;

/* Widths on the picture, pixels. */
typedef struct ThinWidths {
    double below_px;     /* vessels narrower than this are thin */
    double min_width_px; /* vessels narrower than this are thin, too, and are drawn with this width;
                          * 0: all are drawn with their true widths */
} ThinWidths;

/* Finds the vessels that are narrower than one of the two widths in this view. Triangles are never
 * thin. A vessel with an end behind a perspective camera is not thin.
 *
 * whole     borrowed.
 * thin      receives the vessels; release it with thinvessels_release. It must not be moved,
 *           because `lights` contains its address.
 * Errors    STATUS_MEMORY.
 * Cost      O(n); the result does not depend on `threads`. */
MUST_CHECK Status thinvessels_find(const Geometry *whole, const Camera *camera, ThinWidths widths,
                                   int threads, ThinVessels *thin, Err *err);
void thinvessels_release(ThinVessels *thin);

/* Sets thin->ambient, the ambient visibility of each piece. `occluders` are the vessels that block
 * ambient light; drawing->params->occlusion is the number of occlusion directions. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status thinvessels_find_ambient(const Drawing *drawing, const OccluderSet *occluders,
                                           ThinVessels *thin, Err *err);

/* Computes the colors of the pieces whose strips may touch the drawing's band, from the current
 * thin->lights and thin->ambient. Writes only the elements of layer.colors. */
void thinvessels_color(const Drawing *drawing, const ThinVessels *thin);

/* Draws the vessels over the colors of a frame. The frame must have a depth plane, with depths
 * along the rays, and the rows of the drawing's band, one sample per pixel. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status thinvessels_draw(const Drawing *drawing, const ThinVessels *thin, Frame *frame,
                                   Err *err);

#endif
