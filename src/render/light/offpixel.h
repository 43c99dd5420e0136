/* How much of each light reaches places that belong to no pixel, as those that stand for vessels
 * thinner than a pixel. */
#ifndef CORCAST_RENDER_OFFPIXEL_H
#define CORCAST_RENDER_OFFPIXEL_H

#include "render/job.h"
#include "render/light/lightview.h"

/* Places of the world, and how many points of each light reach them. */
typedef struct OffPixelPoints {
    size_t n;
    /* Returns place `number` < n, as this light is asked from it. Called by several threads. */
    Vec3 (*at)(const void *context, const Light *light, size_t number);
    const void *context;              /* borrowed */
    uint16_t *reach[VIEW_MAX_LIGHTS]; /* owned; of each place; NULL: the light casts no shadows */
} OffPixelPoints;

/* Make room for the lights of a view, all of whose points reach no place yet; *places is the
 * caller's even when this fails. STATUS_MEMORY. */
MUST_CHECK Status offpixel_init(const View *view, OffPixelPoints *places, Err *err);
void offpixel_release(OffPixelPoints *places);

/* Looks at all places from a light, or from one point of an area light, and adds 1 to reach[light]
 * of each place that nothing hides from there. `shadow` is what views->look prepared of that point
 * for places in `frame`. STATUS_MEMORY. */
MUST_CHECK Status offpixel_query(const Drawing *drawing, const LightViews *views,
                                 const void *shadow, const Viewpoint *frame, size_t light,
                                 OffPixelPoints *places, Err *err);

/* Sets reach[light] of all places by rays to all points of the light, cast by the drawing's
 * caster. */
void offpixel_trace(const Drawing *drawing, size_t light, OffPixelPoints *places);

#endif
