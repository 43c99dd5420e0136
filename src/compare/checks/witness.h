/* Three programs have drawn one scene: which pairs of them agree about the segment and the depth at
 * each pixel, and who stands alone. */
#ifndef CORCAST_COMPARE_CHECKS_WITNESS_H
#define CORCAST_COMPARE_CHECKS_WITNESS_H

#include "compare/result.h"

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
        CompareResult *ids, *depth; /* owned */
    } pairs[WITNESS_PAIRS];
    bool agrees;        /* all three do */
    char sentence[160]; /* who agrees with whom, and who stands alone */
} Witness;

/* Compares all three, by the tolerance of witnesses, of a depth that has steps of depth_step_mm:
 * *witness (owned), whose version and seconds are kept. STATUS_INPUT when sizes differ. */
MUST_CHECK Status witness_compare(const Testimony three[3], double depth_step_mm, Witness *witness,
                                  Err *err);
void witness_release(Witness *witness);

#endif
