/* Shadows of primitives: whether something stands between a light and a place. */
#ifndef CORCAST_RENDER_RASTERSHADOW_H
#define CORCAST_RENDER_RASTERSHADOW_H

#include "render/light/lightview.h"
#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"

/* The geometry as one light sees it; constant once built. */
typedef struct RasterShadow RasterShadow;

/* That of light i of the view in shadows[i], NULL where the light casts none, is an area light, or
 * no one view of it sees all of the geometry; for places in the frame of `camera`. Borrows the
 * geometry. The shadows are the caller's even when this fails. */
MUST_CHECK Status rastershadows_new(const Geometry *geometry, const View *view,
                                    const Viewpoint *camera, int threads, RasterShadow **shadows,
                                    Err *err);
void rastershadow_free(RasterShadow *shadow);

/* Whether a light that casts shadows has points from which no one view sees all of the geometry. */
bool rastershadows_need_rays(const Geometry *geometry, const View *view);

/* Shadow queries to one light, for the places of up to SHADOW_BATCH tiles of the picture. They are
 * answered together because places that lie in one tile of the light share its list. Not
 * thread-safe: each worker has a queue of its own for each light. */
typedef struct RasterQueue RasterQueue;

/* Makes an empty queue for a shadow that is borrowed. *out is the caller's even when this fails.
 * STATUS_MEMORY. */
MUST_CHECK Status rasterqueue_new(const RasterShadow *shadow, RasterQueue **out, Err *err);
void rasterqueue_free(RasterQueue *queue);

/* Adds a query for each place i whose bit is set in `wanted`; place i lies on items[i], as in
 * RasterHits. `items` is NULL where that is not known, in all calls between two answers or in none
 * of them. It is borrowed until rasterqueue_answer, which writes the answer for place i to
 * shadowed[answer + i]. At most SHADOW_BATCH calls between two answers. */
void rasterqueue_ask(RasterQueue *queue, const TileKernels *kernels, const SeenPlaces *places,
                     const uint32_t items[TILE_SAMPLES], uint64_t wanted, uint32_t answer);
/* Answers all queries and empties the queue. An answer is 1 if a primitive stands between the light
 * and the place, by more than POV-Ray's 0.001 mm or the rounding of the light's view, else 0.
 * Answers that were not asked for are left alone. */
void rasterqueue_answer(RasterQueue *queue, const RasterKernels *kernels, uint8_t *shadowed);

/* All of this for those who ask by places alone, whatever items these lie on. */
extern const LightViews raster_lights;

#endif
