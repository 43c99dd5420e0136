/* What a kernel is given to find the first primitive at each sample of a tile, and what it
 * finds.
 *
 * Places are in the frame of the view: x to the right, y up, z along it. A line of sight is told
 * by the point (x, y) of the view's plane: parallel views look along (0, 0, 1) from (x, y, 0),
 * others along (x, y, 1) from the origin. */
#ifndef CORCAST_RENDER_RASTERTILE_H
#define CORCAST_RENDER_RASTERTILE_H

#include "render/tile/interval.h"
#include "render/tile/tile.h"

typedef enum RasterKind {
    RASTER_CYLINDER, /* closed, or with round ends */
    RASTER_SPHERE,
    RASTER_JOINT, /* of a solid: no line of sight sees it from inside */
    RASTER_EXACT  /* too near, too large or too odd for single precision */
} RasterKind;

/* Rows or columns of tiles, as in TileSpan. */
typedef struct RasterTiles {
    uint16_t first, last;
} RasterTiles;

static inline RasterTiles rastertiles_of(TileSpan span)
{
    return (RasterTiles){(uint16_t)span.first, (uint16_t)span.last};
}

/* A primitive, numbered as in the scene, or a capsule about it; a cylinder with its round ends. Its
 * axis is (sine ex, sine ey, cosine). */
typedef struct RasterItem {
    double x, y, z; /* its middle */
    float ex, ey;   /* unit */
    float sine, cosine;
    float radius, half;        /* mm; half its length, 0 of a sphere */
    uint32_t kind : 2;         /* RasterKind */
    uint32_t round_low : 1;    /* of a cylinder: whether the end against its axis is a ball, */
    uint32_t round_high : 1;   /* and that along it */
    uint32_t joint : 28;       /* index of its RasterJoint */
    RasterTiles rows, columns; /* that it may touch */
    uint32_t box; /* where in them: RasterBox.box, its y too from the first to the last */
} RasterItem;

/* A scene may have no more primitives. */
enum { MOST_ITEMS = 1 << 28 };

/* How far it reaches before and behind its middle, and the depth before which nothing of it is. */
static inline double item_depth(const RasterItem *item)
{
    return (double)item->cosine * (double)item->half + (double)item->radius;
}

static inline double item_nearest(const RasterItem *item)
{
    return item->z - (double)item->cosine * (double)item->half - (double)item->radius;
}

/* Whether an item is about the eye's plane, or so close that its outline tells nothing. */
static inline bool item_is_close(const RasterItem *item)
{
    return item_nearest(item) < 1e-3 * (1 + (double)item->radius);
}

/* A ruled joint about the middle of its item:
 *   C_1(q) = base + cos q a + sin q b,  C_2(q) - C_1(q) = span + cos q da + sin q db,
 * q counted from the ruling that faces the view most. A line of sight of direction D that passes
 * (X, Y) at the depth of the middle meets the ruling q where g(q) = k0 + k1 cos q + k2 sin q + k3
 * cos^2 q + k4 cos q sin q = 0,
 *   k_i = D . (by[i] - (X, Y, 0) x R_i),  R = span, da, db, 0, 0. */
typedef struct RasterJoint {
    float base[3], span[3], a[3], b[3], da[3], db[3];
    float by[5][3];
} RasterJoint;

/* What holds a ruled joint, about the same point: the planes of its circles, a little farther out,
 * so that where n . x + d < 0 of one of them, (n, d) with n unit, there is nothing of it; and the
 * cone about balls in its circles' places, whose balls, s along the item's axis, have the radius
 * middle - s taper. */
typedef struct RasterHull {
    float plane[2][4];
    float middle, taper; /* |taper| < 1 */
} RasterHull;

/* Where samples lie, from the middle of their tile, in the plane of the view. */
typedef struct RasterGrid {
    float x[TILE_SAMPLES], y[TILE_SAMPLES];
    float reach; /* no sample is farther from the middle */
    /* Middles of the blocks of 8 and of 4 samples, and of a block's half sides. */
    float block8_x[TILE_SAMPLES / 8], block8_y[TILE_SAMPLES / 8], block8_half[2];
    float block4_x[TILE_SAMPLES / 4], block4_y[TILE_SAMPLES / 4], block4_half[2];
} RasterGrid;

struct RasterBins;

typedef struct RasterTile {
    const struct RasterBins *bins;
    const RasterItem *items;
    const RasterJoint *joints; /* NULL in a light's view */
    const uint32_t *list;      /* items, ascending */
    size_t n;
    const float *nears; /* of each of the list, a depth before which nothing of it is, less
                         * z_middle; only for RasterKernels.cover */
    const RasterGrid *grid;
    bool perspective;
    double x, y; /* the middle of the tile, in the plane of the view */
    double z_middle;
} RasterTile;

#define RASTER_NOTHING UINT32_MAX
/* Set in `item` where a sample was decided in double precision, and where it sees a joint; the rest
 * is the index. */
#define RASTER_DECIDED 0x80000000u
#define RASTER_RULED 0x40000000u
#define RASTER_NUMBER 0x3fffffffu

/* The first item at each sample. */
typedef struct RasterHits {
    float z[TILE_SAMPLES]; /* depth along the view less z_middle; infinite: nothing is there */
    uint32_t item[TILE_SAMPLES]; /* index, perhaps with flags; or RASTER_NOTHING */
    float ruling[TILE_SAMPLES];  /* of a joint: tan(q / 2) */
} RasterHits;

#endif
