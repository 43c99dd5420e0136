/* A light's view has lists of segments as a camera's has, for all its tiles at once, as places come
 * in the order of the picture. Kernels look from the places to the light: so once the lists are
 * made, segments are reflected, in the plane of a parallel light, in the place of a point, such
 * that lines of sight keep their places in the view and z rises towards the light. */
#include "render/field/fieldshadow.h"

#include "render/cast/caster.h"
#include "render/field/fieldkernels.h"
#include "render/field/fieldspace.h"
#include "render/field/vessellists.h"
#include <stdlib.h>
#include <string.h>

/* Blockers nearer than this to the lit place cast no shadow [docs/POVRAY.md section 3]. */
static const double nearest_mm = 1e-3;

/* The segments as one light sees them; constant once built. */
typedef struct FieldShadow {
    const Geometry *geometry;
    LightView view;
    LightAim aim;
    VesselLists lists;
    BinLists *rows; /* of tiles: the lists of each */
    TileSpan *columns;
    int workers;
} FieldShadow;

typedef struct FieldQueue {
    const FieldShadow *shadow;
    const bool *hidden; /* per segment: the camera does not see it; NULL: it sees all. Borrowed. */
    ShadowQueue *queue;
    uint32_t answer[SHADOW_BATCH]; /* of each call */
    /* Of the answers at hand: */
    ShadowKernel *kernel;
    uint8_t *shadowed;
    Status status;
    Err *err;
    FieldPlaces places;
    QueuedPoints near;                  /* places at hidden segments */
    uint8_t is_near[SHADOW_MAX_POINTS]; /* per place of a request */
    FieldSpace space;
} FieldQueue;

/* ---- what a light sees ----------------------------------------------------------------------- */

static bool can_look(const Geometry *geometry, const View *view, const Light *light)
{
    LightWay way = light_way(light, box_center(geometry->bounds));
    return lightview_sees_all(geometry, view, light) && way.distance > lightview_radius(geometry);
}

typedef struct Listing {
    FieldShadow *shadow;
    Status *status; /* of each worker */
} Listing;

static void list_row(size_t row, int worker, void *context)
{
    const Listing *listing = context;
    FieldShadow *shadow = listing->shadow;
    if (listing->status[worker] == STATUS_OK)
        listing->status[worker] = vessellists_row(
            &shadow->lists, row, shadow->columns + (size_t)worker * shadow->lists.longest,
            &shadow->rows[row], NULL);
}

static Status list_rows(FieldShadow *shadow, Err *err)
{
    size_t n = (size_t)shadow->lists.tile_rows, workers = (size_t)shadow->workers;
    Listing listing = {shadow, NULL};
    TRY(mem_calloc(&shadow->rows, n, sizeof *shadow->rows, "rows of tiles", err));
    TRY(mem_calloc(&shadow->columns, workers * shadow->lists.longest, sizeof *shadow->columns,
                   "rows of tiles", err));
    TRY(mem_calloc(&listing.status, workers, sizeof *listing.status, "rows of tiles", err));
    threads_for(n, shadow->workers, list_row, &listing);
    Status status = STATUS_OK;
    for (size_t i = 0; i < workers && status == STATUS_OK; i++)
        if (listing.status[i] != STATUS_OK)
            status = err_set(err, listing.status[i], "out of memory: no room for shadows");
    free(listing.status);
    free(shadow->columns);
    shadow->columns = NULL;
    return status;
}

static Vec3 reflected(const VesselLists *lists, Vec3 v)
{
    return lists->eye.perspective ? vec3_scale(v, -1) : vec3(v.x, v.y, -v.z);
}

static void reflect_segments(VesselLists *lists)
{
    for (size_t i = 0; i < lists->n_segments; i++) {
        FrameSegment *segment = &lists->segments[i];
        segment->a = reflected(lists, segment->a);
        segment->b = reflected(lists, segment->b);
        segment->axis = reflected(lists, segment->axis);
    }
}

static void free_shadow(void *of)
{
    FieldShadow *shadow = of;
    if (!shadow)
        return;
    for (int i = 0; shadow->rows && i < shadow->lists.tile_rows; i++)
        binlists_release(&shadow->rows[i]);
    free(shadow->rows);
    free(shadow->columns);
    vessellists_release(&shadow->lists);
    free(shadow);
}

/* Tiles on a side of a light's view: half as many as those of the picture, but no more tiles than
 * segments. */
static int tiles_for(const Camera *camera, size_t n_segments)
{
    enum { LEAST = 16, MOST = 384 };
    int side = (camera->width > camera->height ? camera->width : camera->height) / 16;
    side = (int)min_of(side, sqrt((double)n_segments));
    return side < LEAST ? LEAST : side > MOST ? MOST : side;
}

static Status look(const Drawing *drawing, const Light *light, const Viewpoint *frame,
                   const Box *asked, void **out, Err *err)
{
    Status status;
    FieldShadow *shadow = NULL;
    const RenderParams *params = drawing->params;
    double from_mm = params->shadow_from_mm > 0 ? params->shadow_from_mm : nearest_mm;
    if (model_has(drawing->geometry->model, MODEL_BLOB))
        from_mm = BLOB_NEAREST_MM;
    TRY(mem_calloc(&shadow, 1, sizeof *shadow, "shadows", err));
    shadow->geometry = drawing->geometry;
    shadow->workers = params->threads;
    shadow->view =
        lightview_of(drawing->geometry, light,
                     tiles_for(&drawing->view->camera, drawing->geometry->n_segments), asked);
    shadow->aim = lightview_aim(&shadow->view, frame, from_mm);
    TRY_GOTO(vessellists_of_light(drawing->geometry, &shadow->view, params->threads, &shadow->lists,
                                  err));
    TRY_GOTO(list_rows(shadow, err));
    reflect_segments(&shadow->lists);
    *out = shadow;
    return STATUS_OK;
done:
    free_shadow(shadow);
    return status;
}

/* ---- asking ---------------------------------------------------------------------------------- */

static Status new_queue(const void *of, const bool *hidden, void **out, Err *err)
{
    const FieldShadow *shadow = of;
    FieldQueue *queue;
    TRY(mem_calloc(&queue, 1, sizeof *queue, "shadows", err));
    *out = queue;
    queue->shadow = shadow;
    queue->hidden = hidden;
    TRY(fieldspace_init(shadow->geometry, &queue->space, err));
    return shadowqueue_new(&shadow->aim, &queue->queue, err);
}

static void free_queue(void *of)
{
    FieldQueue *queue = of;
    if (!queue)
        return;
    shadowqueue_free(queue->queue);
    fieldspace_release(&queue->space);
    free(queue);
}

static void ask(void *to, const TileKernels *kernels, const SeenPlaces *places, uint64_t wanted,
                uint32_t answer)
{
    FieldQueue *queue = to;
    if (wanted)
        queue->answer[shadowqueue_ask(queue->queue, kernels, places, wanted)] = answer;
}

/* A tile of the light but for its terms. */
static FieldTile tile_of(const FieldShadow *shadow, int number, LocalGroups *groups)
{
    const LightView *view = &shadow->view;
    const double half = TILE_SIDE / 2.0, middle = half - 0.5;
    int row = number / view->tiles, column = number % view->tiles;
    return (FieldTile){.groups = groups,
                       .perspective = view->eye.perspective,
                       .any_depth = true,
                       .middle_x = view->left + (column * TILE_SIDE + middle) * view->step_x,
                       .middle_y = view->top + (row * TILE_SIDE + middle) * view->step_y,
                       .half_size =
                           (float)(1.0001 * half * elementary_hypot(view->step_x, view->step_y)),
                       .z_min = HUGE_VAL};
}

/* Sets the z of a request's places to those that the kernel reads, and the tile's z_min, from where
 * on vessels matter. Leaves out places outside the tile: they are outside the light's view, and see
 * the light. Returns how many are left. */
static int place_request(const FieldQueue *queue, const TileQueries *request, FieldTile *tile)
{
    QueuedPoints *asked = request->places;
    const LightAim *aim = &queue->shadow->aim;
    float half_x = (float)fabs(0.50005 / aim->per_x), half_y = (float)fabs(0.50005 / aim->per_y);
    int n = 0;
    for (int i = 0; i < request->n; i++) {
        float x = asked->x[i], y = asked->y[i];
        double z = -(asked->z[i] + aim->z_middle);
        if (!(fabsf(x) <= half_x && fabsf(y) <= half_y))
            continue;
        asked->x[n] = x;
        asked->y[n] = y;
        asked->z[n] = z;
        asked->from[n] = asked->from[i];
        tile->z_min = min_of(tile->z_min, z);
        n++;
    }
    return n;
}

/* Gives the kernel n > 0 places, in their own memory. */
static void set_places(QueuedPoints *asked, int n, FieldPlaces *places)
{
    places->x = asked->x;
    places->y = asked->y;
    places->z = asked->z;
    places->n = n;
    for (int i = n; i < n + POINT_PADDING; i++) {
        places->x[i] = places->x[n - 1];
        places->y[i] = places->y[n - 1];
        places->z[i] = places->z[n - 1];
    }
}

/* Decides a place in double precision. */
static Status decide(FieldQueue *queue, const FieldTile *tile, int number, Err *err)
{
    const FieldShadow *shadow = queue->shadow;
    const Viewpoint *eye = &shadow->view.eye;
    FieldPlaces *places = &queue->places;
    double z = -places->z[number], scale = eye->perspective ? z : 1;
    Vec3 place = {(tile->middle_x + (double)places->x[number]) * scale,
                  (tile->middle_y + (double)places->y[number]) * scale, z};
    Vec3 towards = viewpoint_to_world(eye, eye->perspective ? place : vec3(0, 0, 1));
    Ray ray = {viewpoint_point(eye, place), vec3_normalized(vec3_scale(towards, -1))};
    TRY(fieldspace_reserve_rays(&queue->space, tile->n_terms, err));
    bool dark = fieldspace_is_shadowed(&queue->space, tile->n_terms, ray);
    places->state[number] = dark ? PLACE_DARK : PLACE_LIT;
    return STATUS_OK;
}

/* Where the list of a tile begins in its row's items, and where that of the next does. */
static const size_t *list_of(const FieldShadow *shadow, int tile)
{
    return &shadow->rows[tile / shadow->view.tiles].offsets[tile % shadow->view.tiles];
}

/* Place i in the frame of the segments. */
static Vec3 place_at(const FieldTile *tile, const QueuedPoints *asked, int i)
{
    const double z = asked->z[i], scale = tile->perspective ? z : 1;
    return vec3((tile->middle_x + (double)asked->x[i]) * scale,
                (tile->middle_y + (double)asked->y[i]) * scale, z);
}

/* Marks the places of [first, end) that lie within reach of a segment. */
static void mark_near(FieldQueue *queue, const FieldTile *tile, const QueuedPoints *asked,
                      int first, int end, const FrameSegment *segment)
{
    for (int i = first; i < end; i++) {
        const Vec3 from = vec3_sub(place_at(tile, asked, i), segment->a);
        const double along = min_of(max_of(vec3_dot(from, segment->axis), 0), segment->length);
        const Vec3 off = vec3_add_scaled(from, segment->axis, -along);
        queue->is_near[i] |= vec3_dot(off, off) < segment->reach * segment->reach;
    }
}

/* Marks the n places that lie within reach of a hidden segment. Places that follow one another are
 * close together: most blocks of them are far from a segment. */
static void find_near(FieldQueue *queue, const FieldTile *tile, const QueuedPoints *asked, int n)
{
    Box blocks[SHADOW_BATCH];
    for (int i = 0; i < n; i++) {
        Box *block = &blocks[i / TILE_SAMPLES];
        *block =
            box_with_ball(i % TILE_SAMPLES ? *block : box_empty(), place_at(tile, asked, i), 0);
    }
    memset(queue->is_near, 0, (size_t)n);
    for (size_t i = 0; i < tile->n_terms; i++) {
        const uint32_t number = queue->space.candidates[i];
        const FrameSegment *segment = &queue->shadow->lists.segments[number];
        if (!queue->hidden[number])
            continue;
        Box box = box_with_ball(box_empty(), segment->a, segment->reach);
        box = box_with_ball(box, segment->b, segment->reach);
        for (int first = 0; first < n; first += TILE_SAMPLES)
            if (box_meets(box, blocks[first / TILE_SAMPLES]))
                mark_near(queue, tile, asked, first,
                          first + TILE_SAMPLES < n ? first + TILE_SAMPLES : n, segment);
    }
}

/* Moves the places within reach of a hidden segment from `asked` to queue->near. Returns how many
 * places are moved, and sets *n to how many are left.
 *
 * The camera sees the surface that is left without the hidden segments. Where a hidden segment
 * begins, places on that surface lie inside the body of all segments. That body hides every light
 * from them. So a hidden segment casts no shadow on places that its own term reaches. It is thinner
 * than a pixel, and its term reaches 2.4 of its radii. */
static int set_apart(FieldQueue *queue, const FieldTile *tile, QueuedPoints *asked, int *n)
{
    const int n_asked = *n;
    int n_near = *n = 0;
    find_near(queue, tile, asked, n_asked);
    for (int i = 0; i < n_asked; i++) {
        QueuedPoints *to = queue->is_near[i] ? &queue->near : asked;
        int at = queue->is_near[i] ? n_near++ : (*n)++;
        to->x[at] = asked->x[i];
        to->y[at] = asked->y[i];
        to->z[at] = asked->z[i];
        to->from[at] = asked->from[i];
    }
    return n_near;
}

/* Leaves out the terms of hidden segments. */
static void leave_out_hidden(const FieldQueue *queue, FieldTile *tile)
{
    const FieldSpace *space = &queue->space;
    size_t n = 0;
    for (size_t i = 0; i < tile->n_terms; i++) {
        if (queue->hidden[space->candidates[i]])
            continue;
        space->terms[n] = space->terms[i];
        space->candidates[n++] = space->candidates[i];
    }
    tile->n_terms = n;
}

/* Decides n places by the terms of a tile, and stores the answers. */
static Status decide_places(FieldQueue *queue, const FieldTile *tile, QueuedPoints *asked, int n,
                            Err *err)
{
    FieldPlaces *places = &queue->places;
    if (n == 0)
        return STATUS_OK;
    set_places(asked, n, places);
    queue->kernel(tile, &queue->space.work, places);
    for (int i = 0; i < n; i++) {
        if (places->state[i] == PLACE_UNSURE)
            TRY(decide(queue, tile, i, err));
        uint32_t from = asked->from[i];
        queue->shadowed[queue->answer[from / TILE_SAMPLES] + from % TILE_SAMPLES] =
            places->state[i] == PLACE_DARK;
    }
    return STATUS_OK;
}

static Status answer_tile(FieldQueue *queue, const TileQueries *request, Err *err)
{
    const FieldShadow *shadow = queue->shadow;
    FieldSpace *space = &queue->space;
    FieldTile tile = tile_of(shadow, request->tile, space->groups);
    const size_t *list = list_of(shadow, request->tile);
    const uint32_t *segments = shadow->rows[request->tile / shadow->view.tiles].items + list[0];
    int n_near = 0;
    if (request->next >= 0)
        __builtin_prefetch(list_of(shadow, request->next));
    fieldterms_fetch(shadow->lists.segments, segments, list[1] - list[0]);
    int n = place_request(queue, request, &tile);
    if (list[0] == list[1] || n == 0)
        return STATUS_OK;
    TRY(fieldspace_reserve(space, list[1] - list[0], err));
    fieldterms_make(shadow->lists.segments, segments, list[1] - list[0], &tile, space->terms,
                    space->candidates);
    if (queue->hidden)
        n_near = set_apart(queue, &tile, request->places, &n);
    TRY(decide_places(queue, &tile, request->places, n, err));
    if (n_near == 0)
        return STATUS_OK;
    leave_out_hidden(queue, &tile);
    return decide_places(queue, &tile, &queue->near, n_near, err);
}

static void visit_tile(const TileQueries *request, void *context)
{
    FieldQueue *queue = context;
    if (queue->status == STATUS_OK)
        queue->status = answer_tile(queue, request, queue->err);
}

static Status answer(void *of, RenderKernels kernels, uint8_t *shadowed, Err *err)
{
    FieldQueue *queue = of;
    queue->kernel = fieldkernels_for(queue->shadow->geometry, kernels)->shadow;
    queue->shadowed = shadowed;
    queue->status = STATUS_OK;
    queue->err = err;
    shadowqueue_visit(queue->queue, visit_tile, queue);
    return queue->status;
}

const LightViews field_lights = {.can = can_look,
                                 .look = look,
                                 .free = free_shadow,
                                 .queue_new = new_queue,
                                 .queue_free = free_queue,
                                 .ask = ask,
                                 .answer = answer};
