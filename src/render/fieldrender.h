/* Pictures of the potential, tile by tile. */
#ifndef CORCAST_RENDER_FIELDRENDER_H
#define CORCAST_RENDER_FIELDRENDER_H

#include "render/render.h"

/* render() for implicit scenes, into planes that are there. `stats` may be NULL. */
MUST_CHECK Status fieldrender(const Scene *scene, const RenderParams *params, Frame *frame,
                              RenderStats *stats, Err *err);

#endif
