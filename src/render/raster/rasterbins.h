/* The primitives of a geometry, projected to a view and sorted into the rows of tiles that they may
 * touch. A row is sorted into tiles only when it is drawn. A light view is a view from a light, for
 * shadows; it has less data than a view of the camera. Order of the calls:
 *
 *     RasterBins *bins;
 *     TRY(rasterbins_new(geometry, &view, threads, &bins, err));
 *     TRY(rasterbins_list(bins, row, &tiles, err));       per row of tiles: `tiles` has a list per
 * column RasterTile tile = rasterbins_tile(bins, column, row, list, n, &grid);
 *     rasterbins_free(bins);
 *
 * Functions that take a const RasterBins can be called by several threads. */
#ifndef CORCAST_RENDER_RASTER_RASTERBINS_H
#define CORCAST_RENDER_RASTER_RASTERBINS_H

#include "render/light/shadowengine.h"
#include "render/raster/rasteritem.h"

/* Not changed after rasterbins_new, except by rasterbins_free_rows. All arrays are owned. */
typedef struct RasterBins {
    const Geometry *geometry; /* borrowed */
    RasterView view;
    void *item_memory;   /* the memory that contains `items`; owned */
    RasterItem *items;   /* aligned in item_memory so that each fills one cache line */
    RasterJoint *joints; /* per joint; NULL in a light view */
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
 *
 * Errors   STATUS_MEMORY; STATUS_USAGE if a side of the picture has more than 65535 tiles.
 * Cost     O(primitives + rows of tiles that they touch). */
MUST_CHECK Status rasterbins_new(const Geometry *geometry, const RasterView *view, int threads,
                                 RasterBins **out, Err *err);
void rasterbins_free(RasterBins *bins);
/* Frees row_items, row_columns and row_boxes, to save memory. rasterbins_count and rasterbins_list
 * must not be called afterwards. */
void rasterbins_free_rows(RasterBins *bins);

/* Counts the items of each tile in row `row`. Sets offsets[0] to offsets[tile_columns]: in one
 * array of all lists, the list of column i would be [offsets[i], offsets[i + 1]). Errors:
 * STATUS_MEMORY if the lists are too long for 32-bit offsets. */
MUST_CHECK Status rasterbins_count(const RasterBins *bins, size_t row, uint32_t *offsets, Err *err);

/* Lists the items of each tile of row `row`, ascending. Errors: STATUS_MEMORY. */
MUST_CHECK Status rasterbins_list(const RasterBins *bins, size_t row, IndexLists *tiles, Err *err);

/* Returns the tile at (column, row). It borrows `bins`, `grid` and `list`, the indices of the n
 * items that may touch the tile. */
RasterTile rasterbins_tile(const RasterBins *bins, int column, int row, const uint32_t *list,
                           size_t n, const RasterGrid *grid);

/* Computes the joint of item `item` of a light view, which must be a RASTER_JOINT, from its
 * primitive, because a light view stores no joints. */
void raster_joint(const RasterBins *bins, uint32_t item, RasterJoint *joint);

/* Intersects the line of sight at (x, y) of the view's plane [rasterview.h] with the primitive of
 * index `primitive`, in double precision. Returns the depth of the hit along the view in mm, or
 * INFINITY. If there is a hit, sets *normal to the unit normal in the view's frame; `normal` may be
 * NULL. */
double raster_intersect(const RasterBins *bins, uint32_t primitive, double x, double y,
                        Vec3 *normal);

/* Finds which shading points primitives shadow, with the bins of one view per light
 * [render/light/shadowengine.h].
 *
 * Supports every light for which lightview_sees_all is true. A point is in shadow if a primitive is
 * between the point and the light. The primitive counts only if its distance to the light is less
 * than the point's distance, by more than 0.001 mm (POV-Ray's limit) plus the rounding error of the
 * light view. A sphere or cylinder whose hit was found in single precision does not shadow its own
 * points; ShadowPoints.item identifies it, as RasterHits does. */
extern const ShadowEngine raster_shadows;

#endif
