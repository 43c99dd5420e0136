/* The input and output of the kernels that find the first primitive at each sample of a tile.
 *
 * A primitive is projected to a RasterItem, which contains a capsule around the primitive. The
 * kernels test the items of a tile's list. A primitive that single precision cannot draw has the
 * kind RASTER_EXACT. A view is that of a camera, or a light view: the view from a light, for
 * shadows. A joint also has a RasterJoint or, in a light view, a RasterHull: a convex solid around
 * it.
 *
 * Points are in the frame of the view [viewpoint.h], mm. A line of sight is given by a point (x, y)
 * of the view's plane. In a parallel view it starts at (x, y, 0) and has the direction (0, 0, 1).
 * In perspective it starts at the origin and has the direction (x, y, 1). */
#ifndef CORCAST_RENDER_RASTER_RASTERTILE_H
#define CORCAST_RENDER_RASTER_RASTERTILE_H

#include "render/tile/interval.h"
#include "render/tile/tile.h"

/* The kinds of items. */
typedef enum RasterKind {
    RASTER_CYLINDER, /* each end is a flat disc or a ball */
    RASTER_SPHERE,
    RASTER_JOINT, /* the ruled lateral surface of a joint; only its outer side is visible */
    RASTER_EXACT  /* a primitive that single precision cannot draw [rasteritem.c]: each sample is
                   * decided in double precision */
} RasterKind;

/* A range of columns or rows of tiles: a TileSpan in 16-bit numbers. */
typedef struct RasterTiles {
    uint16_t first, last;
} RasterTiles;

/* Converts a TileSpan, whose numbers must be below 65536. */
static inline RasterTiles rastertiles_of(TileSpan span)
{
    return (RasterTiles){(uint16_t)span.first, (uint16_t)span.last};
}

/* A projected primitive, with a capsule that contains it: all points within `radius` of a segment.
 * The segment has the length 2 half and the unit direction (sine ex, sine ey, cosine), with cosine
 * >= 0. Coordinates are mm in the frame of the view. The round ends of a cylinder belong to the
 * cylinder's item. */
typedef struct RasterItem {
    double x, y, z; /* middle of the segment */
    float ex, ey;   /* unit vector: direction of the segment projected to the view's plane */
    float sine, cosine;
    float radius, half;        /* mm; `half` is 0 for a sphere */
    uint32_t kind : 2;         /* RasterKind */
    uint32_t round_low : 1;    /* cylinder: the end at -half along the axis is a ball */
    uint32_t round_high : 1;   /* cylinder: the end at +half along the axis is a ball */
    uint32_t joint : 28;       /* index of its RasterJoint or RasterHull */
    RasterTiles rows, columns; /* tiles that the item may touch */
    union {
        uint32_t box; /* light view, where item i is primitive i: the bounding box of the item,
                       * packed as RasterBox.box; minima relative to the first tile of `rows`
                       * and `columns`, maxima relative to the last */
        uint32_t primitive; /* camera's view: index of the primitive */
    };
} RasterItem;

/* Maximum number of primitives that can be drawn: RasterItem.joint has 28 bits. */
enum { MAX_ITEMS = 1 << 28 };

/* Returns half the extent in depth of the item's capsule, mm. */
static inline double item_half_depth(const RasterItem *item)
{
    return (double)item->cosine * (double)item->half + (double)item->radius;
}

/* Returns the minimum depth of the item's capsule, mm. */
static inline double item_nearest(const RasterItem *item)
{
    return item->z - (double)item->cosine * (double)item->half - (double)item->radius;
}

/* Returns true if an item reaches the plane through the viewpoint, or is so close to that plane
 * that its outline is too large to compute in single precision: within a thousandth of 1 mm plus
 * the radius. Such an item is tested at every sample. */
static inline bool item_is_close(const RasterItem *item)
{
    return item_nearest(item) < 1e-3 * (1 + (double)item->radius);
}

/* A ruled joint. Its surface consists of straight lines (rulings) between two circles, from C_1(q)
 * to C_2(q):
 *     C_1(q) = base + cos q a + sin q b,  C_2(q) - C_1(q) = span + cos q da + sin q db.
 * Coordinates are relative to the middle of the joint's item. q = 0 is the ruling that faces the
 * viewer most. A line of sight has the direction D, and passes (X, Y) at the depth of the item's
 * middle. It meets ruling q where
 *     g(q) = k0 + k1 cos q + k2 sin q + k3 cos^2 q + k4 cos q sin q = 0,
 *     k_i = D . (by[i] - (X, Y, 0) x R_i),  R = span, da, db, 0, 0.
 * g(q) is the moment of the line of sight about ruling q. by[i] is the part of the moment of the
 * rulings, C_1 x (C_2 - C_1), that belongs to term i [rasterjoint_make]. */
typedef struct RasterJoint {
    float base[3], span[3], a[3], b[3], da[3], db[3];
    float by[5][3];
} RasterJoint;

/* A convex solid that contains a ruled joint. Coordinates are relative to the middle of the joint's
 * item. The solid is bounded by the planes of the joint's two circles, moved outwards a little, and
 * by a cone. The cone is the envelope of balls that are centered on the item's axis. */
typedef struct RasterHull {
    float plane[2][4];   /* (n, d) with |n| = 1: the joint is where n . x + d >= 0 */
    float middle, taper; /* the ball at s mm along the axis has the radius middle - s taper, mm;
                          * |taper| < 1 */
} RasterHull;

/* Positions of the samples of a tile in the view's plane, relative to the middle of the tile. It is
 * the same for all tiles of a view. */
typedef struct RasterGrid {
    float x[TILE_SAMPLES], y[TILE_SAMPLES];
    float reach; /* maximum distance of a sample from the middle */
    /* Middles of the blocks of 8 and of 4 consecutive samples, and half the width and height of a
     * block. */
    float block8_x[TILE_SAMPLES / 8], block8_y[TILE_SAMPLES / 8], block8_half[2];
    float block4_x[TILE_SAMPLES / 4], block4_y[TILE_SAMPLES / 4], block4_half[2];
} RasterGrid;

struct RasterBins;

/* A tile of a view with its list of items. All pointers are borrowed. */
typedef struct RasterTile {
    const struct RasterBins *bins;
    const RasterItem *items;
    const RasterJoint *joints; /* NULL in a light view */
    const uint32_t *list;      /* indices of items, ascending */
    size_t n;
    const float *nears; /* per entry of `list`: a lower bound of the item's depths, minus z_middle;
                         * only for shadow queries [RasterKernels.cover in rasterkernels.h] */
    const RasterGrid *grid;
    bool perspective;
    double x, y;     /* middle of the tile, in the plane of the view */
    double z_middle; /* depth that is subtracted from depths in single precision, mm */
} RasterTile;

/* Value of RasterHits.item if the sample hits nothing. */
#define RASTER_NOTHING UINT32_MAX
/* Flags in RasterHits.item, valid if it is not RASTER_NOTHING. RASTER_DECIDED: the sample was
 * decided in double precision. RASTER_RULED: the sample hits a joint. RASTER_INDEX masks the
 * index. */
#define RASTER_DECIDED 0x80000000u
#define RASTER_RULED 0x40000000u
#define RASTER_INDEX 0x3fffffffu

/* The first item at each sample. */
typedef struct RasterHits {
    float z[TILE_SAMPLES];       /* depth along the view minus z_middle, mm; infinite: the sample
                                  * hits nothing */
    uint32_t item[TILE_SAMPLES]; /* index of the primitive, with flags; RASTER_NOTHING: the sample
                                  * hits nothing. With RASTER_RULED, it is the index of the item
                                  * until RasterKernels.resolve replaces it */
    float ruling[TILE_SAMPLES];  /* joints: tan(q / 2) of the ruling that is hit */
} RasterHits;

#endif
