/* A pair is two scenes whose pictures must satisfy a metamorphic relation [relations.h]. Confirms a
 * pair that breaks its relation, and reduces it to a small pair that breaks the relation in the
 * same way. */
#ifndef CORCAST_METAMORPH_SHRINK_H
#define CORCAST_METAMORPH_SHRINK_H

#include "metamorph/judging.h"

/* Draws the pair from three cameras, which are shifted by different fractions of a pixel.
 *
 * kind       the kind of failure to confirm.
 * confirmed  receives true if at least two of the three verdicts are of this kind.
 * Errors     those of pairs_judge [judging.h]. */
MUST_CHECK Status pair_confirm(const TrialRenderer *renderer, const TrialPair *pair,
                               VerdictKind kind, bool *confirmed, Err *err);

/* Replaces a confirmed pair by a smaller pair that fails with the same kind of verdict from two
 * cameras, and repeats this until no smaller pair does. A smaller pair has fewer shapes, lights or
 * pixels, no shadows, no perspective, or rounder numbers.
 *
 * pair     the confirmed pair; receives the smallest pair.
 * verdict  the verdict of *pair; receives the verdict of the smallest pair.
 * Errors   those of pairs_judge. */
MUST_CHECK Status pair_shrink(const TrialRenderer *renderer, TrialPair *pair, PairVerdict *verdict,
                              Err *err);

#endif
