/* Searches a ray for the first crossing of a level, as in docs/ANSWERS.md, section 4.1. The second
 * derivative of the sum S of the terms is in [-concave, convex] up to the start of the next term.
 * The bound is also valid after the end of a term, because it includes 0.
 *
 * - Step. S(t + x) <= S + S' x + convex x^2 / 2. Up to the first x at which this bound reaches the
 *   level, there is no crossing. Such steps converge quadratically towards the surface.
 * - Existence. S(t + x) >= S + S' x - concave x^2 / 2, and S'(t + x) >= S' - concave x. If this
 *   parabola reaches the level at a point x1 before its vertex, S rises on all of [t, t + x1], and
 *   through the level exactly once.
 * - Position. Newton's method gives a point z with the residue g = |S - level|. Let d = 2 g /
 * S'(z). If S' exceeds S'(z) / 2 everywhere in [z - d, z + d], the crossing is in this interval.
 *
 * All bounds use value and slope with their errors on the unfavorable side. */
#include "answer/levelray.h"

#include <math.h>

enum { MAX_STEPS = 2000 }; /* per ray; rays need about 10. Ends the search of a tangent ray */

/* A relative margin that covers the few roundings of one formula. */
static const double margin = 1e-12;

/* The sum of the terms at a point of the ray. */
typedef struct LevelSum {
    double lack_low, lack_high; /* bounds of level - sum, including the terms that are left out */
    double slope_low, slope_high;
    double lack, slope;     /* without bounds, for Newton's method */
    double convex, concave; /* the second derivative is in [-concave, convex] until `next` */
    double since, next;     /* no term starts or ends between `since` and z, and none starts between
                             * z and `next`, mm; may be infinite */
} LevelSum;

/* Returns the sum of the ray's terms at z, with bounds. */
static LevelSum sum_at(const LevelRay *ray, double z)
{
    LevelSample total = {0};
    double magnitude = 0, steepness = 0;
    LevelSum sum = {.since = -(double)INFINITY, .next = (double)INFINITY};
    for (size_t i = 0; i < ray->n; i++) {
        const LevelTerm *term = ray->terms[i];
        if (term->from > z) {
            sum.next = fmin(sum.next, term->from);
            continue;
        }
        sum.since = fmax(sum.since, term->to < z ? term->to : term->from);
        if (term->to < z)
            continue;
        const LevelSample sample = term->kind->sample(term, z);
        total.value += sample.value;
        total.slope += sample.slope;
        total.value_error += sample.value_error;
        total.slope_error += sample.slope_error;
        magnitude += fabs(sample.value);
        steepness += fabs(sample.slope);
        sum.convex += term->convex;
        sum.concave += term->concave;
    }
    const double rounding = ((double)ray->n + 8) * FORM_U;
    const double error = (total.value_error + rounding * (magnitude + ray->level)) * (1 + margin);
    const double slope_error =
        (total.slope_error + rounding * steepness + ray->dropped_slope) * (1 + margin);
    sum.lack = ray->level - total.value;
    sum.lack_low = sum.lack - error - ray->dropped;
    sum.lack_high = sum.lack + error;
    sum.slope = total.slope;
    sum.slope_low = total.slope - slope_error;
    sum.slope_high = total.slope + slope_error;
    sum.convex *= 1 + margin;
    sum.concave *= 1 + margin;
    return sum;
}

/* Returns the first z from t on within a window; infinite if there is none. */
static double next_window(const LevelRay *ray, double t)
{
    double next = (double)INFINITY;
    for (size_t i = 0; i < ray->n; i++) {
        const LevelTerm *term = ray->terms[i];
        if (term->window_to >= t && term->window_from <= term->window_to)
            next = fmin(next, fmax(term->window_from, t));
    }
    return next;
}

/* Returns a point t + x such that the sum rises on all of [t, t + x] and is above the level at its
 * end; NaN if this is not proven. */
static double proven_above(const LevelSum *at, double t)
{
    const double s = at->slope_low, lack = fmax(at->lack_high, 0);
    const double discriminant = s * s - 2 * at->concave * lack * (1 + margin);
    if (!(s > 0 && discriminant >= 0))
        return (double)NAN;
    const double x = 2 * lack / (s + sqrt(discriminant)) * (1 + 1e-9) + 1e-15 * fabs(t);
    return x * at->concave < s && t + x < at->next ? t + x : (double)NAN;
}

/* Bounds the position of the only crossing in [low, high]. The sum rises in this interval. `at` is
 * the sum at `low`. */
static LevelCrossing bound_crossing(const LevelRay *ray, double low, double high, LevelSum at)
{
    const double begin = low, end = high;
    double z = low;
    for (int i = 0; i < 60; i++) {
        const double newton = z + at.lack / at.slope;
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        const double moved = fabs(next - z);
        z = next;
        at = sum_at(ray, z);
        if (moved <= 4 * FORM_U * fabs(z) || fabs(at.lack) <= 4 * FORM_U * ray->level)
            break;
        if (at.lack > 0)
            low = z;
        else
            high = z;
    }
    const double residue = fmax(fabs(at.lack_low), fabs(at.lack_high));
    const double error = (2 * residue / at.slope_low + 4 * FORM_U * fabs(z)) * (1 + margin);
    const double curvature = fmax(at.convex, at.concave);
    if (at.slope_low > 0 && error * curvature <= 0.5 * at.slope_low && z - error > at.since &&
        z + error < at.next)
        return (LevelCrossing){LEVEL_FOUND, z, error};
    const double half = 0.5 * (end - begin);
    return (LevelCrossing){LEVEL_FOUND, begin + half, half * (1 + margin) + 4 * FORM_U * fabs(end)};
}

/* Returns the length of a step from t in which the sum surely stays below the level. */
static double safe_step(const LevelSum *at, double t)
{
    const double lack = fmax(at->lack_low, 0), s = at->slope_high;
    const double root = sqrt(s * s + 2 * at->convex * lack);
    const double step = s > 0            ? 2 * lack / (s + root)
                        : at->convex > 0 ? (root - s) / at->convex
                                         : (double)INFINITY;
    return step * (1 - 1e-9) - 4 * FORM_U * fabs(t);
}

LevelCrossing levelray_first(const LevelRay *ray, double start, double far, bool starts_below)
{
    static const LevelCrossing missed = {.state = LEVEL_MISSED};
    static const LevelCrossing undecided = {.state = LEVEL_UNDECIDED};
    double t = start;
    for (int i = 0; i < MAX_STEPS; i++) {
        if (starts_below || i > 0)
            t = next_window(ray, t);
        if (!(t <= far) || isinf(t))
            return missed;
        const LevelSum at = sum_at(ray, t);
        const double high = proven_above(&at, t);
        if (high > t && (starts_below || i > 0)) {
            const LevelCrossing crossing = bound_crossing(ray, t, high, at);
            return crossing.z - crossing.error > far ? missed : crossing;
        }
        double step = safe_step(&at, t);
        if (!(at.lack_high >= 0 && step > 16 * FORM_U * (1 + fabs(t))))
            return undecided;
        t = fmin(t + step, at.next);
    }
    return undecided;
}

bool levelray_is_above(const LevelRay *ray, double z, double excess)
{
    return sum_at(ray, z).lack_high < -excess;
}
