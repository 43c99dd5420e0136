/* RasterBins: the primitives of a geometry, projected to a view and sorted into the rows of tiles
 * that they may touch. A row is sorted into tiles only when it is drawn. The view is that of the
 * camera, or a light view: the view from a light, for shadows.
 *
 *     RasterBins *bins;
 *     IndexLists tiles = {0};
 *     TRY(rasterbins_new(geometry, &view, threads, &bins, err));
 *     // per row of tiles: `tiles` gets one list of items per column
 *     TRY(rasterbins_list(bins, row, &tiles, err));
 *     // per tile: `list` is the list of the column, n its length
 *     RasterTile tile = rasterbins_tile(bins, column, row, list, n, &grid);
 *     indexlists_release(&tiles);
 *     rasterbins_free(bins);
 *
 * Functions that take a const RasterBins can be called by several threads. */
#ifndef CORCAST_RENDER_RASTER_RASTERBINS_H
#define CORCAST_RENDER_RASTER_RASTERBINS_H

#include "render/light/shadowengine.h"
#include "render/raster/rasteritem.h"

/* The projected and sorted primitives. They do not change after rasterbins_new, except by
 * rasterbins_free_rows. All arrays are owned. Joints and hulls are explained in rastertile.h. */
typedef struct RasterBins {
    const Geometry *geometry; /* borrowed */
    RasterView view;
    void *item_memory;   /* the memory block that contains `items`; owned */
    RasterItem *items;   /* aligned in item_memory to cache lines: one item fills one line */
    RasterJoint *joints; /* per joint; NULL in a light view, which computes a joint when it is
                          * needed [raster_joint] */
    RasterHull *hulls;   /* per joint; only in a light view */
    int tile_columns, tile_rows;
    size_t *row_offsets;      /* row r owns row_items[row_offsets[r] .. row_offsets[r + 1]) */
    uint32_t *row_items;      /* indices of items, ascending within a row */
    RasterTiles *row_columns; /* per entry of row_items: the columns of tiles it may touch */
    RasterBox *row_boxes;     /* per entry of row_items; only in a light view */
} RasterBins;

/* Returns the number of items: one per primitive, except spheres that are the round ends of
 * cylinders, which belong to the cylinder's item. */
static inline size_t rasterbins_items(const Geometry *geometry)
{
    return geometry->n_primitives - geometry->n_ends;
}

/* Returns true if rasterbins_new supports a geometry and an image of width x height pixels. Returns
 * false if there are more items than RasterItem can index, or more than 65535 tiles per side,
 * because columns and rows of tiles are 16-bit numbers. */
bool rasterbins_supports(const Geometry *geometry, int width, int height);
/* Builds the bins; release them with rasterbins_free. They borrow `geometry` and copy `view`.
 * `threads` 0: one thread per processor.
 *
 * Errors   STATUS_MEMORY; STATUS_USAGE if rasterbins_supports is false for the size of the picture.
 * Cost     O(primitives + rows of tiles that they touch). */
MUST_CHECK Status rasterbins_new(const Geometry *geometry, const RasterView *view, int threads,
                                 RasterBins **out, Err *err);
/* Frees the bins. NULL is allowed. */
void rasterbins_free(RasterBins *bins);
/* Frees row_items, row_columns and row_boxes, to save memory. rasterbins_count and rasterbins_list
 * must not be called afterwards. */
void rasterbins_free_rows(RasterBins *bins);

/* Counts the items of each tile in row `row`. Fills the tile_columns + 1 elements of `offsets` with
 * running totals: column i has offsets[i + 1] - offsets[i] items. Errors: STATUS_MEMORY if a total
 * exceeds 32 bits. */
MUST_CHECK Status rasterbins_count(const RasterBins *bins, size_t row, uint32_t *offsets, Err *err);

/* Lists the items of each tile of row `row`, ascending: list i of *tiles is that of column i.
 * Replaces the content of *tiles, whose memory is reused from row to row; the caller zeroes *tiles
 * first and releases it with indexlists_release, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status rasterbins_list(const RasterBins *bins, size_t row, IndexLists *tiles, Err *err);

/* Returns the tile at (column, row). It borrows `bins`, `grid` and `list`, the indices of the n
 * items that may touch the tile. */
RasterTile rasterbins_tile(const RasterBins *bins, int column, int row, const uint32_t *list,
                           size_t n, const RasterGrid *grid);

/* Computes, from its primitive, the joint of item `item`, a RASTER_JOINT, of a light view. A light
 * view stores no joints. */
void raster_joint(const RasterBins *bins, uint32_t item, RasterJoint *joint);

/* Intersects the line of sight at (x, y) of the view's plane [rasterview.h] with the primitive of
 * index `primitive`, in double precision. Returns the depth of the hit along the view in mm, or
 * INFINITY. If there is a hit, sets *normal to the unit normal in the view's frame; `normal` may be
 * NULL. */
double raster_intersect(const RasterBins *bins, uint32_t primitive, double x, double y,
                        Vec3 *normal);

/* The shadow engine of primitives [render/light/shadowengine.h]: finds the shading points that are
 * in the shadow of a primitive, with one RasterBins per light view.
 *
 * Supports every light for which lightview_sees_all is true. A point is in shadow if a primitive is
 * nearer to the light than the point, by more than 0.001 mm plus the rounding error of the light
 * view. 0.001 mm is POV-Ray's limit. A sphere or cylinder whose hit was found in single precision
 * does not shadow its own points, because rounding may put a point inside it. ShadowPoints.item
 * contains the index of this primitive, with the flags of RasterHits.item. */
extern const ShadowEngine raster_shadows;

#endif
