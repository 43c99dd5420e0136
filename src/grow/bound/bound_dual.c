/* Makes a proven lower bound of the target from a step of Newton's method (a solution of the dual
 * problem).
 *
 * Let each outlet have a pull y (a vector) and a charge z (a number), and let Y and Z be their sums
 * at and below a segment. They prove the bound B = sum over the segments of Y . v - Z d, for any
 * positions of the bifurcations; v is the vector from end to end of the segment, and d its pressure
 * drop. The condition is that no |Y| is above the cost of a mm of the segment, cost_of_mm
 * [docs/METHODS.md 1.5].
 *
 * At the optimum, |Y| equals that cost, except that smoothed lengths make |Y| smaller. The
 * linearised forces of Newton's step balance exactly, so little is missing for a proof. From the
 * outlets upwards, where |Y| is too large, all pulls below are reduced by one factor. Only the few
 * segments that have not converged yet lose by that; one factor for the whole tree would make the
 * bound much lower.
 *
 * Charges may then be multiplied by any s, and pulls by s^(a / (1 + a)), the factor by which the
 * cost of a mm changes; the best s has a formula. A share of `margin` covers rounding. */
#include "grow/bound/bound_dual.h"

#include <stdlib.h>
#include <string.h>

/* Share of the bound that is given up to cover rounding: sums over up to millions of segments, each
 * rounded to 1e-16. It is far below the gap of the bound itself, 2e-4 [bound.c]. */
static const double margin = 1e-9;

Status dual_init(Dual *dual, const Problem *problem, Err *err)
{
    TRY(mem_calloc(&dual->force, problem->outlets, sizeof *dual->force, "forces", err));
    TRY(mem_calloc(&dual->sum, problem->n, sizeof *dual->sum, "sums of forces", err));
    return mem_calloc(&dual->kept, problem->n, sizeof *dual->kept, "shares of forces", err);
}

void dual_release(Dual *dual)
{
    free(dual->force);
    free(dual->sum);
    free(dual->kept);
    *dual = (Dual){0};
}

/* Returns the least cost of 1 mm of a segment that carries `flow` and pays `charge` per unit of
 * pressure drop: the minimum over g of charge g + flow^a g^-a. */
static double cost_of_mm(double a, double flow, double charge)
{
    return (1 + a) * elementary_pow(flow * charge / a, a / (1 + a));
}

static double length_of(const State force)
{
    return sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

/* Sums the forces of all outlets, and reduces the pulls below a segment for which they are too
 * large. An outlet whose charge would be below 0 gets the charge 0. Returns the factor, at least 1,
 * by which all pulls may be multiplied. */
static double sum_forces(Dual *dual, const Problem *problem, const Newton *newton, double smoothing)
{
    double room = INFINITY;
    memset(dual->sum, 0, problem->n * sizeof *dual->sum);
    for (size_t i = problem->n; i-- > 0;) {
        const Joint *joint = &problem->joint[i];
        double *sum = dual->sum[i];
        dual->kept[i] = 1;
        if (joint_is_inlet(joint))
            continue;
        if (!joint->is_free) {
            newton_force(problem, newton, smoothing, i, sum);
            sum[DROP] = fmax(0, -sum[DROP]);
        }
        double borne =
            cost_of_mm(problem->a, joint->flow, sum[DROP]) * (1 - margin) / length_of(sum);
        dual->kept[i] = fmin(1, borne);
        room = fmin(room, borne);
        for (int k = 0; k < SPACE_AXES; k++)
            dual->sum[joint->parent][k] += sum[k] * dual->kept[i];
        dual->sum[joint->parent][DROP] += sum[DROP];
    }
    return fmax(1, room);
}

/* The two sums of the bound, over all segments: of Y . v and of Z d. */
typedef struct Sums {
    double pull, charge;
} Sums;

/* Computes the two sums. Sets `kept` of each joint to the factor of its pulls: `grown` times the
 * factors of all segments from the inlet to the joint. */
static Sums sum_bound(Dual *dual, const Problem *problem, double grown)
{
    Sums sums = {0};
    for (size_t i = 0; i < problem->n; i++) {
        if (joint_is_inlet(&problem->joint[i])) {
            dual->kept[i] = grown;
            continue;
        }
        const double *sum = dual->sum[i];
        const JointDifference reach = problem_reach(problem, i, 0);
        dual->kept[i] *= dual->kept[problem->joint[i].parent];
        for (int k = 0; k < SPACE_AXES; k++)
            sums.pull += sum[k] * dual->kept[i] * reach.by[k];
        sums.charge += sum[DROP] * reach.by[DROP];
    }
    return sums;
}

/* Stores the forces of the proof, with charges multiplied by `scale`. */
static void keep(Dual *dual, const Problem *problem, double scale)
{
    const double pull_scale = elementary_pow(scale, problem->a / (1 + problem->a));
    for (size_t i = 0; i < problem->n; i++) {
        const Joint *joint = &problem->joint[i];
        if (joint->outlet < 0)
            continue;
        double *force = dual->force[joint->outlet];
        for (int k = 0; k < SPACE_AXES; k++)
            force[k] = dual->sum[i][k] * dual->kept[i] * pull_scale;
        force[DROP] = dual->sum[i][DROP] * scale;
    }
}

void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing)
{
    const double grown = sum_forces(dual, problem, newton, smoothing);
    const Sums sums = sum_bound(dual, problem, grown);
    const double power = problem->a / (1 + problem->a);
    if (!(sums.pull > 0) || !(sums.charge > 0))
        return;
    const double scale = elementary_pow(power * sums.pull / sums.charge, 1 + problem->a);
    const double bound =
        (elementary_pow(scale, power) * sums.pull - scale * sums.charge) * (1 - margin);
    if (!(bound > dual->bound) || !isfinite(bound))
        return;
    dual->bound = bound;
    keep(dual, problem, scale);
}
