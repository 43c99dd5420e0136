/* Primitives as a view sees them, sorted into the rows of tiles in which they may be seen. */
#ifndef CORCAST_RENDER_RASTERBINS_H
#define CORCAST_RENDER_RASTERBINS_H

#include "render/raster/rasteritem.h"

/* Primitives, sorted into the rows of tiles of a view. Constant once built. */
typedef struct RasterBins {
    const Geometry *geometry; /* borrowed */
    RasterView view;
    void *item_memory;   /* holds the items */
    RasterItem *items;   /* in a line of the cache each; in a light's view one a primitive */
    RasterJoint *joints; /* of items that are joints, but in a light's view: */
    RasterHull *hulls;
    int tile_columns, tile_rows;
    size_t *row_offsets; /* into row_items; one more than there are rows */
    uint32_t *row_items; /* ascending within a row */
    RasterTiles *row_columns;
    RasterBox *row_boxes; /* only in a light's view */
} RasterBins;

/* How many primitives become items: cylinders have their round ends. */
static inline size_t rasterbins_items(const Geometry *geometry)
{
    return geometry->n_primitives - geometry->n_ends;
}

/* Whether rasterbins_new takes a picture of this geometry and size. */
bool rasterbins_take(const Geometry *geometry, int width, int height);
/* Whether rasterbins_new uses one thread for this geometry, however many it may use. */
bool rasterbins_are_small(const Geometry *geometry);

/* Builds the bins (owned by the caller) of a geometry that is borrowed; `view` is copied.
 * O(primitives and the rows that they touch). STATUS_MEMORY; STATUS_USAGE when a side of the
 * picture has more than 65535 tiles. */
MUST_CHECK Status rasterbins_new(const Geometry *geometry, const RasterView *view, int threads,
                                 RasterBins **out, Err *err);
void rasterbins_free(RasterBins *bins);
/* Frees row_items, row_columns and row_boxes: rasterbins_count and rasterbins_list must not be
 * called any more. */
void rasterbins_forget_rows(RasterBins *bins);

/* Sets offsets[tile_columns + 1] of the lists of one row's tiles: the list of column i takes up
 * [offsets[i], offsets[i + 1]). STATUS_MEMORY when 32 bits do not hold them. */
MUST_CHECK Status rasterbins_count(const RasterBins *bins, size_t number, uint32_t *offsets,
                                   Err *err);

/* Lists the items of each tile of row `number`, ascending. Errors: STATUS_MEMORY. */
MUST_CHECK Status rasterbins_list(const RasterBins *bins, size_t number, IndexLists *tiles,
                                  Err *err);

/* The tile at (column, row) with its list of n items, borrowed, and its samples. */
RasterTile rasterbins_tile(const RasterBins *bins, int column, int row, const uint32_t *list,
                           size_t n, const RasterGrid *grid);

/* Makes the joint of an item of a light's view that is a RASTER_JOINT, anew from its primitive. */
void raster_joint(const RasterBins *bins, uint32_t number, RasterJoint *joint);

/* Intersects the line of sight at (x, y) of the view's plane with a primitive, in double precision.
 * Returns the depth of the hit along the view, mm, or INFINITY; if there is a hit and `normal` is
 * not NULL, sets *normal to the surface's unit normal in the view's frame. */
double raster_decide(const RasterBins *bins, uint32_t number, double x, double y, Vec3 *normal);

#endif
