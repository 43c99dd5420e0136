/* Finds where lines of sight enter spheres and cylinders, LANES lines at once. A part of the kernel
 * in kernel_raster.h, which includes this file. `approach` makes the NearItem of an item, `outline`
 * its outline; sight_of makes lines of sight; then sphere_entry or cylinder_entry finds the hits.
 *
 * To stay precise in single precision, all positions are relative to the middle of the item. At the
 * depth of the item's middle, a line of sight passes this middle at the offset (X, Y). `approach`
 * computes the offset of the tile's middle line in double precision; sight_of adds the offsets of
 * the samples, which are small. */
#ifndef CORCAST_RENDER_RASTER_KERNEL_ROUND_H
#define CORCAST_RENDER_RASTER_KERNEL_ROUND_H

#include "render/raster/rastertile.h"
#include "render/tile/lanes.h"

#define RASTER_FN LANE_FN __attribute__((always_inline))

/* Squared sine of the angle between axis and line of sight below which a cylinder is intersected in
 * double precision: the square of min_sine [rasteritem.c]. */
static const float steep_sine2 = 4e-4f;

/* Loads LANES indices; store_items stores them. */
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

/* Lines of sight relative to an item. */
typedef struct SightLines {
    Lanes x, y;   /* position at the depth of the item's middle, relative to the middle */
    Lanes dx, dy; /* directions (dx, dy, 1); set in perspective only */
} SightLines;

/* An item relative to one tile. The middle line is the line of sight through the middle of the
 * tile. The depth z_middle is that of the RasterTile. */
typedef struct NearItem {
    const RasterItem *item;
    bool perspective;
    uint32_t kind;   /* RasterKind */
    uint32_t number; /* index of the item; in kernel_raster.h: of the primitive */
    float x, y;      /* position of the middle line at the depth of the item's middle, relative to
                      * the item's middle */
    float depth;     /* depth of the item's middle along the view; 1 in a parallel view, where it
                      * scales nothing */
    float dx, dy;    /* direction of the tile's middle line */
    float z;         /* depth of the item's middle, minus z_middle */
    float z_near;    /* lower bound of the item's depths, minus z_middle */
    /* Outline of the item's capsule at the depth of its middle, set by outline(): a rectangle whose
     * long side has the unit direction (along_x, along_y), and half the lengths of its sides. */
    float along_x, along_y, reach_along, reach_across;
    float axis[3];  /* unit direction of the axis */
    float per_sine; /* 1 / |n|, with n the cross product of the middle line's direction (dx, dy, 1)
                     * and the axis; in a parallel view, 1 / sine of their angle */
} NearItem;

/* Sets the outline of the item's capsule in the plane at the depth of its middle, projected along
 * the middle line. In perspective the outline is widened, because nearer and farther parts of the
 * item have another scale: a sample is at most grid->reach per mm of depth from the middle line,
 * and the item's depths are at most `deep` from its middle. */
RASTER_FN void outline(const RasterTile *tile, NearItem *near)
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
    float deep = item->cosine * item->half + item->radius;
    near->reach_across = item->radius * stretch + deep * tile->grid->reach;
    near->reach_along = size * item->half + near->reach_across;
}

/* Returns item `number` relative to a tile, without its outline. */
RASTER_FN NearItem approach(const RasterTile *tile, uint32_t number, bool perspective)
{
    const RasterItem *item = &tile->items[number];
    NearItem near;
    near.item = item;
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
        near.per_sine = 1 / sqrtf(sine2);
        if (near.kind == RASTER_CYLINDER &&
            sine2 < steep_sine2 * (1 + near.dx * near.dx + near.dy * near.dy))
            near.kind = RASTER_EXACT;
    } else {
        near.x = (float)(tile->x - item->x);
        near.y = (float)(tile->y - item->y);
    }
    return near;
}

/* Returns the lines of sight at the offsets (x, y) from the tile's middle, relative to an item. */
RASTER_FN SightLines sight_of(const NearItem *near, Lanes x, Lanes y)
{
    SightLines sight;
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

/* Returns the lines of sight that may touch the item's capsule. */
RASTER_FN LaneMask within_outline(const NearItem *near, const SightLines *sight)
{
    Lanes x = lanes_set(near->along_x), y = lanes_set(near->along_y);
    Lanes off = lanes_abs(lanes_fma(sight->y, x, -(sight->x * y)));
    Lanes on = lanes_abs(lanes_fma(sight->x, x, sight->y * y));
    /* 1.00001 covers the rounding of both sides. */
    return (off <= near->reach_across * 1.00001f) & (on <= near->reach_along * 1.00001f);
}

/* ---- spheres and cylinders ------------------------------------------------------------------- */

/* Finds where the lines enter the sphere. Returns the lines that do, and sets *z to their depths
 * relative to the sphere's middle. */
RASTER_FN LaneMask sphere_entry(const NearItem *near, const SightLines *sight, Lanes *z)
{
    float radius2 = near->item->radius * near->item->radius;
    if (!near->perspective) {
        Lanes left = lanes_set(radius2) - lanes_fma(sight->x, sight->x, sight->y * sight->y);
        *z = -lanes_sqrt(lanes_max(left, lanes_set(0)));
        return left > 0.0f;
    }
    /* With D the direction of the line, let n = D x (X, Y, 0). |n|^2 / |D|^2 is the squared
     * distance of the line from the middle. */
    Lanes size2 = lanes_fma(sight->dx, sight->dx, lanes_fma(sight->dy, sight->dy, lanes_set(1)));
    Lanes nz = lanes_fma(sight->dx, sight->y, -(sight->dy * sight->x));
    Lanes n2 = lanes_fma(nz, nz, lanes_fma(sight->x, sight->x, sight->y * sight->y));
    Lanes left = lanes_fma(lanes_set(radius2), size2, -n2), per = 1.0f / size2;
    Lanes along = lanes_fma(sight->dx, sight->x, sight->dy * sight->y);
    *z = -(along + lanes_sqrt(lanes_max(left, lanes_set(0)))) * per;
    return left > 0.0f;
}

/* Lines of sight relative to an infinite cylinder. */
typedef struct CylinderPassage {
    LaneMask met; /* lines that pass through the cylinder */
    Lanes middle; /* depth at which a line is nearest to the axis, relative to the cylinder's
                   * middle */
    Lanes half;   /* half the length of the line's part inside the cylinder, in depth */
    Lanes along;  /* position of the nearest point along the axis, relative to its middle */
    Lanes rate;   /* derivative of `along` by depth */
    Lanes off2;   /* squared distance between line and axis; at a depth t farther the squared
                   * distance from the axis is off2 + sine2 t^2 */
    Lanes sine2;
} CylinderPassage;

/* The nearest points of a line of sight and the axis of an item. D is the direction of the line, u
 * the unit direction of the axis, n = D x u, and P the point of the line at the depth of the axis's
 * middle. */
typedef struct Crossing {
    Lanes sine2; /* |n|^2 */
    Lanes off;   /* n . P: the distance between line and axis, times |n| */
    Lanes turn;  /* -|n|^2 times the depth, from P on, at which the line is nearest to the axis */
    Lanes rate;  /* D . u */
} Crossing;

/* Computes the nearest points of the lines and the axis, in perspective. */
RASTER_FN Crossing cross_axis(const NearItem *near, const SightLines *sight)
{
    Lanes ux = lanes_set(near->axis[0]), uy = lanes_set(near->axis[1]);
    Lanes uz = lanes_set(near->axis[2]);
    Lanes nx = lanes_fma(sight->dy, uz, -uy), ny = lanes_fma(-sight->dx, uz, ux);
    Lanes nz = lanes_fma(sight->dx, uy, -(sight->dy * ux));
    Lanes cross = lanes_fma(nx, sight->y, -(ny * sight->x));
    Crossing crossing;
    crossing.sine2 = lanes_fma(nx, nx, lanes_fma(ny, ny, nz * nz));
    crossing.off = lanes_fma(nx, sight->x, ny * sight->y);
    crossing.turn = lanes_fma(nz, lanes_fma(sight->x, uy, -(sight->y * ux)), uz * cross);
    crossing.rate = lanes_fma(sight->dx, ux, lanes_fma(sight->dy, uy, uz));
    return crossing;
}

/* Intersects the lines with the infinite cylinder. */
RASTER_FN CylinderPassage pass_cylinder(const NearItem *near, const SightLines *sight)
{
    CylinderPassage passage;
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
        passage.off2 = off * off;
        passage.sine2 = lanes_set(item->sine * item->sine);
        return passage;
    }
    Crossing crossing = cross_axis(near, sight);
    Lanes off = crossing.off, per = 1.0f / crossing.sine2;
    Lanes left = lanes_fma(lanes_set(radius2), crossing.sine2, -(off * off));
    Lanes ux = lanes_set(near->axis[0]), uy = lanes_set(near->axis[1]);
    passage.met = left > 0.0f;
    passage.half = lanes_sqrt(lanes_max(left, zero)) * per;
    passage.middle = -crossing.turn * per;
    passage.rate = crossing.rate;
    passage.along = lanes_fma(sight->x, ux, lanes_fma(sight->y, uy, passage.middle * passage.rate));
    passage.off2 = off * off * per;
    passage.sine2 = crossing.sine2;
    return passage;
}

/* The points where lines enter a cylinder. */
typedef struct CylinderEntry {
    LaneMask on_disc; /* lines that enter through a flat end */
    Lanes rate;       /* as in CylinderPassage */
    Lanes along; /* position of the entry into the infinite cylinder along the axis; for a round
                  * end, the position of the ball. The normal points from there to the entry,
                  * except on a flat end */
} CylinderEntry;

/* Returns the lines of `outside` that may enter a round end. `outside`: the lines that enter the
 * infinite cylinder beyond an end of the cylinder, at the position `along` of its axis. */
RASTER_FN LaneMask lines_at_balls(const NearItem *near, Lanes along, LaneMask outside)
{
    LaneMask low = along < 0.0f;
    LaneMask flat_low = low & -(int32_t)!near->item->round_low;
    LaneMask flat_high = ~low & -(int32_t)!near->item->round_high;
    return outside & ~(flat_low | flat_high);
}

/* Finds where the lines enter the ball of the cylinder's radius at the position `along` of its
 * axis. Returns the lines that do, and sets *z. */
RASTER_FN LaneMask ball_entry(const NearItem *near, const SightLines *sight, Lanes along, Lanes *z)
{
    Lanes depth = along * near->axis[2];
    SightLines ball = *sight;
    ball.x = lanes_fma(-along, lanes_set(near->axis[0]), sight->x);
    ball.y = lanes_fma(-along, lanes_set(near->axis[1]), sight->y);
    if (near->perspective) {
        ball.x = lanes_fma(depth, sight->dx, ball.x);
        ball.y = lanes_fma(depth, sight->dy, ball.y);
    }
    LaneMask met = sphere_entry(near, &ball, z);
    *z += depth;
    return met;
}

/* Finds where the lines enter the cylinder with its flat or round ends. Returns the lines that do,
 * and sets *z to their depths relative to the cylinder's middle. */
RASTER_FN LaneMask cylinder_entry(const NearItem *near, const SightLines *sight, Lanes *z,
                                  CylinderEntry *entry)
{
    const RasterItem *item = near->item;
    float half = item->half;
    CylinderPassage passage = pass_cylinder(near, sight);
    /* `first` and `enters` are positions along the axis from the end that a line reaches first, so
     * that they grow with depth: of the point nearest to the axis, and of the entry. */
    Lanes along = passage.along, rate = passage.rate, grows = lanes_set(1);
    if (near->perspective) {
        grows = lanes_select(rate < 0.0f, -grows, grows);
        along *= grows;
        rate *= grows;
    }
    Lanes first = along + half, rise = rate * passage.half, enters = first - rise;
    LaneMask before = passage.met & (enters < 0.0f);
    LaneMask met = passage.met & ~before & (enters <= 2 * half);
    *entry =
        (CylinderEntry){before & (first + rise >= 0.0f), passage.rate, (enters - half) * grows};
    *z = passage.middle - passage.half;
    if (item->round_low | item->round_high) {
        LaneMask round = lines_at_balls(near, entry->along, passage.met & ~met);
        if (lanes_any(round)) {
            Lanes end = lanes_select(entry->along < 0.0f, lanes_set(-half), lanes_set(half)),
                  ball_z;
            met |= round & ball_entry(near, sight, end, &ball_z);
            *z = lanes_select(round, ball_z, *z);
            entry->along = lanes_select(round, end, entry->along);
            entry->on_disc &= ~round;
        }
    }
    /* A line that enters the infinite cylinder before the end, and leaves it beyond the end, passes
     * the disc, where its position is 0. It moves along the axis, so `rate` is not 0. */
    if (lanes_any(entry->on_disc))
        *z = lanes_select(entry->on_disc, passage.middle - first / rate, *z);
    return entry->on_disc | met;
}

/* Computes the normals where the lines enter the sphere at depths z. */
RASTER_FN void sphere_normal(const NearItem *near, const SightLines *sight, Lanes z,
                             Lanes normal[3])
{
    float per = 1 / near->item->radius;
    normal[0] = lanes_fma(z, sight->dx, sight->x) * per;
    normal[1] = lanes_fma(z, sight->dy, sight->y) * per;
    normal[2] = z * per;
}

/* Computes the normals where the lines enter the cylinder at depths z. */
RASTER_FN void cylinder_normal(const NearItem *near, const SightLines *sight, Lanes z,
                               const CylinderEntry *entry, Lanes normal[3])
{
    float per = 1 / near->item->radius;
    Lanes at[3] = {lanes_fma(z, sight->dx, sight->x), lanes_fma(z, sight->dy, sight->y), z};
    for (int c = 0; c < 3; c++)
        normal[c] = lanes_fma(-entry->along, lanes_set(near->axis[c]), at[c]) * per;
    if (!lanes_any(entry->on_disc))
        return;
    Lanes facing = lanes_select(entry->rate > 0.0f, lanes_set(-1), lanes_set(1));
    for (int c = 0; c < 3; c++)
        normal[c] = lanes_select(entry->on_disc, facing * near->axis[c], normal[c]);
}

#endif
