/* Refinement is local search with two moves [refine_move.h]. A round moves all subtrees in random
 * order, and then sweeps over all bifurcations. The geometry level has the sweeps alone.
 *
 * Within the rules of room the search soon comes to a tree where vessels are in each other's way:
 * what would be better lies behind trees that cross. The topology level therefore makes a detour:
 * rules may be broken at a price [refine_toll.h], low at first and rising until no vessel breaks
 * one. When little more is to be gained, only what is near a broken rule is moved, until all are
 * mended. A detour that fails, or gains nothing, ends where it began, and the next begins dearer,
 * closer to the rules. This is what brings a tree of little length (lambda 0) near the shortest
 * that there is.
 *
 * Annealing lets the temperature fall geometrically over most of its budget, takes the best tree
 * and goes on as topology does.
 *
 * Whenever refinement stops, it has a tree that keeps all promises: the present one, or on a detour
 * or when annealing the best before. Viscosities that follow the radii stay as they are within a
 * round and are computed anew after it; should vessels then have come into each other, the tree
 * stays as it was. */
#include "grow/grow.h"

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_check.h"
#include "grow/refine/refine_move.h"
#include "grow/refine/refine_result.h"
#include "grow/refine/refine_room.h"
#include "grow/refine/refine_toll.h"
#include <stdlib.h>

/* Temperatures of annealing over S_root a segment, at first and at last, and the share of the
 * budget that is left then. */
static const double hot = 0.2, cold = 0.03;
static const double last_part = 0.1;
/* A round that gains less than this of S_root is the last: of sweeps; before a detour, on it and
 * after it. */
static const double least_sweep_gain = 1e-4;
static const double least_gain_before = 2e-3, least_gain_across = 2e-4, least_gain_after = 5e-5;
/* The price of the first detour, over S_root a mm of vessels, and how it rises to the next. */
static const double first_price = 0.25, price_rise = 4;
enum { DETOURS = 3, ROUNDS_PER_DETOUR = 40 };
/* Segments that are moved around either end of one that breaks a rule. */
enum { NEIGHBOURS = 8 };
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
    double first_cost;
    int32_t *order; /* in which subtrees move, from 1 */
    /* The tree that is remembered: */
    double best_cost;
    int32_t *best_parent;
    Vec3 *best_place;
} Refinement;

uint64_t refine_moves(GrowRefine level, size_t terminals)
{
    const uint64_t moves_per_terminal[] = {[GROW_REFINE_NONE] = 0,
                                           [GROW_REFINE_GEOMETRY] = 100,
                                           [GROW_REFINE_TOPOLOGY] = 200,
                                           [GROW_REFINE_ANNEAL] = 1600};
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
    int32_t *order = refinement->order;
    for (size_t k = 1; k < n && !*over; k++) {
        if (k % (n / 16 + 1) == 1)
            arbor_look(&surgery->arbor);
        size_t drawn = k + (size_t)(random_uniform(&surgery->random) * (double)(n - k));
        int32_t i = order[drawn];
        order[drawn] = order[k];
        order[k] = i;
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

/* Brings viscosities and bookings to the present radii. */
static Status settle(Surgery *surgery, Err *err)
{
    TRY(arbor_thin(&surgery->arbor, err));
    return room_book(&surgery->room, &surgery->arbor, err);
}

/* Bookings may age for some rounds, viscosities for one. */
static Status settle_for_round(Surgery *surgery, int round, Err *err)
{
    bool is_due = round % ROUNDS_PER_BOOKING == 0 || surgery->arbor.viscosity;
    return is_due ? settle(surgery, err) : STATUS_OK;
}

/* How many segments lack the room that they should have, as of the last room_book. */
static size_t count_unclear(const Surgery *surgery)
{
    size_t count = 0;
    for (size_t i = 1; i < surgery->arbor.n; i++)
        count += !room_is_clear(&surgery->room, &surgery->arbor, (int32_t)i);
    return count;
}

/* Goes back to the tree that is remembered. */
static Status recall(Refinement *refinement, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    arbor_arrange(&surgery->arbor, refinement->best_parent, refinement->best_place);
    return settle(surgery, err);
}

/* Rounds within the rules until one gains less than `least_gain` of S_root. */
static Status descend(Refinement *refinement, double least_gain, bool *over, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    double before = INFINITY, cost = arbor_cost(&surgery->arbor);
    for (int round = 1; !*over && cost < before * (1 - least_gain); round++) {
        before = cost;
        TRY(settle_for_round(surgery, round, err));
        if (refinement->params->level != GROW_REFINE_GEOMETRY)
            TRY(shuffle(refinement, over, err));
        TRY(sweep(refinement, over, err));
        cost = arbor_cost(&surgery->arbor);
    }
    return STATUS_OK;
}

/* Moves segment i in all ways. */
static Status move(Refinement *refinement, int32_t i, bool *over, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    TRY(move_subtree(surgery, i, 0, err));
    *over = is_over(refinement);
    if (*over || surgery->arbor.branch[i].child[0] < 0)
        return STATUS_OK;
    TRY(move_bifurcation(surgery, i, err));
    *over = is_over(refinement);
    return STATUS_OK;
}

/* Moves all segments that break a rule, and what is near them. */
static Status mend(Refinement *refinement, bool *over, Err *err)
{
    const Surgery *surgery = &refinement->surgery;
    for (size_t k = 0; k < surgery->tolls.n_broken && !*over; k++) {
        int32_t i = surgery->tolls.broken[k];
        const Shape *shape = &surgery->arbor.shape[i];
        Near near[2 * NEIGHBOURS];
        int count = grid_nearest(&surgery->room.grid, shape->to, INFINITY, NEIGHBOURS, near);
        count += grid_nearest(&surgery->room.grid, shape->from, INFINITY, NEIGHBOURS, near + count);
        TRY(move(refinement, i, over, err));
        for (int m = 0; m < count && !*over; m++)
            TRY(move(refinement, near[m].segment, over, err));
    }
    return STATUS_OK;
}

/* Rounds across the rules. *done tells whether that led to a better tree; if not, all is as it
 * was. */
static Status detour(Refinement *refinement, double price, bool *done, bool *over, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    Arbor *arbor = &surgery->arbor;
    Tolls *tolls = &surgery->tolls;
    bool gains = true, clear = false;
    remember(refinement);
    tolls_open(tolls, arbor, price);
    for (int round = 0; round < ROUNDS_PER_DETOUR && !clear && !*over; round++) {
        double before = arbor_cost(arbor);
        TRY(tolls_book(&surgery->room, arbor, err));
        if (gains) {
            TRY(shuffle(refinement, over, err));
            TRY(sweep(refinement, over, err));
            gains = arbor_cost(arbor) < before * (1 - least_gain_across);
        } else {
            TRY(mend(refinement, over, err));
        }
        TRY(settle(surgery, err));
        tolls_raise(tolls, &surgery->room, arbor);
        clear = tolls->n_broken == 0;
    }
    tolls->open = false;
    *done = clear && arbor_cost(arbor) < refinement->best_cost;
    return *done ? STATUS_OK : recall(refinement, err);
}

static Status improve_topology(Refinement *refinement, bool *over, Err *err)
{
    double price = first_price;
    bool done = refinement->surgery.room.level == 0; /* vessels of no width pay nothing */
    TRY(descend(refinement, least_gain_before, over, err));
    for (int k = 0; k < DETOURS && !done && !*over; k++, price *= price_rise)
        TRY(detour(refinement, price, &done, over, err));
    return descend(refinement, least_gain_after, over, err);
}

static Status anneal(Refinement *refinement, bool *over, Err *err)
{
    Surgery *surgery = &refinement->surgery;
    remember(refinement);
    for (int round = 1; !*over && refinement->fraction < 1 - last_part; round++) {
        TRY(settle_for_round(surgery, round, err));
        TRY(shuffle(refinement, over, err));
        TRY(sweep(refinement, over, err));
        if (arbor_cost(&surgery->arbor) < refinement->best_cost)
            remember(refinement);
    }
    return recall(refinement, err);
}

static Status refine(Refinement *refinement, Err *err)
{
    GrowRefine level = refinement->params->level;
    bool over = is_over(refinement);
    if (level == GROW_REFINE_GEOMETRY)
        return descend(refinement, least_sweep_gain, &over, err);
    if (level == GROW_REFINE_ANNEAL)
        TRY(anneal(refinement, &over, err));
    return improve_topology(refinement, &over, err);
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
    if (params->level == GROW_REFINE_GEOMETRY)
        return STATUS_OK;
    TRY(tolls_init(&surgery->tolls, tree->n, err));
    TRY(mem_calloc(&refinement->best_parent, tree->n, sizeof *refinement->best_parent, "nodes",
                   err));
    TRY(mem_calloc(&refinement->best_place, tree->n, sizeof *refinement->best_place, "nodes", err));
    TRY(mem_calloc(&refinement->order, tree->n, sizeof *refinement->order, "segments", err));
    for (size_t i = 0; i < tree->n; i++)
        refinement->order[i] = (int32_t)i;
    refinement->best_parent[0] = TREE_NO_PARENT;
    refinement->best_place[0] = tree->position[0];
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
    double before = target_of(&surgery->arbor), after = before;
    size_t unclear = count_unclear(surgery);
    TRY_GOTO(refine(&refinement, err));
    if (surgery->arbor.viscosity)
        TRY_GOTO(settle(surgery, err));
    if (!surgery->arbor.viscosity || count_unclear(surgery) <= unclear) {
        after = target_of(&surgery->arbor);
        TRY_GOTO(result_write(&surgery->arbor, tree, err));
    }
    if (report)
        *report = (RefineReport){.seconds = clock_seconds() - refinement.begun,
                                 .target_before = before,
                                 .target_after = after,
                                 .moves_tried = surgery->tried,
                                 .moves_kept = surgery->kept,
                                 .thickness = surgery->room.level,
                                 .stopped = refinement.stopped};
done:
    free(refinement.order);
    free(refinement.best_parent);
    free(refinement.best_place);
    tolls_release(&surgery->tolls);
    room_release(&surgery->room);
    arbor_release(&surgery->arbor);
    return status;
}
