/* Refinement is local search with two moves [refine_move.h]. A round tries as many moves of
 * subtrees, drawn at random, as there are segments, and then a sweep over all bifurcations. The
 * geometry level has the sweeps alone. Annealing lets the temperature fall geometrically over the
 * budget and has it at 0 for the last part of it, so that it ends in a local optimum; it keeps a
 * copy of the best tree, which the other levels do not need, because they never accept a rise.
 *
 * Every state between two moves is a tree that keeps all promises, so it can stop at any time. */
#include "grow/grow.h"

#include "grow/refine_arbor.h"
#include "grow/refine_check.h"
#include "grow/refine_move.h"
#include "grow/refine_result.h"
#include "grow/refine_room.h"
#include <stdlib.h>

/* Temperatures of annealing over S_root a segment: at first, and just before the last part. */
static const double hot = 0.2, cold = 0.03;
static const double last_part = 0.1;
/* A round that gains less than this of S_root is the last but for annealing. */
static const double least_gain[] = {
    [GROW_REFINE_GEOMETRY] = 1e-5, [GROW_REFINE_TOPOLOGY] = 2e-5, [GROW_REFINE_ANNEAL] = 0};
/* Rounds after which vessels get their room anew. */
enum { ROUNDS_PER_BOOKING = 4 };
/* Moves after which the clock is read. */
enum { MOVES_PER_LOOK = 16 };

typedef struct Refinement {
    const RefineParams *params;
    double begun; /* clock */
    uint64_t moves;
    double fraction; /* of the budget that is spent */
    bool stopped;
    Surgery surgery;
    double first_cost, best_cost;
    /* The best tree, of annealing: */
    int32_t *best_parent;
    Vec3 *best_place;
} Refinement;

uint64_t refine_moves(GrowRefine level, size_t terminals)
{
    const uint64_t moves_per_terminal[] = {[GROW_REFINE_NONE] = 0,
                                           [GROW_REFINE_GEOMETRY] = 100,
                                           [GROW_REFINE_TOPOLOGY] = 100,
                                           [GROW_REFINE_ANNEAL] = 2000};
    return moves_per_terminal[level] * terminals;
}

/* Whether the budget is spent; asked after every move. */
static bool is_over(Refinement *refinement)
{
    const RefineParams *params = refinement->params;
    uint64_t tried = refinement->surgery.tried;
    refinement->stopped =
        refinement->stopped || (params->stop && params->stop(params->stop_context));
    if (refinement->stopped || tried >= refinement->moves)
        return true;
    if (tried % MOVES_PER_LOOK != 0)
        return refinement->fraction >= 1;
    double fraction = (double)tried / (double)refinement->moves;
    if (params->seconds > 0)
        fraction = fmax(fraction, (clock_seconds() - refinement->begun) / params->seconds);
    refinement->fraction = fraction;
    if (params->progress)
        params->progress(fmin(fraction, 1), params->progress_context);
    return fraction >= 1;
}

static Status sweep(Refinement *refinement, bool *over, Err *err)
{
    const Arbor *arbor = &refinement->surgery.arbor;
    arbor_look(&refinement->surgery.arbor);
    for (int32_t i = arbor_root(arbor); i != 0 && !*over; i = arbor_next(arbor, i)) {
        if (arbor->branch[i].child[0] < 0)
            continue;
        TRY(move_bifurcation(&refinement->surgery, i, err));
        *over = is_over(refinement);
    }
    return STATUS_OK;
}

static double temperature(const Refinement *refinement)
{
    double part = refinement->fraction / (1 - last_part);
    if (refinement->params->level != GROW_REFINE_ANNEAL || part >= 1)
        return 0;
    return refinement->first_cost / (double)refinement->surgery.arbor.n * hot *
           pow(cold / hot, part);
}

static Status shuffle(Refinement *refinement, bool *over, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    size_t n = surgery->arbor.n;
    for (size_t k = 0; k < n && !*over; k++) {
        if (k % (n / 16 + 1) == 0)
            arbor_look(&surgery->arbor);
        int32_t i = 1 + (int32_t)(random_uniform(&surgery->random) * (double)(n - 1));
        TRY(move_subtree(surgery, i, temperature(refinement), err));
        *over = is_over(refinement);
    }
    return STATUS_OK;
}

static void remember(Refinement *refinement)
{
    const Arbor *arbor = &refinement->surgery.arbor;
    refinement->best_cost = arbor_cost(arbor);
    for (size_t i = 1; i < arbor->n; i++) {
        refinement->best_parent[i] = arbor->branch[i].parent;
        refinement->best_place[i] = arbor->shape[i].to;
    }
}

static Status refine(Refinement *refinement, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    GrowRefine level = refinement->params->level;
    bool over = is_over(refinement);
    for (int round = 1; !over; round++) {
        double cost = arbor_cost(&surgery->arbor);
        if (round % ROUNDS_PER_BOOKING == 0)
            TRY(room_book(&surgery->room, &surgery->arbor, err));
        if (level != GROW_REFINE_GEOMETRY)
            TRY(shuffle(refinement, &over, err));
        TRY(sweep(refinement, &over, err));
        double now = arbor_cost(&surgery->arbor);
        if (level == GROW_REFINE_ANNEAL && now < refinement->best_cost)
            remember(refinement);
        if (level != GROW_REFINE_ANNEAL && now > cost * (1 - least_gain[level]))
            over = true;
    }
    return STATUS_OK;
}

/* The tree's target, mm^(1 + lambda). */
static double target_of(const Arbor *arbor)
{
    return pow(arbor->radius_unit, arbor->law.lambda) * arbor_cost(arbor);
}

static Status start(Refinement *refinement, const Domain *domain, const Tree *tree, Err *err)
{
    const RefineParams *params = refinement->params;
    Surgery *surgery = &refinement->surgery;
    refinement->moves = params->moves         ? params->moves
                        : params->seconds > 0 ? UINT64_MAX
                                              : refine_moves(params->level, tree->n / 2);
    random_seed(&surgery->random, params->seed);
    TRY(arbor_init(&surgery->arbor, tree, err));
    double cost = refinement->first_cost = arbor_cost(&surgery->arbor);
    if (!(cost > 0) || !isfinite(cost))
        return err_set(err, STATUS_INFEASIBLE,
                       "with gamma %g and lambda %g the radii span more than a double can hold",
                       tree->header.gamma, tree->header.lambda);
    TRY(room_init(&surgery->room, domain, &surgery->arbor, err));
    if (params->level != GROW_REFINE_ANNEAL)
        return STATUS_OK;
    TRY(mem_calloc(&refinement->best_parent, tree->n, sizeof *refinement->best_parent, "nodes",
                   err));
    TRY(mem_calloc(&refinement->best_place, tree->n, sizeof *refinement->best_place, "nodes", err));
    refinement->best_parent[0] = TREE_NO_PARENT;
    refinement->best_place[0] = tree->position[0];
    remember(refinement);
    return STATUS_OK;
}

Status refine_tree(const RefineParams *params, const Domain *domain, Tree *tree,
                   RefineReport *report, Err *err)
{
    TRY(refine_check(params, domain, tree, err));
    Refinement refinement = {.params = params, .begun = clock_seconds()};
    Surgery *surgery = &refinement.surgery;
    Status status = STATUS_OK;
    TRY_GOTO(start(&refinement, domain, tree, err));
    double before = target_of(&surgery->arbor);
    TRY_GOTO(refine(&refinement, err));
    if (refinement.best_parent && refinement.best_cost < arbor_cost(&surgery->arbor))
        arbor_arrange(&surgery->arbor, refinement.best_parent, refinement.best_place);
    double after = target_of(&surgery->arbor);
    TRY_GOTO(result_write(&surgery->arbor, tree, err));
    if (report)
        *report = (RefineReport){.seconds = clock_seconds() - refinement.begun,
                                 .target_before = before,
                                 .target_after = after,
                                 .moves_tried = surgery->tried,
                                 .moves_kept = surgery->kept,
                                 .thickness = surgery->room.level,
                                 .stopped = refinement.stopped};
done:
    free(refinement.best_parent);
    free(refinement.best_place);
    room_release(&surgery->room);
    arbor_release(&surgery->arbor);
    return status;
}
