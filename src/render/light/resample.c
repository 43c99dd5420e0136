/* Adaptive antialiasing compares pixels by square roots of linear channels, because equal steps of
 * a square root look about equal to the eye. POV-Ray compares other numbers, so no picture with a
 * threshold is compared with POV-Ray's. */
#include "render/light/resample.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct MaskJob {
    const Plane *color;
    float threshold;
    uint8_t *mask;
} MaskJob;

static bool differs(const float *a, const float *b, float threshold)
{
    for (int c = 0; c < 3; c++) {
        float clipped_a = fminf(fmaxf(a[c], 0), 1), clipped_b = fminf(fmaxf(b[c], 0), 1);
        if (fabsf(sqrtf(clipped_a) - sqrtf(clipped_b)) >= threshold)
            return true;
    }
    return false;
}

static void mask_row(size_t row, int worker, void *context)
{
    (void)worker;
    const MaskJob *job = context;
    size_t width = (size_t)job->color->width, height = (size_t)job->color->height;
    for (size_t i = 0; i < width; i++) {
        const float *here = &job->color->values[3 * (row * width + i)];
        float threshold = job->threshold;
        bool edge = (i > 0 && differs(here, here - 3, threshold)) ||
                    (i + 1 < width && differs(here, here + 3, threshold)) ||
                    (row > 0 && differs(here, here - 3 * width, threshold)) ||
                    (row + 1 < height && differs(here, here + 3 * width, threshold));
        job->mask[row * width + i] = edge;
    }
}

void resample_mask(const Plane *color, int above, int below, float threshold, int threads,
                   uint8_t *mask)
{
    MaskJob job = {color, threshold, mask};
    size_t width = (size_t)color->width, height = (size_t)color->height;
    threads_for(height, threads, mask_row, &job);
    memset(mask, 0, (size_t)above * width);
    memset(mask + (height - (size_t)below) * width, 0, (size_t)below * width);
}

Resampling resampling_for(int antialias)
{
    assert(antialias <= RENDER_MAX_ANTIALIAS);
    Resampling more = {.side = antialias > 1 ? antialias : 0};
    if (more.side > 0)
        camera_sample_offsets(more.side, more.offsets);
    return more;
}

Status resampling_choose(Resampling *more, const RenderParams *params, const Band *band,
                         const Plane *color, int threads, Err *err)
{
    if (!(params->antialias_threshold > 0))
        return STATUS_OK;
    TRY(mem_calloc(&more->mask, (size_t)color->width * (size_t)color->height, 1, "masks", err));
    resample_mask(color, band->above, band->below, (float)params->antialias_threshold, threads,
                  more->mask);
    return STATUS_OK;
}

void resampling_release(Resampling *more)
{
    free(more->mask);
    *more = (Resampling){0};
}
