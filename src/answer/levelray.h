/* The first point of a single ray at which a sum of terms reaches a level, with a proven error.
 *
 * A ray is a path z -> origin + z unit, z in mm. Each term is a smooth function of z with a known
 * second derivative bound, such as the potential of one vessel segment along the ray. The sum is
 * below the level before the ray starts to count. The search proves for each interval of z that
 * the sum stays below the level, or that the sum rises through the level exactly once. It never
 * samples and guesses: if neither proof succeeds, the result is LEVEL_UNDECIDED.
 * docs/ANSWERS.md, section 5, has the method.
 *
 *     LevelCrossing at = levelray_first(&ray, start, far, false);
 *     if (at.state == LEVEL_FOUND)
 *         ... the point is at z in [at.z - at.error, at.z + at.error] ... */
#ifndef CORCAST_ANSWER_LEVELRAY_H
#define CORCAST_ANSWER_LEVELRAY_H

#include "answer/affine.h"
#include <stddef.h>
#include <stdint.h>

/* A sum of terms at a point of a ray, or one term there. */
typedef struct LevelSample {
    double value, slope;             /* slope: derivative by z, 1/mm */
    double value_error, slope_error; /* bounds of the errors of value and slope */
} LevelSample;

/* The squared distance of the ray from a line or a point, as a polynomial of zeta = z - middle:
 * square[0] + 2 square[1] zeta + square[2] zeta^2. */
typedef struct LevelSquare {
    double middle;  /* a point of the ray near the segment, mm; exact */
    Form square[3]; /* constant forms; the unit of length is that of the term */
} LevelSquare;

/* One term along a ray. */
typedef struct LevelTerm LevelTerm;
struct LevelTerm {
    /* Returns the term and its slope at z. */
    LevelSample (*sample)(const LevelTerm *term, double z);
    uint32_t face;   /* index of the segment's face in AnswerPlan.faces */
    double from, to; /* outside this interval of z, the term is 0, or is left out of sums */
    /* The ray can reach the level only where it is in the window of at least one term.
     * window_from > window_to: the term has no window. */
    double window_from, window_to;
    double convex, concave; /* in [from, to], the second derivative is in [-concave, convex] */
    double peak;            /* upper bound of the term on the ray */
    double ends;            /* potential: upper bound of the factor (erf(u) + erf(v)) / 2 */
    LevelSquare distance;
    Form along[2]; /* potential: distance beyond the first end is along[0] + along[1] zeta */
    Form before;   /* potential: distance before the last end at zeta = 0 */
    /* Vector from the axis line or point to the ray at zeta = 0, and its derivative by z. */
    Form3 across, across_rate;
};

/* A ray with the terms near it. */
typedef struct LevelRay {
    const LevelTerm *const *terms; /* borrowed */
    size_t n;
    double level;
    /* Upper bounds of the sum of all terms that are left out, and of the magnitude of the gradient
     * of this sum, 1/mm. */
    double dropped, dropped_slope;
} LevelRay;

typedef enum LevelState {
    LEVEL_MISSED,   /* the sum stays below the level */
    LEVEL_FOUND,    /* the sum reaches the level */
    LEVEL_UNDECIDED /* neither is proven */
} LevelState;

typedef struct LevelCrossing {
    LevelState state;
    double z, error; /* LEVEL_FOUND: the crossing is in [z - error, z + error] */
} LevelCrossing;

/* Finds the first crossing with z in [start, far]. `far` may be infinite. A crossing that may be
 * before `far` or behind it, because of its error, is also returned.
 *
 * starts_below  false: the sum is known to be at most the level at `start`, but may be equal to
 *               it, because `start` is on the surface. true: the sum is known to be below it. */
LevelCrossing levelray_first(const LevelRay *ray, double start, double far, bool starts_below);

#endif
