/* Chooses the engine: implicit scenes are drawn by field/fieldrender.c, primitives by
 * raster/rasterrender.c or raster/zbuffer.c where that is asked for and enough, all else ray by ray
 * by light/rayrender.c. Rows are drawn in bands; what bands have in common is kept from one to the
 * next. */
#include "render/render.h"

#include "render/field/fieldrender.h"
#include "render/light/rayrender.h"
#include "render/light/sight.h"
#include "render/planes.h"
#include "render/raster/rasterrender.h"
#include "render/raster/zbuffer.h"
#include "render/tile/tilekernels.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct Renderer {
    const Scene *scene;
    RenderParams params;
    int threads;
    Caster
        *caster; /* NULL when the potential is drawn and nothing asks what is in the way of light */
    RenderStats stats;
    /* What bands have in common, of this camera, these lights and this antialiasing. */
    RasterPrepared raster;
    FieldPrepared field;
    Camera camera;
    Light *lights; /* owned */
    size_t n_lights;
    int antialias;
};

static bool is_field(const Renderer *renderer)
{
    return renderer->scene->model == SCENE_ISOSURFACE && !renderer->params.povray_cells;
}

/* Soft shadows, occlusion and the ground are for rays to find. */
static bool is_traced(const Renderer *renderer)
{
    return renderer->scene->n_primitives == 0 || renderer->params.method == RENDER_TRACE ||
           sight_is_needed(renderer->scene, &renderer->params);
}

static Status check_kernels(RenderKernels kernels, Err *err)
{
    int usable = kernels_usable();
    if ((int)kernels <= usable)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "`kernels`: this processor cannot run %s, at most %s",
                   render_kernel_names[kernels], render_kernel_names[usable]);
}

Status renderer_new(const Scene *scene, const RenderParams *params, Renderer **out, Err *err)
{
    Renderer *renderer;
    double start_s = clock_seconds(), start_cpu_s = clock_cpu_seconds();
    TRY(check_kernels(params->kernels, err));
    TRY(mem_calloc(&renderer, 1, sizeof *renderer, "renderers", err));
    *renderer = (Renderer){.scene = scene, .params = *params};
    renderer->threads = params->threads > 0 ? params->threads : threads_available();
    Status status = STATUS_OK;
    if (is_traced(renderer) && (!is_field(renderer) || params->shadows || params->occlusion > 0))
        status = caster_new(scene, params->povray_cells, renderer->threads, &renderer->caster, err);
    if (renderer->caster && params->shadow_from_mm > 0)
        caster_shadow_from(renderer->caster, params->shadow_from_mm);
    if (status != STATUS_OK) {
        renderer_free(renderer);
        return status;
    }
    renderer->stats.prepare_s = clock_seconds() - start_s;
    renderer->stats.cpu_s = clock_cpu_seconds() - start_cpu_s;
    *out = renderer;
    return STATUS_OK;
}

static void forget(Renderer *renderer)
{
    rasterprepared_release(&renderer->raster);
    fieldprepared_release(&renderer->field);
}

void renderer_free(Renderer *renderer)
{
    if (!renderer)
        return;
    forget(renderer);
    free(renderer->lights);
    caster_free(renderer->caster);
    free(renderer);
}

/* Frees what was prepared for another camera, other lights or another antialiasing than the next
 * band has, and remembers those that it has. */
static Status forget_other_views(Renderer *renderer, Err *err)
{
    const Scene *scene = renderer->scene;
    size_t size = scene->n_lights * sizeof *scene->lights;
    bool same = renderer->n_lights == scene->n_lights &&
                renderer->antialias == renderer->params.antialias &&
                memcmp(&renderer->camera, &scene->camera, sizeof scene->camera) == 0 &&
                (size == 0 || memcmp(renderer->lights, scene->lights, size) == 0);
    if (same)
        return STATUS_OK;
    forget(renderer);
    free(renderer->lights);
    renderer->lights = NULL;
    renderer->n_lights = 0;
    renderer->antialias = 0; /* of no picture */
    TRY(mem_calloc(&renderer->lights, scene->n_lights, sizeof *scene->lights, "lights", err));
    if (size > 0)
        memcpy(renderer->lights, scene->lights, size);
    renderer->n_lights = scene->n_lights;
    renderer->antialias = renderer->params.antialias;
    memcpy(&renderer->camera, &scene->camera, sizeof scene->camera);
    renderer->stats.preparations++;
    return STATUS_OK;
}

void renderer_antialias(Renderer *renderer, int antialias)
{
    renderer->params.antialias = antialias;
}

RenderStats renderer_stats(const Renderer *renderer)
{
    return renderer->stats;
}

static Status draw(Renderer *renderer, const Band *band, Frame *frame, Err *err)
{
    const RenderParams *params = &renderer->params;
    bool tiles = is_traced(renderer) ? is_field(renderer) : params->method == RENDER_RASTER;
    bool codes = params->codes_suffice && params->antialias == 1 && tiles;
    TRY(planes_make(renderer->scene->camera.width, band->rows, params, codes, frame, err));
    TRY(forget_other_views(renderer, err));
    if (!is_traced(renderer) && params->method == RENDER_RASTER)
        return rasterrender(renderer->scene, params, band, &renderer->raster, frame,
                            &renderer->stats, err);
    if (!is_traced(renderer))
        return zbuffer_render(renderer->scene, params, band, frame, &renderer->stats, err);
    if (is_field(renderer))
        return fieldrender(renderer->scene, params, renderer->caster, band, &renderer->field, frame,
                           &renderer->stats, err);
    return rayrender(renderer->scene, params, renderer->caster, band, frame, &renderer->stats, err);
}

/* The band with the neighbours that adaptive antialiasing looks at. */
static Band band_of(const Renderer *renderer, int first, int rows)
{
    const RenderParams *params = &renderer->params;
    Band band = {.first = first, .rows = rows};
    int left = renderer->scene->camera.height - first - rows;
    if (params->antialias > 1 && params->antialias_threshold > 0) {
        band.above = first > 0 ? RENDER_BAND_STEP : 0;
        band.below = left < RENDER_BAND_STEP ? left : RENDER_BAND_STEP;
    }
    band.first -= band.above;
    band.rows += band.above + band.below;
    return band;
}

Status renderer_rows(Renderer *renderer, int first, int rows, Frame *frame, Err *err)
{
    const Camera *camera = &renderer->scene->camera;
    assert(first >= 0 && rows > 0 && first + rows <= camera->height &&
           first % RENDER_BAND_STEP == 0);
    Frame made = {0};
    double start_cpu_s = clock_cpu_seconds();
    const Band band = band_of(renderer, first, rows);
    Status status = draw(renderer, &band, &made, err);
    renderer->stats.cpu_s += clock_cpu_seconds() - start_cpu_s;
    renderer->stats.rays += (size_t)camera->width * (size_t)band.rows;
    if (status != STATUS_OK) {
        frame_release(&made);
        return status;
    }
    if (band.above + band.below)
        planes_cut(&made, &band);
    *frame = made;
    return STATUS_OK;
}

Status render(const Scene *scene, const RenderParams *params, Frame *frame, RenderStats *stats,
              Err *err)
{
    Renderer *renderer;
    TRY(renderer_new(scene, params, &renderer, err));
    Status status = renderer_rows(renderer, 0, scene->camera.height, frame, err);
    if (status == STATUS_OK && stats)
        *stats = renderer->stats;
    renderer_free(renderer);
    return status;
}
