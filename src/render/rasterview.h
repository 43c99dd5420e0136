/* Primitives as a view sees them, that of the camera or of a light, and in which tiles of its
 * picture they may be seen. */
#ifndef CORCAST_RENDER_RASTERVIEW_H
#define CORCAST_RENDER_RASTERVIEW_H

#include "render/rastertile.h"
#include "scene/scene.h"

/* Parallel lines of sight through a plane, or lines through one point, on a grid of pixels. */
typedef struct RasterView {
    Vec3 location;
    Vec3 axes[3]; /* right, up and along the view: orthonormal */
    bool perspective;
    double left, top; /* the middle of the first pixel: mm from the location, or per mm of depth */
    double step_x, step_y; /* from pixel to pixel, to the right and down: above and below 0 */
    double per_x, per_y;   /* 1 / step, set by rasterbins_new */
    int columns, rows;     /* pixels */
    int first;             /* pixels above the first row, a multiple of TILE_SIDE */
    double stray;          /* how far samples lie off the middles of their pixels, in pixels */
    double z_middle;       /* depths in single precision are relative to it, mm */
} RasterView;

/* That of a camera, rows from `first` on; `antialias` as in RenderParams. */
RasterView rasterview_of_camera(const Scene *scene, int first, int rows, int antialias);

/* The line of sight at a point of the view's plane, its direction a unit vector. */
Ray rasterview_ray(const RasterView *view, double x, double y);
Vec3 rasterview_to_frame(const RasterView *view, Vec3 v);
Vec3 rasterview_to_world(const RasterView *view, Vec3 v);

/* The primitives of a scene, sorted into the rows of tiles of a view. Constant once built. */
typedef struct RasterBins {
    const Scene *scene; /* borrowed */
    RasterView view;
    RasterItem *items;   /* one a primitive */
    RasterJoint *joints; /* of items that are joints */
    int tile_columns, tile_rows;
    size_t *row_offsets; /* into row_items; one more than there are rows */
    uint32_t *row_items; /* ascending within a row */
} RasterBins;

/* Borrows the scene. STATUS_MEMORY when there is no room. */
MUST_CHECK Status rasterbins_new(const Scene *scene, const RasterView *view, int threads,
                                 RasterBins **out, Err *err);
void rasterbins_free(RasterBins *bins);

/* The items of each tile of one row: lists[offsets[i] .. offsets[i + 1]) for column i,
 * ascending. */
typedef struct RasterRow {
    uint32_t *offsets;
    uint32_t *lists;
    size_t lists_capacity;
    int32_t *spans;
    size_t spans_capacity;
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
