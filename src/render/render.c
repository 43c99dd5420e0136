/* Rays are cast one a sample and rows are the unit of work, so that the picture does not depend on
 * the number of threads. Samples stand where POV-Ray puts them: the centre of the pixel, and with
 * antialiasing an N x N grid more; their mean weighs all N * N + 1 alike (tracetask.cpp
 * of 3.7.0.10: every pixel is supersampled when the threshold is 0). */
#include "render/render.h"

#include "render/caster.h"
#include "render/fieldrender.h"
#include "render/shade.h"
#include <math.h>

typedef struct Job {
    const Scene *scene;
    const RenderParams *params;
    Caster *caster;
    Frame *frame;
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
    double step = 1.0 / n, range = 0.5 - step * 0.5, end = range + 1e-10;
    Rgb sum = center;
    for (double y = -range; y <= end; y += step) {
        for (double x = -range; x <= end; x += step) {
            Rgb sample = sample_color(job, worker, i + x, j + y);
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
        if (job->params->antialias > 1)
            color = antialiased(job, worker, i, (int)row, color);
        float *value = &job->frame->color.values[3 * pixel];
        value[0] = color.r;
        value[1] = color.g;
        value[2] = color.b;
    }
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
    Job job = {scene, params, caster, frame};
    threads_for((size_t)scene->camera.height, threads, render_row, &job);
    caster_free(caster);
    if (stats)
        *stats = (RenderStats){.prepare_s = built_s - start_s,
                               .trace_s = clock_seconds() - built_s,
                               .rays = (size_t)scene->camera.width * (size_t)scene->camera.height};
    return STATUS_OK;
}

Status render(const Scene *scene, const RenderParams *params, Frame *frame, RenderStats *stats,
              Err *err)
{
    Frame made = {0};
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
    return STATUS_OK;
}
