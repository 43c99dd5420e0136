/* Primitives as a view sees them, that of the camera or of a light, and in which tiles of its
 * picture they may be seen. */
#ifndef CORCAST_RENDER_RASTERVIEW_H
#define CORCAST_RENDER_RASTERVIEW_H

#include "render/raster/rastertile.h"
#include "render/tile/viewpoint.h"
#include "scene/scene.h"

/* Parallel lines of sight through a plane, or lines through one point, on a grid of pixels. */
typedef struct RasterView {
    Viewpoint eye;
    double left, top; /* the middle of the first pixel: mm from the location, or per mm of depth */
    double step_x, step_y; /* from pixel to pixel, to the right and down: above and below 0 */
    double per_x, per_y;   /* 1 / step, set by rasterbins_new */
    int columns, rows;     /* pixels */
    double stray;          /* how far samples lie off the middles of their pixels, in pixels */
    double z_middle;       /* depths in single precision are relative to it, mm */
    bool light; /* bins shall have boxes and, of joints, hulls alone: few are looked at */
} RasterView;

/* That of a camera, for what is in `bounds`; `antialias` as in RenderParams. */
RasterView rasterview_of_camera(const Camera *camera, Box bounds, int antialias);

/* The line of sight at a point of the view's plane, its direction a unit vector. */
Ray rasterview_ray(const RasterView *view, double x, double y);

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

/* The places of a tile's samples when all lie (x, y) pixels off the middles of their pixels. */
RasterGrid rastergrid_make(const RasterView *view, double x, double y);

#endif
