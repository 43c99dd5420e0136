/* How the camera, or a light, looks at primitives: from where, and on which grid of pixels. */
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

/* The places of a tile's samples when all lie (x, y) pixels off the middles of their pixels. */
RasterGrid rastergrid_make(const RasterView *view, double x, double y);

#endif
