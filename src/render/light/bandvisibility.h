/* For each pixel of a band of an image, computes which fraction of the ambient light and of each
 * area light reaches the surface there. All samples of the pixel share this visibility;
 * visibility.h describes the result. If pixelvisibility_is_needed, call pixelvisibility_compute per
 * band. */
#ifndef CORCAST_RENDER_LIGHT_BANDVISIBILITY_H
#define CORCAST_RENDER_LIGHT_BANDVISIBILITY_H

#include "render/light/occlusion.h"
#include "render/light/offpixel.h"
#include "render/light/visibility.h"

/* Returns true if samples share visibility. Four conditions must hold: colors are wanted, the
 * method is not RENDER_TRACE, the view is not an x-ray, and ambient occlusion or soft shadows are
 * on. */
bool pixelvisibility_is_needed(const View *view, const RenderParams *params);

/* Number of rows of a block. The shading points of a block query an area light together. The
 * kernels of isosurfaces and blobs round differently if other shading points are queried together.
 * If a view has area lights, the caller of pixelvisibility_compute therefore passes a band of whole
 * blocks; the result then has the same bytes as that of the whole image. A larger block puts more
 * queries into one tile of a light view, and makes bands coarser. */
enum { VISIBILITY_BLOCK = 64 };

/* Draws the depth and normal planes of the drawing's band into *planes: one ray through each pixel
 * centre, vessels only. The caller releases *planes with frame_release, even after an error.
 * Errors: STATUS_MEMORY. */
typedef Status DrawVesselPlanes(const Drawing *drawing, void *context, Frame *planes, Err *err);

/* The inputs of pixelvisibility_compute. All are borrowed. */
typedef struct VisibilitySources {
    DrawVesselPlanes *draw_planes;
    void *context;                /* passed to draw_planes */
    const ShadowEngine *engine;   /* answers shadow queries to area lights. If it is NULL or does
                                   * not support a light, the drawing's caster traces shadow rays */
    const OccluderSet *occluders; /* the vessels that block ambient light; read only if occlusion is
                                   * on */
    OffPixelPoints *off_pixel;    /* shading points that are not the hit of a pixel's centre ray
                                   * [offpixel.h]; they receive their visibility of the area
                                   * lights, too; NULL: none */
} VisibilitySources;

/* Computes the visibility of all pixels of the drawing's band.
 *
 * The three rows next to an edge of the band are correct only if that edge is also an edge of the
 * image: ambient occlusion averages over 3 x 3 blocks of 2 x 2 pixels, which reach three rows. If
 * ambient occlusion is on, the band's first row must be even.
 *
 * out      receives the result; release it with pixelvisibility_free. Set on success only.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status pixelvisibility_compute(const Drawing *drawing, const VisibilitySources *sources,
                                          PixelVisibility **out, Err *err);

#endif
