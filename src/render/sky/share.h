/* The light that the samples of a pixel share [render/light/sharedlight.h], of a band of a picture.
 */
#ifndef CORCAST_RENDER_SHARE_H
#define CORCAST_RENDER_SHARE_H

#include "render/light/sharedlight.h"
#include "render/sky/beams.h"
#include "render/sky/lonelight.h"
#include "render/tile/lightqueue.h"
#include "render/tile/lightview.h"

/* Whether samples share light: there is occlusion, or an area light that casts shadows, and not
 * every ray is to be traced [RENDER_TRACE]; and there is light at all, not the length of vessels.
 */
bool share_is_wanted(const View *view, const RenderParams *params);

/* Rows of pixels to either side of a band whose places its light depends on. */
enum { SHARE_MARGIN = 3 };

/* Rows of a block of the picture. The places of a block ask an area light together, and kernels of
 * isosurfaces and blobs round by the places that ask together. So that a band has the bytes of the
 * whole picture, light is found for whole blocks where there are area lights. */
enum { SHARE_BLOCK = 64 };

/* Sets depth and normal of what the centre rays of the drawing's band see of vessels; *planes is
 * the caller's even when this fails. STATUS_MEMORY. */
typedef Status SharePlanes(const Drawing *drawing, void *context, Frame *planes, Err *err);

/* What light is found from. */
typedef struct LightSources {
    SharePlanes *see;
    void *context;           /* of `see` */
    const LightViews *views; /* area lights are looked from by these, or by rays of the drawing's
                              * caster where these cannot or are NULL */
    const Beams *beams;      /* of what hides the sky; needed for occlusion alone */
    LonePlaces *lone;        /* whose reach of the area lights is found, too; NULL: no places' */
} LightSources;

/* Finds it for the drawing's band. *out is owned. The rows at the band's edges are right where they
 * are the picture's too, or SHARE_MARGIN away. STATUS_MEMORY. */
MUST_CHECK Status share_light(const Drawing *drawing, const LightSources *from, SharedLight **out,
                              Err *err);

#endif
