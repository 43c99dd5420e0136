/* Finds a proven lower bound of the target of all trees with the same topology [docs/METHODS.md
 * 1.5].
 *
 * The least target of a tree whose radii, bifurcations and pressures are free is the minimum of a
 * convex function. Newton's method [bound_newton.h] minimises it, and every step also gives a
 * solution of the dual problem, which is a bound [bound_dual.h]. Where bifurcations merge, lengths
 * of 0 make the function non-smooth. Lengths are therefore smoothed, strongly at first, and less as
 * soon as a step gains little. For 1,000 terminals, the gap between target and bound is 5.5 % with
 * a smoothing of 0.3 mean lengths, 0.6 % with 0.09, 0.09 % with 0.03, and 0.016 % with 0.008.
 *
 * The search ends when bound and target are within `wanted` of each other, when less smoothing
 * gains little, or when all steps are used. The bound is a valid proof wherever the search ends. */
#include "grow/bound/bound.h"

#include "grow/bound/bound_dual.h"
#include "grow/cco/law.h"
#include <stdlib.h>

/* Gap between the best target and the bound at which the search ends, as a share of the bound: 0.02
 * %, less than any refinement can gain. */
static const double wanted = 2e-4;
/* Ratio of a smoothing to the one before. A smaller ratio begins farther from the next minimum, and
 * Newton's method needs more steps there; a larger ratio needs more smoothings. */
static const double next_smoothing = 0.3;
/* The search ends at a smoothing that reduces the gap by less than this share. */
static const double least_progress = 0.05;
/* The slope of a step is the change of the target that its first derivatives promise, here as a
 * share of the target. Only below slope_to_prove is the bound of the step computed: before, it is
 * far from the best. Below slope_to_end, the same number as `wanted`, it is the last step at its
 * smoothing. */
static const double slope_to_prove = 0.1, slope_to_end = 2e-4;
/* Maximum number of steps in all and at one smoothing. They bound the time; the bound that is found
 * by then is a proof. */
enum { MAX_STEPS = 80, MAX_STEPS_A_SMOOTHING = 25 };
/* Outlets whose pressure drops differ by a smaller share count as having the same pressure. */
static const double same_drop = 1e-6;

/* The state of the search. `best` is the lowest target so far. */
typedef struct BoundSearch {
    Problem problem;
    Newton newton;
    Dual dual;
    double smoothing; /* mm */
    double best;
    int steps;
} BoundSearch;

/* Returns the relative gap between target and bound; INFINITY while no bound is proved. */
static double gap(const BoundSearch *search)
{
    return search->best / search->dual.bound - 1;
}

/* Minimises at the present smoothing. */
static void settle(BoundSearch *search)
{
    Problem *problem = &search->problem;
    Newton *newton = &search->newton;
    for (int step = 0; step < MAX_STEPS_A_SMOOTHING && search->steps < MAX_STEPS; step++) {
        double slope = newton_step(problem, newton, search->smoothing);
        if (-slope < slope_to_prove * search->best)
            dual_take(&search->dual, problem, newton, search->smoothing);
        search->steps++;
        if (!newton_move(problem, newton, search->smoothing, slope))
            return;
        search->best = fmin(search->best, newton_cost(problem, newton, 0, 0));
        if (gap(search) <= wanted || -slope < slope_to_end * search->best)
            return;
    }
}

/* Computes the target of the present geometry with the radii of Murray's law; NAN if outlets have
 * different pressures. Lengths are smoothed, because a terminal of length 0 would have no radius.
 */
static Status murray_target(const BoundSearch *search, const Law *law, double *target, Err *err)
{
    const Problem *problem = &search->problem;
    Subtree *below = NULL;
    TRY(mem_calloc(&below, problem->n, sizeof *below, "sums", err));
    double sum = 0, drop = NAN;
    for (size_t i = problem->n; i-- > 0;) {
        const Joint *joint = &problem->joint[i];
        if (joint_is_inlet(joint))
            continue;
        if (!joint->is_free && isnan(drop))
            drop = joint->at[DROP];
        if (!joint->is_free && fabs(joint->at[DROP] - drop) > same_drop * drop)
            sum = NAN;
        JointDifference reach = problem_reach(problem, i, search->smoothing);
        Subtree at = law_add_daughters(law, below[i].rho_gamma, below[i].cost);
        Reduced reduced = law_add_segment(law, joint->flow, sqrt(reach.length2), &at);
        below[joint->parent].rho_gamma += reduced.rho_gamma;
        below[joint->parent].cost += reduced.cost;
        if (joint_is_inlet(&problem->joint[joint->parent]))
            sum += reduced.cost;
    }
    free(below);
    *target = sum * elementary_pow(drop, -problem->a);
    return STATUS_OK;
}

/* Minimises at smaller and smaller smoothings. */
static Status run(BoundSearch *search, Err *err)
{
    Problem *problem = &search->problem;
    TRY(newton_init(&search->newton, problem->n, err));
    TRY(dual_init(&search->dual, problem, err));
    search->best = fmin(problem->target, newton_cost(problem, &search->newton, 0, 0));
    search->smoothing = FIRST_SMOOTHING * problem->mean_length;
    for (double before = INFINITY, now; search->steps < MAX_STEPS; before = now) {
        settle(search);
        now = gap(search);
        if (now <= wanted || now > before * (1 - least_progress))
            break;
        search->smoothing *= next_smoothing;
    }
    return STATUS_OK;
}

/* Writes what was found to *out, which is zeroed. */
static Status report(const BoundSearch *search, const Tree *tree, Bound *out, Err *err)
{
    const Problem *problem = &search->problem;
    out->target = problem->target;
    out->best = search->best;
    out->bound = search->dual.bound;
    out->steps = search->steps;
    out->murray = NAN;
    if (tree->meta.known[META_GAMMA]) {
        const Law law = {tree->meta.number[META_GAMMA], out->lambda};
        TRY(murray_target(search, &law, &out->murray, err));
    }
    TRY(mem_calloc(&out->outlet, problem->outlets, sizeof *out->outlet, "outlets", err));
    out->outlets = problem->outlets;
    for (size_t i = 0; i < problem->n; i++) {
        const Joint *joint = &problem->joint[i];
        if (joint->outlet < 0)
            continue;
        const double *force = search->dual.force[joint->outlet];
        out->outlet[joint->outlet] = (Outlet){.node = problem->node[joint->outlet],
                                              .flow = joint->flow,
                                              .pull = {force[0], force[1], force[2]},
                                              .charge = force[DROP]};
    }
    return STATUS_OK;
}

Status bound_tree(const Tree *tree, double lambda, Bound *out, Err *err)
{
    char range[RANGE_TEXT_SIZE];
    if (!range_has(BOUND_LAMBDA_RANGE, lambda))
        return err_set(err, STATUS_USAGE, "`lambda` is %g; it must be %s", lambda,
                       range_text(BOUND_LAMBDA_RANGE, range));
    BoundSearch search = {0};
    Bound made = {.lambda = lambda};
    Status status;
    TRY_GOTO(problem_init(&search.problem, tree, lambda, err));
    TRY_GOTO(run(&search, err));
    TRY_GOTO(report(&search, tree, &made, err));
    *out = made;
    made = (Bound){0};
done:
    problem_release(&search.problem);
    newton_release(&search.newton);
    dual_release(&search.dual);
    bound_release(&made);
    return status;
}

void bound_release(Bound *bound)
{
    free(bound->outlet);
    *bound = (Bound){0};
}
