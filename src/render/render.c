/* The potential is drawn by fieldrender.c. For primitives rays are cast one a sample and rows are the
 * unit of work, so that the picture does not depend on the number of threads. Samples stand where POV-Ray puts them: the centre of the pixel, and with
 * antialiasing an N x N grid more; their mean weighs all N * N + 1 alike (tracetask.cpp
 * of 3.7.0.10: every pixel is supersampled when the threshold is 0). */
#include "render/render.h"

#include "render/caster.h"
#include "render/fieldrender.h"
#include "render/resample.h"
#include "render/shade.h"
#include <math.h>
#include <stdlib.h>

typedef struct Job {
    const Scene *scene;
    const RenderParams *params;
    Caster *caster;
    Frame *frame;
    double *offsets; /* of a pixel's further samples */
    uint8_t *mask;   /* pixels that get them; NULL: all */
} Job;

typedef struct ShadowContext {
    Caster *caster;
    int worker;
} ShadowContext;

static bool shadowed(void *context, Vec3 point, Vec3 towards, double distance)
{
    const ShadowContext *shadow = context;
    return caster_shadow(shadow->caster, shadow->worker, point, towards, distance);
}

static Rgb surfel_color(const Job *job, int worker, Ray ray, const Surfel *surfel)
{
    ShadowContext context = {job->caster, worker};
    return shade(job->scene, surfel->pigment, ray_at(ray, surfel->t), surfel->normal, ray.direction,
                 job->params->shadows ? shadowed : NULL, &context);
}

static Rgb sample_color(const Job *job, int worker, double i, double j)
{
    Ray ray = camera_ray(&job->scene->camera, i, j);
    Surfel surfel;
    if (!caster_first(job->caster, worker, ray, &surfel))
        return job->scene->background;
    return surfel_color(job, worker, ray, &surfel);
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

static void render_row(size_t row, int worker, void *context)
{
    const Job *job = context;
    const Camera *camera = &job->scene->camera;
    if (worker == 0 && job->params->progress)
        job->params->progress((double)row / camera->height, job->params->progress_context);
    for (int i = 0; i < camera->width; i++) {
        size_t pixel = row * (size_t)camera->width + (size_t)i;
        Ray ray = camera_ray(camera, i, (double)row);
        Surfel surfel;
        bool seen = caster_first(job->caster, worker, ray, &surfel);
        store_geometry(job->frame, pixel, seen ? &surfel : NULL);
        if (!job->frame->color.values)
            continue;
        Rgb color = job->scene->background;
        if (seen)
            color = surfel_color(job, worker, ray, &surfel);
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
    if (worker == 0 && job->params->progress)
        job->params->progress((double)row / camera->height, job->params->progress_context);
    for (int i = 0; i < camera->width; i++) {
        size_t pixel = row * (size_t)camera->width + (size_t)i;
        if (job->mask && !job->mask[pixel])
            continue;
        float *value = &job->frame->color.values[3 * pixel];
        Rgb color = antialiased(job, worker, i, (int)row, (Rgb){value[0], value[1], value[2]});
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
        resample_mask(color, (float)params->antialias_threshold, threads, job->mask);
    }
    threads_for((size_t)color->height, threads, resample_row, job);
    return STATUS_OK;
}

static Status make_planes(const Camera *camera, const RenderParams *params, Frame *frame, Err *err)
{
    int width = camera->width, height = camera->height;
    if (params->want_color)
        TRY(plane_init(&frame->color, width, height, 3, err));
    if (params->want_depth)
        TRY(plane_init(&frame->depth, width, height, 1, err));
    if (params->want_normal)
        TRY(plane_init(&frame->normal, width, height, 3, err));
    if (params->want_id)
        TRY(idplane_init(&frame->id, width, height, err));
    return STATUS_OK;
}

static Status rayrender(const Scene *scene, const RenderParams *params, Frame *frame,
                        RenderStats *stats, Err *err)
{
    Caster *caster = NULL;
    int threads = params->threads > 0 ? params->threads : threads_available();
    double start_s = clock_seconds();
    TRY(caster_new(scene, params->povray_cells, threads, &caster, err));
    double built_s = clock_seconds();
    Job job = {scene, params, caster, frame, NULL, NULL};
    Status status = STATUS_OK;
    threads_for((size_t)scene->camera.height, threads, render_row, &job);
    if (params->antialias > 1 && frame->color.values)
        status = resample(&job, threads, err);
    free(job.offsets);
    free(job.mask);
    caster_free(caster);
    if (stats)
        *stats = (RenderStats){.prepare_s = built_s - start_s,
                               .trace_s = clock_seconds() - built_s,
                               .rays = (size_t)scene->camera.width * (size_t)scene->camera.height};
    return status;
}

Status render(const Scene *scene, const RenderParams *params, Frame *frame, RenderStats *stats,
              Err *err)
{
    Frame made = {0};
    double start_s = clock_cpu_seconds();
    Status status = make_planes(&scene->camera, params, &made, err);
    if (status == STATUS_OK)
        status = scene->model == SCENE_ISOSURFACE && !params->povray_cells
                     ? fieldrender(scene, params, &made, stats, err)
                     : rayrender(scene, params, &made, stats, err);
    if (status != STATUS_OK) {
        frame_release(&made);
        return status;
    }
    *frame = made;
    if (stats)
        stats->cpu_s = clock_cpu_seconds() - start_s;
    return STATUS_OK;
}
