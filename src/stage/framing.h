/* The camera of a picture, and what it has to frame. */
#ifndef CORCAST_STAGE_FRAMING_H
#define CORCAST_STAGE_FRAMING_H

#include "stage/stage.h"

typedef struct Ball {
    Vec3 center;
    double radius;
} Ball;

/* The two end balls of every segment drawn, in *balls (owned). The implicit surface reaches beyond
 * its segments by 0.551 r at free ends and by less than r where vessels meet, so that its balls
 * have twice the radius. STATUS_MEMORY. */
MUST_CHECK Status framing_balls(const Geometry *geometry, Ball **balls, size_t *n, Err *err);

/* The camera that `params` asks for. Where they leave open where it stands or how much it shows, it
 * shows all of the balls, which `bounds` holds, with the margin. STATUS_USAGE when the vectors
 * given make no camera. O(n). */
MUST_CHECK Status framing_camera(const Ball *balls, size_t n, Box bounds, const ViewParams *params,
                                 Camera *camera, Err *err);

#endif
