/* Makes a pair that breaks a relation as small as possible. */
#ifndef CORCAST_METAMORPH_SHRINK_H
#define CORCAST_METAMORPH_SHRINK_H

#include "metamorph/judging.h"

/* Draws the pair with the camera moved by three odd fractions of a pixel.
 *
 * confirmed  receives true if the relation is broken, in the same kind, in two of the three.
 * Errors     those of pairs_judge. */
MUST_CHECK Status pair_confirm(const TrialRenderer *renderer, const TrialPair *pair,
                               VerdictKind kind, bool *confirmed, Err *err);

/* Replaces a confirmed pair by smaller ones while they fail in the same kind: leaves out shapes,
 * lights, shadows, perspective, the picture's edges, and digits of numbers.
 *
 * verdict  that of the pair; replaced by the verdict of the smallest pair.
 * Errors   those of pairs_judge. */
MUST_CHECK Status pair_shrink(const TrialRenderer *renderer, TrialPair *pair, PairVerdict *verdict,
                              Err *err);

#endif
