/* The parts of a render job that all engines share: progress, colors, statistics.
 *
 * Progress counts samples. A picture with N x N further samples per pixel counts as 1 + N * N
 * passes over its rows, the first of which draws the centre samples. */
#include "render/job.h"

const char *const render_kernel_names[] = {[KERNELS_FASTEST] = "fastest",
                                           [KERNELS_PORTABLE] = "portable",
                                           [KERNELS_AVX2] = "avx2",
                                           [KERNELS_AVX512] = "avx512",
                                           NULL};

Status drawing_progress(const Drawing *drawing, int worker, bool further, size_t rows, Err *err)
{
    const RenderParams *params = drawing->params;
    const Band *band = &drawing->band;
    if (worker != 0 || !params->progress)
        return STATUS_OK;
    const double part = (double)rows / band->rows;
    const double more = params->want_color && params->antialias > 1
                            ? (double)params->antialias * params->antialias
                            : 0;
    const double done = (further ? 1 + more * part : part) / (1 + more);
    const double fraction = (band->first + done * band->rows) / drawing->view->camera.height;
    return params->progress(fraction, params->progress_context) ? STATUS_OK : err_cancelled(err);
}

Rgb drawing_color(const Drawing *drawing, uint32_t segment, Vec3 point)
{
    const Appearance *appearance = drawing->appearance;
    if (!drawing->mean)
        return appearance_color(appearance, segment);
    return appearance_blended(appearance, termmean_at(drawing->mean, appearance->positions, point));
}

void renderstats_add(RenderStats *all, const RenderStats *more)
{
    all->prepare_s += more->prepare_s;
    all->trace_s += more->trace_s;
    all->cpu_s += more->cpu_s;
    all->rays += more->rays;
    if (more->engine)
        all->engine = more->engine;
}
