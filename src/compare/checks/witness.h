/* Three programs have drawn one scene: which pairs agree about the segment and the depth at each
 * pixel, and which program stands alone. */
#ifndef CORCAST_COMPARE_CHECKS_WITNESS_H
#define CORCAST_COMPARE_CHECKS_WITNESS_H

#include "compare/result.h"

/* What one program has drawn. All members are borrowed. */
typedef struct Testimony {
    const char *name; /* "POV-Ray" */
    const IdPlane *ids;
    const Plane *depth;
} Testimony;

/* The pairs of the three: the two sides A and B, and each side with the witness. */
typedef enum WitnessPair { PAIR_SIDES, PAIR_A, PAIR_B, WITNESS_PAIRS } WitnessPair;

typedef struct Witness {
    const char *name; /* borrowed */
    char version[16];
    double seconds; /* that both planes took */
    struct {
        char title[64]; /* "POV-Ray and Tachyon" */
        bool agrees;
        CompareResult *ids, *depth; /* owned */
    } pairs[WITNESS_PAIRS];
    bool agrees;        /* all three agree */
    char sentence[160]; /* who agrees with whom, and who stands alone */
} Witness;

/* Compares A, B and the witness, in this order.
 *
 * depth_step_mm   step of the depths.
 * witness         keeps its version and seconds; release it with witness_release.
 * Errors          STATUS_INPUT if sizes differ; STATUS_MEMORY. */
MUST_CHECK Status witness_compare(const Testimony three[3], double depth_step_mm, Witness *witness,
                                  Err *err);
void witness_release(Witness *witness);

#endif
