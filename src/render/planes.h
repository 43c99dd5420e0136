/* Stores pixels in the planes of a frame: hits (depth, normal, id) and linear colors. Pixels are
 * given by their index in the planes, row by row. Nothing is allocated, and nothing can fail. */
#ifndef CORCAST_RENDER_PLANES_H
#define CORCAST_RENDER_PLANES_H

#include "geom/geom.h"
#include "render/job.h"
#include <math.h>
#include <string.h>

/* Stores the hit of a pixel in those of the depth, normal and id planes that the frame has.
 *
 * pixel    index of the pixel.
 * depth    distance along the ray, mm.
 * normal   unit, facing the viewer.
 * id       SWC id of the segment. */
static inline void planes_store(const Frame *frame, size_t pixel, double depth, Vec3 normal,
                                uint32_t id)
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

/* Stores a miss for n pixels from index `first` on: infinite depth, normal (0, 0, 0), id 0. */
static inline void planes_store_nothing(const Frame *frame, size_t first, size_t n)
{
    for (size_t i = 0; i < n && frame->depth.values; i++)
        frame->depth.values[first + i] = HUGE_VALF;
    if (frame->normal.values)
        memset(frame->normal.values + 3 * first, 0, 3 * n * sizeof *frame->normal.values);
    if (frame->id.ids)
        memset(frame->id.ids + first, 0, n * sizeof *frame->id.ids);
}

/* Stores the linear color of a pixel. The frame must have a float color plane. */
static inline void planes_store_color(const Frame *frame, size_t pixel, Rgb color)
{
    frame->color.values[3 * pixel] = color.r;
    frame->color.values[3 * pixel + 1] = color.g;
    frame->color.values[3 * pixel + 2] = color.b;
}

#endif
