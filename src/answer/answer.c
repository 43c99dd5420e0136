/* Computes the answers of all pixels, in parallel. Tiles are the unit of work. Each pixel is
 * computed on its own from what its tile shows, so that neither tiles nor threads change the
 * result. */
#include "answer/answer.h"

#include "answer/certificate.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pixels along a side of a tile. All pixels of a tile search one list of faces. */
enum { TILE_SIDE = 16 };

typedef struct AnswerJob {
    AnswerPlan plan;
    AnswerWorkspace *works; /* per thread; owned */
    int threads, columns, rows;
    Plane plane;
} AnswerJob;

/* ---- pixels ---------------------------------------------------------------------------------- */

static float rounded_down(double value)
{
    const float near = (float)value;
    return (double)near > value ? nextafterf(near, -INFINITY) : near;
}

static float rounded_up(double value)
{
    const float near = (float)value;
    return (double)near < value ? nextafterf(near, INFINITY) : near;
}

static void store(const AnswerPlan *plan, const ColorInterval *interval, const Center *center,
                  float *values)
{
    const uint32_t *ids = plan->scene->geometry.ids;
    for (int c = 0; c < 3; c++) {
        values[ANSWER_LOW + c] = rounded_down(interval->low[c]);
        values[ANSWER_HIGH + c] = rounded_up(interval->high[c]);
    }
    values[ANSWER_STATE] = interval_width(interval) <= plan->params.width ? ANSWER_DECIDED
                           : plan->params.pattern > 0                     ? ANSWER_UNDECIDED
                                                                          : ANSWER_OVER_BUDGET;
    values[ANSWER_ID] =
        center->face == UINT32_MAX ? 0 : (float)ids[plan->faces[center->face].segment];
    values[ANSWER_NEAR] = rounded_down(center->near);
    values[ANSWER_FAR] = rounded_up(center->far);
}

/* Returns how many pixels beyond a pixel its square reaches: a wide filter includes parts of the
 * next pixels. */
static int filter_reach(const AnswerPlan *plan)
{
    return plan->params.filter > 1;
}

/* Lists the faces in a pixel, of those in its tile. */
static void list_pixel(AnswerWorkspace *work, int i, int j)
{
    const AnswerPlan *plan = work->plan;
    const int reach = filter_reach(plan);
    work->pixel.n = 0;
    for (size_t k = 0; k < work->tile.n; k++) {
        const uint32_t face = work->tile.faces[k];
        const PixelRect *on = &plan->screen[face];
        if (i + reach >= on->left && i < on->left + on->width + reach && j + reach >= on->top &&
            j < on->top + on->height + reach)
            work->pixel.faces[work->pixel.n++] = face;
    }
    if (plan->has_ground)
        work->pixel.faces[work->pixel.n++] = (uint32_t)plan->n;
}

static Status pixel_interval(AnswerWorkspace *work, int i, int j, ColorInterval *interval, Err *err)
{
    if (work->plan->params.pattern == 0)
        return area_answer(work, i, j, interval, err);
    *interval = pattern_answer(work, i, j);
    return STATUS_OK;
}

static Status answer_pixel(AnswerWorkspace *work, int i, int j, float *values, Err *err)
{
    const Beam ray = answerplan_ray(work->plan, i + 0.5, j + 0.5);
    Center center;
    ColorInterval interval;
    list_pixel(work, i, j);
    find_center(work, &ray, &center);
    TRY(pixel_interval(work, i, j, &interval, err));
    store(work->plan, &interval, &center, values);
    work->undecided += values[ANSWER_STATE] != ANSWER_DECIDED;
    return STATUS_OK;
}

/* Lists the faces that pixels of a tile may show. */
static void list_tile(AnswerWorkspace *work, const PixelRect *tile)
{
    const int reach = filter_reach(work->plan);
    work->tile.n = 0;
    for (size_t k = 0; k < work->plan->n; k++) {
        const PixelRect *on = &work->plan->screen[k];
        if (on->left < tile->left + tile->width + reach &&
            tile->left < on->left + on->width + reach &&
            on->top < tile->top + tile->height + reach && tile->top < on->top + on->height + reach)
            work->tile.faces[work->tile.n++] = (uint32_t)k;
    }
}

static Status report(const AnswerJob *job, size_t tile, int worker, Err *err)
{
    const AnswerParams *params = &job->plan.params;
    if (worker != 0 || !params->progress)
        return STATUS_OK;
    const double part = (double)tile / ((double)job->columns * job->rows);
    return params->progress(part, params->progress_context) ? STATUS_OK : err_cancelled(err);
}

static Status answer_tile(size_t tile, int worker, void *context, Err *err)
{
    AnswerJob *job = context;
    AnswerWorkspace *work = &job->works[worker];
    const Camera *camera = &job->plan.scene->view.camera;
    const int left = (int)(tile % (size_t)job->columns) * TILE_SIDE;
    const int top = (int)(tile / (size_t)job->columns) * TILE_SIDE;
    const int width = camera->width - left < TILE_SIDE ? camera->width - left : TILE_SIDE;
    const int height = camera->height - top < TILE_SIDE ? camera->height - top : TILE_SIDE;
    TRY(report(job, tile, worker, err));
    list_tile(work, &(PixelRect){left, top, width, height});
    for (int j = top; j < top + height; j++)
        for (int i = left; i < left + width; i++) {
            const size_t pixel = (size_t)j * (size_t)camera->width + (size_t)i;
            TRY(answer_pixel(work, i, j, job->plane.values + pixel * ANSWER_CHANNELS, err));
        }
    return STATUS_OK;
}

/* Writes the claims of some pixels. These pixels are evenly spaced in the list of all pixels that
 * show a vessel at their center. */
static Status certify(AnswerJob *job, Err *err)
{
    AnswerWorkspace *work = &job->works[0];
    const AnswerParams *params = &job->plan.params;
    const size_t width = (size_t)job->plane.width, n = width * (size_t)job->plane.height;
    size_t shown = 0, seen = 0;
    for (size_t pixel = 0; pixel < n; pixel++)
        shown += !isinf(job->plane.values[pixel * ANSWER_CHANNELS + ANSWER_NEAR]);
    const size_t step = shown / (size_t)params->certified + 1;
    certificate_begin(&job->plan, params->certificate);
    for (size_t pixel = 0; pixel < n; pixel++) {
        const int i = (int)(pixel % width), j = (int)(pixel / width);
        ColorInterval interval;
        if (isinf(job->plane.values[pixel * ANSWER_CHANNELS + ANSWER_NEAR]) || seen++ % step != 0)
            continue;
        list_tile(work, &(PixelRect){i, j, 1, 1});
        list_pixel(work, i, j);
        TRY(pixel_interval(work, i, j, &interval, err));
        certificate_put_pixel(work, i, j, &interval, seen == 1, params->certificate);
    }
    text_puts(params->certificate, "]}\n");
    return text_check(params->certificate, err);
}

static Status make_works(AnswerJob *job, Err *err)
{
    job->threads = job->plan.params.threads > 0 ? job->plan.params.threads : threads_available();
    TRY(mem_calloc(&job->works, (size_t)job->threads, sizeof *job->works, "workspaces", err));
    for (int i = 0; i < job->threads; i++) {
        AnswerWorkspace *work = &job->works[i];
        work->plan = &job->plan;
        FaceList *lists[] = {&work->tile, &work->pixel, &work->blockers};
        for (size_t k = 0; k < sizeof lists / sizeof *lists; k++)
            TRY(mem_calloc(&lists[k]->faces, job->plan.n + 1, sizeof *lists[k]->faces, "faces",
                           err));
        TRY(levelworkspace_make(&job->plan, &work->levels, err));
    }
    return STATUS_OK;
}

static void release_works(AnswerJob *job)
{
    for (int i = 0; job->works && i < job->threads; i++) {
        free(job->works[i].tile.faces);
        free(job->works[i].pixel.faces);
        free(job->works[i].blockers.faces);
        ARRAY_RELEASE(&job->works[i].leaves);
        ARRAY_RELEASE(&job->works[i].heap);
        levelworkspace_release(&job->works[i].levels);
    }
    free(job->works);
}

Status answer_make(const Scene *scene, const AnswerParams *params, Answer *out, Err *err)
{
    const Camera *camera = &scene->view.camera;
    AnswerJob job = {.columns = (camera->width + TILE_SIDE - 1) / TILE_SIDE,
                     .rows = (camera->height + TILE_SIDE - 1) / TILE_SIDE};
    Status status;
    TRY_GOTO(answerplan_make(scene, params, &job.plan, err));
    TRY_GOTO(make_works(&job, err));
    TRY_GOTO(plane_init(&job.plane, camera->width, camera->height, ANSWER_CHANNELS, err));
    TRY_GOTO(
        threads_try((size_t)job.columns * (size_t)job.rows, job.threads, answer_tile, &job, err));
    if (params->certificate)
        TRY_GOTO(certify(&job, err));
    Answer made = {.plane = job.plane, .scene = answer_scene_hash(scene, params->shadows)};
    for (int i = 0; i < job.threads; i++) {
        made.beams += job.works[i].beams;
        made.undecided += job.works[i].undecided;
    }
    *out = made;
    job.plane = (Plane){0};
done:
    plane_release(&job.plane);
    release_works(&job);
    answerplan_release(&job.plan);
    return status;
}

void answer_release(Answer *answer)
{
    plane_release(&answer->plane);
    *answer = (Answer){0};
}
