/* Chooses the pixels that get the further samples of adaptive antialiasing: those whose color
 * differs from that of one of their four neighbours by at least a threshold. Colors are compared by
 * the square roots of their linear channels, because equal steps of a square root look about equal
 * to the eye. POV-Ray compares other numbers, so no picture with a threshold is compared with
 * POV-Ray's. */
#include "render/light/resample.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The arguments of the threads that compare pixels. */
typedef struct MaskJob {
    const Plane *color;
    float threshold;
    uint8_t *mask;
} MaskJob;

/* Returns true if two colors differ in a channel by at least the threshold. */
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

Resampling resampling_for(int antialias)
{
    assert(antialias <= RENDER_MAX_ANTIALIAS);
    Resampling more = {.side = antialias > 1 ? antialias : 0};
    if (more.side > 0)
        camera_sample_offsets(more.side, more.offsets);
    return more;
}

Status resampling_choose(Resampling *more, const RenderParams *params, const Band *band,
                         const Plane *color, Err *err)
{
    if (!(params->antialias_threshold > 0))
        return STATUS_OK;
    const size_t width = (size_t)color->width, height = (size_t)color->height;
    TRY(mem_calloc(&more->mask, width * height, 1, "masks", err));
    MaskJob job = {color, (float)params->antialias_threshold, more->mask};
    threads_for(height, params->threads, mask_row, &job);
    memset(more->mask, 0, (size_t)band->above * width);
    memset(more->mask + (height - (size_t)band->below) * width, 0, (size_t)band->below * width);
    return STATUS_OK;
}

void resampling_release(Resampling *more)
{
    free(more->mask);
    *more = (Resampling){0};
}
