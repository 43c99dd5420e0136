/* Draws pictures in bands of rows. Each band is written or copied before the next one is drawn.
 * This header has two helpers; the functions that draw are rendering_draw and rendering_draw_view,
 * which render.h declares. */
#ifndef CORCAST_JOB_PICTURE_RENDER_BANDS_H
#define CORCAST_JOB_PICTURE_RENDER_BANDS_H

#include "job/picture/render.h"

/* Returns the number of rows of a band, so that a band takes about `memory_mb` or less, in MB of
 * 10^6 bytes.
 *
 * params  NULL: pixels do not share visibility of lights, which takes memory.
 * view    NULL: there are no area lights. */
int render_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
                     double memory_mb);

/* Returns the statistics summed over all pictures drawn so far. */
RenderStats render_stats(const Rendering *rendering);

#endif
