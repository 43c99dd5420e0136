/* Light views: projections of the scene from a light, as a camera at the light would show it. A
 * parallel light has a parallel view along its direction; a point light has a perspective view.
 *
 * A light view is divided into a square grid of tiles of TILE_SIDE x TILE_SIDE samples, like an
 * image. To decide whether a point is in shadow, the point is projected to its tile, and only the
 * vessels in this tile are tested. lightview_sees_all tells whether a light has a light view,
 * lightview_of makes it, and lightview_projection projects points to it. No function has state.
 * Lengths are in mm. */
#ifndef CORCAST_RENDER_LIGHT_LIGHTVIEW_H
#define CORCAST_RENDER_LIGHT_LIGHTVIEW_H

#include "render/tile/interval.h"
#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* A square grid of tiles in the view's plane: the smallest that contains the geometry. */
typedef struct LightView {
    Viewpoint eye;                    /* looks along the light */
    int tiles;                        /* tiles along a side of the grid */
    double left, top, step_x, step_y; /* position of the upper left sample, and steps from sample to
                                       * sample, in the view's plane: mm, or, in perspective, mm at
                                       * depth 1; step_y < 0 */
    double z_middle;                  /* depth of the geometry's middle along the view axis, mm.
                                       * Depths are stored relative to it, to lose fewer digits */
    TileSpan columns, rows;           /* tiles that may contain points to be tested for shadow */
} LightView;

/* Returns the radius, mm, of the ball around the middle of the geometry's bounds that contains the
 * bounds. */
double lightview_radius(const Geometry *geometry);

/* Returns true if one light view shows all of the geometry. Two conditions must hold. The light is
 * parallel, or is more than 1.16 times lightview_radius from the middle of the geometry's bounds;
 * nearer lights would need a view of more than about 120 degrees. Light and geometry are on the
 * same side of the ground plane, view->ground, if there is one. */
bool lightview_sees_all(const Geometry *geometry, const View *view, const Light *light);

/* Returns the light view of a light for which lightview_sees_all is true.
 *
 * tiles   number of tiles along a side of the grid, >= 1.
 * points  bounds of the points to be tested, world coordinates; NULL: points may be anywhere. */
LightView lightview_of(const Geometry *geometry, const Light *light, int tiles, const Box *points);

/* Returns the projection that takes points in the frame of `camera` to tiles and depths of the
 * light view. Blockers nearer to a point than `slack` mm cast no shadow on it. */
LightProjection lightview_projection(const LightView *view, const Viewpoint *camera, double slack);

#endif
