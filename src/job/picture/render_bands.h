/* Two helpers of rendering_draw and rendering_draw_view [render.h], which draw a picture in bands
 * of rows: the height of a band, and the statistics. Each band is written or copied before the next
 * one is drawn. */
#ifndef CORCAST_JOB_PICTURE_RENDER_BANDS_H
#define CORCAST_JOB_PICTURE_RENDER_BANDS_H

#include "job/picture/render.h"

/* Returns the number of rows of a band, so that a band takes about `memory_mb` or less, in MB of
 * 10^6 bytes.
 * params  NULL: no memory is counted for sharing the visibility of lights between pixels.
 * view    NULL: there are no area lights. */
int render_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
                     double memory_mb);

/* Returns the statistics summed over all pictures drawn so far. */
RenderStats render_stats(const Rendering *rendering);

#endif
