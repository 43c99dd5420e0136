/* What a light sees of a scene, as a camera would: parallel light along its direction, the light of
 * a point in perspective. */
#ifndef CORCAST_RENDER_LIGHTVIEW_H
#define CORCAST_RENDER_LIGHTVIEW_H

#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* A view of tiles x tiles tiles, just wide enough for a geometry. */
typedef struct LightView {
    Viewpoint eye; /* looks the way of the light */
    int tiles;
    double left, top, step_x, step_y; /* of samples in the view's plane, step_y below 0 */
    double z_middle;                  /* of the geometry */
} LightView;

/* The radius of a ball about the middle of the geometry's bounds that holds all of it. */
double lightview_radius(const Geometry *geometry);

/* Whether one view of the light sees all of the geometry: it is parallel, or a point far enough
 * off. */
bool lightview_sees_all(const Geometry *geometry, const Light *light);

/* That view. */
LightView lightview_of(const Geometry *geometry, const Light *light, int tiles);

/* How it looks at places in the frame of a camera; see AimedPlaces for `slack`, mm. */
LightAim lightview_aim(const LightView *view, const Viewpoint *camera, double slack);

#endif
