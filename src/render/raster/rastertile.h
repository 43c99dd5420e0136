/* The input of the kernels that find the first primitive at each sample of a tile, and their
 * output.
 *
 * Points are in the frame of the view [viewpoint.h], mm. A line of sight is given by a point (x, y)
 * of the view's plane: in a parallel view it leads from (x, y, 0) along (0, 0, 1), in perspective
 * from the origin along (x, y, 1). */
#ifndef CORCAST_RENDER_RASTERTILE_H
#define CORCAST_RENDER_RASTERTILE_H

#include "render/tile/interval.h"
#include "render/tile/tile.h"

typedef enum RasterKind {
    RASTER_CYLINDER, /* its ends flat discs or balls */
    RASTER_SPHERE,
    RASTER_JOINT, /* the wall of a solid: no line of sight sees it from inside */
    RASTER_EXACT  /* a primitive that single precision cannot draw [rasteritem.c]: each sample is
                   * decided in double precision */
} RasterKind;

/* Rows or columns of tiles, as in TileSpan. */
typedef struct RasterTiles {
    uint16_t first, last;
} RasterTiles;

static inline RasterTiles rastertiles_of(TileSpan span)
{
    return (RasterTiles){(uint16_t)span.first, (uint16_t)span.last};
}

/* One primitive of the geometry, as a capsule that contains it: all points within `radius` of a
 * segment of length 2 half about the middle, along the unit axis (sine ex, sine ey, cosine) with
 * cosine >= 0. In the view of a light items have the numbers of their primitives; a cylinder's
 * round ends are its own. */
typedef struct RasterItem {
    double x, y, z; /* the middle */
    float ex, ey;   /* a unit vector, where the axis points to across the view */
    float sine, cosine;
    float radius, half;      /* mm; `half` is 0 of a sphere */
    uint32_t kind : 2;       /* RasterKind */
    uint32_t round_low : 1;  /* of a cylinder: whether its end at -half along the axis is a ball */
    uint32_t round_high : 1; /* and that at +half */
    uint32_t joint : 28;     /* index of its RasterJoint or RasterHull */
    RasterTiles rows, columns; /* of tiles that it may touch */
    union {
        uint32_t box;       /* in the view of a light: the item's box [rasteritem.h] in those tiles,
                             * its minima in the first, its maxima in the last */
        uint32_t primitive; /* in any other: its number */
    };
} RasterItem;

/* No geometry with more primitives can be drawn. */
enum { MAX_ITEMS = 1 << 28 };

/* How far the capsule extends along the view from its middle, and the smallest depth of it. */
static inline double item_depth(const RasterItem *item)
{
    return (double)item->cosine * (double)item->half + (double)item->radius;
}

static inline double item_nearest(const RasterItem *item)
{
    return item->z - (double)item->cosine * (double)item->half - (double)item->radius;
}

/* Whether an item reaches the plane of the eye, or is so close to it that its outline in the view's
 * plane has no bound. */
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
 * is the number of the primitive. */
#define RASTER_DECIDED 0x80000000u
#define RASTER_RULED 0x40000000u
#define RASTER_NUMBER 0x3fffffffu

/* The first item at each sample. */
typedef struct RasterHits {
    float z[TILE_SAMPLES]; /* depth along the view less z_middle; infinite: nothing is there */
    uint32_t item[TILE_SAMPLES]; /* the number of its primitive, perhaps with flags, but of a joint,
                                  * until it is resolved, its own; or RASTER_NOTHING */
    float ruling[TILE_SAMPLES];  /* of a joint: tan(q / 2) */
} RasterHits;

#endif
