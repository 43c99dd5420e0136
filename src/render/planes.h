/* The planes of a picture, or of a band of it. */
#ifndef CORCAST_RENDER_PLANES_H
#define CORCAST_RENDER_PLANES_H

#include "geom/geom.h"
#include "render/job.h"
#include <math.h>

static inline bool planes_want_geometry(const Frame *frame)
{
    return frame->depth.values || frame->normal.values || frame->id.ids;
}

/* Stores what is seen at a pixel in those planes of geometry that there are: the depth along the
 * ray in mm, infinite where nothing is seen; the unit normal, facing the viewer, or 0; the id of
 * the segment, or 0. */
static inline void planes_store(Frame *frame, size_t pixel, double depth, Vec3 normal, uint32_t id)
{
    if (frame->depth.values)
        frame->depth.values[pixel] = (float)depth;
    if (frame->normal.values) {
        frame->normal.values[3 * pixel] = (float)normal.x;
        frame->normal.values[3 * pixel + 1] = (float)normal.y;
        frame->normal.values[3 * pixel + 2] = (float)normal.z;
    }
    if (frame->id.ids)
        frame->id.ids[pixel] = id;
}

static inline void planes_store_nothing(Frame *frame, size_t pixel)
{
    planes_store(frame, pixel, HUGE_VAL, vec3(0, 0, 0), 0);
}

static inline void planes_store_color(Frame *frame, size_t pixel, Rgb color)
{
    frame->color.values[3 * pixel] = color.r;
    frame->color.values[3 * pixel + 1] = color.g;
    frame->color.values[3 * pixel + 2] = color.b;
}

#endif
