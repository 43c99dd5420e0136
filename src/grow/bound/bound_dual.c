/* Forces y and charges z of the outlets, summed to Y and Z of every segment, prove the bound B =
 * sum over the segments of Y . v - Z d, v from end to end of the segment, wherever its ends are, as
 * long as no |Y| is above what a mm costs, dual_mm [METHODS 1.5]. At the optimum |Y| is that cost,
 * but for smoothed lengths, which only make it less. So those of Newton's linearised forces, which
 * balance exactly, need but one factor for all of them to become a proof: y / m with m the greatest
 * |Y| over cost. Charges may then be multiplied by any s, and y by s^(a / (1 + a)), which the cost
 * of a mm follows, and the best s is known. A share of `margin` covers rounding. */
#include "grow/bound/bound_dual.h"

#include <stdlib.h>
#include <string.h>

static const double margin = 1e-9;

Status dual_init(Dual *dual, const Problem *problem, Err *err)
{
    TRY(mem_calloc(&dual->force, problem->outlets, sizeof *dual->force, "forces", err));
    return mem_calloc(&dual->sum, problem->n, sizeof *dual->sum, "sums of forces", err);
}

void dual_release(Dual *dual)
{
    free(dual->force);
    free(dual->sum);
    *dual = (Dual){0};
}

double dual_mm(double a, double flow, double charge)
{
    return (1 + a) * pow(flow * charge / a, a / (1 + a));
}

/* The forces of all outlets, summed. False when one of them would rather have less drop. */
static bool sum_forces(Dual *dual, const Problem *problem, const Newton *newton, double smoothing)
{
    memset(dual->sum, 0, problem->n * sizeof *dual->sum);
    for (size_t i = problem->n; i-- > 0;) {
        const Joint *joint = &problem->joint[i];
        if (joint_is_inlet(joint))
            continue;
        double *sum = dual->sum[i];
        if (!joint->is_free) {
            newton_force(problem, newton, smoothing, i, sum);
            sum[DROP] = -sum[DROP];
            if (!(sum[DROP] > 0))
                return false;
        }
        for (int k = 0; k < STATE; k++)
            dual->sum[joint->parent][k] += sum[k];
    }
    return true;
}

/* What the proof is made of. */
typedef struct Sums {
    double pull, charge; /* the sums of Y . v and of Z d */
    double excess;       /* m */
} Sums;

static Sums add_up(const Dual *dual, const Problem *problem)
{
    Sums sums = {0};
    for (size_t i = 0; i < problem->n; i++) {
        if (joint_is_inlet(&problem->joint[i]))
            continue;
        const double *sum = dual->sum[i];
        const Reach reach = problem_reach(problem, i, 0);
        double pull2 = 0;
        for (int k = 0; k < PLACE_AXES; k++) {
            sums.pull += sum[k] * reach.by[k];
            pull2 += sum[k] * sum[k];
        }
        sums.charge += sum[DROP] * reach.by[DROP];
        double cost = dual_mm(problem->a, problem->joint[i].flow, sum[DROP]);
        sums.excess = fmax(sums.excess, sqrt(pull2) / cost);
    }
    return sums;
}

void dual_take(Dual *dual, const Problem *problem, const Newton *newton, double smoothing)
{
    if (!sum_forces(dual, problem, newton, smoothing))
        return;
    const Sums sums = add_up(dual, problem);
    const double power = problem->a / (1 + problem->a);
    const double pull = sums.pull * (1 - margin) / sums.excess;
    if (!(pull > 0) || !(sums.charge > 0))
        return;
    const double scale = pow(power * pull / sums.charge, 1 + problem->a);
    const double bound = (pow(scale, power) * pull - scale * sums.charge) * (1 - margin);
    if (!(bound > dual->bound) || !isfinite(bound))
        return;
    dual->bound = bound;
    for (size_t i = 0; i < problem->n; i++) {
        const Joint *joint = &problem->joint[i];
        if (joint->outlet < 0)
            continue;
        double *force = dual->force[joint->outlet];
        for (int k = 0; k < PLACE_AXES; k++)
            force[k] = dual->sum[i][k] * pow(scale, power) * (1 - margin) / sums.excess;
        force[DROP] = dual->sum[i][DROP] * scale;
    }
}
