/* How pictures are drawn: in bands of rows, each handed over before the next is drawn. */
#ifndef CORCAST_JOB_PICTURE_RENDER_BANDS_H
#define CORCAST_JOB_PICTURE_RENDER_BANDS_H

#include "job/picture/render.h"

/* Returns the number of rows of a band that takes at most about `memory_mb`. `params` NULL: no
 * shared light; `view` NULL: no area lights. */
int render_band_rows(const FramesForm *form, const RenderParams *params, const View *view,
                     double memory_mb);

/* Returns what the renderers have done so far. */
RenderStats render_stats(const Rendering *rendering);

#endif
