/* Pictures of the potential, tile by tile. */
#ifndef CORCAST_RENDER_FIELDRENDER_H
#define CORCAST_RENDER_FIELDRENDER_H

#include "render/band.h"
#include "render/caster.h"

/* renderer_rows() for implicit scenes, into planes that are there. `caster` is for shadows; NULL without.
 * Adds the seconds taken to *stats. */
MUST_CHECK Status fieldrender(const Scene *scene, const RenderParams *params, Caster *caster,
                              const Band *rows, Frame *frame, RenderStats *stats, Err *err);

#endif
