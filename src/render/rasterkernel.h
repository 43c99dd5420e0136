/* The first primitive at each sample of a tile, several samples at once: included by each source that
 * compiles it for its lanes, RASTER_KERNEL(name) making the names of its functions.
 *
 * For every item of the tile's list the blocks of LANES samples that its capsule may touch are found all
 * at once, and the item is met with those. A sample keeps the nearest item and, of a joint, the ruling;
 * normals are left to the end, when an item's samples are known.
 *
 * A line of sight passes an item's middle, at the middle's depth, in (X, Y) = (x, y) depth - middle, which is taken in double
 * precision for the tile and stays small.
 *
 * Joints are walls of solids, so only a root of g [rastertile.h] where the wall faces the view can be seen: where g falls.
 * Multiplied by (1 + u^2)^2, u = tan(q / 2) in [-1, 1], g is a quartic on each half of the circle, that of q in
 * [-90, 90] degrees and its back. In Bernstein form a quartic has as many roots as its coefficients change sign, or fewer
 * by an even number. A sample whose front shows one fall and whose back shows, quarter by quarter, nothing but
 * a rise has one root, which Newton's method finds inside its bracket; one without changes has none; and a hit
 * counts if it lies on its line to 1e-4 of the joint's size. All other samples, a few next to the
 * outline, are decided in double precision. */
#ifndef RASTER_KERNEL
#error "define RASTER_KERNEL(name), the name of a function"
#endif

#include "render/lanes.h"
#include "render/rasterkernels.h"

enum { BLOCKS = TILE_SAMPLES / LANES };

#define RASTER_FN LANE_FN __attribute__((always_inline))

/* Below this squared sine a wall is looked at along its axis. */
static const float steep_sine2 = 4e-4f;
/* How far a joint's crossing may lie off its ends, over its length, and off its line, over its size. */
static const float off_joint_end = 1e-5f, off_joint_line = 1e-4f;
enum { RULING_STEPS = 12 };

/* Bit i is set where lane i is true. */
RASTER_FN unsigned mask_bits(LaneMask mask)
{
#ifdef LANES_AVX2
    return (unsigned)_mm256_movemask_ps((__m256)mask);
#else
    return (unsigned)((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}

RASTER_FN LaneMask load_items(const uint32_t *items)
{
    LaneMask lanes;
    __builtin_memcpy(&lanes, items, sizeof lanes);
    return lanes;
}

RASTER_FN void store_items(uint32_t *items, LaneMask lanes)
{
    __builtin_memcpy(items, &lanes, sizeof lanes);
}

/* Lines of sight beside an item. */
typedef struct Sight {
    Lanes x, y;   /* where they pass its middle's depth, from the middle */
    Lanes dx, dy; /* directions (dx, dy, 1); only in perspective */
} Sight;

/* An item as one tile sees it. */
typedef struct Near {
    const RasterItem *item;
    const RasterJoint *joint;
    bool perspective;
    uint32_t kind;
    uint32_t number;
    float x, y;   /* where the tile's middle passes it, from its middle */
    float depth;  /* of its middle, along the view; 1 when parallel */
    float dx, dy; /* direction of the tile's middle */
    float z;      /* of its middle, less z_middle */
    float z_near; /* nothing of it is nearer */
    float along_x, along_y, reach_along,
        reach_across; /* its capsule's outline at the middle's depth */
    float axis[3], per_sine;
} Near;

/* The outline of the capsule in the plane of its middle's depth, looked at along the tile's middle. */
RASTER_FN void outline(Near *near)
{
    const RasterItem *item = near->item;
    near->along_x = item->ex;
    near->along_y = item->ey;
    near->reach_across = item->radius;
    near->reach_along = item->sine * item->half + item->radius;
    if (!near->perspective)
        return;
    float x = near->axis[0] - near->dx * near->axis[2];
    float y = near->axis[1] - near->dy * near->axis[2], size = sqrtf(x * x + y * y);
    float stretch = sqrtf(1 + near->dx * near->dx + near->dy * near->dy);
    near->along_x = size > 0 ? x / size : 1;
    near->along_y = size > 0 ? y / size : 0;
    near->reach_across = item->radius * stretch;
    near->reach_along = size * item->half + near->reach_across;
}

RASTER_FN Near approach(const RasterTile *tile, uint32_t number, bool perspective)
{
    const RasterItem *item = &tile->items[number];
    Near near;
    near.item = item;
    near.joint = &tile->joints[item->joint];
    near.perspective = perspective;
    near.kind = item->kind;
    near.number = number;
    near.depth = 1;
    near.dx = near.dy = 0;
    near.axis[0] = item->sine * item->ex;
    near.axis[1] = item->sine * item->ey;
    near.axis[2] = item->cosine;
    near.per_sine = 1 / item->sine;
    near.z = (float)(item->z - tile->z_middle);
    near.z_near = near.z - item->cosine * item->half - item->radius;
    if (perspective) {
        near.x = (float)(tile->x * item->z - item->x);
        near.y = (float)(tile->y * item->z - item->y);
        near.depth = (float)item->z;
        near.dx = (float)tile->x;
        near.dy = (float)tile->y;
        float nx = near.dy * near.axis[2] - near.axis[1],
              ny = near.axis[0] - near.dx * near.axis[2];
        float nz = near.dx * near.axis[1] - near.dy * near.axis[0];
        float sine2 = nx * nx + ny * ny + nz * nz;
        if (near.kind == RASTER_CYLINDER &&
            sine2 < steep_sine2 * (1 + near.dx * near.dx + near.dy * near.dy))
            near.kind = RASTER_EXACT;
    } else {
        near.x = (float)(tile->x - item->x);
        near.y = (float)(tile->y - item->y);
    }
    return near;
}

RASTER_FN Sight sight_of(const Near *near, Lanes x, Lanes y)
{
    Sight sight;
    if (near->perspective) {
        sight.x = lanes_fma(x, lanes_set(near->depth), lanes_set(near->x));
        sight.y = lanes_fma(y, lanes_set(near->depth), lanes_set(near->y));
        sight.dx = x + near->dx;
        sight.dy = y + near->dy;
    } else {
        sight.x = x + near->x;
        sight.y = y + near->y;
        sight.dx = sight.dy = lanes_set(0);
    }
    return sight;
}

/* Whether lines of sight may touch the item's capsule. */
RASTER_FN LaneMask within_outline(const Near *near, const Sight *sight)
{
    if (near->perspective)
        return ~(LaneMask){0};
    Lanes x = lanes_set(near->along_x), y = lanes_set(near->along_y);
    Lanes off = lanes_abs(lanes_fma(sight->y, x, -(sight->x * y)));
    Lanes on = lanes_abs(lanes_fma(sight->x, x, sight->y * y));
    return (off <= near->reach_across * 1.00001f) & (on <= near->reach_along * 1.00001f);
}

/* ---- spheres and cylinders ----------------------------------------------------------------------- */

/* Where the lines enter the sphere, as depth from its middle. */
RASTER_FN LaneMask sphere_entry(const Near *near, const Sight *sight, Lanes *z)
{
    float radius2 = near->item->radius * near->item->radius;
    if (!near->perspective) {
        Lanes left = lanes_set(radius2) - lanes_fma(sight->x, sight->x, sight->y * sight->y);
        *z = -lanes_sqrt(lanes_max(left, lanes_set(0)));
        return left > 0.0f;
    }
    /* About the line's nearest point: n = D x (X, Y, 0), |n|^2 / |D|^2 the squared distance. */
    Lanes size2 = lanes_fma(sight->dx, sight->dx, lanes_fma(sight->dy, sight->dy, lanes_set(1)));
    Lanes nz = lanes_fma(sight->dx, sight->y, -(sight->dy * sight->x));
    Lanes n2 = lanes_fma(nz, nz, lanes_fma(sight->x, sight->x, sight->y * sight->y));
    Lanes left = lanes_fma(lanes_set(radius2), size2, -n2), per = 1.0f / size2;
    Lanes along = lanes_fma(sight->dx, sight->x, sight->dy * sight->y);
    *z = -(along + lanes_sqrt(lanes_max(left, lanes_set(0)))) * per;
    return left > 0.0f;
}

/* How lines of sight run through an endless cylinder. */
typedef struct Passage {
    LaneMask met;
    Lanes middle; /* depth where they are nearest to the axis, from that of the cylinder's middle */
    Lanes half;   /* of what is inside, in depth */
    Lanes along;  /* at that place, along the axis from its middle */
    Lanes rate;   /* of that with depth */
} Passage;

RASTER_FN Passage pass_cylinder(const Near *near, const Sight *sight)
{
    Passage passage;
    const RasterItem *item = near->item;
    float radius2 = item->radius * item->radius;
    Lanes zero = lanes_set(0);
    if (!near->perspective) {
        Lanes off = lanes_fma(sight->y, lanes_set(item->ex), -(sight->x * item->ey));
        Lanes left = lanes_fma(-off, off, lanes_set(radius2));
        passage.met = left > 0.0f;
        passage.half = lanes_sqrt(lanes_max(left, zero)) * near->per_sine;
        passage.along =
            lanes_fma(sight->x, lanes_set(item->ex), sight->y * item->ey) * near->per_sine;
        passage.middle = passage.along * item->cosine;
        passage.rate = lanes_set(item->cosine);
        return passage;
    }
    Lanes ux = lanes_set(near->axis[0]), uy = lanes_set(near->axis[1]);
    Lanes uz = lanes_set(near->axis[2]);
    Lanes nx = lanes_fma(sight->dy, uz, -uy), ny = lanes_fma(-sight->dx, uz, ux);
    Lanes nz = lanes_fma(sight->dx, uy, -(sight->dy * ux));
    Lanes n2 = lanes_fma(nx, nx, lanes_fma(ny, ny, nz * nz)), per = 1.0f / n2;
    Lanes off = lanes_fma(nx, sight->x, ny * sight->y);
    Lanes left = lanes_fma(lanes_set(radius2), n2, -(off * off));
    Lanes cross = lanes_fma(nx, sight->y, -(ny * sight->x));
    Lanes turn = lanes_fma(nz, lanes_fma(sight->x, uy, -(sight->y * ux)), uz * cross);
    passage.met = left > 0.0f;
    passage.half = lanes_sqrt(lanes_max(left, zero)) * per;
    passage.middle = -turn * per;
    passage.rate = lanes_fma(sight->dx, ux, lanes_fma(sight->dy, uy, uz));
    passage.along = lanes_fma(sight->x, ux, lanes_fma(sight->y, uy, passage.middle * passage.rate));
    return passage;
}

/* Where the lines enter the cylinder; *on_disc is set where that is its end. */
RASTER_FN LaneMask cylinder_entry(const Near *near, const Sight *sight, Lanes *z, LaneMask *on_disc,
                                  Passage *passage)
{
    float half = near->item->half;
    *passage = pass_cylinder(near, sight);
    /* Counted from the end that a line comes to first, lengths grow with depth. */
    Lanes along = passage->along, rate = passage->rate;
    if (near->perspective) {
        Lanes grows = lanes_select(rate < 0.0f, lanes_set(-1), lanes_set(1));
        along *= grows;
        rate *= grows;
    }
    Lanes first = along + half, rise = rate * passage->half, enters = first - rise;
    *on_disc = passage->met & (enters < 0.0f) & (first + rise >= 0.0f);
    *z = passage->middle - passage->half;
    if (lanes_any(*on_disc))
        *z = lanes_select(*on_disc, passage->middle - first / rate, *z);
    return *on_disc | (passage->met & (enters >= 0.0f) & (enters <= 2 * half));
}

/* ---- joints -------------------------------------------------------------------------------------- */

/* g of rastertile.h: k0 + k1 cos + k2 sin + k3 cos^2 + k4 cos sin. */
typedef struct Ruling {
    Lanes k[5];
} Ruling;

RASTER_FN Lanes ruling_part(const Near *near, const Sight *sight, const float by[3],
                            const float *run)
{
    if (!near->perspective) {
        Lanes part = lanes_set(by[2]);
        if (run)
            part = lanes_fma(sight->y, lanes_set(run[0]), part - sight->x * run[1]);
        return part;
    }
    Lanes part = lanes_fma(sight->dx, lanes_set(by[0]),
                           lanes_fma(sight->dy, lanes_set(by[1]), lanes_set(by[2])));
    if (!run)
        return part;
    Lanes rz = lanes_set(run[2]);
    part = lanes_fma(sight->x, lanes_fma(sight->dy, rz, lanes_set(-run[1])), part);
    return lanes_fma(sight->y, lanes_fma(-sight->dx, rz, lanes_set(run[0])), part);
}

RASTER_FN Ruling ruling_of(const Near *near, const Sight *sight)
{
    const RasterJoint *joint = near->joint;
    return (Ruling){{ruling_part(near, sight, joint->by[0], joint->span),
                     ruling_part(near, sight, joint->by[1], joint->da),
                     ruling_part(near, sight, joint->by[2], joint->db),
                     ruling_part(near, sight, joint->by[3], NULL),
                     ruling_part(near, sight, joint->by[4], NULL)}};
}

/* -1 where a and b differ in sign. */
RASTER_FN LaneMask changes(Lanes a, Lanes b)
{
    return (a < 0.0f) ^ (b < 0.0f);
}

/* The sign changes of the two halves of a quartic in Bernstein form, times -1. */
RASTER_FN LaneMask changes_of_halves(const Lanes b[5])
{
    Lanes c[4] = {b[0] + b[1], b[1] + b[2], b[2] + b[3], b[3] + b[4]};
    Lanes d[3] = {c[0] + c[1], c[1] + c[2], c[2] + c[3]};
    Lanes e[2] = {d[0] + d[1], d[1] + d[2]}, middle = e[0] + e[1];
    return changes(b[0], c[0]) + changes(c[0], d[0]) + changes(d[0], e[0]) + changes(e[0], middle) +
           changes(middle, e[1]) + changes(e[1], d[2]) + changes(d[2], c[3]) + changes(c[3], b[4]);
}

/* What the signs prove: that a line misses, or that it has one fall in front. */
typedef struct Signs {
    LaneMask misses, single;
} Signs;

RASTER_FN Signs judge_signs(const Ruling *g)
{
    const Lanes *k = g->k;
    Lanes ends = k[0] - k[2], middle = (k[0] + k[3] + k[3]) * (2.0f / 3);
    Lanes b[5] = {ends + ends, k[1] - k[4], middle, k[1] + k[4], k[0] + k[2]};
    b[4] += b[4];
    Lanes back[5] = {b[0], -b[1], b[2], -b[3], b[4]};
    LaneMask in_front = changes_of_halves(b), behind = changes_of_halves(back);
    Signs signs;
    signs.single = (in_front == -1) & (behind == -1) & (b[0] >= 0.0f);
    signs.misses = (in_front == 0) & (behind == 0);
    return signs;
}

/* The fall in front, as tan(q / 2): Newton's method inside a bracket, from the root of the first harmonic. */
RASTER_FN Lanes ruling_root(const Ruling *g, LaneMask wanted)
{
    const Lanes *k = g->k, one = lanes_set(1);
    Lanes p0 = k[0] + k[1] + k[3], p1 = 2.0f * (k[2] + k[4]), p2 = 2.0f * (k[0] - k[3]);
    Lanes p3 = 2.0f * (k[2] - k[4]), p4 = k[0] - k[1] + k[3];
    Lanes low = -one, high = one;
    Lanes sine = lanes_max(lanes_min(-k[0] / k[2], one), -one);
    Lanes u = sine / (1.0f + lanes_sqrt(lanes_max(lanes_fma(-sine, sine, one), lanes_set(0))));
    u = lanes_select(wanted, u, lanes_set(0));
    for (int step = 0; step < RULING_STEPS; step++) {
        Lanes value = lanes_fma(p4, u, p3), slope = p4;
        slope = lanes_fma(slope, u, value);
        value = lanes_fma(value, u, p2);
        slope = lanes_fma(slope, u, value);
        value = lanes_fma(value, u, p1);
        slope = lanes_fma(slope, u, value);
        value = lanes_fma(value, u, p0);
        LaneMask before = value > 0.0f;
        low = lanes_select(before, u, low);
        high = lanes_select(before, high, u);
        Lanes next = u - value / slope;
        LaneMask inside = (next >= low) & (next <= high);
        next = lanes_select(inside, next, (low + high) * 0.5f);
        LaneMask moves = (lanes_abs(next - u) > 1e-6f) & wanted;
        u = next;
        if (!lanes_any(moves))
            break;
    }
    return u;
}

/* A joint's ruling beside lines of sight. */
typedef struct Line3 {
    Lanes start[3], run[3];
} Line3;

RASTER_FN Line3 ruling_line(const RasterJoint *joint, Lanes cosine, Lanes sine)
{
    Line3 line;
    for (int c = 0; c < 3; c++) {
        line.start[c] =
            lanes_fma(sine, lanes_set(joint->b[c]),
                      lanes_fma(cosine, lanes_set(joint->a[c]), lanes_set(joint->base[c])));
        line.run[c] =
            lanes_fma(sine, lanes_set(joint->db[c]),
                      lanes_fma(cosine, lanes_set(joint->da[c]), lanes_set(joint->span[c])));
    }
    return line;
}

/* How far along the ruling, in its length, the lines pass it. */
RASTER_FN Lanes ruling_place(const Near *near, const Sight *sight, const Line3 *line, Lanes off[2],
                             Lanes run[2])
{
    off[0] = line->start[0] - sight->x;
    off[1] = line->start[1] - sight->y;
    run[0] = line->run[0];
    run[1] = line->run[1];
    if (near->perspective) {
        off[0] = lanes_fma(-sight->dx, line->start[2], off[0]);
        off[1] = lanes_fma(-sight->dy, line->start[2], off[1]);
        run[0] = lanes_fma(-sight->dx, line->run[2], run[0]);
        run[1] = lanes_fma(-sight->dy, line->run[2], run[1]);
    }
    Lanes along = lanes_fma(off[0], run[0], off[1] * run[1]);
    return -along / lanes_fma(run[0], run[0], run[1] * run[1]);
}

/* Where the lines `among` enter the joint; *unsure is set where that takes double precision. */
RASTER_FN LaneMask joint_entry(const Near *near, const Sight *sight, LaneMask among, Lanes *z,
                               Lanes *ruling, LaneMask *unsure)
{
    Ruling g = ruling_of(near, sight);
    Signs signs = judge_signs(&g);
    *unsure = among & ~(signs.misses | signs.single);
    LaneMask wanted = among & signs.single;
    *z = *ruling = lanes_set(0);
    if (!lanes_any(wanted))
        return wanted;
    Lanes u = ruling_root(&g, wanted), u2 = u * u, per = 1.0f / (1.0f + u2), off[2], run[2];
    Line3 line = ruling_line(near->joint, (1.0f - u2) * per, 2.0f * u * per);
    Lanes place = ruling_place(near, sight, &line, off, run);
    Lanes x = lanes_fma(place, run[0], off[0]), y = lanes_fma(place, run[1], off[1]);
    float most = off_joint_line * near->item->radius;
    LaneMask sound = lanes_fma(x, x, y * y) <= most * most;
    *z = lanes_fma(place, line.run[2], line.start[2]);
    *ruling = u;
    *unsure |= wanted & ~sound;
    return wanted & sound & (place >= -off_joint_end) & (place <= 1 + off_joint_end);
}

/* ---- tiles --------------------------------------------------------------------------------------- */

typedef struct RasterState {
    const RasterTile *tile;
    RasterHits *hits;
    float farthest[BLOCKS]; /* depth behind which a block needs nothing */
    bool any;
} RasterState;

/* Keeps what is nearer. */
RASTER_FN void keep_nearer(RasterState *state, const Near *near, int block, LaneMask met, Lanes z,
                           const Lanes *ruling)
{
    RasterHits *hits = state->hits;
    int first = block * LANES;
    Lanes depth = z + near->z, before = lanes_load(&hits->z[first]);
    LaneMask nearer = met & (depth < before);
    if (!lanes_any(nearer))
        return;
    Lanes kept = (Lanes)load_items(&hits->item[first]);
    Lanes item = (Lanes)((LaneMask){0} + (int32_t)near->number);
    depth = lanes_select(nearer, depth, before);
    lanes_store(&hits->z[first], depth);
    store_items(&hits->item[first], (LaneMask)lanes_select(nearer, item, kept));
    if (ruling)
        lanes_store(&hits->ruling[first],
                    lanes_select(nearer, *ruling, lanes_load(&hits->ruling[first])));
    state->farthest[block] = lanes_largest(depth);
    state->any = true;
}

/* Decides the samples `unsure` of a block in double precision. */
LANE_TARGET static void decide_block(RasterState *state, const Near *near, int block,
                                     LaneMask unsure)
{
    const RasterTile *tile = state->tile;
    RasterHits *hits = state->hits;
    for (int lane = 0; lane < LANES; lane++) {
        int sample = block * LANES + lane;
        if (!unsure[lane])
            continue;
        double z = raster_decide(tile->bins, near->number, tile->x + (double)tile->grid->x[sample],
                                 tile->y + (double)tile->grid->y[sample], NULL);
        float depth = (float)(z - tile->z_middle);
        if (!(depth < hits->z[sample]))
            continue;
        hits->z[sample] = depth;
        hits->item[sample] = near->number | RASTER_DECIDED;
        state->any = true;
    }
    state->farthest[block] = lanes_largest(lanes_load(&hits->z[block * LANES]));
}

RASTER_FN void meet_block(RasterState *state, const Near *near, int block)
{
    const RasterGrid *grid = state->tile->grid;
    Sight sight =
        sight_of(near, lanes_load(&grid->x[block * LANES]), lanes_load(&grid->y[block * LANES]));
    Lanes z;
    if (near->kind == RASTER_CYLINDER) {
        LaneMask on_disc;
        Passage passage;
        LaneMask met = cylinder_entry(near, &sight, &z, &on_disc, &passage);
        keep_nearer(state, near, block, met, z, NULL);
    } else if (near->kind == RASTER_SPHERE) {
        LaneMask met = sphere_entry(near, &sight, &z);
        keep_nearer(state, near, block, met, z, NULL);
    } else if (near->kind == RASTER_EXACT) {
        decide_block(state, near, block, ~(LaneMask){0});
    } else {
        Lanes ruling;
        LaneMask unsure, within = within_outline(near, &sight);
        LaneMask met = joint_entry(near, &sight, within, &z, &ruling, &unsure);
        keep_nearer(state, near, block, met, z, &ruling);
        if (lanes_any(unsure))
            decide_block(state, near, block, unsure);
    }
}

/* The blocks of the tile that the item's capsule may touch and that do not all see something nearer, as
 * bits. */
RASTER_FN unsigned touched_blocks(const RasterState *state, const Near *near)
{
    const RasterGrid *grid = state->tile->grid;
    const float *xs = LANES == 8 ? grid->block8_x : grid->block4_x;
    const float *ys = LANES == 8 ? grid->block8_y : grid->block4_y;
    const float *half = LANES == 8 ? grid->block8_half : grid->block4_half;
    float half_x = half[0] * near->depth, half_y = half[1] * near->depth;
    float ax = near->along_x < 0 ? -near->along_x : near->along_x;
    float ay = near->along_y < 0 ? -near->along_y : near->along_y;
    float across = near->reach_across + half_x * ay + half_y * ax;
    float along = near->reach_along + half_x * ax + half_y * ay;
    if (near->perspective) {
        /* What is nearer or farther than the middle is seen at another scale. */
        float deep = near->item->cosine * near->item->half + near->item->radius;
        float spread = deep * 8 * (half[0] + half[1]);
        across += spread;
        along += spread;
    }
    float rounding = 1e-6f * (near->item->half + near->item->radius + near->reach_across);
    across += rounding;
    along += rounding;
    unsigned bits = 0;
    for (int first = 0; first < BLOCKS; first += LANES) {
        Lanes x = lanes_fma(lanes_load(&xs[first]), lanes_set(near->depth), lanes_set(near->x));
        Lanes y = lanes_fma(lanes_load(&ys[first]), lanes_set(near->depth), lanes_set(near->y));
        Lanes off = lanes_abs(lanes_fma(y, lanes_set(near->along_x), -(x * near->along_y)));
        Lanes on = lanes_abs(lanes_fma(x, lanes_set(near->along_x), y * near->along_y));
        LaneMask touched =
            (off <= across) & (on <= along) & (lanes_load(&state->farthest[first]) > near->z_near);
        bits |= mask_bits(touched) << first;
    }
    return bits;
}

RASTER_FN void trace_items(RasterState *state, bool perspective)
{
    const RasterTile *tile = state->tile;
    for (size_t i = 0; i < tile->n; i++) {
        Near near = approach(tile, tile->list[i], perspective);
        outline(&near);
        unsigned blocks = touched_blocks(state, &near);
        if (item_is_close(near.item))
            blocks = (1u << BLOCKS) - 1;
        for (; blocks; blocks &= blocks - 1)
            meet_block(state, &near, __builtin_ctz(blocks));
    }
}

LANE_TARGET static bool RASTER_KERNEL(trace)(const RasterTile *tile, RasterHits *hits)
{
    RasterState state = {.tile = tile, .hits = hits};
    for (int sample = 0; sample < TILE_SAMPLES; sample += LANES) {
        lanes_store(&hits->z[sample], lanes_set(HUGE_VALF));
        store_items(&hits->item[sample], (LaneMask){0} + (int32_t)RASTER_NOTHING);
        state.farthest[sample / LANES] = HUGE_VALF;
    }
    if (tile->perspective)
        trace_items(&state, true);
    else
        trace_items(&state, false);
    return state.any;
}

/* ---- normals ------------------------------------------------------------------------------------- */

RASTER_FN void joint_normal(const Near *near, const Sight *sight, Lanes u, Lanes normal[3])
{
    const RasterJoint *joint = near->joint;
    Lanes u2 = u * u, per = 1.0f / (1.0f + u2), off[2], run[2];
    Lanes cosine = (1.0f - u2) * per, sine = 2.0f * u * per;
    Line3 line = ruling_line(joint, cosine, sine);
    Lanes place = ruling_place(near, sight, &line, off, run), turn[3];
    for (int c = 0; c < 3; c++) {
        Lanes a = lanes_fma(place, lanes_set(joint->da[c]), lanes_set(joint->a[c]));
        Lanes b = lanes_fma(place, lanes_set(joint->db[c]), lanes_set(joint->b[c]));
        turn[c] = lanes_fma(cosine, b, -(sine * a));
    }
    for (int c = 0; c < 3; c++) {
        int d = (c + 1) % 3, e = (c + 2) % 3;
        normal[c] = lanes_fma(turn[d], line.run[e], -(turn[e] * line.run[d]));
    }
    Lanes size2 =
        lanes_fma(normal[0], normal[0], lanes_fma(normal[1], normal[1], normal[2] * normal[2]));
    Lanes scale = 1.0f / lanes_sqrt(lanes_max(size2, lanes_set(1e-35f)));
    for (int c = 0; c < 3; c++)
        normal[c] *= scale;
}

RASTER_FN void sphere_normal(const Near *near, const Sight *sight, Lanes normal[3])
{
    Lanes z;
    sphere_entry(near, sight, &z);
    float per = 1 / near->item->radius;
    normal[0] = lanes_fma(z, sight->dx, sight->x) * per;
    normal[1] = lanes_fma(z, sight->dy, sight->y) * per;
    normal[2] = z * per;
}

RASTER_FN void cylinder_normal(const Near *near, const Sight *sight, Lanes normal[3])
{
    LaneMask on_disc;
    Passage passage;
    Lanes z;
    cylinder_entry(near, sight, &z, &on_disc, &passage);
    Lanes along = lanes_fma(-passage.half, passage.rate, passage.along);
    float per = 1 / near->item->radius;
    Lanes at[3] = {lanes_fma(z, sight->dx, sight->x), lanes_fma(z, sight->dy, sight->y), z};
    for (int c = 0; c < 3; c++)
        normal[c] = lanes_fma(-along, lanes_set(near->axis[c]), at[c]) * per;
    if (!lanes_any(on_disc))
        return;
    Lanes facing = lanes_select(passage.rate > 0.0f, lanes_set(-1), lanes_set(1));
    for (int c = 0; c < 3; c++)
        normal[c] = lanes_select(on_disc, facing * near->axis[c], normal[c]);
}

/* The normals of the samples `of` a block, which see the item. */
RASTER_FN void resolve_item(const RasterTile *tile, const RasterHits *hits, int block, LaneMask of,
                            const Near *near, Lanes normal[3])
{
    int first = block * LANES;
    Sight sight =
        sight_of(near, lanes_load(&tile->grid->x[first]), lanes_load(&tile->grid->y[first]));
    Lanes own[3];
    if (near->kind == RASTER_SPHERE)
        sphere_normal(near, &sight, own);
    else if (near->kind == RASTER_CYLINDER)
        cylinder_normal(near, &sight, own);
    else
        joint_normal(near, &sight, lanes_load(&hits->ruling[first]), own);
    for (int c = 0; c < 3; c++)
        normal[c] = lanes_select(of, own[c], normal[c]);
}

LANE_TARGET static void resolve_decided(const RasterTile *tile, uint32_t number, int sample,
                                        Lanes normal[3])
{
    Vec3 found = {0, 0, 0};
    raster_decide(tile->bins, number, tile->x + (double)tile->grid->x[sample],
                  tile->y + (double)tile->grid->y[sample], &found);
    normal[0][sample % LANES] = (float)found.x;
    normal[1][sample % LANES] = (float)found.y;
    normal[2][sample % LANES] = (float)found.z;
}

RASTER_FN void resolve_block(const RasterTile *tile, const RasterHits *hits, int block,
                             bool perspective, TileHits *surface)
{
    int first = block * LANES;
    LaneMask items = load_items(&hits->item[first]);
    unsigned left = mask_bits(items != (int32_t)RASTER_NOTHING);
    Lanes normal[3] = {lanes_set(0), lanes_set(0), lanes_set(0)};
    for (int lane = 0; lane < LANES; lane++)
        surface->state[first + lane] = left >> lane & 1 ? TILE_HIT : TILE_MISS;
    if (!left)
        return;
    while (left) {
        int lane = __builtin_ctz(left);
        uint32_t number = hits->item[first + lane];
        if (number & RASTER_DECIDED) {
            resolve_decided(tile, number & ~RASTER_DECIDED, first + lane, normal);
            left &= left - 1;
            continue;
        }
        LaneMask of = items == (int32_t)number;
        left &= ~mask_bits(of);
        Near near = approach(tile, number, perspective);
        resolve_item(tile, hits, block, of, &near, normal);
    }
    for (int c = 0; c < 3; c++)
        lanes_store(&surface->normal[c][first], normal[c]);
    store_items(&surface->segment[first], items & (int32_t)~RASTER_DECIDED);
}

LANE_TARGET static void RASTER_KERNEL(resolve)(const RasterTile *tile, const RasterHits *hits,
                                               TileHits *surface)
{
    for (int block = 0; block < BLOCKS; block++)
        if (tile->perspective)
            resolve_block(tile, hits, block, true, surface);
        else
            resolve_block(tile, hits, block, false, surface);
}

/* ---- pixels -------------------------------------------------------------------------------------- */

typedef float Quad __attribute__((vector_size(16)));

/* Four pixels of three channels each. */
LANE_FN void store_pixels(float *to, Quad r, Quad g, Quad b)
{
    Quad low = __builtin_shufflevector(r, g, 0, 4, 1, 5);
    Quad high = __builtin_shufflevector(r, g, 2, 6, 3, 7);
    Quad middle = __builtin_shufflevector(low, b, 3, 5, 3, 5);
    Quad first = __builtin_shufflevector(low, b, 0, 1, 4, 2);
    Quad second = __builtin_shufflevector(middle, high, 0, 1, 4, 5);
    Quad third = __builtin_shufflevector(b, high, 2, 6, 7, 3);
    __builtin_memcpy(to, &first, sizeof first);
    __builtin_memcpy(to + 4, &second, sizeof second);
    __builtin_memcpy(to + 8, &third, sizeof third);
}

LANE_TARGET static void RASTER_KERNEL(paint)(float color[3][TILE_SAMPLES], float *pixels,
                                             size_t stride)
{
    for (int block = 0; block < TILE_SAMPLES / 8; block++) {
        Quad upper[3], lower[3];
        for (int c = 0; c < 3; c++) {
            Quad left, right;
            __builtin_memcpy(&left, &color[c][8 * block], sizeof left);
            __builtin_memcpy(&right, &color[c][8 * block + 4], sizeof right);
            upper[c] = __builtin_shufflevector(left, right, 0, 1, 4, 5);
            lower[c] = __builtin_shufflevector(left, right, 2, 3, 6, 7);
        }
        float *to =
            pixels + (size_t)tile_sample_y(8 * block) * stride + 3 * tile_sample_x(8 * block);
        store_pixels(to, upper[0], upper[1], upper[2]);
        store_pixels(to + stride, lower[0], lower[1], lower[2]);
    }
}

/* Gives the samples that see nothing the background. */
LANE_TARGET static void RASTER_KERNEL(clear)(const RasterHits *hits, const float background[3],
                                             float color[3][TILE_SAMPLES])
{
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        LaneMask seen = load_items(&hits->item[first]) != (int32_t)RASTER_NOTHING;
        for (int c = 0; c < 3; c++)
            lanes_store(&color[c][first],
                        lanes_select(seen, lanes_load(&color[c][first]), lanes_set(background[c])));
    }
}

/* ---- shadows ------------------------------------------------------------------------------------- */

/* Whether the item is seen before the probes' depths. */
RASTER_FN LaneMask item_covers(const Near *near, const RasterTile *tile, RasterProbes *probes,
                               int first, Lanes x, Lanes y, Lanes z, LaneMask among)
{
    Sight sight = sight_of(near, x, y);
    Lanes entry = lanes_set(0);
    LaneMask met, unsure = (LaneMask){0};
    if (near->kind == RASTER_CYLINDER) {
        LaneMask on_disc;
        Passage passage;
        met = cylinder_entry(near, &sight, &entry, &on_disc, &passage);
    } else if (near->kind == RASTER_SPHERE) {
        met = sphere_entry(near, &sight, &entry);
    } else if (near->kind == RASTER_JOINT) {
        Lanes ruling;
        met = joint_entry(near, &sight, among & within_outline(near, &sight), &entry, &ruling,
                          &unsure);
    } else {
        unsure = among;
        met = (LaneMask){0};
    }
    LaneMask covered = met & among & (entry + near->z < z);
    for (int lane = 0; lane < LANES; lane++)
        if (unsure[lane] && !covered[lane])
            covered[lane] = -(raster_decide(tile->bins, near->number, probes->x[first + lane],
                                            probes->y[first + lane], NULL) -
                                  tile->z_middle <
                              (double)probes->z[first + lane]);
    return covered;
}

RASTER_FN void cover_block(const RasterTile *tile, RasterProbes *probes, int first, int n,
                           bool perspective)
{
    Lanes x = lanes_set(0), y = lanes_set(0), z = lanes_set(0);
    LaneMask open = (LaneMask){0};
    for (int lane = 0; lane < n; lane++) {
        x[lane] = (float)(probes->x[first + lane] - tile->x);
        y[lane] = (float)(probes->y[first + lane] - tile->y);
        z[lane] = probes->z[first + lane];
        open[lane] = -1;
    }
    for (size_t i = 0; i < tile->n && lanes_any(open); i++) {
        Near near = approach(tile, tile->list[i], perspective);
        outline(&near);
        LaneMask among = open & (z > near.z_near);
        if (near.kind == RASTER_EXACT || lanes_any(among))
            open &= ~item_covers(&near, tile, probes, first, x, y, z, among);
    }
    for (int lane = 0; lane < n; lane++)
        probes->covered[first + lane] |= !open[lane];
}

LANE_TARGET static void RASTER_KERNEL(cover)(const RasterTile *tile, RasterProbes *probes,
                                             int first, int last)
{
    for (; first < last; first += LANES) {
        int n = last - first < LANES ? last - first : LANES;
        if (tile->perspective)
            cover_block(tile, probes, first, n, true);
        else
            cover_block(tile, probes, first, n, false);
    }
}
