/* How a camera or a light sees the primitives: a viewpoint, and the grid of pixels at which the
 * view is sampled. The caller makes a RasterView, by rasterview_of_camera or from a light;
 * rasterbins_new [rasterbins.h] copies it, completes it and sorts the primitives into its tiles.
 * Tiles are numbered row by row from the upper left. No function has state. */
#ifndef CORCAST_RENDER_RASTER_RASTERVIEW_H
#define CORCAST_RENDER_RASTER_RASTERVIEW_H

#include "render/raster/rastertile.h"
#include "render/tile/interval.h"
#include "render/tile/viewpoint.h"
#include "scene/scene.h"

/* A viewpoint with a grid of pixels. Lines of sight are parallel, or pass through one point
 * (perspective). */
typedef struct RasterView {
    Viewpoint eye;
    /* Positions in the view's plane: mm in a parallel view, mm per mm of depth in perspective. */
    double left, top;                     /* centre of the upper left pixel */
    double step_x, step_y;                /* from one pixel to the next to the right (> 0) and below
                                           * (< 0) */
    double per_x, per_y;                  /* 1 / step, set by rasterbins_new */
    int columns, rows;                    /* size of the grid, pixels */
    TileSpan listed_columns, listed_rows; /* tiles whose primitives rasterbins_new lists. In a
                                           * camera's view, all tiles; set by rasterbins_new. In a
                                           * light view, the tiles with points that are tested for
                                           * shadow; set by the caller */
    double max_offset;                    /* maximum distance of a sample from the centre of its
                                           * pixel along x or y, in pixels */
    double z_middle;                      /* depths in single precision are relative to this depth,
                                           * mm */
    bool many;                            /* true: it pays to leave out the primitives that no
                                           * sample can hit [rasterreach_misses], because there are
                                           * many; set by rasterbins_new */
    const bool *hidden;                   /* per primitive: true if it is not drawn; NULL: none is
                                           * hidden. Borrowed. */
    bool light;                           /* true: a light view, the view from a light for shadows.
                                           * The bins then have RasterBoxes, and RasterHulls instead
                                           * of RasterJoints */
} RasterView;

/* Returns the view of a camera on the geometry in `bounds`. `antialias` is
 * RenderParams.antialias. */
RasterView rasterview_of_camera(const Camera *camera, Box bounds, int antialias);

/* Returns the line of sight at a point of the view's plane, in world coordinates. Its direction is
 * a unit vector. */
Ray rasterview_ray(const RasterView *view, double x, double y);

/* Returns the joint (the body between two cylinders) of a PRIMITIVE_JOINT in the coordinates of the
 * view. This frame is left-handed, so a normal that points outwards in world coordinates points
 * inwards in the frame. */
JointFrame rasterview_joint(const RasterView *view, const Primitive *primitive);

/* Returns the positions of the samples of any tile, relative to the tile's middle. Each sample is
 * (x, y) pixels from the centre of its pixel. */
RasterGrid rastergrid_make(const RasterView *view, double x, double y);

#endif
