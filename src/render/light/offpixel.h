/* Visibility of lights at shading points that belong to no pixel, such as the sample points of
 * vessels thinner than a pixel. offpixel_init allocates the counts; then offpixel_query or
 * offpixel_trace counts, for each light, the visible points of the light. */
#ifndef CORCAST_RENDER_LIGHT_OFFPIXEL_H
#define CORCAST_RENDER_LIGHT_OFFPIXEL_H

#include "render/light/shadowengine.h"

/* The shading points, and the visibility of each light at them. The caller sets n, at and
 * context. */
typedef struct OffPixelPoints {
    size_t n;
    /* Returns the position of point `index` < n in world coordinates, mm, for queries to this
     * light. The position may depend on the light: a sample point of a thin vessel is on the side
     * of the vessel that faces the light. Called by several threads. */
    Vec3 (*at)(const void *context, const Light *light, size_t index);
    const void *context;                  /* passed to `at`; borrowed */
    uint16_t *n_visible[VIEW_MAX_LIGHTS]; /* per shading point: number of points of the light that
                                           * are visible; NULL: the light casts no shadows.
                                           * Owned. */
} OffPixelPoints;

/* Allocates `n_visible` for the lights of a view, all 0. Release the points with offpixel_release,
 * even after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status offpixel_init(const View *view, OffPixelPoints *points, Err *err);
void offpixel_release(OffPixelPoints *points);

/* The light views of a light, or of some sample points of an area light. Borrowed. */
typedef struct OffPixelViews {
    LightBins *const *bins; /* n_views light bins, made for points in `frame` */
    int n_views;
    const Viewpoint *frame;
} OffPixelViews;

/* Queries the light views for all shading points. Adds the number of views from which a shading
 * point is lit to its n_visible[light], so that several calls can share the views of an area light.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status offpixel_query(const Drawing *drawing, const OffPixelViews *views, size_t light,
                                 OffPixelPoints *points, Err *err);

/* Sets n_visible[light] of all shading points, by shadow rays of the drawing's caster to all sample
 * points of the light. */
void offpixel_trace(const Drawing *drawing, size_t light, OffPixelPoints *points);

#endif
