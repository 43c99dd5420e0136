/* Tachyon, a renderer that shares no code with corcast or POV-Ray: how it is run, and the planes
 * that it draws. It reads coordinates in single precision, computes in double precision, and gives
 * depth in 65535 steps. */
#ifndef CORCAST_ORACLE_TACHYON_H
#define CORCAST_ORACLE_TACHYON_H

#include "base/base.h"
#include "image/image.h"

/* What it is asked to draw of a scene written for it [EmitParams.planes]. */
typedef enum WitnessPlane { WITNESS_DEPTH, WITNESS_ID } WitnessPlane;

typedef struct WitnessParams {
    const char *program; /* NULL: tachyon */
    const char *scene;   /* a file under any name */
    const char *output;  /* .ppm file, likewise */
    int width, height;   /* pixels */
    int threads;         /* 0: Tachyon's own choice */
    double patience_s;   /* Tachyon is ended after this many seconds without output; 0: never */
    WitnessPlane plane;
} WitnessParams;

/* Has it draw a plane; `seconds` is the wall clock, `version` what it says of itself ("0.99").
 * STATUS_TOOL with its own words when it is missing or fails, or when it falls silent. */
MUST_CHECK Status witness_run(const WitnessParams *params, double *seconds, char version[16],
                              Err *err);

/* Reads what witness_run wrote: ids, and depth in mm along the ray between `near_mm` and `far_mm`
 * as the scene has them, INFINITY where the ids (of the same scene) say that nothing is seen. */
MUST_CHECK Status witness_read_ids(IdPlane *ids, const char *path, Err *err);
MUST_CHECK Status witness_read_depth(Plane *depth, const char *path, const IdPlane *ids,
                                     double near_mm, double far_mm, Err *err);

#endif
