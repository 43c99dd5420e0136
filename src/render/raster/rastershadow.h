/* What stands between a light and the places that it may light. */
#ifndef CORCAST_RENDER_RASTERSHADOW_H
#define CORCAST_RENDER_RASTERSHADOW_H

#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"

/* The geometry as one light sees it; constant once built. */
typedef struct RasterShadow RasterShadow;

/* That of light i of the view in shadows[i], NULL where the light casts none or is too near to see
 * all of the geometry in one view, for places in the frame of `camera`. Borrows the geometry. The
 * shadows are the caller's even when this fails. */
MUST_CHECK Status rastershadows_new(const Geometry *geometry, const View *view,
                                    const RasterView *camera, int threads, RasterShadow **shadows,
                                    Err *err);
void rastershadow_free(RasterShadow *shadow);

/* Whether a light that casts shadows is too near for a RasterShadow. */
bool rastershadows_need_rays(const Geometry *geometry, const View *view);

/* Places that a light is asked about, of up to RASTER_BATCH tiles of the picture; a worker needs
 * one of its own for each light. */
typedef struct RasterQueue RasterQueue;

/* Borrows the shadow. The queue is the caller's even when this fails. */
MUST_CHECK Status rasterqueue_new(const RasterShadow *shadow, RasterQueue **out, Err *err);
void rasterqueue_free(RasterQueue *queue);

/* Asks about the places with a bit set in `wanted`, bit i for place i, which are on these items, as
 * in RasterHits and borrowed until the answer; that to place i is to be the one numbered answer +
 * i. */
void rasterqueue_ask(RasterQueue *queue, const RasterKernels *kernels, const RasterPlaces *places,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t answer);
/* Answers what was asked, and empties the queue: 1 where a primitive stands farther than POV-Ray's
 * 0.001 mm, or the rounding of the light's view, before the place, else 0. */
void rasterqueue_answer(RasterQueue *queue, const RasterKernels *kernels, uint8_t *shadowed);

#endif
