/* What the geometry alone decides, the search structure of rays (Caster), is made once and kept.
 * What a view decides, tiles and their lists, is kept until a camera, lights or an antialiasing
 * come that are not the same to the last bit. An appearance decides nothing but colours.
 *
 * Implicit models are drawn by field/fieldrender.c, primitives by raster/rasterrender.c or
 * raster/zbuffer.c where that is asked for and enough, all else ray by ray by
 * light/rayrender.c. */
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
    const Geometry *geometry;
    RenderParams params;
    int threads;
    Caster *caster; /* of the geometry; NULL until a view needs it */
    RenderStats stats;
    /* What is kept while camera, lights and antialiasing are these. */
    RasterPrepared raster;
    FieldPrepared field;
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    int antialias;
};

/* ---- what is prepared ------------------------------------------------------------------------ */

static bool is_field(const Renderer *renderer)
{
    return renderer->geometry->model == SCENE_ISOSURFACE && !renderer->params.povray_cells;
}

/* Area lights, occlusion and the ground are for rays to find. */
static bool is_traced(const Renderer *renderer, const View *view)
{
    return renderer->geometry->n_primitives == 0 || renderer->params.method == RENDER_TRACE ||
           sight_is_needed(view, &renderer->params);
}

static bool needs_caster(const Renderer *renderer, const View *view)
{
    const RenderParams *params = &renderer->params;
    if (is_traced(renderer, view))
        return !is_field(renderer) || params->shadows || params->occlusion > 0;
    return params->method == RENDER_RASTER && params->shadows &&
           rastershadows_need_rays(renderer->geometry, view);
}

/* Makes the caster if the view needs it and none before did. */
static Status prepare_caster(Renderer *renderer, const View *view, Err *err)
{
    if (renderer->caster || !needs_caster(renderer, view))
        return STATUS_OK;
    double start_s = clock_seconds();
    TRY(caster_new(renderer->geometry, renderer->params.povray_cells, renderer->threads,
                   &renderer->caster, err));
    if (renderer->params.shadow_from_mm > 0)
        caster_shadow_from(renderer->caster, renderer->params.shadow_from_mm);
    renderer->stats.prepare_s += clock_seconds() - start_s;
    return STATUS_OK;
}

static Status check_kernels(RenderKernels kernels, Err *err)
{
    int usable = kernels_usable();
    if ((int)kernels <= usable)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "`kernels`: this processor cannot run %s, at most %s",
                   render_kernel_names[kernels], render_kernel_names[usable]);
}

Status renderer_new(const Geometry *geometry, const RenderParams *params, Renderer **out, Err *err)
{
    static const View plain; /* no lights, no ground: what it needs, all views need */
    Renderer *renderer;
    double start_cpu_s = clock_cpu_seconds();
    TRY(check_kernels(params->kernels, err));
    TRY(mem_calloc(&renderer, 1, sizeof *renderer, "renderers", err));
    renderer->geometry = geometry;
    renderer->params = *params;
    renderer->threads = params->threads > 0 ? params->threads : threads_available();
    Status status = prepare_caster(renderer, &plain, err);
    if (status != STATUS_OK) {
        renderer_free(renderer);
        return status;
    }
    renderer->stats.cpu_s = clock_cpu_seconds() - start_cpu_s;
    *out = renderer;
    return STATUS_OK;
}

static void forget_view(Renderer *renderer)
{
    rasterprepared_release(&renderer->raster);
    fieldprepared_release(&renderer->field);
}

void renderer_free(Renderer *renderer)
{
    if (!renderer)
        return;
    forget_view(renderer);
    caster_free(renderer->caster);
    free(renderer);
}

/* Frees what was prepared for another camera, other lights or another antialiasing than the next
 * rows have, and remembers those that they have. */
static void forget_other_views(Renderer *renderer, const View *view)
{
    size_t size = view->n_lights * sizeof *view->lights;
    if (renderer->n_lights == view->n_lights && renderer->antialias == renderer->params.antialias &&
        memcmp(&renderer->camera, &view->camera, sizeof view->camera) == 0 &&
        memcmp(renderer->lights, view->lights, size) == 0)
        return;
    forget_view(renderer);
    memcpy(&renderer->camera, &view->camera, sizeof view->camera);
    memcpy(renderer->lights, view->lights, size);
    renderer->n_lights = view->n_lights;
    renderer->antialias = renderer->params.antialias;
    renderer->stats.preparations++;
}

void renderer_antialias(Renderer *renderer, int antialias)
{
    renderer->params.antialias = antialias;
}

RenderStats renderer_stats(const Renderer *renderer)
{
    return renderer->stats;
}

static Status draw(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    RenderStats *stats = &renderer->stats;
    bool traced = is_traced(renderer, drawing->view);
    bool tiles = traced ? is_field(renderer) : params->method == RENDER_RASTER;
    bool codes = params->codes_suffice && params->antialias == 1 && tiles;
    TRY(planes_make(drawing->view->camera.width, drawing->band.rows, params, codes, frame, err));
    forget_other_views(renderer, drawing->view);
    if (!traced && params->method == RENDER_RASTER)
        return rasterrender(drawing, &renderer->raster, frame, stats, err);
    if (!traced)
        return zbuffer_render(drawing, frame, stats, err);
    if (is_field(renderer))
        return fieldrender(drawing, &renderer->field, frame, stats, err);
    return rayrender(drawing, frame, stats, err);
}

/* The band with the neighbours that adaptive antialiasing looks at. */
static Band band_of(const RenderParams *params, int height, int first, int rows)
{
    Band band = {.first = first, .rows = rows};
    int left = height - first - rows;
    if (params->antialias > 1 && params->antialias_threshold > 0) {
        band.above = first > 0 ? RENDER_BAND_STEP : 0;
        band.below = left < RENDER_BAND_STEP ? left : RENDER_BAND_STEP;
    }
    band.first -= band.above;
    band.rows += band.above + band.below;
    return band;
}

Status renderer_rows(Renderer *renderer, const View *view, const Appearance *appearance, int first,
                     int rows, Frame *frame, Err *err)
{
    int height = view->camera.height;
    assert(first >= 0 && rows > 0 && first + rows <= height && first % RENDER_BAND_STEP == 0);
    Frame made = {0};
    double start_cpu_s = clock_cpu_seconds();
    TRY(prepare_caster(renderer, view, err));
    const Drawing drawing = {.geometry = renderer->geometry,
                             .view = view,
                             .appearance = appearance,
                             .params = &renderer->params,
                             .caster = renderer->caster,
                             .band = band_of(&renderer->params, height, first, rows)};
    Status status = draw(renderer, &drawing, &made, err);
    renderer->stats.cpu_s += clock_cpu_seconds() - start_cpu_s;
    renderer->stats.rays += (size_t)view->camera.width * (size_t)drawing.band.rows;
    if (status != STATUS_OK) {
        frame_release(&made);
        return status;
    }
    if (drawing.band.above + drawing.band.below)
        planes_cut(&made, &drawing.band);
    *frame = made;
    return STATUS_OK;
}

Status render(const Scene *scene, const RenderParams *params, Frame *frame, RenderStats *stats,
              Err *err)
{
    Renderer *renderer;
    TRY(renderer_new(&scene->geometry, params, &renderer, err));
    Status status = renderer_rows(renderer, &scene->view, &scene->appearance, 0,
                                  scene->view.camera.height, frame, err);
    if (status == STATUS_OK && stats)
        *stats = renderer->stats;
    renderer_free(renderer);
    return status;
}
