/* Counts the visible points of lights at shading points that belong to no pixel, such as those of
 * thin vessels. Points query in runs, in the order of their indices. Rounding in the shadow kernels
 * depends on which points are queried together; since runs are always the same, a result depends
 * neither on the number of threads nor on the band that is drawn. */
#include "render/light/offpixel.h"

#include "render/light/shadowpass.h"
#include <stdlib.h>

/* Points of a run, the unit of work of a thread; at most SHADOW_RUN. A different number would
 * change the last digits of results, because kernels round differently. */
enum { RUN = 4096 };

Status offpixel_init(const View *view, OffPixelPoints *points, Err *err)
{
    for (size_t i = 0; i < view->n_lights; i++)
        if (view->lights[i].casts_shadows)
            TRY(mem_calloc(&points->n_visible[i], points->n, sizeof *points->n_visible[i], "lights",
                           err));
    return STATUS_OK;
}

void offpixel_release(OffPixelPoints *points)
{
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        free(points->n_visible[i]);
    *points = (OffPixelPoints){0};
}

/* The arguments of the threads that query one light. */
typedef struct OffPixelJob {
    const Drawing *drawing;
    const OffPixelPoints *points;
    const Viewpoint *frame; /* of the light views */
    size_t light;
    ShadowPass pass;
} OffPixelJob;

static size_t run_count(const OffPixelPoints *points)
{
    return (points->n + RUN - 1) / RUN;
}

static size_t run_end(const OffPixelPoints *points, size_t run)
{
    return (run + 1) * RUN < points->n ? (run + 1) * RUN : points->n;
}

/* ShadowClient.locate: all points query. */
static uint64_t locate_points(const void *context, size_t first, size_t n, HitPoints *frame_points)
{
    const OffPixelJob *job = context;
    const OffPixelPoints *points = job->points;
    const Light *light = &job->drawing->view->lights[job->light];
    for (size_t i = 0; i < n; i++) {
        Vec3 at = viewpoint_frame_point(job->frame, points->at(points->context, light, first + i));
        frame_points->x[i] = at.x;
        frame_points->y[i] = at.y;
        frame_points->z[i] = at.z;
    }
    return UINT64_MAX >> (TILE_SAMPLES - n);
}

/* ShadowClient.store: adds to the count, because the points of an area light come set by set. */
static void add_visible(const void *context, size_t index, int n_lit)
{
    const OffPixelJob *job = context;
    uint16_t *n_visible = &job->points->n_visible[job->light][index];
    *n_visible = (uint16_t)(*n_visible + n_lit);
}

static Status query_run(size_t run, int worker, void *context, Err *err)
{
    const OffPixelJob *job = context;
    return shadowpass_run(&job->pass, run * RUN, run_end(job->points, run), worker, err);
}

Status offpixel_query(const Drawing *drawing, const OffPixelViews *views, size_t light,
                      OffPixelPoints *points, Err *err)
{
    OffPixelJob job = {.drawing = drawing, .points = points, .frame = views->frame, .light = light};
    Status status;
    job.pass.client = (ShadowClient){locate_points, add_visible, &job};
    TRY_GOTO(shadowpass_init(drawing, views->bins, views->n_views, NULL, &job.pass, err));
    TRY_GOTO(threads_try(run_count(points), drawing->params->threads, query_run, &job, err));
done:
    shadowpass_release(&job.pass);
    return status;
}

static void trace_run(size_t run, int worker, void *context)
{
    const OffPixelJob *job = context;
    const OffPixelPoints *points = job->points;
    const Light *light = &job->drawing->view->lights[job->light];
    for (size_t i = run * RUN; i < run_end(points, run); i++) {
        Vec3 point = points->at(points->context, light, i);
        points->n_visible[job->light][i] =
            (uint16_t)shadowrays_count(job->drawing, worker, light, ALL_SETS, point);
    }
}

void offpixel_trace(const Drawing *drawing, size_t light, OffPixelPoints *points)
{
    OffPixelJob job = {.drawing = drawing, .points = points, .light = light};
    threads_for(run_count(points), drawing->params->threads, trace_run, &job);
}
