/* One primitive as a view sees it: what it is there, and in which tiles. */
#ifndef CORCAST_RENDER_RASTERITEM_H
#define CORCAST_RENDER_RASTERITEM_H

#include "render/raster/rasterview.h"

/* Sets the item of primitive `number`, except RasterItem.joint and RasterItem.primitive. Sets only
 * `rows` and `columns` of an item that touches no tile. If the item is a RASTER_JOINT, sets *hull
 * in the view of a light and *joint in any other view; the other one may be NULL. */
void rasteritem_make(const Geometry *geometry, const RasterView *view, uint32_t number,
                     RasterItem *item, RasterJoint *joint, RasterHull *hull);

/* Returns the joint of a primitive in the frame of the view, relative to `middle`, the middle of
 * its item. */
RasterJoint rasterjoint_make(const RasterView *view, const Primitive *primitive, Vec3 middle);

/* A box in a tile, packed into 32 bits so that one subtraction tells whether two boxes overlap.
 * Units are 1/128 of the tile's side, x from the left and y from the top.
 *
 *   bits   31  30 ... 24     23  22 ... 16     15  14 ... 8      7   6 ... 0
 *   item   1   127 - y_min   1   y_max         1   127 - x_min   1   x_max
 *   query  0   127 - y_max   0   y_min         0   127 - x_max   0   x_min
 *
 * In `item - query` the guard, the top bit of a byte, survives if and only if the item's number in
 * that byte is at least the query's; the boxes overlap if and only if all four guards survive. */
#define RASTERBOX_GUARDS 0x80808080u
#define RASTERBOX_HIGH_X 0x7fu
#define RASTERBOX_LOW_X 0x7f00u
enum { RASTERBOX_PARTS = 128 };

/* Where an item may be in the tiles of a row that it touches. */
typedef struct RasterBox {
    uint32_t box; /* an item's: x_min is that in the first of those tiles, x_max that in the last */
    float near;   /* no part of the item has a smaller depth, mm, less z_middle */
} RasterBox;

/* The slab of space that the lines of sight of a row of tiles fill, between two planes: y = y[0]
 * and y[1] in a parallel view, y = y[0] z and y[1] z in perspective. */
typedef struct RasterSlab {
    double y[2];          /* of the lowest and of the highest line */
    double per_length[2]; /* 1 / the length of the planes' normals (0, 1, -y) */
} RasterSlab;

RasterSlab rasterslab_of(const RasterView *view, size_t row);

/* Whether a parallel view has no sample within a capsule's box, or, where it has few and all lie at
 * the middles of pixels, within the capsule; in perspective, whether none of its tiles has one in a
 * ball about the capsule. */
bool rasterreach_misses(const RasterView *view, Vec3 middle, Vec3 span, double radius);
/* Sets the rows and columns of tiles that an item may touch, none if it is behind the viewer, and
 * in the view of a light its box. */
void rasterreach_set(const RasterView *view, RasterItem *item);
/* RasterBox.near of an item. */
float rasterreach_near(const RasterView *view, const RasterItem *item);
/* The tiles of one of the item's rows that it may touch, and in the view of a light *box, the
 * item's box in that row. */
TileSpan rasterreach_in_row(const RasterView *view, const RasterItem *item, int row,
                            const RasterSlab *slab, uint32_t *box);

#endif
