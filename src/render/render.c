/* The potential is drawn by fieldrender.c. For primitives rays are cast one a sample and rows are
 * the unit of work, so that the picture does not depend on the number of threads. Samples stand
 * where POV-Ray puts them: the centre of the pixel, and with antialiasing an N x N grid more; their
 * mean weighs all N * N + 1 alike (tracetask.cpp of 3.7.0.10: every pixel is supersampled when the
 * threshold is 0). */
#include "render/render.h"

#include "render/field/fieldrender.h"
#include "render/light/resample.h"
#include "render/light/sight.h"
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

typedef struct Job {
    const Scene *scene;
    const RenderParams *params;
    Sight sight;
    const Band *band;
    Frame *frame;
    double *offsets; /* of a pixel's further samples */
    uint8_t *mask;   /* pixels that get them; NULL: all */
} Job;

static Rgb sample_color(const Job *job, int worker, double i, double j)
{
    Ray ray = camera_ray(&job->scene->camera, i, j);
    Surfel surfel;
    bool seen = caster_first(job->sight.caster, worker, ray, &surfel);
    return sight_color(&job->sight, worker, ray, i, j, seen ? &surfel : NULL);
}

/* The mean of the centre sample and the grid around it, summed row by row in float. */
static Rgb antialiased(const Job *job, int worker, int i, int j, Rgb center)
{
    int n = job->params->antialias;
    Rgb sum = center;
    for (int y = 0; y < n; y++) {
        for (int x = 0; x < n; x++) {
            Rgb sample = sample_color(job, worker, i + job->offsets[x], j + job->offsets[y]);
            sum.r += sample.r;
            sum.g += sample.g;
            sum.b += sample.b;
        }
    }
    double count = n * n + 1;
    return (Rgb){(float)((double)sum.r / count), (float)((double)sum.g / count),
                 (float)((double)sum.b / count)};
}

static void store_geometry(Frame *frame, size_t pixel, const Surfel *surfel)
{
    if (frame->depth.values)
        frame->depth.values[pixel] = surfel ? (float)surfel->t : INFINITY;
    if (frame->normal.values) {
        float *normal = &frame->normal.values[3 * pixel];
        normal[0] = surfel ? (float)surfel->normal.x : 0;
        normal[1] = surfel ? (float)surfel->normal.y : 0;
        normal[2] = surfel ? (float)surfel->normal.z : 0;
    }
    if (frame->id.ids)
        frame->id.ids[pixel] = surfel ? surfel->id : 0;
}

static void report_progress(const Job *job, bool further, size_t row, int worker)
{
    if (worker == 0)
        band_progress(job->band, job->params, job->scene->camera.height, further,
                      (double)row / job->band->rows);
}

static void render_row(size_t row, int worker, void *context)
{
    const Job *job = context;
    const Camera *camera = &job->scene->camera;
    report_progress(job, false, row, worker);
    for (int i = 0; i < camera->width; i++) {
        size_t pixel = row * (size_t)camera->width + (size_t)i;
        Ray ray = camera_ray(camera, i, job->band->first + (int)row);
        Surfel surfel;
        bool seen = caster_first(job->sight.caster, worker, ray, &surfel);
        store_geometry(job->frame, pixel, seen ? &surfel : NULL);
        if (!job->frame->color.values)
            continue;
        Rgb color = sight_color(&job->sight, worker, ray, i, job->band->first + (int)row,
                                seen ? &surfel : NULL);
        float *value = &job->frame->color.values[3 * pixel];
        value[0] = color.r;
        value[1] = color.g;
        value[2] = color.b;
    }
}

static void resample_row(size_t row, int worker, void *context)
{
    const Job *job = context;
    const Camera *camera = &job->scene->camera;
    report_progress(job, true, row, worker);
    for (int i = 0; i < camera->width; i++) {
        size_t pixel = row * (size_t)camera->width + (size_t)i;
        if (job->mask && !job->mask[pixel])
            continue;
        float *value = &job->frame->color.values[3 * pixel];
        Rgb color = antialiased(job, worker, i, job->band->first + (int)row,
                                (Rgb){value[0], value[1], value[2]});
        value[0] = color.r;
        value[1] = color.g;
        value[2] = color.b;
    }
}

/* The further samples, of all pixels or of those that differ from their neighbours. */
static Status resample(Job *job, int threads, Err *err)
{
    const RenderParams *params = job->params;
    const Plane *color = &job->frame->color;
    TRY(mem_calloc(&job->offsets, (size_t)params->antialias, sizeof *job->offsets, "samples", err));
    resample_offsets(params->antialias, job->offsets);
    if (params->antialias_threshold > 0) {
        TRY(mem_calloc(&job->mask, (size_t)color->width * (size_t)color->height, 1, "masks", err));
        resample_mask(color, job->band->above, job->band->below, (float)params->antialias_threshold,
                      threads, job->mask);
    }
    threads_for((size_t)color->height, threads, resample_row, job);
    return STATUS_OK;
}

static Status rayrender(const Renderer *renderer, const Band *band, Frame *frame, Err *err)
{
    const RenderParams *params = &renderer->params;
    Job job = {.scene = renderer->scene,
               .params = params,
               .sight = {renderer->scene, params, renderer->caster},
               .band = band,
               .frame = frame};
    Status status = STATUS_OK;
    threads_for((size_t)band->rows, renderer->threads, render_row, &job);
    if (params->antialias > 1 && frame->color.values)
        status = resample(&job, renderer->threads, err);
    free(job.offsets);
    free(job.mask);
    return status;
}

/* ---- bands ----------------------------------------------------------------------------------- */

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
    return err_set(err, STATUS_USAGE, "--kernels: this processor cannot run %s, at most %s",
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

static Status draw(Renderer *renderer, const Band *band, Frame *frame, Err *err)
{
    double start_s = clock_seconds();
    const RenderParams *params = &renderer->params;
    bool tiles = is_traced(renderer) ? is_field(renderer) : params->method == RENDER_RASTER;
    bool codes = params->codes_suffice && params->antialias == 1 && tiles;
    TRY(make_planes(renderer->scene->camera.width, band->rows, params, codes, frame, err));
    TRY(forget_other_views(renderer, err));
    if (!is_traced(renderer) && params->method == RENDER_RASTER)
        return rasterrender(renderer->scene, params, band, &renderer->raster, frame,
                            &renderer->stats, err);
    if (!is_traced(renderer))
        return zbuffer_render(renderer->scene, params, band, frame, &renderer->stats, err);
    if (is_field(renderer))
        return fieldrender(renderer->scene, params, renderer->caster, band, &renderer->field, frame,
                           &renderer->stats, err);
    TRY(rayrender(renderer, band, frame, err));
    renderer->stats.trace_s += clock_seconds() - start_s;
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

/* Takes the neighbours away. */
static void cut_frame(Frame *frame, const Band *band)
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
        cut_frame(&made, &band);
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
