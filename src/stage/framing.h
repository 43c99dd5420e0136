/* The camera of a picture. */
#ifndef CORCAST_STAGE_FRAMING_H
#define CORCAST_STAGE_FRAMING_H

#include "stage/stage.h"

typedef struct Ball {
    Vec3 center;
    double radius;
} Ball;

/* The camera that params asks for, framing the balls where it leaves that open. `bounds` holds
 * them. STATUS_USAGE when the vectors given make no camera. */
MUST_CHECK Status framing_camera(const Ball *balls, size_t n, Box bounds, const StageParams *params,
                                 Camera *camera, Err *err);

#endif
