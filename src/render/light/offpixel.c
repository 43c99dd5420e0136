/* Places are asked about in runs of the order that they have, whoever asks: an answer depends
 * neither on the number of threads nor on the band that is drawn. */
#include "render/light/offpixel.h"

#include "render/cast/caster.h"
#include "render/light/shadowqueue.h"
#include <stdlib.h>
#include <string.h>

enum { RUN = 4096 };

typedef struct Asking {
    const Drawing *drawing;
    const OffPixelPoints *places;
    size_t light;
    /* Of what is seen from the light: */
    const LightViews *views;
    const Viewpoint *frame;
    void **queues;  /* owned, as all that follows; one a worker */
    Status *status; /* likewise */
} Asking;

Status offpixel_init(const View *view, OffPixelPoints *places, Err *err)
{
    for (size_t i = 0; i < view->n_lights; i++)
        if (view->lights[i].casts_shadows)
            TRY(mem_calloc(&places->reach[i], places->n, sizeof *places->reach[i], "lights", err));
    return STATUS_OK;
}

void offpixel_release(OffPixelPoints *places)
{
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        free(places->reach[i]);
    *places = (OffPixelPoints){0};
}

static size_t runs_of(const OffPixelPoints *places)
{
    return (places->n + RUN - 1) / RUN;
}

static size_t end_of(const OffPixelPoints *places, size_t run)
{
    return (run + 1) * RUN < places->n ? (run + 1) * RUN : places->n;
}

/* ---- looking --------------------------------------------------------------------------------- */

/* Asks about the places from a number on, at most TILE_SAMPLES of them. */
static void ask_places(const Asking *asking, size_t from, size_t to, void *queue, uint32_t answer)
{
    const OffPixelPoints *places = asking->places;
    const TileKernels *kernels = tilekernels[kernels_kind(asking->drawing->params->kernels)];
    const Light *light = &asking->drawing->view->lights[asking->light];
    SeenPlaces seen = {.x = {0}};
    uint64_t wanted = 0;
    for (size_t i = 0; i < TILE_SAMPLES && from + i < to; i++) {
        Vec3 at = viewpoint_place(asking->frame, places->at(places->context, light, from + i));
        seen.x[i] = at.x;
        seen.y[i] = at.y;
        seen.z[i] = at.z;
        wanted |= (uint64_t)1 << i;
    }
    asking->views->ask(queue, kernels, &seen, wanted, answer);
}

static void look_at_run(size_t run, int worker, void *context)
{
    const Asking *asking = context;
    uint16_t *reach = asking->places->reach[asking->light];
    uint8_t shadowed[RUN] = {0};
    size_t from = run * RUN, to = end_of(asking->places, run);
    for (size_t i = from; i < to; i += TILE_SAMPLES)
        ask_places(asking, i, to, asking->queues[worker], (uint32_t)(i - from));
    Status status = asking->views->answer(asking->queues[worker], asking->drawing->params->kernels,
                                          shadowed, NULL);
    if (status != STATUS_OK)
        asking->status[worker] = status;
    for (size_t i = from; i < to; i++)
        reach[i] = (uint16_t)(reach[i] + !shadowed[i - from]);
}

static Status look(Asking *asking, const void *shadow, Err *err)
{
    size_t workers = (size_t)asking->drawing->params->threads;
    TRY(mem_calloc(&asking->queues, workers, sizeof *asking->queues, "lights", err));
    TRY(mem_calloc(&asking->status, workers, sizeof *asking->status, "lights", err));
    for (size_t i = 0; i < workers; i++)
        TRY(asking->views->queue_new(shadow, NULL, &asking->queues[i], err));
    threads_for(runs_of(asking->places), (int)workers, look_at_run, asking);
    for (size_t i = 0; i < workers; i++)
        if (asking->status[i] != STATUS_OK)
            return err_set(err, asking->status[i], "out of memory: no room for shadows");
    return STATUS_OK;
}

Status offpixel_query(const Drawing *drawing, const LightViews *views, const void *shadow,
                      const Viewpoint *frame, size_t light, OffPixelPoints *places, Err *err)
{
    Asking asking = {
        .drawing = drawing, .places = places, .light = light, .views = views, .frame = frame};
    Status status = look(&asking, shadow, err);
    for (int i = 0; asking.queues && i < drawing->params->threads; i++)
        views->queue_free(asking.queues[i]);
    free(asking.queues);
    free(asking.status);
    return status;
}

/* ---- rays ------------------------------------------------------------------------------------ */

static void cast_run(size_t run, int worker, void *context)
{
    const Asking *asking = context;
    const Drawing *drawing = asking->drawing;
    const OffPixelPoints *places = asking->places;
    const Light *light = &drawing->view->lights[asking->light];
    for (size_t i = run * RUN; i < end_of(places, run); i++) {
        Vec3 point = places->at(places->context, light, i);
        uint16_t seen = 0;
        for (int k = 0; k < light_points(light); k++) {
            LightWay way = light_way_to_point(light, k, point);
            seen = (uint16_t)(seen + !caster_shadow(drawing->caster, worker, &drawing->view->ground,
                                                    point, way.towards, way.distance));
        }
        places->reach[asking->light][i] = seen;
    }
}

void offpixel_trace(const Drawing *drawing, size_t light, OffPixelPoints *places)
{
    Asking asking = {.drawing = drawing, .places = places, .light = light};
    threads_for(runs_of(places), drawing->params->threads, cast_run, &asking);
}
