/* The further samples of antialiasing, and which pixels get them. */
#ifndef CORCAST_RENDER_RESAMPLE_H
#define CORCAST_RENDER_RESAMPLE_H

#include "image/image.h"
#include "render/job.h"

/* Sets mask[pixel] to 1 where the square root of a channel, clipped to [0, 1], differs by
 * `threshold` or more from that of the pixel to the left, right, above or below, and to 0
 * elsewhere. In the first `above` and the last `below` rows it is 0 throughout: they are there only
 * as neighbours. `color` has 3 channels; `mask` as many bytes as it has pixels. */
void resample_mask(const Plane *color, int above, int below, float threshold, int threads,
                   uint8_t *mask);

/* The further samples of the pixels of a band. */
typedef struct Resampling {
    int side;                              /* N of N x N further samples a pixel; 0: none */
    double offsets[RENDER_MOST_ANTIALIAS]; /* camera_sample_offsets(side) */
    uint8_t *mask; /* owned; 1 for pixels that get further samples; NULL: all do */
} Resampling;

/* For `antialias` as in RenderParams; there is no mask yet, and nothing to release. */
Resampling resampling_for(int antialias);
/* Sets the mask, if the threshold of `params` asks for one, by the colours of the centre samples.
 * STATUS_MEMORY. */
MUST_CHECK Status resampling_choose(Resampling *more, const RenderParams *params, const Band *band,
                                    const Plane *color, int threads, Err *err);
void resampling_release(Resampling *more);

static inline bool resampling_wants(const Resampling *more, size_t pixel)
{
    return !more->mask || more->mask[pixel];
}

/* The mean of a pixel's centre and further samples, whose sum in float, in the order of the
 * samples' rows, is `sum`. */
static inline float resampling_mean(const Resampling *more, float sum)
{
    return (float)((double)sum / (more->side * more->side + 1));
}

#endif
