/* Visibility of lights at shading points that belong to no pixel, such as the sample points of
 * vessels thinner than a pixel. */
#ifndef CORCAST_RENDER_LIGHT_OFFPIXEL_H
#define CORCAST_RENDER_LIGHT_OFFPIXEL_H

#include "render/light/shadowengine.h"

/* Shading points, and the visibility of each light at them. */
typedef struct OffPixelPoints {
    size_t n;
    /* Returns the position of point `index` < n in world coordinates, for queries to this light.
     * Called by several threads. */
    Vec3 (*at)(const void *context, const Light *light, size_t index);
    const void *context;                  /* passed to `at`; borrowed */
    uint16_t *n_visible[VIEW_MAX_LIGHTS]; /* per point: number of points of the light that are
                                           * visible so far; NULL: the light casts no shadows.
                                           * Owned. */
} OffPixelPoints;

/* Allocates `n_visible` for the lights of a view, all 0. Release the points with offpixel_release,
 * even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status offpixel_init(const View *view, OffPixelPoints *points, Err *err);
void offpixel_release(OffPixelPoints *points);

/* The light views of a light, or of some points of an area light. */
typedef struct OffPixelViews {
    LightBins *const *bins; /* n_views light bins, made for points in `frame` */
    int n_views;
    const Viewpoint *frame;
} OffPixelViews;

/* Queries the light views for all shading points. Adds to n_visible[light] of each point the number
 * of views from which the point is lit. Errors: STATUS_MEMORY. */
MUST_CHECK Status offpixel_query(const Drawing *drawing, const OffPixelViews *views, size_t light,
                                 OffPixelPoints *points, Err *err);

/* Sets n_visible[light] of all points by shadow rays of the drawing's caster to all points of the
 * light. */
void offpixel_trace(const Drawing *drawing, size_t light, OffPixelPoints *points);

#endif
