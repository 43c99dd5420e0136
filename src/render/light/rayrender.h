/* Pictures ray by ray. */
#ifndef CORCAST_RENDER_RAYRENDER_H
#define CORCAST_RENDER_RAYRENDER_H

#include "render/cast/caster.h"
#include "render/job.h"

/* Draws the band into planes that are there, one worker a row at a time, with the workspaces of the
 * drawing's caster for as many workers, and adds the seconds taken to *stats. STATUS_MEMORY. */
MUST_CHECK Status rayrender(const Drawing *drawing, Frame *frame, RenderStats *stats, Err *err);

#endif
