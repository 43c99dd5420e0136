/* How the camera, or a light, looks at primitives: from where, and on which grid of pixels. */
#ifndef CORCAST_RENDER_RASTERVIEW_H
#define CORCAST_RENDER_RASTERVIEW_H

#include "render/raster/rastertile.h"
#include "render/tile/interval.h"
#include "render/tile/viewpoint.h"
#include "scene/scene.h"

/* Parallel lines of sight through a plane, or lines through one point, on a grid of pixels. */
typedef struct RasterView {
    Viewpoint eye;
    /* In the view's plane: mm in a parallel view, mm per mm of depth in perspective. */
    double left, top;      /* the middle of the first pixel */
    double step_x, step_y; /* from one pixel to the next to the right (> 0) and below (< 0) */
    double per_x, per_y;   /* 1 / step, set by rasterbins_new */
    int columns, rows;     /* pixels */
    TileSpan listed_columns, listed_rows; /* of tiles: those whose lists are not left empty. All of
                                           * a camera's, set by rasterbins_new; of a light's those
                                           * that places lie in, set before */
    double max_offset; /* how far samples lie off the middles of their pixels, in pixels */
    double z_middle;   /* depths in single precision are relative to it, mm */
    bool many; /* primitives, set by rasterbins_new: those that no sample sees are looked for */
    const bool *hidden; /* per primitive: not seen; NULL: none is hidden. Borrowed. */
    bool light;         /* of a light: its bins have boxes, and hulls instead of joints */
} RasterView;

/* That of a camera, for what is in `bounds`; `antialias` as in RenderParams. */
RasterView rasterview_of_camera(const Camera *camera, Box bounds, int antialias);

/* The line of sight at a point of the view's plane, its direction a unit vector. */
Ray rasterview_ray(const RasterView *view, double x, double y);

/* Where the samples of a tile are if each lies (x, y) pixels off the middle of its pixel. */
RasterGrid rastergrid_make(const RasterView *view, double x, double y);

#endif
