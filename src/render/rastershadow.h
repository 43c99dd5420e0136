/* What stands between a light and the places that it may light. */
#ifndef CORCAST_RENDER_RASTERSHADOW_H
#define CORCAST_RENDER_RASTERSHADOW_H

#include "render/rasterkernels.h"
#include "render/rasterview.h"

/* The scene as one light sees it; constant once built. */
typedef struct RasterShadow RasterShadow;

/* Whether the light sees all of the scene in one view: it is parallel, or well outside. */
bool rastershadow_can(const Scene *scene, const Light *light);

/* For places in the frame of `camera`. Borrows the scene, which must not change;
 * rastershadow_can(). */
MUST_CHECK Status rastershadow_new(const Scene *scene, const Light *light, const RasterView *camera,
                                   int threads, RasterShadow **out, Err *err);
void rastershadow_free(RasterShadow *shadow);

/* Of the places with a bit set in `wanted`, bit i for place i, sets shadowed[i] to 1 where a
 * primitive stands farther than POV-Ray's 0.001 mm, or the rounding of the light's view, before
 * them, and to 0 elsewhere. */
void rastershadow_test(const RasterShadow *shadow, const RasterKernels *kernels,
                       const RasterPlaces *places, uint64_t wanted, uint8_t shadowed[TILE_SAMPLES]);

#endif
