/* Pictures of primitives by sampled surfaces and a depth buffer, as the paper draws them [N,
 * section 3]. */
#ifndef CORCAST_RENDER_ZBUFFER_H
#define CORCAST_RENDER_ZBUFFER_H

#include "render/job.h"

/* Draws a band of primitives into planes that are there, and adds the time it takes to *stats: one
 * sample a pixel, without shadows. STATUS_USAGE when the camera is among the vessels. */
MUST_CHECK Status zbuffer_render(const Drawing *drawing, Frame *frame, RenderStats *stats,
                                 Err *err);

#endif
