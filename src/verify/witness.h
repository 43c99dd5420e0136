/* A third program, Tachyon, as witness of a scene that two have drawn: which pixels show which
 * segment, and how far away. It shares no code with either, reads coordinates in single precision
 * and computes in double, and gives depth in 65535 steps. Part of the room's door. */
#ifndef CORCAST_VERIFY_WITNESS_H
#define CORCAST_VERIFY_WITNESS_H

#include "base/base.h"
#include "image/image.h"
#include <jansson.h>

struct CompareResult;

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

/* What one of the three has drawn. All is borrowed. */
typedef struct Testimony {
    const char *name; /* "POV-Ray" */
    const IdPlane *ids;
    const Plane *depth;
} Testimony;

/* The pairs of the three: the two sides, and each side and the witness. */
typedef enum WitnessPair { PAIR_SIDES, PAIR_A, PAIR_B, WITNESS_PAIRS } WitnessPair;

typedef struct Witness {
    const char *name; /* borrowed */
    char version[16];
    double seconds; /* of both planes */
    struct {
        char title[64]; /* "POV-Ray and Tachyon" */
        bool agrees;
        struct CompareResult *ids, *depth; /* owned */
    } pairs[WITNESS_PAIRS];
    bool agrees;        /* all three do */
    char sentence[160]; /* who agrees with whom, and who stands alone */
} Witness;

/* Compares all three, by the tolerance of witnesses, of a depth that has steps of depth_step_mm:
 * *witness (owned), whose version and seconds are kept. STATUS_INPUT when sizes differ. */
MUST_CHECK Status witness_compare(const Testimony three[3], double depth_step_mm, Witness *witness,
                                  Err *err);
void witness_release(Witness *witness);

/* New reference, NULL when memory runs out. */
json_t *witness_json(const Witness *witness);

#endif
