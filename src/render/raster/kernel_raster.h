/* The kernels RasterKernels.trace and RasterKernels.resolve: find the first primitive at each
 * sample of a tile, LANES samples at once. rasterkernels.c compiles this file once per instruction
 * set.
 *
 * `trace` iterates over the items of the tile's list. It first finds all blocks of LANES samples
 * that the item's capsule may touch, then intersects the samples of these blocks with the item. A
 * sample stores the nearest item and its normal, or, for a joint, the ruling that is hit. `resolve`
 * computes the normals of joints at the end. A ruling is one of the straight lines of a joint's
 * surface [RasterJoint]. */
#include "render/raster/kernel_joint.h"
#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"

/* A block is LANES samples, which are intersected at once. A part is a group of samples that one
 * lane tests against an item's capsule: 8 samples with 8 lanes, otherwise 4, so that the number of
 * parts of a tile is a multiple of LANES. */
enum {
    BLOCKS = TILE_SAMPLES / LANES,
    PART = LANES == 8 ? 8 : 4,
    PARTS = TILE_SAMPLES / PART,
    PARTS_OF_BLOCK = LANES / PART
};

/* ---- tiles ----------------------------------------------------------------------------------- */

/* The state of `trace` for one tile. */
typedef struct RasterState {
    const RasterTile *tile;
    RasterHits *hits;
    TileHits *surface;
    /* per part: depth, minus z_middle, beyond which no item can be visible */
    float farthest[PARTS];
} RasterState;

/* Sets `farthest` of all parts of a block. */
RASTER_FN void set_farthest(RasterState *state, int block, float depth)
{
    for (int part = 0; part < PARTS_OF_BLOCK; part++)
        state->farthest[block * PARTS_OF_BLOCK + part] = depth;
}

/* Stores the new hits that are nearer than the stored ones, and returns their samples. `value` is
 * the value for RasterHits.item, and z the depth relative to the item's middle. */
RASTER_FN LaneMask keep_nearer(RasterState *state, const NearItem *near, uint32_t value, int block,
                               LaneMask met, Lanes z)
{
    RasterHits *hits = state->hits;
    int first = block * LANES;
    Lanes depth = z + near->z, before = lanes_load(&hits->z[first]);
    LaneMask nearer = met & (depth < before);
    if (!lanes_any(nearer))
        return nearer;
    Lanes kept = (Lanes)load_items(&hits->item[first]);
    Lanes item = (Lanes)((LaneMask){0} + (int32_t)value);
    depth = lanes_select(nearer, depth, before);
    lanes_store(&hits->z[first], depth);
    store_items(&hits->item[first], (LaneMask)lanes_select(nearer, item, kept));
    if (state->tile->n > 4) /* for a shorter list it saves no time */
        set_farthest(state, block, lanes_reduce_max(depth));
    return nearer;
}

/* Replaces the lanes of `mask` in an array of LANES values. */
RASTER_FN void keep_lanes(float *values, LaneMask mask, Lanes lanes)
{
    lanes_store(values, lanes_select(mask, lanes, lanes_load(values)));
}

/* Stores the normals of the samples of `mask` of a block. */
RASTER_FN void keep_normal(TileHits *surface, int block, LaneMask mask, const Lanes normal[3])
{
    for (int c = 0; c < 3; c++)
        keep_lanes(&surface->normal[c][block * LANES], mask, normal[c]);
}

/* Decides the samples `unsure` of a block in double precision. */
LANE_TARGET static void decide_block(RasterState *state, const NearItem *near, int block,
                                     LaneMask unsure)
{
    const RasterTile *tile = state->tile;
    RasterHits *hits = state->hits;
    for (int lane = 0; lane < LANES; lane++) {
        int sample = block * LANES + lane;
        if (!unsure[lane])
            continue;
        double z =
            raster_intersect(tile->bins, near->number, tile->x + (double)tile->grid->x[sample],
                             tile->y + (double)tile->grid->y[sample], NULL);
        float depth = (float)(z - tile->z_middle);
        if (!(depth < hits->z[sample]))
            continue;
        hits->z[sample] = depth;
        hits->item[sample] = near->number | RASTER_DECIDED;
    }
    set_farthest(state, block, lanes_reduce_max(lanes_load(&hits->z[block * LANES])));
}

/* Intersects the lines of sight of a block with an item, and stores the nearer hits. */
RASTER_FN void meet_block(RasterState *state, const NearItem *near, int block)
{
    const RasterGrid *grid = state->tile->grid;
    SightLines sight =
        sight_of(near, lanes_load(&grid->x[block * LANES]), lanes_load(&grid->y[block * LANES]));
    Lanes z, normal[3];
    if (near->kind == RASTER_CYLINDER) {
        CylinderEntry entry;
        LaneMask met = cylinder_entry(near, &sight, &z, &entry);
        met = keep_nearer(state, near, near->number, block, met, z);
        if (lanes_any(met)) {
            cylinder_normal(near, &sight, z, &entry, normal);
            keep_normal(state->surface, block, met, normal);
        }
    } else if (near->kind == RASTER_SPHERE) {
        LaneMask met = sphere_entry(near, &sight, &z);
        met = keep_nearer(state, near, near->number, block, met, z);
        if (lanes_any(met)) {
            sphere_normal(near, &sight, z, normal);
            keep_normal(state->surface, block, met, normal);
        }
    } else if (near->kind == RASTER_EXACT) {
        decide_block(state, near, block, ~(LaneMask){0});
    } else {
        Lanes ruling;
        LaneMask unsure, within = within_outline(near, &sight);
        const RasterJoint *joint = &state->tile->joints[near->item->joint];
        LaneMask met =
            joint_entry(near, joint, &sight, within, (LaneMask){0}, &z, &ruling, &unsure);
        uint32_t item = (uint32_t)(near->item - state->tile->items);
        met = keep_nearer(state, near, item | RASTER_RULED, block, met, z);
        keep_lanes(&state->hits->ruling[block * LANES], met, ruling);
        if (lanes_any(unsure))
            decide_block(state, near, block, unsure);
    }
}

/* Returns a bit mask of the parts of the tile that the item's capsule may touch, without the parts
 * in which all samples hit something nearer. The outline grows by 1e-6 of its size, the rounding
 * error of single precision. */
RASTER_FN unsigned touched_parts(const RasterState *state, const NearItem *near)
{
    const RasterGrid *grid = state->tile->grid;
    const float *xs = PART == 8 ? grid->block8_x : grid->block4_x;
    const float *ys = PART == 8 ? grid->block8_y : grid->block4_y;
    const float *half = PART == 8 ? grid->block8_half : grid->block4_half;
    float half_x = half[0] * near->depth, half_y = half[1] * near->depth;
    float ax = near->along_x < 0 ? -near->along_x : near->along_x;
    float ay = near->along_y < 0 ? -near->along_y : near->along_y;
    float across = near->reach_across + half_x * ay + half_y * ax;
    float along = near->reach_along + half_x * ax + half_y * ay;
    float rounding = 1e-6f * (near->item->half + near->item->radius + near->reach_across);
    across += rounding;
    along += rounding;
    unsigned bits = 0;
    for (int first = 0; first < PARTS; first += LANES) {
        Lanes x = lanes_fma(lanes_load(&xs[first]), lanes_set(near->depth), lanes_set(near->x));
        Lanes y = lanes_fma(lanes_load(&ys[first]), lanes_set(near->depth), lanes_set(near->y));
        Lanes off = lanes_abs(lanes_fma(y, lanes_set(near->along_x), -(x * near->along_y)));
        Lanes on = lanes_abs(lanes_fma(x, lanes_set(near->along_x), y * near->along_y));
        LaneMask touched =
            (off <= across) & (on <= along) & (lanes_load(&state->farthest[first]) > near->z_near);
        bits |= lanes_bits(touched) << first;
    }
    return bits;
}

/* Number of items by which prefetching is ahead. The intersection of 8 items takes longer than an
 * access to memory; the result does not depend on it. */
enum { ITEMS_AHEAD = 8 };

/* Tests all items of the tile's list. */
RASTER_FN void trace_items(RasterState *state, bool perspective)
{
    const RasterTile *tile = state->tile;
    for (size_t i = 0; i < tile->n && i < ITEMS_AHEAD; i++)
        __builtin_prefetch(&tile->items[tile->list[i]]);
    for (size_t i = 0; i < tile->n; i++) {
        if (i + ITEMS_AHEAD < tile->n)
            __builtin_prefetch(&tile->items[tile->list[i + ITEMS_AHEAD]]);
        NearItem near = approach(tile, tile->list[i], perspective);
        near.number = near.item->primitive;
        outline(tile, &near);
        unsigned parts = touched_parts(state, &near);
        if (item_is_close(near.item)) /* its outline is unknown */
            parts = (1u << PARTS) - 1;
        while (parts) {
            int block = __builtin_ctz(parts) / PARTS_OF_BLOCK;
            meet_block(state, &near, block);
            parts &= ~(((1u << PARTS_OF_BLOCK) - 1) << block * PARTS_OF_BLOCK);
        }
    }
}

/* RasterKernels.trace: finds the first item at each sample. */
LANE_TARGET static uint64_t LANES_NAME(trace)(const RasterTile *tile, RasterHits *hits,
                                              TileHits *surface)
{
    RasterState state = {.tile = tile, .hits = hits, .surface = surface};
    for (int sample = 0; sample < TILE_SAMPLES; sample += LANES) {
        lanes_store(&hits->z[sample], lanes_set(HUGE_VALF));
        store_items(&hits->item[sample], (LaneMask){0} + (int32_t)RASTER_NOTHING);
        set_farthest(&state, sample / LANES, HUGE_VALF);
    }
    if (tile->perspective)
        trace_items(&state, true);
    else
        trace_items(&state, false);
    uint64_t seen = 0;
    for (int first = 0; first < TILE_SAMPLES; first += LANES)
        seen |= (uint64_t)lanes_bits(load_items(&hits->item[first]) != (int32_t)RASTER_NOTHING)
                << first;
    return seen;
}

/* ---- normals --------------------------------------------------------------------------------- */

/* Sets the normal of a sample that was decided in double precision. */
LANE_TARGET static void resolve_decided(const RasterTile *tile, uint32_t number, int sample,
                                        TileHits *surface)
{
    Vec3 normal = {0, 0, 0};
    raster_intersect(tile->bins, number, tile->x + (double)tile->grid->x[sample],
                     tile->y + (double)tile->grid->y[sample], &normal);
    tile_set_vector(surface->normal, sample, normal);
}

/* Sets the normals of the samples of `mask` of a block, which hit the joint of item `index`, and
 * replaces the index of the item in their hits by the index of the primitive. */
RASTER_FN void resolve_joint(const RasterTile *tile, RasterHits *hits, uint32_t index, int block,
                             LaneMask mask, bool perspective, TileHits *surface)
{
    int first = block * LANES;
    NearItem near = approach(tile, index, perspective);
    SightLines sight =
        sight_of(&near, lanes_load(&tile->grid->x[first]), lanes_load(&tile->grid->y[first]));
    Lanes normal[3];
    joint_normal(&near, &tile->joints[near.item->joint], &sight, lanes_load(&hits->ruling[first]),
                 normal);
    keep_normal(surface, block, mask, normal);
    for (uint32_t left = lanes_bits(mask); left; left &= left - 1) {
        int sample = first + __builtin_ctz(left);
        surface->segment[sample] = near.item->primitive;
        hits->item[sample] = near.item->primitive | RASTER_RULED;
    }
}

/* Completes the hits of a block [RasterKernels.resolve]. `open`: the samples whose normal is
 * missing; their RasterHits.item has the flag RASTER_DECIDED or RASTER_RULED. */
RASTER_FN void resolve_block(const RasterTile *tile, RasterHits *hits, int block, bool perspective,
                             TileHits *surface)
{
    int first = block * LANES;
    LaneMask items = load_items(&hits->item[first]), seen = items != (int32_t)RASTER_NOTHING;
    lanes_to_bytes(&surface->state[first], seen); /* TILE_HIT or TILE_MISS */
    lanes_to_doubles_plus(&surface->z[first], lanes_load(&hits->z[first]), tile->z_middle);
    store_items(&surface->segment[first], items & (int32_t)RASTER_INDEX);
    LaneMask open = seen & ((items & (int32_t)~RASTER_INDEX) != 0);
    for (uint32_t left = lanes_bits(open); left;) {
        int sample = first + __builtin_ctz(left);
        uint32_t item = hits->item[sample];
        LaneMask same = items == (int32_t)item;
        if (item & RASTER_DECIDED) {
            resolve_decided(tile, item & RASTER_INDEX, sample, surface);
            left &= left - 1;
        } else {
            resolve_joint(tile, hits, item & RASTER_INDEX, block, same, perspective, surface);
            left &= ~lanes_bits(same);
        }
    }
}

/* RasterKernels.resolve: completes the result of `trace`. */
LANE_TARGET static void LANES_NAME(resolve)(const RasterTile *tile, RasterHits *hits,
                                            TileHits *surface)
{
    for (int block = 0; block < BLOCKS; block++)
        if (tile->perspective)
            resolve_block(tile, hits, block, true, surface);
        else
            resolve_block(tile, hits, block, false, surface);
}
