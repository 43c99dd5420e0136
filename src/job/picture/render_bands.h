/* Draws pictures in bands of rows. Each band is written or copied before the next is drawn. The
 * functions that draw are rendering_draw and rendering_draw_view [render.h]. */
#ifndef CORCAST_JOB_PICTURE_RENDER_BANDS_H
#define CORCAST_JOB_PICTURE_RENDER_BANDS_H

#include "job/picture/render.h"

/* Returns the number of rows of a band that takes at most about `memory_mb`, in MB of 10^6 bytes.
 *
 * params  NULL: pixels share no light.
 * view    NULL: there are no area lights. */
int render_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
                     double memory_mb);

/* Returns the sums over all pictures that the renderers have drawn so far. */
RenderStats render_stats(const Rendering *rendering);

#endif
