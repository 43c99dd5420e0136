/* The flat faces of a block or a plate, which vessels leave through. */
#ifndef CORCAST_PRINT_FACE_H
#define CORCAST_PRINT_FACE_H

#include "print/solid.h"

/* Points of a solid, one after the other round a closed way. */
typedef struct FaceLoop {
    const uint32_t *points;
    uint32_t n;
} FaceLoop;

/* Fills a face across an axis with triangles: outside lies towards the high end of the axis, or, if
 * `is_low`, towards its low end. The first loop is the face's edge, counterclockwise seen from
 * outside, the others are holes in it, clockwise; all points have the same coordinate along the
 * axis, and loops do not touch. STATUS_INFEASIBLE where they do. O(n^2) of n points. */
MUST_CHECK Status face_fill(Solid *solid, int axis, bool is_low, const FaceLoop *loops,
                            size_t n_loops, uint32_t label, Err *err);

#endif
