/* The ray engine: traces each camera ray separately, and draws what no faster engine draws. The
 * color of a ray is found by raycolor.c. A row of pixels is the unit of work, so that the picture
 * does not depend on the number of threads.
 *
 * Samples are where POV-Ray puts them: at the centre of the pixel and, with antialiasing, at N x N
 * more positions. The N * N + 1 samples have equal weights (tracetask.cpp of POV-Ray 3.7.0.10:
 * every pixel is supersampled if the threshold is 0). */
#include "render/engine.h"
#include "render/light/raycolor.h"
#include "render/light/resample.h"
#include "render/planes.h"

/* The band that is drawn. `more` is the further samples of antialiasing. */
typedef struct RayPicture {
    const Drawing *drawing;
    Frame *frame;
    Resampling more;
} RayPicture;

/* Returns the color at the picture position (i, j), pixels. */
static Rgb sample_color(const RayPicture *picture, int worker, double i, double j)
{
    Ray ray = camera_ray(&picture->drawing->view->camera, i, j);
    Surfel surfel;
    bool seen = caster_first(picture->drawing->caster, worker, ray, &surfel);
    return ray_color(picture->drawing, worker, ray, i, j, seen ? &surfel : NULL);
}

/* Returns the mean of the centre sample and the N x N samples, summed row by row in float. */
static Rgb antialiased(const RayPicture *picture, int worker, int i, int j, Rgb center)
{
    int n = picture->more.side;
    Rgb sum = center;
    for (int y = 0; y < n; y++) {
        for (int x = 0; x < n; x++) {
            Rgb sample = sample_color(picture, worker, i + picture->more.offsets[x],
                                      j + picture->more.offsets[y]);
            sum.r += sample.r;
            sum.g += sample.g;
            sum.b += sample.b;
        }
    }
    return (Rgb){resampling_mean(&picture->more, sum.r), resampling_mean(&picture->more, sum.g),
                 resampling_mean(&picture->more, sum.b)};
}

/* Draws the centre samples of a row of the band, and its planes of geometry. */
static Status render_row(size_t row, int worker, void *context, Err *err)
{
    const RayPicture *picture = context;
    const Camera *camera = &picture->drawing->view->camera;
    TRY(drawing_progress(picture->drawing, worker, false, row, err));
    for (int i = 0; i < camera->width; i++) {
        Ray ray = camera_ray(camera, i, picture->drawing->band.first + (int)row);
        Surfel surfel;
        bool seen = caster_first(picture->drawing->caster, worker, ray, &surfel);
        raycolor_store(picture->drawing, worker, i, (int)row, seen ? &surfel : NULL,
                       picture->frame);
    }
    return STATUS_OK;
}

/* Replaces the colors of the row's chosen pixels by the means of all their samples. */
static Status resample_row(size_t row, int worker, void *context, Err *err)
{
    const RayPicture *picture = context;
    const Camera *camera = &picture->drawing->view->camera;
    TRY(drawing_progress(picture->drawing, worker, true, row, err));
    for (int i = 0; i < camera->width; i++) {
        size_t pixel = row * (size_t)camera->width + (size_t)i;
        if (!resampling_wants(&picture->more, pixel))
            continue;
        const float *center = &picture->frame->color.values[3 * pixel];
        planes_store_color(picture->frame, pixel,
                           antialiased(picture, worker, i, picture->drawing->band.first + (int)row,
                                       (Rgb){center[0], center[1], center[2]}));
    }
    return STATUS_OK;
}

static Status draw_rows(const Drawing *drawing, void *prepared, Frame *frame, Err *err)
{
    (void)prepared;
    const RenderParams *params = drawing->params;
    const Band *band = &drawing->band;
    RayPicture picture = {.drawing = drawing,
                          .frame = frame,
                          .more = resampling_for(frame->color.values ? params->antialias : 1)};
    const size_t rows = (size_t)band->rows;
    Status status = STATUS_OK;
    TRY_GOTO(threads_try(rows, params->threads, render_row, &picture, err));
    if (picture.more.side == 0)
        goto done;
    TRY_GOTO(resampling_choose(&picture.more, params, band, &frame->color, err));
    status = threads_try(rows, params->threads, resample_row, &picture, err);
done:
    resampling_release(&picture.more);
    return status;
}

static bool always(const Drawing *drawing)
{
    (void)drawing;
    return true;
}

const Engine ray_engine = {
    .name = "trace", .supports = always, .needs_rays = always, .rows = draw_rows};
