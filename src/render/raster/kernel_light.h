/* The kernel RasterKernels.cover: answers the shadow queries of a tile of a light view (the view
 * from a light), LANES queries at once. A query asks whether the line of sight through a point
 * enters an item (a projected primitive [rastertile.h]) at a smaller depth. rasterkernels.c
 * compiles this file once per instruction set.
 *
 * For each block of LANES queries, items_before selects the items whose boxes and depths may be in
 * front of a query. Each of these items is tested by its capsule (may_enter), a joint also by its
 * hull (may_enter_joint), then exactly, until all queries of the block are in shadow. A line that
 * single precision cannot decide is decided in double precision. Loops over lanes have no branches,
 * so that compilers can vectorise them. */
#include "render/raster/kernel_raster.h"
#include "render/raster/rasterbins.h"
#include "render/raster/rasterkernels.h"

/* Joints that are viewed nearly along their axis are not tested by their hull: those whose 1 / sine
 * of the angle between axis and line of sight is above this. 50 is 1 / min_sine [rasteritem.c]: at
 * smaller angles pass_cylinder loses its digits. */
static const float max_per_sine = 50;

/* LANES queries. Positions are relative to the middle of the tile, mm. */
typedef struct QueryBlock {
    Lanes x, y, z;
    LaneMask item; /* per query: ShadowPoints.item, the item on which the point is, with the flags
                    * of RasterHits.item */
    float deepest; /* maximum of z */
    uint32_t box;  /* the packed box of the queries [RasterBox], to be compared with the boxes of
                    * items */
} QueryBlock;

/* Decides one query as item_covers does, but in double precision. Returns true if the item shadows
 * it. */
LANE_TARGET static bool decide_query(const NearItem *near, const RasterTile *tile,
                                     const ShadowPoints *points, int query)
{
    double z = raster_intersect(tile->bins, near->number, tile->x + (double)points->x[query],
                                tile->y + (double)points->y[query], NULL);
    return z - tile->z_middle < (double)(float)points->z[query];
}

/* Returns the lines that may enter the item at a depth below z, relative to the item's middle.
 * Tests the item's capsule, without a square root. The capsule's radius is increased by 2e-4 of
 * itself, because joints may be hit 1e-4 of their radius beside the line (off_joint_line).
 *
 * Up to a common factor: `left` is radius^2 minus the squared distance between line and axis line;
 * `beyond` is how far the point of the axis line that is nearest to the line of sight is beyond the
 * capsule's ends; `behind` is how much z is deeper than the line's nearest point. The first test
 * holds if the line meets the capsule's outline, the second if it enters the infinite cylinder
 * before z. */
RASTER_FN LaneMask may_enter(const NearItem *near, const SightLines *sight, Lanes z)
{
    const RasterItem *item = near->item;
    const float radius = item->radius * 1.0002f;
    Lanes left, beyond, behind, size2 = lanes_set(1);
    if (near->kind == RASTER_EXACT)
        return ~(LaneMask){0};
    if (near->perspective) {
        Crossing crossing = cross_axis(near, sight);
        Lanes on = lanes_fma(sight->x, lanes_set(near->axis[0]), sight->y * near->axis[1]);
        on = lanes_fma(on, crossing.sine2, -(crossing.turn * crossing.rate));
        size2 += lanes_fma(sight->dx, sight->dx, sight->dy * sight->dy);
        left = crossing.sine2 * (radius * radius) - crossing.off * crossing.off;
        behind = lanes_fma(z, crossing.sine2, crossing.turn);
        beyond = lanes_abs(on) - crossing.sine2 * item->half;
    } else {
        Lanes off = lanes_fma(sight->y, lanes_set(item->ex), -(sight->x * item->ey));
        Lanes on = lanes_fma(sight->x, lanes_set(item->ex), sight->y * item->ey);
        left = lanes_fma(-off, off, lanes_set(radius * radius));
        behind = lanes_fma(-on, lanes_set(item->cosine), z * item->sine);
        beyond = lanes_abs(on) - item->sine * item->half;
    }
    beyond = lanes_max(beyond, lanes_set(0));
    return (beyond * beyond < left * size2) & ((behind > 0.0f) | (behind * behind < left));
}

/* Limits the interval of depths [*from, *to] in which a line may be inside a joint to the depths
 * between the planes of the joint's ends [RasterHull.plane]. */
RASTER_FN void clip_to_ends(const RasterHull *hull, const NearItem *near, const SightLines *sight,
                            Lanes *from, Lanes *to)
{
    for (int i = 0; i < 2; i++) {
        const float *plane = hull->plane[i], least = 1e-6f; /* avoids a division by 0 */
        Lanes at = lanes_fma(sight->x, lanes_set(plane[0]),
                             lanes_fma(sight->y, lanes_set(plane[1]), lanes_set(plane[3])));
        Lanes rate = lanes_set(plane[2]);
        if (near->perspective)
            rate = lanes_fma(sight->dx, lanes_set(plane[0]),
                             lanes_fma(sight->dy, lanes_set(plane[1]), rate));
        LaneMask comes_in = rate >= 0.0f;
        rate = lanes_select(comes_in, lanes_max(rate, lanes_set(least)),
                            lanes_min(rate, lanes_set(-least)));
        Lanes crossing = -at / rate;
        *from = lanes_select(comes_in, lanes_max(*from, crossing), *from);
        *to = lanes_select(comes_in, *to, lanes_min(*to, crossing));
    }
}

/* Returns the lines that may be inside the cone around a joint at a depth in [from, to].
 *
 * Let t be the depth of a point of the line minus the depth of the line's point nearest to the
 * axis. Let s be the position along the axis, and `middle` the radius of the ball at s = 0
 * [RasterHull]. The line is inside the cone where (1 - taper^2) distance^2 - (middle - s taper)^2 =
 * a t^2 + 2 b t + c <= 0. If a <= 0, the line is steeper than the cone and counts as inside. */
RASTER_FN LaneMask in_cone(const RasterHull *hull, const CylinderPassage *passage, Lanes from,
                           Lanes to)
{
    /* Below this, a counts as not positive: it has the errors of single precision. */
    const float least = 1e-3f;
    Lanes taper = lanes_set(hull->taper), per = 1.0f - taper * taper;
    Lanes slant = taper * passage->rate, a = per * passage->sine2 - slant * slant;
    Lanes radius = lanes_fma(-passage->along, taper, lanes_set(hull->middle)), b = radius * slant;
    Lanes t = -b / lanes_max(a, lanes_set(least));
    t = lanes_max(lanes_min(t, to - passage->middle), from - passage->middle);
    Lanes c = lanes_fma(per, passage->off2, -(radius * radius));
    return (from < to) & ((a < least) | (lanes_fma(t, lanes_fma(t, a, b + b), c) <= 0.0f));
}

/* Returns the lines that may enter a joint at a depth below z, relative to the joint's middle.
 * Tests the joint's hull, unless the joint is viewed nearly along its axis.
 *
 * A hit may be off_joint_line = 1e-4 radii beside its line. It may then be in front of the
 * capsule's surface by at most sqrt(2e-4) = 0.0141 radii, divided by the sine; the margin is
 * 0.015. */
RASTER_FN LaneMask may_enter_joint(const RasterTile *tile, const NearItem *near,
                                   const SightLines *sight, Lanes z)
{
    const RasterHull *hull = &tile->bins->hulls[near->item->joint];
    if (!(near->per_sine < max_per_sine))
        return ~(LaneMask){0};
    CylinderPassage passage = pass_cylinder(near, sight);
    float margin = 0.015f * near->item->radius * near->per_sine;
    Lanes from = passage.middle - passage.half - margin;
    Lanes to = lanes_min(z, passage.middle + passage.half);
    clip_to_ends(hull, near, sight, &from, &to);
    return in_cone(hull, &passage, from, to);
}

/* Returns the queries of a block that the item shadows: their line enters the item at a smaller
 * depth. */
RASTER_FN LaneMask item_covers(const NearItem *near, const RasterTile *tile,
                               const ShadowPoints *points, int first, const QueryBlock *block,
                               LaneMask among)
{
    const Lanes z = block->z;
    SightLines sight = sight_of(near, block->x, block->y);
    Lanes entry = lanes_set(0);
    LaneMask met, unsure = (LaneMask){0};
    among &= may_enter(near, &sight, z - near->z);
    if (!lanes_any(among))
        return among;
    if (near->kind == RASTER_CYLINDER) {
        CylinderEntry how;
        met = cylinder_entry(near, &sight, &entry, &how);
    } else if (near->kind == RASTER_SPHERE) {
        met = sphere_entry(near, &sight, &entry);
    } else if (near->kind == RASTER_JOINT) {
        Lanes ruling;
        among &= may_enter_joint(tile, near, &sight, z - near->z);
        if (!lanes_any(among))
            return among;
        RasterJoint joint;
        raster_joint(tile->bins, near->number, &joint);
        met = joint_entry(near, &joint, &sight, among,
                          block->item == (int32_t)(near->number | RASTER_RULED), &entry, &ruling,
                          &unsure);
    } else {
        unsure = among;
        met = (LaneMask){0};
    }
    LaneMask covered = met & among & (entry + near->z < z);
    unsure &= ~covered;
    for (uint32_t left = lanes_bits(unsure); left; left &= left - 1) {
        int lane = __builtin_ctz(left);
        covered[lane] = -decide_query(near, tile, points, first + lane); /* a mask: 0 or -1 */
    }
    return covered;
}

/* Returns the range of positions along one axis of a tile, packed as in a query's box
 * [rasteritem.h], in units of 1 / RASTERBOX_PARTS of the tile's side. `per` is 1 / pixel step. */
RASTER_FN uint32_t packed_range(Lanes at, double per)
{
    const float middle = RASTERBOX_PARTS / 2, last = RASTERBOX_PARTS - 1;
    Lanes scale = lanes_set((float)per * (RASTERBOX_PARTS / TILE_SIDE));
    Lanes part = lanes_fma(at, scale, lanes_set(middle));
    part = lanes_max(lanes_min(part, lanes_set(last)), lanes_set(0));
    return (uint32_t)lanes_reduce_min(part) |
           (RASTERBOX_PARTS - 1 - (uint32_t)lanes_reduce_max(part)) << 8;
}

/* Loads the queries [first, first + LANES). */
RASTER_FN QueryBlock load_queries(const RasterTile *tile, const ShadowPoints *points, int first)
{
    const RasterView *view = &tile->bins->view;
    QueryBlock block = {.x = lanes_load(&points->x[first]),
                        .y = lanes_load(&points->y[first]),
                        .z = lanes_from_doubles_plus(&points->z[first], 0),
                        .item = load_items(&points->item[first])};
    block.deepest = lanes_reduce_max(block.z);
    block.box = packed_range(block.x, view->per_x) | packed_range(block.y, view->per_y) << 16;
    return block;
}

/* Returns a bit mask of the items, among the LANES items from index `first` of the list on, that
 * may be in front of a query: the boxes overlap, which one subtraction tells [RASTERBOX_GUARDS],
 * and the item is not deeper than the deepest query. The boxes are behind the n indices of
 * tile->list. Reads LANES boxes and depths; bits of items past the end of the list are 0. */
RASTER_FN uint32_t items_before(const RasterTile *tile, size_t first, const QueryBlock *block)
{
    LaneWords boxes;
    __builtin_memcpy(&boxes, tile->list + tile->n + first, sizeof boxes);
    LaneMask touched = ((boxes - block->box) & RASTERBOX_GUARDS) == RASTERBOX_GUARDS;
    uint32_t bits = lanes_bits(touched & (lanes_load(tile->nears + first) <= block->deepest));
    size_t left = tile->n - first;
    return left < LANES ? bits & ((1u << left) - 1) : bits;
}

/* Decides the queries [first, first + LANES). On entry points->state is 1 for a query to be decided
 * and 0 for padding; on return it is 1 for a point in shadow and for padding, else 0. */
RASTER_FN void cover_block(const RasterTile *tile, ShadowPoints *points, int first,
                           bool perspective)
{
    const QueryBlock block = load_queries(tile, points, first);
    LaneMask open = lanes_of_bytes(&points->state[first]);
    for (size_t i = 0; i < tile->n && lanes_any(open); i += LANES) {
        uint32_t bits = items_before(tile, i, &block);
        for (uint32_t left = bits; left; left &= left - 1)
            __builtin_prefetch(&tile->items[tile->list[i + (size_t)__builtin_ctz(left)]]);
        for (; bits; bits &= bits - 1) {
            NearItem near =
                approach(tile, tile->list[i + (size_t)__builtin_ctz(bits)], perspective);
            LaneMask among = open & (block.z > near.z_near) & (block.item != (int32_t)near.number);
            if (lanes_any(among))
                open &= ~item_covers(&near, tile, points, first, &block, among);
        }
    }
    for (int lane = 0; lane < LANES; lane++)
        points->state[first + lane] = !open[lane];
}

/* RasterKernels.cover: sets points->state to 1 for points in shadow, else 0. */
LANE_TARGET static void LANES_NAME(cover)(const RasterTile *tile, ShadowPoints *points)
{
    __builtin_memset(points->state, 1, (size_t)points->n);
    /* Copies of the first query fill the last block; their results are not used. */
    for (int i = points->n; i % LANES; i++) {
        shadowpoints_copy(points, 0, points, i);
        points->state[i] = 0;
    }
    for (int first = 0; first < points->n; first += LANES)
        if (tile->perspective)
            cover_block(tile, points, first, true);
        else
            cover_block(tile, points, first, false);
}

const RasterKernels LANES_NAME(rasterkernels) = {
    .trace = LANES_NAME(trace), .resolve = LANES_NAME(resolve), .cover = LANES_NAME(cover)};
