/* Finds the first point of a single ray at which a sum of terms reaches a level, with a proven
 * error. levelterm.h computes the terms of a ray; levelray_first then searches the ray.
 *
 * A ray is a path z -> origin + z unit, z in mm. Each term is a function of z whose second
 * derivative has known bounds, such as the potential of one vessel segment along the ray. The
 * search begins where the sum is at most the level. It proves for each interval of z that the sum
 * stays below the level, or that the sum rises through the level exactly once. If neither proof
 * succeeds, the result is LEVEL_UNDECIDED. docs/ANSWERS.md, section 4.1, describes the method. A
 * Form is a number with a proven error bound [affine.h]; all forms here are constants, because a
 * single ray has no rectangle over which they could vary.
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
    double value, slope;             /* slope: derivative with respect to z, 1/mm */
    double value_error, slope_error; /* bounds of the errors of value and slope */
} LevelSample;

/* The squared distance of the ray from the axis line of a term, in the term's unit of length, as a
 * polynomial of zeta = z - middle: square[0] + 2 square[1] zeta + square[2] zeta^2. */
typedef struct LevelSquare {
    double middle; /* a point of the ray near the axis, mm; exact */
    Form square[3];
} LevelSquare;

typedef struct LevelTerm LevelTerm;

/* A kind of term. */
typedef struct LevelKind {
    /* Returns the term and its slope at z, which must be in [from, to]. */
    LevelSample (*sample)(const LevelTerm *term, double z);
    /* Returns the gradient of the term, 1/mm, at zeta = z - distance.middle. */
    Form3 (*gradient)(const LevelTerm *term, Form zeta);
    /* Sets window_from and window_to. Outside this window the term is below its peak / `ratio`;
     * `ratio` is at least 1. */
    void (*find_window)(LevelTerm *term, double ratio);
} LevelKind;

/* One term along a ray. Its unit of length is radius / sqrt 2 of the segment for the potential, and
 * the component's radius of influence for a blob. */
struct LevelTerm {
    const LevelKind *kind;
    uint32_t face;   /* index of the segment's face in AnswerPlan.faces */
    double from, to; /* outside this interval of z, the term is 0, or is left out of sums */
    /* The ray can reach the level only where it is in the window of at least one term.
     * window_from > window_to: the term has no window. */
    double window_from, window_to;
    double convex, concave; /* in [from, to], the second derivative is in [-concave, convex],
                             * 1/mm^2 */
    double peak;            /* upper bound of the term on the ray */
    double ends;            /* potential: upper bound of the factor (erf(u) + erf(v)) / 2, where u
                             * and v are the distances from the ends, below; blob: strength of the
                             * component */
    LevelSquare distance;
    double least; /* lower bound of the squared distance from the axis line for z in [from, to], in
                   * squared units of length */
    Form unit;    /* 1 / the unit of length, 1/mm */
    Form3 axis;   /* unit vector along the axis, 0 if the axis is a point */
    /* Distances along the axis, in the unit of length, positive towards the segment: u = along[0] +
     * along[1] zeta from the first end, v = before - along[1] zeta from the second end. */
    Form along[2], before;
    /* Vector from the axis line to the ray at zeta = 0, mm, and its derivative with respect to z.
     */
    Form3 across, across_rate;
};

/* A ray with the terms near it. */
typedef struct LevelRay {
    const LevelTerm *const *terms; /* borrowed */
    size_t n;
    double level;
    /* The terms of the field that are not in `terms` have a sum in [0, dropped]. The gradient of
     * this sum is at most dropped_slope, 1/mm. */
    double dropped, dropped_slope;
} LevelRay;

typedef enum LevelState {
    LEVEL_MISSED,   /* the sum stays below the level in [start, far] */
    LEVEL_FOUND,    /* the sum reaches the level */
    LEVEL_UNDECIDED /* neither is proven */
} LevelState;

typedef struct LevelCrossing {
    LevelState state;
    double z, error; /* LEVEL_FOUND: the crossing is in [z - error, z + error] */
} LevelCrossing;

/* Finds the first crossing with z in [start, far]; `far` may be infinite. A crossing whose error
 * interval contains `far` is also returned. Allows for `dropped`, which must be below the level.
 * Without terms the result is LEVEL_MISSED. If the sum may exceed the level at `start`, the result
 * is LEVEL_UNDECIDED.
 *
 * starts_below  false: the sum is known to be at most the level at `start`, but may be equal to
 *               it, because `start` is on the surface. true: the sum is known to be below it. */
LevelCrossing levelray_first(const LevelRay *ray, double start, double far, bool starts_below);

/* Returns true if the sum of `terms` alone is proven to exceed the level by more than `excess` at
 * z. */
bool levelray_is_above(const LevelRay *ray, double z, double excess);

#endif
