/* The rows of a picture that a frame holds. */
#ifndef CORCAST_RENDER_BAND_H
#define CORCAST_RENDER_BAND_H

#include "render/render.h"

/* Rows first .. first + rows of the picture. The outermost `above` and `below` of them are there only
 * for their neighbours to be told apart from: they get no further samples and are cut off at the
 * end. */
typedef struct Band {
    int first, rows;
    int above, below;
} Band;

/* Says how far the whole picture is; `part` is of this pass over the band, whose further samples are a
 * pass of their own. */
void band_progress(const Band *band, const RenderParams *params, int height, bool further,
                   double part);

#endif
