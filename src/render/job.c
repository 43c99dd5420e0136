/* Progress counts samples: a picture with N x N further samples a pixel is 1 + N N passes over its
 * rows, of which the first is that of the centres. */
#include "render/job.h"

const char *const render_kernel_names[] = {[KERNELS_FASTEST] = "fastest",
                                           [KERNELS_PORTABLE] = "portable",
                                           [KERNELS_AVX2] = "avx2",
                                           [KERNELS_AVX512] = "avx512",
                                           NULL};

Status band_progress(const Band *band, const RenderParams *params, int height, bool further,
                     double part, Err *err)
{
    if (!params->progress)
        return STATUS_OK;
    double more = params->want_color && params->antialias > 1
                      ? (double)params->antialias * params->antialias
                      : 0;
    double done = (further ? 1 + more * part : part) / (1 + more);
    const double fraction = (band->first + done * band->rows) / height;
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
