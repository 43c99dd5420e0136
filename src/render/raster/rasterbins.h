/* The primitives of a geometry, projected to a view and sorted into the rows of tiles that they may
 * touch. A row is sorted into tiles only when it is drawn:
 *
 *     RasterBins *bins;
 *     TRY(rasterbins_new(geometry, &view, threads, &bins, err));
 *     TRY(rasterbins_list(bins, row, &tiles, err));       per row of tiles
 *     RasterTile tile = rasterbins_tile(bins, column, row, list, n, &grid);
 *     rasterbins_free(bins);
 *
 * Functions that take a const RasterBins can be called by several threads. */
#ifndef CORCAST_RENDER_RASTER_RASTERBINS_H
#define CORCAST_RENDER_RASTER_RASTERBINS_H

#include "render/light/shadowengine.h"
#include "render/raster/rasteritem.h"

/* Immutable once built. */
typedef struct RasterBins {
    const Geometry *geometry; /* borrowed */
    RasterView view;
    void *item_memory;   /* the memory of `items`; owned */
    RasterItem *items;   /* each fills one cache line; a light view has one per primitive */
    RasterJoint *joints; /* per joint; NULL in a light view */
    RasterHull *hulls;   /* per joint, in a light view alone */
    int tile_columns, tile_rows;
    size_t *row_offsets;      /* row r owns row_items[row_offsets[r] .. row_offsets[r + 1]) */
    uint32_t *row_items;      /* indices of items, ascending within a row */
    RasterTiles *row_columns; /* per entry of row_items: the columns of tiles it may touch */
    RasterBox *row_boxes;     /* per entry of row_items; in a light view alone */
} RasterBins;

/* Returns the number of items: one per primitive, except spheres that are the round ends of
 * cylinders, which belong to the cylinder's item. */
static inline size_t rasterbins_items(const Geometry *geometry)
{
    return geometry->n_primitives - geometry->n_ends;
}

/* Returns true if rasterbins_new supports a geometry and an image of this size in pixels. */
bool rasterbins_take(const Geometry *geometry, int width, int height);
/* Builds the bins; release them with rasterbins_free. They borrow `geometry` and copy `view`.
 *
 * Errors   STATUS_MEMORY; STATUS_USAGE if a side of the picture has more than 65535 tiles.
 * Cost     O(primitives + rows of tiles that they touch). */
MUST_CHECK Status rasterbins_new(const Geometry *geometry, const RasterView *view, int threads,
                                 RasterBins **out, Err *err);
void rasterbins_free(RasterBins *bins);
/* Frees row_items, row_columns and row_boxes, to save memory. rasterbins_count and rasterbins_list
 * must not be called afterwards. */
void rasterbins_forget_rows(RasterBins *bins);

/* Counts the items of each tile in row `number`. Sets the tile_columns + 1 offsets of their lists:
 * the list of column i is [offsets[i], offsets[i + 1]). Errors: STATUS_MEMORY if the lists are too
 * long for 32-bit offsets. */
MUST_CHECK Status rasterbins_count(const RasterBins *bins, size_t number, uint32_t *offsets,
                                   Err *err);

/* Lists the items of each tile of row `number`, ascending. Errors: STATUS_MEMORY. */
MUST_CHECK Status rasterbins_list(const RasterBins *bins, size_t number, IndexLists *tiles,
                                  Err *err);

/* Returns the tile at (column, row). It borrows `bins`, `grid` and `list`, the indices of the n
 * items that may touch the tile. */
RasterTile rasterbins_tile(const RasterBins *bins, int column, int row, const uint32_t *list,
                           size_t n, const RasterGrid *grid);

/* Computes the joint of item `number` of a light view, which must be a RASTER_JOINT, from its
 * primitive: a light view stores no joints. */
void raster_joint(const RasterBins *bins, uint32_t number, RasterJoint *joint);

/* Intersects the line of sight at (x, y) of the view's plane with primitive `number`, in double
 * precision. Returns the depth of the hit along the view in mm, or INFINITY. If there is a hit,
 * sets *normal to the unit normal in the view's frame; `normal` may be NULL. */
double raster_decide(const RasterBins *bins, uint32_t number, double x, double y, Vec3 *normal);

/* Answers shadow queries among primitives, by the bins of light views
 * [render/light/shadowengine.h].
 *
 * Supports every light for which lightview_sees_all is true. A point is in shadow if a primitive is
 * between the point and the light. The primitive must be nearer to the light than the point by more
 * than 0.001 mm, POV-Ray's limit, plus the rounding error of the light view. ShadowPoints.item is
 * as in RasterHits: a sphere or cylinder whose hit was found in single precision does not shadow
 * its own points. */
extern const ShadowEngine raster_shadows;

#endif
