/* What the geometry alone decides, the search structure of rays (Caster), is made once and kept.
 * What a view decides, an engine's lists of tiles, is kept until a camera, lights or an
 * antialiasing come that are not the same to the last bit, or another engine. An appearance decides
 * nothing but colours.
 *
 * The first engine of the table that can draws: the special ones first, rays, which can draw
 * anything, last. */
#include "render/render.h"

#include "render/cast/caster.h"
#include "render/field/fieldrender.h"
#include "render/light/rayrender.h"
#include "render/raster/rasterrender.h"
#include "render/raster/zbuffer.h"
#include "render/tile/tilekernels.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

static const Engine *const engines[] = {&field_engine, &raster_engine, &zbuffer_engine,
                                        &ray_engine};

struct Renderer {
    const Geometry *geometry;
    RenderParams params; /* with the number of threads */
    Caster *caster;      /* of the geometry; NULL until a view needs it */
    TermMean *mean;      /* likewise; NULL until an appearance needs it */
    RenderStats stats;
    /* What is kept while engine, camera, lights and antialiasing are these. */
    const Engine *engine; /* NULL: nothing is */
    void *prepared;       /* the engine's */
    Camera camera;
    Light lights[VIEW_MAX_LIGHTS];
    size_t n_lights;
    int antialias;
};

/* ---- planes ------------------------------------------------------------------------------------
 */

/* Makes the planes that are wanted, zeroed, in *frame (owned by the caller even when this fails):
 * of colour 8-bit codes if `codes`, else floats. */
static Status make_planes(int width, int height, const RenderParams *params, bool codes,
                          Frame *frame, Err *err)
{
    if (params->want_color && codes)
        TRY(picture_init(&frame->codes, width, height, 3, 8, err));
    else if (params->want_color)
        TRY(plane_init(&frame->color, width, height, 3, err));
    if (params->want_depth)
        TRY(plane_init(&frame->depth, width, height, 1, err));
    if (params->want_normal)
        TRY(plane_init(&frame->normal, width, height, 3, err));
    if (params->want_id)
        TRY(idplane_init(&frame->id, width, height, err));
    return STATUS_OK;
}

static void cut_plane(Plane *plane, const Band *band)
{
    if (!plane->values)
        return;
    size_t row = (size_t)plane->width * (size_t)plane->channels;
    plane->height = band->rows - band->above - band->below;
    memmove(plane->values, plane->values + (size_t)band->above * row,
            (size_t)plane->height * row * sizeof *plane->values);
}

/* Cuts off the rows of the band that are there for their neighbours alone; those of codes have
 * none. */
static void cut_planes(Frame *frame, const Band *band)
{
    cut_plane(&frame->color, band);
    cut_plane(&frame->depth, band);
    cut_plane(&frame->normal, band);
    if (!frame->id.ids)
        return;
    size_t width = (size_t)frame->id.width;
    frame->id.height = band->rows - band->above - band->below;
    memmove(frame->id.ids, frame->id.ids + (size_t)band->above * width,
            (size_t)frame->id.height * width * sizeof *frame->id.ids);
}

/* ---- what is prepared ------------------------------------------------------------------------ */

static const Engine *engine_for(const Drawing *drawing)
{
    size_t i = 0;
    while (!engines[i]->can(drawing))
        i++;
    return engines[i];
}

/* Makes the caster if the drawing needs it and none before did. */
static Status prepare_caster(Renderer *renderer, Drawing *drawing, Err *err)
{
    const RenderParams *params = &renderer->params;
    if (!renderer->caster && engine_for(drawing)->needs_rays(drawing)) {
        double start_s = clock_seconds();
        TRY(caster_new(renderer->geometry, params->povray_cells, params->threads, &renderer->caster,
                       err));
        if (params->shadow_from_mm > 0)
            caster_shadow_from(renderer->caster, params->shadow_from_mm);
        renderer->stats.prepare_s += clock_seconds() - start_s;
    }
    drawing->caster = renderer->caster;
    return STATUS_OK;
}

/* Makes what blends colours if the drawing needs it and none before did. */
static Status prepare_mean(Renderer *renderer, Drawing *drawing, Err *err)
{
    if (!drawing->appearance->places || !model_has(renderer->geometry->model, MODEL_FIELD))
        return STATUS_OK;
    double start_s = clock_seconds();
    if (!renderer->mean)
        TRY(termmean_new(renderer->geometry, &renderer->mean, err));
    renderer->stats.prepare_s += clock_seconds() - start_s;
    drawing->mean = renderer->mean;
    return STATUS_OK;
}

RenderKernels render_fastest_kernels(void)
{
    return (RenderKernels)kernels_usable();
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
    if (params->threads <= 0)
        renderer->params.threads = threads_available();
    Drawing any = {.geometry = geometry, .view = &plain, .params = &renderer->params};
    Status status = prepare_caster(renderer, &any, err);
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
    if (renderer->prepared)
        renderer->engine->free(renderer->prepared);
    renderer->prepared = NULL;
    renderer->engine = NULL;
}

void renderer_free(Renderer *renderer)
{
    if (!renderer)
        return;
    forget_view(renderer);
    caster_free(renderer->caster);
    termmean_free(renderer->mean);
    free(renderer);
}

static bool is_prepared(const Renderer *renderer, const Engine *engine, const View *view)
{
    size_t size = view->n_lights * sizeof *view->lights;
    return renderer->engine == engine && renderer->n_lights == view->n_lights &&
           renderer->antialias == renderer->params.antialias &&
           memcmp(&renderer->camera, &view->camera, sizeof view->camera) == 0 &&
           memcmp(renderer->lights, view->lights, size) == 0;
}

/* Frees what was prepared for another view, and prepares this. */
static Status prepare_view(Renderer *renderer, const Drawing *drawing, Err *err)
{
    const View *view = drawing->view;
    const Engine *engine = engine_for(drawing);
    double start_s = clock_seconds();
    if (is_prepared(renderer, engine, view))
        return STATUS_OK;
    forget_view(renderer);
    if (engine->prepare)
        TRY(engine->prepare(drawing, &renderer->prepared, err));
    renderer->engine = engine;
    renderer->stats.engine = engine->name;
    memcpy(&renderer->camera, &view->camera, sizeof view->camera);
    memcpy(renderer->lights, view->lights, view->n_lights * sizeof *view->lights);
    renderer->n_lights = view->n_lights;
    renderer->antialias = renderer->params.antialias;
    renderer->stats.preparations++;
    renderer->stats.prepare_s += clock_seconds() - start_s;
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

static Status draw(Renderer *renderer, const Drawing *drawing, Frame *frame, Err *err)
{
    const RenderParams *params = drawing->params;
    TRY(prepare_view(renderer, drawing, err));
    double start_s = clock_seconds();
    bool codes = params->codes_suffice && params->antialias == 1 && renderer->engine->makes_codes;
    TRY(make_planes(drawing->view->camera.width, drawing->band.rows, params, codes, frame, err));
    TRY(renderer->engine->rows(drawing, renderer->prepared, frame, err));
    renderer->stats.trace_s += clock_seconds() - start_s;
    return STATUS_OK;
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
    Drawing drawing = {.geometry = renderer->geometry,
                       .view = view,
                       .appearance = appearance,
                       .params = &renderer->params,
                       .band = band_of(&renderer->params, height, first, rows)};
    Status status = prepare_caster(renderer, &drawing, err);
    if (status == STATUS_OK)
        status = prepare_mean(renderer, &drawing, err);
    if (status == STATUS_OK)
        status = draw(renderer, &drawing, &made, err);
    renderer->stats.cpu_s += clock_cpu_seconds() - start_cpu_s;
    renderer->stats.rays += (size_t)view->camera.width * (size_t)drawing.band.rows;
    if (status != STATUS_OK) {
        frame_release(&made);
        return status;
    }
    if (drawing.band.above + drawing.band.below)
        cut_planes(&made, &drawing.band);
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
