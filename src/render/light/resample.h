/* Antialiasing: the further samples that a pixel gets in addition to its centre sample, and which
 * pixels get them.
 *
 *     Resampling more = resampling_for(params.antialias);
 *     TRY_GOTO(resampling_choose(&more, &params, &band, &color, err));
 *     resampling_release(&more); */
#ifndef CORCAST_RENDER_LIGHT_RESAMPLE_H
#define CORCAST_RENDER_LIGHT_RESAMPLE_H

#include "image/image.h"
#include "render/job.h"

/* The further samples of the pixels in a band: N x N per pixel. */
typedef struct Resampling {
    int side; /* N; 0: no further samples */
    /* camera_sample_offsets(side): distances from the pixel's centre, pixels */
    double offsets[RENDER_MAX_ANTIALIAS];
    uint8_t *mask; /* per pixel: 1 if it gets further samples; NULL: all
                    * pixels do; owned */
} Resampling;

/* Returns the further samples for a value of RenderParams.antialias. All pixels get them. */
Resampling resampling_for(int antialias);
/* Selects the pixels that get further samples, if params->antialias_threshold is above 0. Otherwise
 * changes nothing: all pixels get them.
 *
 * A pixel is compared with the pixels to the left, to the right, above and below. It is selected if
 * the square root of a channel, clipped to [0, 1], differs by the threshold or more. The root
 * approximates the sRGB encoding.
 *
 * color    colors of the centre samples: 3 channels. The first band->above and the last band->below
 *          rows belong to neighbouring bands: they are compared but not selected.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status resampling_choose(Resampling *more, const RenderParams *params, const Band *band,
                                    const Plane *color, Err *err);
/* Frees the mask. */
void resampling_release(Resampling *more);

/* Returns true if the pixel gets further samples. */
static inline bool resampling_wants(const Resampling *more, size_t pixel)
{
    return !more->mask || more->mask[pixel];
}

/* Returns the mean of all samples of a pixel. `sum` is the sum of the centre sample and the further
 * samples, added in float, row by row. */
static inline float resampling_mean(const Resampling *more, float sum)
{
    return (float)((double)sum / (more->side * more->side + 1));
}

#endif
