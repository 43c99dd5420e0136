/* Which pixels adaptive antialiasing samples again. */
#ifndef CORCAST_RENDER_RESAMPLE_H
#define CORCAST_RENDER_RESAMPLE_H

#include "image/image.h"

/* Sets mask[pixel] to 1 where the square root of a channel, clipped to [0, 1], differs by
 * `threshold` or more from that of a pixel to the left, right, above or below, else to 0, and to 0
 * in the rows `above` the others and `below` them. `color` has 3 channels. */
void resample_mask(const Plane *color, int above, int below, float threshold, int threads,
                   uint8_t *mask);

/* Where a pixel's N x N further samples stand, from its centre, in pixels: offsets[n], the same in
 * both directions; POV-Ray's places [docs/POVRAY.md], summed up as it sums them. */
void resample_offsets(int n, double *offsets);

#endif
