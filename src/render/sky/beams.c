/* The sky is cut into directions that are the same for all places, and each is looked along by a
 * view of its own, as a light does. A place asks how much of a beam is free that widens as its part
 * of the sky does up to a width of some vessels, and is a line where it begins. The parts of the
 * beam that capsules leave free are multiplied.
 *
 * Why this: single rays err as random numbers do, by the root of their number (0.046 in a ball of
 * 20,000 segments by 256 directions of the sphere, 0.061 by 128), and leave bands where directions
 * are shared, grain where they are not. A beam is the mean of many rays: 0.032 by 128 directions,
 * and its edges are soft. Cells of the sky, which are beams that widen for ever, err less in a ball
 * but need all vessels at every place; beams of bounded width need those of one tile of the view.
 * A beam never widens beyond its height above the surface, so that it cannot be covered by what
 * lies below the horizon.
 *
 * All models are seen as capsules about their segments: against the rays of the model itself the
 * error is the same for rounded, joined and isosurface to 0.001. */
#include "render/sky/beams.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the mean radius; wider beams err less in dense trees and more in thin ones. */
static const float wide_in_radii = 3.5f;
/* Of a ball far away, that is drawn as a square. */
static const float quarter_turn = 0.7853982f;
static const double golden_turn = 2.399963229728653;
/* So many capsules for each tile of a view. */
static const double capsules_a_tile = 9;
enum { MOST_TILES = 1024, VIEWS_BYTES = 256 << 20 };

typedef struct Capsule {
    float a[3], b[3]; /* from the origin */
    float radius;
} Capsule;

/* ---- capsules -------------------------------------------------------------------------------- */

static void store_point(float to[3], Vec3 point, Vec3 origin)
{
    to[0] = (float)(point.x - origin.x);
    to[1] = (float)(point.y - origin.y);
    to[2] = (float)(point.z - origin.z);
}

static void add_capsule(Beams *beams, Vec3 a, Vec3 b, double radius)
{
    Capsule *capsule = &beams->capsules[beams->n++];
    store_point(capsule->a, a, beams->origin);
    store_point(capsule->b, b, beams->origin);
    capsule->radius = (float)radius;
}

static float mean_radius(const Beams *beams)
{
    double sum = 0;
    for (size_t i = 0; i < beams->n; i++)
        sum += (double)beams->capsules[i].radius;
    return beams->n > 0 ? (float)(sum / (double)beams->n) : 0;
}

Status beams_new(const Geometry *geometry, Beams *beams, Err *err)
{
    size_t primitives = geometry->n_primitives - geometry->n_ends;
    *beams = (Beams){.origin = box_center(geometry->bounds)};
    TRY(mem_calloc(&beams->capsules, primitives + geometry->n_segments, sizeof *beams->capsules,
                   "occlusion", err));
    for (size_t i = 0; i < primitives; i++) {
        const Primitive *one = &geometry->primitives[i];
        add_capsule(beams, one->a, one->kind == PRIMITIVE_SPHERE ? one->a : one->b,
                    (one->radius_mm + primitive_radius_b(one)) / 2);
    }
    for (size_t i = 0; i < geometry->n_segments; i++) {
        const FieldSegment *one = &geometry->segments[i];
        add_capsule(beams, one->a, one->b, one->radius_mm);
    }
    double side = ceil(sqrt((double)beams->n / capsules_a_tile));
    beams->tiles = side < 1 ? 1 : side > MOST_TILES ? MOST_TILES : (int)side;
    beams->wide = wide_in_radii * mean_radius(beams);
    return STATUS_OK;
}

/* Fibonacci's lattice: rings of equal area, each a golden angle on from the last. */
Vec3 beams_direction(int n, int k)
{
    double z = 1 - (2 * k + 1.0) / n, across = sqrt(1 - z * z);
    return vec3(across * cos(golden_turn * k), across * sin(golden_turn * k), z);
}

/* ---- views ----------------------------------------------------------------------------------- */

static float least_of(float a, float b)
{
    return a < b ? a : b;
}

static float most_of(float a, float b)
{
    return a > b ? a : b;
}

static void project(const BeamView *view, const float point[3], float to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] =
            view->axes[i][0] * point[0] + view->axes[i][1] * point[1] + view->axes[i][2] * point[2];
}

/* A capsule across the view, in the square that a beam must begin in to touch it. */
static SeenCapsule see(const Beams *beams, const BeamView *view, const Capsule *capsule)
{
    float a[3], b[3], reach = capsule->radius + beams->wide;
    project(view, capsule->a, a);
    project(view, capsule->b, b);
    const float *low = a[2] > b[2] ? b : a, *high = a[2] > b[2] ? a : b;
    float x = high[0] - low[0], y = high[1] - low[1], length = sqrtf(x * x + y * y);
    /* One that points to the sky is a ball at its upper end. */
    bool stands = length < 1e-3f * capsule->radius;
    const float *from = stands ? high : low;
    return (SeenCapsule){.x = from[0],
                         .y = from[1],
                         .z = from[2],
                         .ux = stands ? 1 : x / length,
                         .uy = stands ? 0 : y / length,
                         .length = stands ? 0 : length,
                         .slope = stands ? 0 : (high[2] - low[2]) / length,
                         .radius = capsule->radius,
                         .round = stands ? quarter_turn * capsule->radius : 0,
                         .low = {least_of(a[0], b[0]) - reach, least_of(a[1], b[1]) - reach},
                         .high = {most_of(a[0], b[0]) + reach, most_of(a[1], b[1]) + reach}};
}

/* Sees all capsules, and sets the tiles of the view: squares, over all that a beam may touch. */
static void see_all(const Beams *beams, BeamView *view)
{
    float low[2] = {HUGE_VALF, HUGE_VALF}, high[2] = {-HUGE_VALF, -HUGE_VALF};
    for (size_t i = 0; i < beams->n; i++) {
        view->seen[i] = see(beams, view, &beams->capsules[i]);
        for (int c = 0; c < 2; c++) {
            low[c] = least_of(low[c], view->seen[i].low[c]);
            high[c] = most_of(high[c], view->seen[i].high[c]);
        }
    }
    float width = high[0] - low[0], height = high[1] - low[1];
    float side = most_of(sqrtf(width * height) / (float)beams->tiles,
                         most_of(width, height) / (float)MOST_TILES);
    view->left = low[0];
    view->top = low[1];
    view->per_tile = 1 / side;
    view->columns = (int)ceilf(width / side);
    view->rows = (int)ceilf(height / side);
}

/* The tiles from first to last, in columns and rows, that a capsule touches. */
typedef struct Span {
    int first[2], last[2];
} Span;

static int tile_of(float at, float first, float per_tile, int count)
{
    float tile = (at - first) * per_tile;
    return tile < 0 ? 0 : tile < (float)count ? (int)tile : count - 1;
}

static Span span_of(const BeamView *view, const SeenCapsule *seen)
{
    const float first[2] = {view->left, view->top};
    const int count[2] = {view->columns, view->rows};
    Span span;
    for (int c = 0; c < 2; c++) {
        span.first[c] = tile_of(seen->low[c], first[c], view->per_tile, count[c]);
        span.last[c] = tile_of(seen->high[c], first[c], view->per_tile, count[c]);
    }
    return span;
}

/* Counts in view->taken how many capsules each tile has. */
static void count_capsules(const Beams *beams, BeamView *view)
{
    for (size_t i = 0; i < beams->n; i++) {
        const Span span = span_of(view, &view->seen[i]);
        for (int row = span.first[1]; row <= span.last[1]; row++)
            for (int column = span.first[0]; column <= span.last[0]; column++)
                view->taken[row * view->columns + column]++;
    }
}

static void put(const SeenCapsule *seen, CapsuleBlock *block, uint32_t place)
{
    block->x[place] = seen->x;
    block->y[place] = seen->y;
    block->z[place] = seen->z;
    block->ux[place] = seen->ux;
    block->uy[place] = seen->uy;
    block->length[place] = seen->length;
    block->slope[place] = seen->slope;
    block->radius[place] = seen->radius;
    block->round[place] = seen->round;
}

static void fill_blocks(const Beams *beams, BeamView *view)
{
    for (size_t i = 0; i < beams->n; i++) {
        const SeenCapsule *seen = &view->seen[i];
        const Span span = span_of(view, seen);
        for (int row = span.first[1]; row <= span.last[1]; row++)
            for (int column = span.first[0]; column <= span.last[0]; column++) {
                size_t tile = (size_t)(row * view->columns + column);
                uint32_t number = view->taken[tile]++;
                put(seen, &view->blocks[view->first[tile] + number / CAPSULES], number % CAPSULES);
            }
    }
}

/* Fills up the last block of each tile with what no beam meets. */
static void fill_up(BeamView *view)
{
    static const SeenCapsule nothing = {.z = -1e30f, .ux = 1};
    size_t tiles = (size_t)view->columns * (size_t)view->rows;
    for (size_t tile = 0; tile < tiles; tile++)
        for (uint32_t number = view->taken[tile]; number % CAPSULES; number++)
            put(&nothing, &view->blocks[view->first[tile] + number / CAPSULES], number % CAPSULES);
}

Status beamview_make(const Beams *beams, Vec3 direction, BeamView *view, Err *err)
{
    Vec3 other = fabs(direction.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    Vec3 across = vec3_normalized(vec3_cross(direction, other));
    store_point(view->axes[0], across, vec3(0, 0, 0));
    store_point(view->axes[1], vec3_cross(direction, across), vec3(0, 0, 0));
    store_point(view->axes[2], direction, vec3(0, 0, 0));
    TRY(mem_reserve(&view->seen, &view->seen_capacity, beams->n, sizeof *view->seen, "occlusion",
                    err));
    see_all(beams, view);
    size_t tiles = (size_t)view->columns * (size_t)view->rows;
    TRY(mem_reserve(&view->first, &view->tiles_capacity, tiles + 1, sizeof *view->first,
                    "occlusion", err));
    TRY(mem_reserve(&view->taken, &view->taken_capacity, tiles, sizeof *view->taken, "occlusion",
                    err));
    memset(view->taken, 0, tiles * sizeof *view->taken);
    count_capsules(beams, view);
    view->first[0] = 0;
    for (size_t i = 0; i < tiles; i++)
        view->first[i + 1] = view->first[i] + (view->taken[i] + CAPSULES - 1) / CAPSULES;
    TRY(mem_reserve(&view->blocks, &view->blocks_capacity, view->first[tiles] + 1,
                    sizeof *view->blocks, "occlusion", err));
    memset(view->taken, 0, tiles * sizeof *view->taken);
    fill_blocks(beams, view);
    fill_up(view);
    free(view->seen);
    view->seen = NULL;
    view->seen_capacity = 0;
    return STATUS_OK;
}

static void release_view(BeamView *view)
{
    free(view->seen);
    free(view->first);
    free(view->taken);
    free(view->blocks);
    *view = (BeamView){0};
}

static void release_views(Beams *beams)
{
    for (int i = 0; i < beams->room; i++)
        release_view(&beams->views[i]);
    free(beams->views);
    beams->views = NULL;
    beams->room = beams->kept = 0;
}

void beams_release(Beams *beams)
{
    release_views(beams);
    free(beams->capsules);
    *beams = (Beams){0};
}

/* About how many bytes a view takes. */
static size_t bytes_of_view(const Beams *beams)
{
    size_t tiles = (size_t)beams->tiles * (size_t)beams->tiles;
    return (3 * beams->n / CAPSULES + tiles) * sizeof(CapsuleBlock);
}

Status beams_make_room(Beams *beams, int n, int threads, int *room, Err *err)
{
    size_t most = VIEWS_BYTES / (bytes_of_view(beams) + 1);
    int wanted = most < (size_t)threads ? threads : most < (size_t)n ? (int)most : n;
    wanted = wanted < n ? wanted : n;
    if (beams->room != wanted) {
        release_views(beams);
        TRY(mem_calloc(&beams->views, (size_t)wanted, sizeof *beams->views, "occlusion", err));
        beams->room = wanted;
    }
    *room = wanted;
    return STATUS_OK;
}
