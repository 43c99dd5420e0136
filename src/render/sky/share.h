/* The light that the samples of a pixel share [render/light/sharedlight.h], of a band of a picture.
 */
#ifndef CORCAST_RENDER_SHARE_H
#define CORCAST_RENDER_SHARE_H

#include "render/light/sharedlight.h"
#include "render/sky/beams.h"
#include "render/tile/lightqueue.h"
#include "render/tile/lightview.h"

/* Whether samples share light: there is occlusion, or an area light that casts shadows, and not
 * every ray is to be traced [RENDER_TRACE]; and there is light at all, not the length of vessels.
 */
bool share_is_wanted(const View *view, const RenderParams *params);

/* Rows of pixels to either side of a band whose places its light depends on. */
enum { SHARE_MARGIN = 3 };

/* Finds it for the drawing's band, whose centre rays have seen what `planes` has, depth and normal
 * of vessels. `beams` is of what hides the sky, and needed for occlusion alone; area lights
 * are looked from by `views`, or by rays of the drawing's caster where those cannot or are NULL.
 * *out is owned. The rows at the band's edges are right where they are the picture's too, or
 * SHARE_MARGIN away. STATUS_MEMORY. */
MUST_CHECK Status share_light(const Drawing *drawing, const LightViews *views, Frame *planes,
                              const Beams *beams, SharedLight **out, Err *err);

#endif
