/* Makes the bins of lights: per tile of a light view (the picture as the light sees it), the
 * vessels that the tile may show.
 *
 * Making the bins of one light has serial parts. Bins are therefore made for several lights at the
 * same time, one light per thread, as long as there is a light for each thread. For each of the
 * remaining lights, all threads work together, unless the geometry is so small that threads would
 * not help. */
#include "render/light/shadowengine.h"

#include <stdlib.h>
#include <string.h>

/* Number of vessels from which on several threads make the bins of one light faster than one
 * thread: twice what the cache of one processor holds. */
enum { MIN_SHARED_VESSELS = 1 << 17 };

bool shadowengine_supports(const ShadowEngine *engine, const Drawing *drawing, const Light *light)
{
    bool supports = true;
    for (int k = 0; k < light_points(light); k++) {
        const Light point = light_at_point(light, k);
        supports = supports && engine->supports(drawing->geometry, drawing->view, &point);
    }
    return supports;
}

bool shadowengine_needs_rays(const ShadowEngine *engine, const Drawing *drawing)
{
    const RenderParams *params = drawing->params;
    const bool traces = params->method == RENDER_TRACE;
    bool rays = params->occlusion > 0 && traces;
    for (size_t i = 0; i < drawing->view->n_lights && params->shadows; i++) {
        const Light *light = &drawing->view->lights[i];
        rays |= light->casts_shadows && (traces || !shadowengine_supports(engine, drawing, light));
    }
    return rays;
}

/* ---- making bins ----------------------------------------------------------------------------- */

void lightbins_free(LightBins *bins)
{
    if (!bins)
        return;
    bins->engine->release(bins->lists);
    free(bins);
}

/* The arguments of the threads that make bins. */
typedef struct BinsJob {
    const LightBinsParams *params;
    const Light *lights;
    LightBins **bins;
    Drawing drawing; /* the drawing; its number of threads is that of one light: one, or all */
} BinsJob;

static Status make_bins(size_t index, int worker, void *context, Err *err)
{
    (void)worker;
    const BinsJob *job = context;
    const Drawing *drawing = &job->drawing;
    const ShadowEngine *engine = job->params->engine;
    LightBins *bins;
    TRY(mem_calloc(&bins, 1, sizeof *bins, "shadows", err));
    job->bins[index] = bins;
    bins->engine = engine;
    bins->geometry = drawing->geometry;
    bins->view = lightview_of(drawing->geometry, &job->lights[index], engine->tiles(drawing),
                              job->params->box);
    bins->aim = lightview_projection(&bins->view, &job->params->frame, engine->slack(drawing));
    return engine->bin(drawing, bins, err);
}

Status lightbins_new(const LightBinsParams *params, const Light *lights, size_t n, LightBins **bins,
                     Err *err)
{
    const Geometry *geometry = params->drawing->geometry;
    const int threads = params->drawing->params->threads;
    RenderParams one_thread = *params->drawing->params;
    BinsJob job = {.params = params, .lights = lights, .bins = bins, .drawing = *params->drawing};
    size_t left_over = n % (size_t)threads; /* lights whose bins all threads make together */
    if (left_over > 1 && geometry->n_primitives + geometry->n_segments < MIN_SHARED_VESSELS)
        left_over = 0;
    for (size_t i = 0; i < n; i++)
        bins[i] = NULL;
    one_thread.threads = 1;
    job.drawing.params = &one_thread;
    TRY(threads_try(n - left_over, threads, make_bins, &job, err));
    job.drawing.params = params->drawing->params;
    for (size_t i = n - left_over; i < n; i++)
        TRY(make_bins(i, 0, &job, err));
    return STATUS_OK;
}

/* Returns true if a light has hard shadows that a light view of the engine can answer. */
static bool has_light_view(const ShadowEngine *engine, const Drawing *drawing, const Light *light)
{
    return light->casts_shadows && light->samples <= 1 && drawing->params->method != RENDER_TRACE &&
           engine->supports(drawing->geometry, drawing->view, light);
}

Status lightbins_new_for_view(const ShadowEngine *engine, const Drawing *drawing,
                              const Viewpoint *eye, LightBins *bins[VIEW_MAX_LIGHTS], Err *err)
{
    const LightBinsParams params = {.engine = engine, .drawing = drawing, .frame = *eye};
    const View *view = drawing->view;
    Light lights[VIEW_MAX_LIGHTS] = {{.samples = 1}};
    LightBins *made[VIEW_MAX_LIGHTS];
    size_t n = 0, of[VIEW_MAX_LIGHTS];
    for (size_t i = 0; i < view->n_lights; i++)
        if (has_light_view(engine, drawing, &view->lights[i])) {
            lights[n] = view->lights[i];
            of[n++] = i;
        }
    Status status = lightbins_new(&params, lights, n, made, err);
    for (size_t i = 0; i < n; i++)
        bins[of[i]] = made[i];
    return status;
}
