/* One primitive as a view sees it: what it is there, and in which tiles. */
#ifndef CORCAST_RENDER_RASTERITEM_H
#define CORCAST_RENDER_RASTERITEM_H

#include "render/raster/rasterview.h"

/* Makes the item of a primitive of the geometry, but for its tiles and box. If it is a RASTER_JOINT
 * its index `joint` is kept, and its hull set for the view of a light, else its joint. */
void rasteritem_make(const Geometry *geometry, const RasterView *view, uint32_t number,
                     uint32_t joint, RasterItem *item, RasterJoint *made, RasterHull *hull);

/* The joint that a primitive is, about `middle`, that of its item. */
RasterJoint rasterjoint_make(const RasterView *view, const Primitive *primitive, Vec3 middle);

/* A box within a tile in 128ths of its sides, from the left and the top, for one subtraction to
 * compare with another: 7 bits each of the greatest x, 127 less the least x, the greatest y and
 * 127 less the least y, below guards that are set in boxes of items. */
#define RASTERBOX_GUARDS 0x80808080u
#define RASTERBOX_HIGH_X 0x7fu
#define RASTERBOX_LOW_X 0x7f00u
enum { RASTERBOX_PARTS = 128 };

/* Where in its tiles of a row an item may be. */
typedef struct RasterBox {
    uint32_t box; /* its x are the least in the first tile and the greatest in the last */
    float near;   /* a depth before which nothing of the item is, less z_middle */
} RasterBox;

/* The slab that the lines of sight of a row of tiles fill. */
typedef struct RasterSlab {
    double y[2], per_length[2]; /* lowest and highest */
} RasterSlab;

RasterSlab rasterslab_of(const RasterView *view, size_t row);

/* Sets tiles and box of an item. */
void rasterreach_set(const RasterView *view, RasterItem *item);
/* A depth before which nothing of it is, less z_middle. */
float rasterreach_near(const RasterView *view, const RasterItem *item);
/* The columns of one of its rows, and the box there. */
TileSpan rasterreach_in_row(const RasterView *view, const RasterItem *item, int row,
                            const RasterSlab *slab, uint32_t *box);

#endif
