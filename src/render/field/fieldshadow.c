/* The shadow engine of implicit surfaces: decides whether vessels are between a point and a light.
 *
 * The lists of all tiles of a light view are made at once, because points query the view in the
 * order of the image. The kernels trace from the points to the light, in the direction of
 * increasing z. The light view looks the other way. Once the lists are made, the segments are
 * therefore reflected: in the view's plane for a parallel light, in the position of a point light.
 * Lines of sight keep their positions in the view, and z then increases towards the light. */
#include "render/field/fieldtiles.h"

#include "render/cast/caster.h"
#include "render/field/fieldkernels.h"
#include "render/field/fieldspace.h"
#include "render/field/vessellists.h"
#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* The segments in the tiles of a light view. All arrays are owned. */
typedef struct FieldLists {
    VesselLists vessels;
    IndexLists *rows;  /* per row of tiles: the lists of its tiles */
    TileSpan *columns; /* a workspace for each worker while lists are made */
} FieldLists;

/* The workspace in which one thread answers queries. */
typedef struct FieldTester {
    const LightBins *light;
    const FieldLists *lists;
    const bool *hidden; /* per segment: true if it is hidden from the camera; NULL: none is hidden.
                         * Borrowed. */
    ShadowKernel *kernel;
    ShadowPoints near;               /* points at hidden segments */
    uint8_t is_near[POINT_CAPACITY]; /* per point of a tile */
    FieldSpace space;
} FieldTester;

/* ---- making lists ---------------------------------------------------------------------------- */

/* ShadowEngine.supports: the light must be outside the geometry's bounding sphere. */
static bool supports_light(const Geometry *geometry, const View *view, const Light *light)
{
    LightDirection to_light = light_direction(light, box_center(geometry->bounds));
    return lightview_sees_all(geometry, view, light) &&
           to_light.distance > lightview_radius(geometry);
}

/* Lists the segments of each tile of a row. Called in parallel. */
static Status list_segments_of_row(size_t row, int worker, void *context, Err *err)
{
    FieldLists *lists = context;
    return vessellists_row(&lists->vessels, row,
                           lists->columns + (size_t)worker * lists->vessels.longest,
                           &lists->rows[row], err);
}

/* Lists the segments of each tile of the light's view. */
static Status list_segments(FieldLists *lists, int threads, Err *err)
{
    size_t n = (size_t)lists->vessels.tile_rows, longest = lists->vessels.longest;
    TRY(mem_calloc(&lists->rows, n, sizeof *lists->rows, "rows of tiles", err));
    TRY(mem_calloc(&lists->columns, (size_t)threads * longest, sizeof *lists->columns,
                   "rows of tiles", err));
    TRY(threads_try(n, threads, list_segments_of_row, lists, err));
    free(lists->columns);
    lists->columns = NULL;
    return STATUS_OK;
}

/* Returns the vector in the frame in which rays travel towards the light; reflecting depths turns
 * rays around. */
static Vec3 reflected(const VesselLists *lists, Vec3 v)
{
    return lists->eye.perspective ? vec3_scale(v, -1) : vec3(v.x, v.y, -v.z);
}

/* Reflects all segments, so that rays start at the surface and end at the light. */
static void reflect_segments(VesselLists *lists)
{
    for (size_t i = 0; i < lists->n_segments; i++) {
        FrameSegment *segment = &lists->segments[i];
        segment->a = reflected(lists, segment->a);
        segment->b = reflected(lists, segment->b);
        segment->axis = reflected(lists, segment->axis);
    }
}

static void release_field_lists(void *of)
{
    FieldLists *lists = of;
    if (!lists)
        return;
    for (int i = 0; lists->rows && i < lists->vessels.tile_rows; i++)
        indexlists_release(&lists->rows[i]);
    free(lists->rows);
    free(lists->columns);
    vessellists_release(&lists->vessels);
    free(lists);
}

/* ShadowEngine.tiles: half as many tiles per side as the image has, but no more tiles than there
 * are segments. MAX_SIDE bounds the memory of the lists of all tiles; MIN_SIDE keeps the lists of a
 * small image short. */
static int tiles_for_segments(const Drawing *drawing)
{
    enum { MIN_SIDE = 16, MAX_SIDE = 384 };
    const Camera *camera = &drawing->view->camera;
    int side = (camera->width > camera->height ? camera->width : camera->height) / 16;
    side = (int)min_of(side, sqrt((double)drawing->geometry->n_segments));
    return side < MIN_SIDE ? MIN_SIDE : side > MAX_SIDE ? MAX_SIDE : side;
}

/* ShadowEngine.slack: POV-Ray's distance, from the lit point on, within which nothing casts a
 * shadow on it. */
static double slack_of_field(const Drawing *drawing)
{
    const double from_mm = drawing->params->shadow_from_mm;
    if (model_has(drawing->geometry->model, MODEL_BLOB))
        return BLOB_NEAREST_MM;
    return from_mm > 0 ? from_mm : SHADOW_NEAREST_MM;
}

/* Prepares a light [ShadowEngine.bin]: finds the tiles of its view and their segments. */
static Status bin_segments(const Drawing *drawing, LightBins *light, Err *err)
{
    const int threads = drawing->params->threads;
    FieldLists *lists;
    TRY(mem_calloc(&lists, 1, sizeof *lists, "shadows", err));
    light->lists = lists;
    TRY(vessellists_of_light(drawing->geometry, &light->view, threads, &lists->vessels, err));
    TRY(list_segments(lists, threads, err));
    reflect_segments(&lists->vessels);
    return STATUS_OK;
}

/* ---- queries --------------------------------------------------------------------------------- */

/* Makes a worker's workspace [ShadowEngine.begin]. */
static Status begin(const LightBins *light, const bool *hidden, void **workspace, Err *err)
{
    FieldTester *tester;
    TRY(mem_calloc(&tester, 1, sizeof *tester, "shadows", err));
    *workspace = tester;
    tester->light = light;
    tester->lists = light->lists;
    tester->hidden = hidden;
    return fieldspace_init(light->geometry, &tester->space, err);
}

static void end(void *workspace)
{
    FieldTester *tester = workspace;
    if (tester)
        fieldspace_release(&tester->space);
    free(tester);
}

/* Returns a tile of the light view, without terms. */
static FieldTile tile_without_terms(const LightView *view, int number, LocalGroups *groups)
{
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

/* Sets the z of the points to the depths that the kernel reads, reflected as the segments are, and
 * tile->z_min to the smallest of them. Removes points outside the tile: they are outside the light
 * view, and so they are lit. */
static void place_points(const LightProjection *aim, ShadowPoints *points, FieldTile *tile)
{
    float half_x = (float)fabs(0.50005 / aim->per_x), half_y = (float)fabs(0.50005 / aim->per_y);
    int n = 0;
    for (int i = 0; i < points->n; i++) {
        if (!(fabsf(points->x[i]) <= half_x && fabsf(points->y[i]) <= half_y))
            continue;
        shadowpoints_copy(points, i, points, n);
        points->z[n] = -(points->z[n] + aim->z_middle);
        tile->z_min = min_of(tile->z_min, points->z[n++]);
    }
    points->n = n;
}

/* Repeats the last point POINT_PADDING times behind it, for the kernel. */
static void pad_points(ShadowPoints *points)
{
    for (int n = points->n, i = n; i < n + POINT_PADDING; i++)
        shadowpoints_copy(points, n - 1, points, i);
}

/* Returns point i in the frame of the segments. */
static Vec3 point_at(const FieldTile *tile, const ShadowPoints *points, int i)
{
    const double z = points->z[i], scale = tile->perspective ? z : 1;
    return vec3((tile->middle_x + (double)points->x[i]) * scale,
                (tile->middle_y + (double)points->y[i]) * scale, z);
}

/* Decides a point by a ray to the light, in double precision. */
static Status decide_by_ray(FieldTester *tester, const FieldTile *tile, ShadowPoints *points, int i,
                            Err *err)
{
    const Viewpoint *eye = &tester->light->view.eye;
    Vec3 point = reflected(&tester->lists->vessels, point_at(tile, points, i));
    Vec3 from_light = viewpoint_world_direction(eye, eye->perspective ? point : vec3(0, 0, 1));
    Ray ray = {viewpoint_world_point(eye, point), vec3_normalized(vec3_scale(from_light, -1))};
    TRY(fieldspace_reserve_rays(&tester->space, tile->n_terms, err));
    bool dark = fieldspace_is_shadowed(&tester->space, tile->n_terms, ray);
    points->state[i] = dark ? SHADOW_DARK : SHADOW_LIT;
    return STATUS_OK;
}

/* Decides the points by the terms of a tile: by the kernel, and by rays where that is unsure. */
static Status decide_points(FieldTester *tester, const FieldTile *tile, ShadowPoints *points,
                            Err *err)
{
    if (points->n == 0)
        return STATUS_OK;
    pad_points(points);
    assert(tile->n_terms <= tester->space.work_capacity);
    tester->kernel(tile, tester->space.work, points);
    for (int i = 0; i < points->n; i++)
        if (points->state[i] == SHADOW_UNSURE)
            TRY(decide_by_ray(tester, tile, points, i, err));
    return STATUS_OK;
}

/* ---- points at hidden segments ---------------------------------------------------------------
 *
 * Thin vessels are hidden from the camera, which sees the surface of the other segments only, but
 * cast shadows. Where a hidden segment begins, points on the visible surface lie inside the surface
 * of all segments, which would hide every light from them. A hidden segment therefore casts no
 * shadow on points that its own term reaches. The segment is thinner than a pixel, and its term
 * reaches 2.4 of its radii, so that this is too small to see. */

/* Marks the points of [first, end) that are within reach of a segment. */
static void mark_near(FieldTester *tester, const FieldTile *tile, const ShadowPoints *points,
                      int first, int end, const FrameSegment *segment)
{
    for (int i = first; i < end; i++) {
        const Vec3 from = vec3_sub(point_at(tile, points, i), segment->a);
        const double along = min_of(max_of(vec3_dot(from, segment->axis), 0), segment->length);
        const Vec3 off = vec3_add_scaled(from, segment->axis, -along);
        tester->is_near[i] |= vec3_dot(off, off) < segment->reach * segment->reach;
    }
}

/* Marks the points that are within reach of a hidden segment. Consecutive points are close
 * together: most blocks of them are far from a segment. */
static void find_near(FieldTester *tester, const FieldTile *tile, const ShadowPoints *points)
{
    Box blocks[SHADOW_BATCH];
    const int n = points->n;
    for (int i = 0; i < n; i++) {
        Box *block = &blocks[i / TILE_SAMPLES];
        *block =
            box_with_ball(i % TILE_SAMPLES ? *block : box_empty(), point_at(tile, points, i), 0);
    }
    memset(tester->is_near, 0, (size_t)n);
    for (size_t i = 0; i < tile->n_terms; i++) {
        const uint32_t number = tester->space.candidates.items[i];
        const FrameSegment *segment = &tester->lists->vessels.segments[number];
        if (!tester->hidden[number])
            continue;
        Box box = box_with_ball(box_empty(), segment->a, segment->reach);
        box = box_with_ball(box, segment->b, segment->reach);
        for (int first = 0; first < n; first += TILE_SAMPLES)
            if (box_overlaps(box, blocks[first / TILE_SAMPLES]))
                mark_near(tester, tile, points, first,
                          first + TILE_SAMPLES < n ? first + TILE_SAMPLES : n, segment);
    }
}

/* Moves the marked points from `points` to tester->near. */
static void separate_near(FieldTester *tester, ShadowPoints *points)
{
    const int n = points->n;
    points->n = tester->near.n = 0;
    for (int i = 0; i < n; i++)
        if (tester->is_near[i])
            shadowpoints_copy(points, i, &tester->near, tester->near.n++);
        else
            shadowpoints_copy(points, i, points, points->n++);
}

/* Removes the terms of hidden segments. */
static void remove_hidden(const FieldTester *tester, FieldTile *tile)
{
    TileTerm *terms = tester->space.terms.items;
    uint32_t *candidates = tester->space.candidates.items;
    size_t n = 0;
    for (size_t i = 0; i < tile->n_terms; i++) {
        if (tester->hidden[candidates[i]])
            continue;
        terms[n] = terms[i];
        candidates[n++] = candidates[i];
    }
    tile->n_terms = n;
}

/* Decides the points in a view with hidden segments: first those that no hidden segment reaches, by
 * all terms; then the others, by the terms of the segments that are not hidden. */
static Status decide_with_hidden(FieldTester *tester, FieldTile *tile, ShadowPoints *points,
                                 Err *err)
{
    find_near(tester, tile, points);
    separate_near(tester, points);
    TRY(decide_points(tester, tile, points, err));
    if (tester->near.n == 0)
        return STATUS_OK;
    remove_hidden(tester, tile);
    TRY(decide_points(tester, tile, &tester->near, err));
    for (int i = 0; i < tester->near.n; i++)
        shadowpoints_copy(&tester->near, i, points, points->n++);
    return STATUS_OK;
}

/* ---- tiles ----------------------------------------------------------------------------------- */

/* Returns where a tile's list begins in the items of its row, and where the next one does. */
static const uint32_t *list_of(const FieldTester *tester, int tile)
{
    const int tiles = tester->light->view.tiles;
    return &tester->lists->rows[tile / tiles].first[tile % tiles];
}

/* ShadowEngine.test. */
static Status test_by_terms(const LightBins *light, void *workspace, const TileQueries *queries,
                            Err *err)
{
    FieldTester *tester = workspace;
    FieldSpace *space = &tester->space;
    ShadowPoints *points = queries->points;
    FieldTile tile = tile_without_terms(&light->view, queries->tile, space->groups);
    const uint32_t *list = list_of(tester, queries->tile);
    const size_t n = list[1] - list[0];
    const FrameSegment *segments = tester->lists->vessels.segments;
    const uint32_t *listed = tester->lists->rows[queries->tile / light->view.tiles].items + list[0];
    if (queries->next >= 0)
        __builtin_prefetch(list_of(tester, queries->next));
    fieldterms_fetch(segments, listed, n);
    place_points(&light->aim, points, &tile);
    if (n == 0)
        points->n = 0;
    if (points->n == 0)
        return STATUS_OK;
    TRY(fieldspace_reserve(space, n, err));
    fieldterms_make(segments, listed, n, &tile, space->terms.items, space->candidates.items);
    tester->kernel = fieldkernels_for(light->geometry, queries->kernels)->shadow;
    if (tester->hidden)
        return decide_with_hidden(tester, &tile, points, err);
    return decide_points(tester, &tile, points, err);
}

const ShadowEngine field_shadows = {.supports = supports_light,
                                    .tiles = tiles_for_segments,
                                    .slack = slack_of_field,
                                    .bin = bin_segments,
                                    .release = release_field_lists,
                                    .begin = begin,
                                    .end = end,
                                    .test = test_by_terms};
