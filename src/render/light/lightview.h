/* What a light sees of a scene, as a camera would: parallel light along its direction, the light of
 * a point in perspective. */
#ifndef CORCAST_RENDER_LIGHTVIEW_H
#define CORCAST_RENDER_LIGHTVIEW_H

#include "render/tile/interval.h"
#include "render/tile/tilekernels.h"
#include "render/tile/viewpoint.h"

/* A view of tiles x tiles tiles, just wide enough for a geometry. */
typedef struct LightView {
    Viewpoint eye; /* looks the way of the light */
    int tiles;
    double left, top, step_x, step_y; /* of samples in the view's plane, step_y below 0 */
    double z_middle;                  /* of the geometry */
    TileSpan columns, rows;           /* of the tiles that places lie in */
} LightView;

/* The radius of a ball about the middle of the geometry's bounds that holds all of it. */
double lightview_radius(const Geometry *geometry);

/* Whether one view of the light sees all of the geometry: it is parallel, or a point far enough
 * off, and the view's ground is not before it. */
bool lightview_sees_all(const Geometry *geometry, const View *view, const Light *light);

/* That view, for places in a box of the world; `asked` NULL: for places anywhere. */
LightView lightview_of(const Geometry *geometry, const Light *light, int tiles, const Box *asked);

/* How it looks at places in the frame of a camera; see AimedPlaces for `slack`, mm. */
LightAim lightview_aim(const LightView *view, const Viewpoint *camera, double slack);

/* How an engine looks from lights, for those who ask by places alone. */
typedef struct LightViews {
    /* Whether it can, from one point or along parallel lines. */
    bool (*can)(const Geometry *geometry, const View *view, const Light *light);
    /* What a light that it can look from sees of the drawing's geometry, for places in `frame`,
     * which lie in a box of the world; `asked` NULL: anywhere. *shadow is owned. STATUS_MEMORY. */
    Status (*look)(const struct Drawing *drawing, const Light *light, const Viewpoint *frame,
                   const Box *asked, void **shadow, Err *err);
    void (*free)(void *shadow);
    /* Makes a queue of shadow queries for one thread. `hidden` is that of the drawing if the
     * shading points are those that its camera sees, else NULL; it is borrowed. *queue is the
     * caller's even when this fails. STATUS_MEMORY. */
    Status (*queue_new)(const void *shadow, const bool *hidden, void **queue, Err *err);
    void (*queue_free)(void *queue);
    /* Puts the question whether the light is hidden from place i, for each i whose bit is set in
     * `wanted`; at most SHADOW_BATCH calls between two answers. */
    void (*ask)(void *queue, const TileKernels *kernels, const SeenPlaces *places, uint64_t wanted,
                uint32_t answer);
    /* Answers all questions since the last answer: sets shadowed[answer + i], `answer` being that
     * of the call that asked about place i, to 1 if the light is hidden from the place, else to 0.
     */
    Status (*answer)(void *queue, RenderKernels kernels, uint8_t *shadowed, Err *err);
} LightViews;

/* Whether they can look from all points of a light. */
bool lightviews_can(const LightViews *views, const Geometry *geometry, const View *view,
                    const Light *light);

#endif
