/* Projects one primitive to a view: computes its RasterItem and the tiles that it may touch.
 * rasterbins.c calls these functions for all primitives of a geometry. All functions are pure and
 * can run in parallel. */
#ifndef CORCAST_RENDER_RASTER_RASTERITEM_H
#define CORCAST_RENDER_RASTER_RASTERITEM_H

#include "render/raster/rasterview.h"

/* Computes the item of the primitive with index `number`, except RasterItem.joint and
 * RasterItem.primitive. In a light view also computes RasterItem.box.
 *
 * item          if the primitive touches no tile, or is hidden, only `rows` and `columns` are set,
 *               to empty ranges.
 * joint, hull   for a RASTER_JOINT, *hull is set in a light view, and *joint in any other view. The
 *               pointer that is not used may be NULL. */
void rasteritem_make(const Geometry *geometry, const RasterView *view, uint32_t number,
                     RasterItem *item, RasterJoint *joint, RasterHull *hull);

/* Returns the joint of a PRIMITIVE_JOINT in the frame of the view. Coordinates are relative to
 * `middle`, the middle of the joint's item in that frame. */
RasterJoint rasterjoint_make(const RasterView *view, const Primitive *primitive, Vec3 middle);

/* A box in a tile, packed into 32 bits so that one subtraction tells whether two boxes overlap.
 * Units are 1/128 of the tile's side, x from the left and y from the top.
 *
 *     bits   31  30 ... 24     23  22 ... 16     15  14 ... 8      7   6 ... 0
 *     item   1   127 - y_min   1   y_max         1   127 - x_min   1   x_max
 *     query  0   127 - y_max   0   y_min         0   127 - x_max   0   x_min
 *
 * The top bit of each byte is a guard. In `item - query`, the guard of a byte stays set if and only
 * if the item's number in that byte is at least the query's number. The boxes overlap if and only
 * if all four guards stay set. */
#define RASTERBOX_GUARDS 0x80808080u
/* The bits of x_max, and of 127 - x_min, in a packed box of an item. */
#define RASTERBOX_X_MAX_BITS 0x7fu
#define RASTERBOX_X_MIN_BITS 0x7f00u
enum { RASTERBOX_PARTS = 128 };

/* Bounds of an item in one row of tiles. */
typedef struct RasterBox {
    uint32_t box; /* packed box of kind `item`: x_min is relative to the leftmost tile that the item
                   * touches in this row, x_max to the rightmost one */
    float near;   /* minimum depth of the item, mm, minus RasterView.z_middle */
} RasterBox;

/* The region that the lines of sight of one row of tiles fill. It is between two planes: y = y[0]
 * and y = y[1] in a parallel view, y = y[0] z and y = y[1] z in perspective. */
typedef struct RasterSlab {
    double y[2];          /* y of the lowest and of the highest line of sight, in the view's
                           * plane */
    double per_length[2]; /* 1 / the length of the planes' normals (0, 1, -y) */
} RasterSlab;

/* Returns the slab of row `row` of tiles. */
RasterSlab rasterslab_of(const RasterView *view, size_t row);

/* Returns true only if no sample of the view can hit a capsule. May return false for a capsule that
 * no sample hits.
 *
 * In a parallel view, only the samples in the capsule's bounding rectangle can hit it. If they are
 * few, and each is at the centre of its pixel, they are tested against the capsule itself. In
 * perspective, the tiles are tested against a ball around the capsule.
 *
 * middle   middle of the capsule's axis, in the frame of the view, mm.
 * span     vector from one end of the axis to the other, mm.
 * radius   radius of the capsule, mm. */
bool rasterreach_misses(const RasterView *view, Vec3 middle, Vec3 span, double radius);
/* Sets item->rows and item->columns, the tiles that the item may touch; empty if the item is behind
 * the viewer. In a light view also sets item->box. All other fields of the item are input. */
void rasterreach_set(const RasterView *view, RasterItem *item);
/* Returns RasterBox.near of an item. */
float rasterreach_near(const RasterView *view, const RasterItem *item);
/* Returns the tiles of row `row` that the item may touch.
 *
 * row   one of the item's rows.
 * slab  rasterslab_of(view, row).
 * box   receives RasterBox.box of the item in this row; undefined except in a light view. */
TileSpan rasterreach_in_row(const RasterView *view, const RasterItem *item, int row,
                            const RasterSlab *slab, uint32_t *box);

#endif
