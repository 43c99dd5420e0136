/* Primitives as a view sees them, sorted into the rows of tiles in which they may be seen. */
#ifndef CORCAST_RENDER_RASTERBINS_H
#define CORCAST_RENDER_RASTERBINS_H

#include "render/raster/rasteritem.h"

/* Primitives, sorted into the rows of tiles of a view. Constant once built. */
typedef struct RasterBins {
    const Geometry *geometry; /* borrowed */
    RasterView view;
    void *item_memory;   /* holds the items */
    RasterItem *items;   /* in a line of the cache each */
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

/* Whether one thread makes the bins of the geometry, however many there are. */
bool rasterbins_are_small(const Geometry *geometry);

/* Borrows the geometry. STATUS_MEMORY when there is no room. */
MUST_CHECK Status rasterbins_new(const Geometry *geometry, const RasterView *view, int threads,
                                 RasterBins **out, Err *err);
void rasterbins_free(RasterBins *bins);
/* Frees row_items, row_columns and row_boxes, of which nothing may be asked any more. */
void rasterbins_forget_rows(RasterBins *bins);

/* Counts the items of each tile of one row: those of column i are to be
 * [offsets[i], offsets[i + 1]) of as many as the last offset says. */
MUST_CHECK Status rasterbins_count(const RasterBins *bins, size_t number, uint32_t *offsets,
                                   Err *err);

/* The items of each tile of one row: lists[offsets[i] .. offsets[i + 1]) for column i,
 * ascending. */
typedef struct RasterRow {
    uint32_t *offsets;
    uint32_t *lists;
    size_t lists_capacity;
} RasterRow;

/* Fills *row, which is zeroed or has been used for these bins before. */
MUST_CHECK Status rasterbins_list(const RasterBins *bins, size_t number, RasterRow *row, Err *err);
void rasterrow_release(RasterRow *row);

/* Sets up a tile of the view for its list. */
RasterTile rasterbins_tile(const RasterBins *bins, int column, int row, const uint32_t *list,
                           size_t n, const RasterGrid *grid);

/* Makes the joint that item number `item` is. */
void raster_joint(const RasterBins *bins, uint32_t item, RasterJoint *joint);

/* Meets an item in double precision with the line of sight at (x, y) of the view's plane: its
 * depth z along the view, INFINITY when it is not met, and if `normal` is not NULL the surface's
 * normal in the view's frame. */
double raster_decide(const RasterBins *bins, uint32_t item, double x, double y, Vec3 *normal);

#endif
