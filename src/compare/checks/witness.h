/* Compares the id and depth planes of one scene that three programs have drawn: A, B and a third,
 * independent renderer, the witness. If A and B disagree, the witness shows which of them is wrong.
 * Zero a Witness, set its version and seconds, call witness_compare, then witness_release. */
#ifndef CORCAST_COMPARE_CHECKS_WITNESS_H
#define CORCAST_COMPARE_CHECKS_WITNESS_H

#include "compare/result.h"

/* The planes that one program has drawn. All members are borrowed. */
typedef struct Testimony {
    const char *name; /* name of the program, such as "POV-Ray" */
    const IdPlane *ids;
    const Plane *depth; /* mm */
} Testimony;

/* The pairs of the three programs. PAIR_SIDES is A and B, PAIR_A is A and the witness, PAIR_B is B
 * and the witness. WITNESS_PAIRS is the number of pairs. */
typedef enum WitnessPair { PAIR_SIDES, PAIR_A, PAIR_B, WITNESS_PAIRS } WitnessPair;

/* The result. */
typedef struct Witness {
    const char *name; /* name of the witness; borrowed */
    char version[16]; /* version of the witness */
    double seconds;   /* time to draw both planes */
    struct {
        char title[64];             /* "POV-Ray and Tachyon"; cut off if longer */
        bool agrees;                /* ids and depths agree */
        CompareResult *ids, *depth; /* owned */
    } pairs[WITNESS_PAIRS];
    bool agrees;        /* all three agree */
    char sentence[160]; /* which programs agree, and which one differs from both others; cut off if
                         * longer */
} Witness;

/* Compares the three pairs. Single-precision renderers may differ at a few pixels: ids, and depths
 * beyond depth_step_mm, may differ at up to 20 pixels per million, or at 2 pixels of a small
 * picture.
 *
 * three          A, B and the witness, in this order; planes of one size.
 * depth_step_mm  depths that differ by at most this length are equal, mm. It is the step in which
 *                files store depths.
 * witness        must be zero before the call, except the members `version` and `seconds`, which
 *                the caller sets. Release it with witness_release. After an error there is nothing
 *                to release.
 * Errors         STATUS_INPUT if the sizes differ; STATUS_MEMORY. */
MUST_CHECK Status witness_compare(const Testimony three[3], double depth_step_mm, Witness *witness,
                                  Err *err);
void witness_release(Witness *witness);

#endif
