/* Refines a grown tree: lowers its target (S_root, the reduced cost of the law [cco/law.h]) by
 * moving bifurcations and reconnecting subtrees, while the rules of clearance are kept: no vessel
 * is shorter than wide, and none touches another.
 *
 * Refinement is a local search with two moves [refine_move.h]: a bifurcation moves to a better
 * position, or a subtree is cut off and connected elsewhere. A round tries all subtrees in random
 * order (shuffle), and then all bifurcations one by one (sweep). In `descend`, a joint move of all
 * bifurcations comes first [refine_joint.h]. The geometry level moves no subtrees, so it has no
 * shuffles.
 *
 * If every move must keep the rules, the search soon gets stuck where vessels are in each other's
 * way: the path to better trees leads through trees whose vessels cross. The levels above geometry
 * therefore anneal with penalties for broken rules [refine_penalty.h]. While the temperature falls
 * geometrically, the penalty per mm rises, until few segments still break a rule (anneal). Then the
 * penalties rise further, most for the segments that break a rule, until no segment does (mend).
 * When rounds of mending gain little, only segments that break a rule and their neighbours move
 * (repair). A last descent keeps the rules. Annealing within the rules instead ends at a target
 * that is 1 % higher. Joint moves are not used while annealing, because they would undo the random
 * changes.
 *
 * Annealing, mending and the last descent are one cycle. If there are enough moves for several
 * cycles, they run in parallel from the same tree (refine_in_cycles), and the best tree is the
 * result.
 *
 * Refinement may be stopped after any move, and then returns a tree that keeps the rules: in
 * `descend`, the present tree; during annealing and mending, the tree from before, which `recall`
 * restores. `recall` also restores it if mending fails.
 *
 * Viscosities and exponents that depend on radii are held fixed within a round, and computed again
 * after it (settle). If vessels meet at the end because of that, the result is the tree of the last
 * round after which none did. */
#include "grow/grow.h"

#include "grow/refine/refine_arbor.h"
#include "grow/refine/refine_clearance.h"
#include "grow/refine/refine_joint.h"
#include "grow/refine/refine_move.h"
#include "grow/refine/refine_penalty.h"
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Temperatures in units of S_root per segment: at the beginning and at the end of annealing, and in
 * repairs. At a temperature of t units, a move that costs t times a mean segment is accepted with
 * the probability 1 / e. So annealing begins where subtrees move freely, and ends where only 2 % of
 * a segment can be lost; repairs may lose 5 %. */
static const double hot = 1, cold = 0.02, warm = 0.05;
/* Penalty per mm of a broken rule, relative to S_root per mm of vessels: at the beginning and at
 * the end of annealing. At 0.1, vessels may cross if that saves a tenth of the crossing's depth; at
 * 2, hardly any crossing pays. A lower end leaves more to mend, a higher beginning blocks the paths
 * through crossings. */
static const double first_rate = 0.1, last_rate = 2;
/* Share of the budget that is left after annealing, for mending and the last descent: the time of
 * last_moves moves per terminal, but at least least_left and at most most_left. Chosen so that both
 * usually end before the budget does. */
static const double last_moves = 40, least_left = 0.1, most_left = 0.5;
/* A round that gains less than this share of S_root is the last of its kind: rounds of `descend` at
 * the geometry level, joint moves, rounds of `descend` in large trees; and rounds of shuffles
 * before annealing, while mending, and after it. Smaller shares take more time for less and less
 * gain. The descent before annealing ends early, because annealing undoes most of it. */
static const double least_sweep_gain = 1e-4, least_joint_gain = 1e-4, least_large_gain = 1e-2;
static const double least_gain_before = 2e-3, least_gain_mending = 2e-4, least_gain_after = 5e-5;
/* Maximum number of rounds of mending. Penalties have then risen 90,000-fold or more; rules that
 * are still broken are in conflict, and mending has failed. */
enum { ROUNDS_OF_MENDING = 120 };
/* Moves of a cycle divided by the square of the number of terminals, and their maximum divided by
 * that number. If a cycle cools more slowly, the tree comes to depend on broken rules, and mending
 * costs more than annealing gained [docs/METHODS.md 1.3, anneal]. */
static const double moves_per_square = 20, most_per_terminal = 2000;
/* Maximum number of cycles. Only small trees with long times could have more. */
static const double most_cycles = 1 << 20;
/* Number of segments near each end of a broken segment that `repair` moves: those that can be in
 * its way. */
enum { NEIGHBOURS = 8 };
/* Number of rounds of `descend` after which reserved radii are computed again, which costs about as
 * much as a round. */
enum { ROUNDS_PER_RESERVATION = 4 };
/* Number of moves after which the clock is read and progress reported: reading it after each move
 * would take a noticeable part of the time of a move. */
enum { MOVES_PER_LOOK = 16 };
/* The geometry of trees with more terminals is refined without sweeps [is_large]. */
enum { LARGE = 250000 };

/* A tree that a search can go back to. The arrays are owned. */
typedef struct Remembered {
    double cost;     /* its S_root */
    int32_t *parent; /* per node */
    Vec3 *place;     /* per node, mm */
} Remembered;

/* The state of one search: of the whole refinement, or of one cycle. All arrays are owned. */
typedef struct Refinement {
    const RefineParams *params;
    double begun;                        /* clock at the beginning of the refinement, s */
    uint64_t moves;                      /* the budget: maximum number of moves */
    double fraction;                     /* of the budget that is spent */
    double progress_from, progress_span; /* progress to report at the beginning, and its increase
                                          * until the end */
    bool stopped;                        /* by the caller, or cancelled */
    atomic_bool *cancelled; /* the progress callback asked to stop; shared by all cycles */
    LocalSearch search;
    Joints joints;
    size_t unclear;  /* number of segments that broke a rule at the beginning */
    int32_t *order;  /* the order in which shuffles try the subtrees */
    Remembered best; /* the tree that `recall` restores */
} Refinement;

/* Where a cycle began. */
typedef struct Cycle {
    uint64_t first_move;
    double first_fraction; /* of the budget */
} Cycle;

/* Returns the maximum number of moves that a level tries on a tree of `terminals` terminals if
 * neither moves nor seconds are specified. The geometry level ends earlier when there is little
 * left to gain. */
static uint64_t most_moves(GrowRefine level, size_t terminals)
{
    const uint64_t moves_per_terminal[] = {[GROW_REFINE_NONE] = 0,
                                           [GROW_REFINE_GEOMETRY] = 100,
                                           [GROW_REFINE_TOPOLOGY] = 88,
                                           [GROW_REFINE_ANNEAL] = 2000};
    return moves_per_terminal[level] * terminals;
}

/* Returns true if the budget is used up. Called after every move. */
static bool is_over(Refinement *refinement)
{
    const RefineParams *params = refinement->params;
    uint64_t tried = refinement->search.tried;
    refinement->stopped = refinement->stopped ||
                          atomic_load_explicit(refinement->cancelled, memory_order_relaxed) ||
                          (params->stop && params->stop(params->stop_context));
    if (refinement->stopped || tried >= refinement->moves)
        return true;
    if (tried % MOVES_PER_LOOK != 0)
        return refinement->fraction >= 1;
    double fraction = (double)tried / (double)refinement->moves;
    if (params->seconds > 0)
        fraction = fmax(fraction, (clock_seconds() - refinement->begun) / params->seconds);
    refinement->fraction = fraction;
    if (params->progress &&
        !params->progress(refinement->progress_from + refinement->progress_span * fmin(fraction, 1),
                          params->progress_context)) {
        atomic_store(refinement->cancelled, true);
        refinement->stopped = true;
    }
    return refinement->stopped || fraction >= 1;
}

/* Tries all bifurcations, in depth-first order. */
static Status sweep(Refinement *refinement, bool *over, Err *err)
{
    const Arbor *arbor = &refinement->search.arbor;
    arbor_refresh(&refinement->search.arbor);
    for (int32_t i = arbor_first(arbor); i != 0 && !*over; i = arbor_next(arbor, i)) {
        if (arbor->branch[i].child[0] < 0)
            continue;
        TRY(move_bifurcation(&refinement->search, i, err));
        *over = is_over(refinement);
    }
    return STATUS_OK;
}

/* Moves all bifurcations at once, which counts as one move. *gains receives true if the gain
 * justifies another such move. */
static Status move_jointly(Refinement *refinement, bool *gains, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    double before = arbor_cost(&search->arbor);
    bool kept;
    if (*over)
        return STATUS_OK;
    TRY(joint_move(&refinement->joints, &search->arbor, &search->clearance, &kept, err));
    search->tried++;
    search->kept += kept;
    *gains = arbor_cost(&search->arbor) < before * (1 - least_joint_gain);
    *over = is_over(refinement);
    return STATUS_OK;
}

/* Returns true if the tree is so large that sweeps, at O(depth) per bifurcation, would take minutes
 * and gain only a tenth of what a joint move gains. */
static bool is_large(const Refinement *refinement)
{
    return refinement->params->level == GROW_REFINE_GEOMETRY &&
           refinement->search.arbor.terminals > LARGE;
}

/* Returns S_root divided by the number of segments: the unit of temperatures. */
static double cost_of_segment(const Arbor *arbor)
{
    return arbor_cost(arbor) / (double)arbor->n;
}

/* Tries to reconnect all subtrees, in random order. Marginals [refine_arbor.h] are computed again
 * 16 times. */
static Status shuffle(Refinement *refinement, double temperature, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    size_t n = search->arbor.n;
    int32_t *order = refinement->order;
    for (size_t k = search->arbor.inlets; k < n && !*over; k++) {
        if (k % (n / 16 + 1) == 1 || k == search->arbor.inlets)
            arbor_refresh(&search->arbor);
        size_t drawn = k + (size_t)(random_uniform(&search->random) * (double)(n - k));
        int32_t i = order[drawn];
        order[drawn] = order[k];
        order[k] = i;
        TRY(move_subtree(search, i, temperature, err));
        *over = is_over(refinement);
    }
    return STATUS_OK;
}

/* Stores the present tree in refinement->best. */
static void remember(Refinement *refinement)
{
    const Arbor *arbor = &refinement->search.arbor;
    refinement->best.cost = arbor_cost(arbor);
    for (size_t i = 0; i < arbor->n; i++) {
        refinement->best.parent[i] = arbor->branch[i].parent;
        refinement->best.place[i] = arbor->shape[i].to;
    }
}

/* Computes viscosities, exponents and reserved radii from the present radii. */
static Status settle(LocalSearch *search, Err *err)
{
    TRY(arbor_iterate_local(&search->arbor, err));
    return clearance_reserve(&search->clearance, &search->arbor, err);
}

/* Settles if it is due: reserved radii may be some rounds old, viscosities and exponents one round.
 */
static Status settle_for_round(LocalSearch *search, int round, Err *err)
{
    bool is_due = round % ROUNDS_PER_RESERVATION == 0 || search->arbor.local;
    return is_due ? settle(search, err) : STATUS_OK;
}

/* Returns the number of segments that break a rule, as of the last clearance_reserve. */
static size_t count_unclear(const LocalSearch *search)
{
    size_t count = 0;
    for (size_t i = search->arbor.inlets; i < search->arbor.n; i++)
        count += !clearance_is_kept(&search->clearance, &search->arbor, (int32_t)i);
    return count;
}

/* Restores the tree in refinement->best. */
static Status recall(Refinement *refinement, Err *err)
{
    LocalSearch *search = &refinement->search;
    arbor_arrange(&search->arbor, refinement->best.parent, refinement->best.place);
    return settle(search, err);
}

/* Settles. If the new viscosities and exponents make more segments break a rule than at first,
 * restores the tree in refinement->best. */
static Status settle_for_good(Refinement *refinement, Err *err)
{
    LocalSearch *search = &refinement->search;
    TRY(settle(search, err));
    if (search->arbor.local && count_unclear(search) > refinement->unclear)
        return recall(refinement, err);
    return STATUS_OK;
}

/* Makes rounds that keep the rules, until a round gains less than the fraction `least_gain` of
 * S_root. */
static Status descend(Refinement *refinement, double least_gain, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    double before = INFINITY, cost = arbor_cost(&search->arbor);
    bool jointly = true;
    for (int round = 1; !*over && cost < before * (1 - least_gain); round++) {
        before = cost;
        TRY(settle_for_round(search, round, err));
        if (search->arbor.local && arbor_cost(&search->arbor) < refinement->best.cost &&
            count_unclear(search) <= refinement->unclear)
            remember(refinement);
        if (refinement->params->level != GROW_REFINE_GEOMETRY)
            TRY(shuffle(refinement, 0, over, err));
        if (jointly || refinement->params->level == GROW_REFINE_GEOMETRY)
            TRY(move_jointly(refinement, &jointly, over, err));
        if (!is_large(refinement))
            TRY(sweep(refinement, over, err));
        cost = arbor_cost(&search->arbor);
    }
    return STATUS_OK;
}

/* Tries both moves of segment i: its subtree at the temperature `heat`, then its bifurcation. */
static Status move(Refinement *refinement, int32_t i, double heat, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    TRY(move_subtree(search, i, heat, err));
    *over = is_over(refinement);
    if (*over || search->arbor.branch[i].child[0] < 0)
        return STATUS_OK;
    TRY(move_bifurcation(search, i, err));
    *over = is_over(refinement);
    return STATUS_OK;
}

/* Moves all segments that break a rule, and the segments near them, at the temperature `warm`, at
 * which neighbours give way. */
static Status repair(Refinement *refinement, bool *over, Err *err)
{
    const LocalSearch *search = &refinement->search;
    double heat = warm * cost_of_segment(&search->arbor);
    for (size_t k = 0; k < search->penalties.n_broken && !*over; k++) {
        int32_t i = search->penalties.broken[k];
        const Shape *shape = &search->arbor.shape[i];
        Near near[2 * NEIGHBOURS];
        int count = grid_nearest(&search->clearance.grid, shape->to, INFINITY, NEIGHBOURS, near);
        count +=
            grid_nearest(&search->clearance.grid, shape->from, INFINITY, NEIGHBOURS, near + count);
        TRY(move(refinement, i, heat, over, err));
        for (int m = 0; m < count && !*over; m++)
            TRY(move(refinement, near[m].segment, heat, over, err));
    }
    return STATUS_OK;
}

/* Returns the number of moves of a cycle, which is annealing, mending and the descent after it. In
 * a small tree several cycles find a lower target than one long cycle, because S_root during
 * annealing is not that of the tree after a descent. */
static double cycle_moves(const Refinement *refinement)
{
    double terminals = (double)refinement->search.arbor.terminals;
    return terminals * fmin(moves_per_square * terminals, most_per_terminal);
}

/* Returns the share of a cycle's annealing that is done; 1: all. */
static double part_done(const Refinement *refinement, const Cycle *cycle)
{
    const LocalSearch *search = &refinement->search;
    double moves = (double)(search->tried - cycle->first_move);
    double done =
        fmax(moves / cycle_moves(refinement),
             (refinement->fraction - cycle->first_fraction) / (1 - cycle->first_fraction));
    double left = moves > 0 ? last_moves * (double)search->arbor.terminals * done / moves : 0;
    return done / (1 - fmin(fmax(left, least_left), most_left));
}

/* Allows segments to break rules for a penalty of `rate` per mm. At clearance level 0, where only
 * centrelines count, no rule may be broken. */
static Status allow_faults(LocalSearch *search, double rate, Err *err)
{
    TRY(settle(search, err));
    if (search->clearance.level == 0)
        return STATUS_OK;
    penalties_begin(&search->penalties, &search->arbor, rate);
    return clearance_suspend(&search->clearance, &search->arbor, err);
}

/* Makes rounds in which rules may be broken and S_root may rise: penalties rise and the temperature
 * falls from round to round. */
static Status anneal(Refinement *refinement, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    Arbor *arbor = &search->arbor;
    const Cycle cycle = {search->tried, refinement->fraction};
    double unit = cost_of_segment(arbor);
    for (double part; (part = part_done(refinement, &cycle)) < 1 && !*over;) {
        TRY(allow_faults(search, first_rate * elementary_pow(last_rate / first_rate, part), err));
        TRY(shuffle(refinement, unit * hot * elementary_pow(cold / hot, part), over, err));
        TRY(sweep(refinement, over, err));
    }
    return STATUS_OK;
}

/* Makes rounds in which penalties rise, until no segment breaks a rule; *done then receives true.
 * As long as rounds gain, all segments move; then only those that break a rule and their
 * neighbours. */
static Status mend(Refinement *refinement, bool *done, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    Arbor *arbor = &search->arbor;
    Penalties *penalties = &search->penalties;
    bool gains = true;
    *done = !penalties->active;
    for (int round = 0; round < ROUNDS_OF_MENDING && !*done && !*over; round++) {
        double before = arbor_cost(arbor);
        TRY(clearance_suspend(&search->clearance, arbor, err));
        if (gains) {
            TRY(shuffle(refinement, 0, over, err));
            TRY(sweep(refinement, over, err));
        } else {
            TRY(repair(refinement, over, err));
        }
        TRY(settle(search, err));
        gains = gains && arbor_cost(arbor) < before * (1 - least_gain_mending);
        penalties_raise(penalties, &search->clearance, arbor);
        *done = penalties->n_broken == 0;
    }
    return STATUS_OK;
}

/* Searches for a better tree by way of trees that break rules. If it finds none, restores the
 * present tree. */
static Status improve_topology(Refinement *refinement, bool *over, Err *err)
{
    LocalSearch *search = &refinement->search;
    bool done;
    remember(refinement);
    TRY(anneal(refinement, over, err));
    TRY(mend(refinement, &done, over, err));
    search->penalties.active = false;
    if (!done)
        TRY(recall(refinement, err));
    double best = refinement->best.cost;
    TRY(descend(refinement, least_gain_after, over, err));
    return arbor_cost(&search->arbor) < best ? STATUS_OK : recall(refinement, err);
}

/* Sets *mm to the distance within which the proof compares vessels of different trees, mm: that of
 * the terminals of a pair, or twice the clearance if that is more. 0: the tree has neither a
 * clearance nor pairs, and needs no proof. */
static Status proof_distance(const Tree *tree, double *mm, Err *err)
{
    TreePair *pair = NULL;
    size_t n = 0;
    *mm = 2 * fmax(meta_number(&tree->meta, META_CLEARANCE), 0);
    if (!tree_column(tree, tree_pairs_name))
        return STATUS_OK;
    TRY(tree_pairs(tree, &pair, &n, err));
    if (n > 0)
        *mm = fmax(*mm,
                   vec3_distance(tree->position[pair[0].node[0]], tree->position[pair[0].node[1]]));
    free(pair);
    return STATUS_OK;
}

/* Proves that the tree `made`, which was made of the tree `was`, keeps the clearance of `was`, if
 * it has one. */
static Status prove_apart(const Tree *made, const Tree *was, double *apart, Err *err)
{
    double clearance = meta_number(&was->meta, META_CLEARANCE), within;
    *apart = INFINITY;
    TRY(proof_distance(was, &within, err));
    if (!(within > 0))
        return STATUS_OK;
    return trees_prove_clearance(made, clearance > 0 ? clearance : -HUGE_VAL, within, "", apart,
                                 err);
}

/* Proves that the arbor keeps the clearance of the tree before anything moves. */
static Status prove_start(const Arbor *arbor, const Tree *tree, Err *err)
{
    Tree made;
    double within, apart;
    TRY(proof_distance(tree, &within, err));
    if (!(within > 0))
        return STATUS_OK;
    TRY(arbor_to_tree(arbor, tree, &made, err));
    Status status = prove_apart(&made, tree, &apart, err);
    if (status == STATUS_INFEASIBLE)
        err_prefix(err, "as the trees are, ");
    tree_release(&made);
    return status;
}

/* Moves *made to *tree, which keeps its metadata. */
static void take_result(Tree *made, Tree *tree)
{
    made->meta = tree->meta;
    tree->meta = (TreeMeta){0};
    tree_release(tree);
    *tree = *made;
    *made = (Tree){0};
}

/* Returns the tree's target, mm^(1 + lambda). */
static double target_of(const Arbor *arbor)
{
    return elementary_pow(arbor->radius_unit, arbor->law.lambda) * arbor_cost(arbor);
}

/* Makes the arbor of a tree and all that the search needs, and checks the tree. */
static Status start(Refinement *refinement, const Domain *domain, const Tree *tree, Err *err)
{
    const RefineParams *params = refinement->params;
    LocalSearch *search = &refinement->search;
    random_seed(&search->random, params->seed);
    TRY(arbor_init(&search->arbor, tree, err));
    size_t n = search->arbor.n;
    refinement->moves = params->moves ? params->moves
                        : params->seconds > 0 && params->level == GROW_REFINE_ANNEAL
                            ? UINT64_MAX
                            : most_moves(params->level, search->arbor.terminals);
    double cost = arbor_cost(&search->arbor);
    if (!(cost > 0) || !isfinite(cost))
        return err_set(err, STATUS_INFEASIBLE,
                       "with this gamma and lambda %g the radii span more than a double can hold",
                       tree->meta.number[META_LAMBDA]);
    TRY(prove_start(&search->arbor, tree, err));
    TRY(clearance_init(&search->clearance, domain, meta_number(&tree->meta, META_CLEARANCE),
                       &search->arbor, err));
    refinement->unclear = count_unclear(search);
    TRY(joints_init(&refinement->joints, n, err));
    Remembered *best = &refinement->best;
    TRY(mem_calloc(&best->parent, n, sizeof *best->parent, "nodes", err));
    TRY(mem_calloc(&best->place, n, sizeof *best->place, "nodes", err));
    remember(refinement);
    if (params->level == GROW_REFINE_GEOMETRY)
        return STATUS_OK;
    TRY(penalties_init(&search->penalties, n, err));
    TRY(mem_calloc(&refinement->order, n, sizeof *refinement->order, "segments", err));
    for (size_t i = 0; i < n; i++)
        refinement->order[i] = (int32_t)i;
    return STATUS_OK;
}

/* ---- cycles in parallel ---------------------------------------------------------------------- */

static void release(Refinement *refinement)
{
    LocalSearch *search = &refinement->search;
    joints_release(&refinement->joints);
    free(refinement->order);
    free(refinement->best.parent);
    free(refinement->best.place);
    penalties_release(&search->penalties);
    clearance_release(&search->clearance);
    arbor_release(&search->arbor);
}

/* The results of the cycles that one worker has run. */
typedef struct Found {
    Remembered best;      /* the best tree; its arrays are NULL while no cycle has ended */
    size_t cycle;         /* the cycle that found it */
    uint64_t tried, kept; /* moves of all cycles */
    double seconds;       /* that the longest cycle took */
    bool stopped;
} Found;

/* Cycles that begin with the same tree, each with a seed of its own. */
typedef struct Cycles {
    const Refinement *from; /* from->best is the tree with which they begin */
    const Domain *domain;
    const Tree *tree;
    size_t count;
    uint64_t moves; /* maximum number of moves of each */
    Found *found;   /* per worker; owned */
} Cycles;

/* Returns true if the tree of `cost` that the cycle `number` has found is better than another. */
static bool is_better(double cost, size_t number, const Found *than)
{
    return !than->best.place || cost < than->best.cost ||
           (cost == than->best.cost && number < than->cycle);
}

/* Runs one cycle, and stores its tree in `found` if that is the worker's best. */
static Status run_cycle(const Cycles *cycles, size_t number, const RefineParams *params,
                        Found *found, Err *err)
{
    const Refinement *from = cycles->from;
    Refinement cycle = {
        .params = params, .begun = from->begun, .progress_span = 1, .cancelled = from->cancelled};
    const Arbor *arbor = &cycle.search.arbor;
    Status status;
    if (!(params->seconds > 0)) {
        cycle.progress_span = 1 / (double)cycles->count;
        cycle.progress_from = (double)number * cycle.progress_span;
    }
    TRY_GOTO(start(&cycle, cycles->domain, cycles->tree, err));
    cycle.moves = cycles->moves;
    cycle.best.cost = from->best.cost;
    memcpy(cycle.best.parent, from->best.parent, arbor->n * sizeof *cycle.best.parent);
    memcpy(cycle.best.place, from->best.place, arbor->n * sizeof *cycle.best.place);
    TRY_GOTO(recall(&cycle, err));
    bool over = is_over(&cycle);
    TRY_GOTO(improve_topology(&cycle, &over, err));
    TRY_GOTO(settle_for_good(&cycle, err));
    remember(&cycle);
    found->tried += cycle.search.tried;
    found->kept += cycle.search.kept;
    found->stopped = cycle.stopped;
    if (is_better(cycle.best.cost, number, found)) {
        const Remembered before = found->best;
        found->best = cycle.best;
        found->cycle = number;
        cycle.best = before;
    }
done:
    release(&cycle);
    return status;
}

/* Returns true if a worker may begin another cycle: its longest cycle so far would end in time. */
static bool has_time(const Refinement *from, const Found *found)
{
    double end = clock_seconds() - from->begun + found->seconds;
    if (found->stopped)
        return false;
    return !found->best.place || !(from->params->seconds > 0) || end <= from->params->seconds;
}

/* Runs cycle `number` on a worker, unless the time is up. */
static Status run_in_turn(size_t number, int worker, void *context, Err *err)
{
    const Cycles *cycles = context;
    Found *found = &cycles->found[worker];
    RefineParams params = *cycles->from->params;
    double begun = clock_seconds();
    if (!has_time(cycles->from, found))
        return STATUS_OK;
    params.seed ^= number * UINT64_C(0x9e3779b97f4a7c15);
    if (worker != 0)
        params.progress = NULL;
    TRY(run_cycle(cycles, number, &params, found, err));
    found->seconds = fmax(found->seconds, clock_seconds() - begun);
    return STATUS_OK;
}

/* Makes the best tree that any worker has found the present tree. */
static Status take_best(Refinement *refinement, const Found *found, int workers, Err *err)
{
    LocalSearch *search = &refinement->search;
    const Found *best = NULL;
    for (int i = 0; i < workers; i++) {
        search->tried += found[i].tried;
        search->kept += found[i].kept;
        refinement->stopped = refinement->stopped || found[i].stopped;
        if (found[i].best.place && (!best || is_better(found[i].best.cost, found[i].cycle, best)))
            best = &found[i];
    }
    if (!best)
        return STATUS_OK;
    arbor_arrange(&search->arbor, best->best.parent, best->best.place);
    TRY(settle(search, err));
    remember(refinement);
    return STATUS_OK;
}

static Status refine_in_cycles(Refinement *refinement, const Domain *domain, const Tree *tree,
                               size_t count, uint64_t moves, Err *err)
{
    int workers =
        refinement->params->threads > 0 ? refinement->params->threads : threads_available();
    Cycles cycles = {
        .from = refinement, .domain = domain, .tree = tree, .count = count, .moves = moves};
    TRY(mem_calloc(&cycles.found, (size_t)workers, sizeof *cycles.found, "cycles", err));
    Status status;
    TRY_GOTO(threads_try(count, workers, run_in_turn, &cycles, err));
    TRY_GOTO(take_best(refinement, cycles.found, workers, err));
done:
    for (int i = 0; i < workers; i++) {
        free(cycles.found[i].best.parent);
        free(cycles.found[i].best.place);
    }
    free(cycles.found);
    return status;
}

static Status refine(Refinement *refinement, const Domain *domain, const Tree *tree, Err *err)
{
    GrowRefine level = refinement->params->level;
    bool over = is_over(refinement);
    if (level == GROW_REFINE_GEOMETRY)
        return descend(refinement, is_large(refinement) ? least_large_gain : least_sweep_gain,
                       &over, err);
    if (level == GROW_REFINE_ANNEAL) /* a run that is stopped early then has a better tree, too */
        TRY(descend(refinement, least_gain_before, &over, err));
    uint64_t left = refinement->moves - refinement->search.tried;
    double count = fmin(round((double)left / cycle_moves(refinement)), most_cycles);
    if (over)
        return STATUS_OK;
    if (count < 2)
        return improve_topology(refinement, &over, err);
    remember(refinement);
    if (refinement->moves < UINT64_MAX)
        left /= (uint64_t)count;
    return refine_in_cycles(refinement, domain, tree, (size_t)count, left, err);
}

Status refine_tree(const RefineParams *params, const Domain *domain, Tree *tree,
                   RefineReport *report, Err *err)
{
    TRY(refine_check(params, domain, tree, err));
    atomic_bool cancelled = false;
    Refinement refinement = {
        .params = params, .begun = clock_seconds(), .progress_span = 1, .cancelled = &cancelled};
    LocalSearch *search = &refinement.search;
    Tree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(start(&refinement, domain, tree, err));
    double before = target_of(&search->arbor), after = before, apart;
    TRY_GOTO(refine(&refinement, domain, tree, err));
    if (atomic_load(&cancelled))
        TRY_GOTO(err_cancelled(err));
    TRY_GOTO(settle_for_good(&refinement, err));
    TRY_GOTO(arbor_to_tree(&search->arbor, tree, &made, err));
    TRY_GOTO(prove_apart(&made, tree, &apart, err));
    size_t broken = count_unclear(search);
    if (search->arbor.local && broken > refinement.unclear) {
        broken = refinement.unclear;
    } else {
        after = target_of(&search->arbor);
        take_result(&made, tree);
    }
    if (report)
        *report = (RefineReport){.seconds = clock_seconds() - refinement.begun,
                                 .target_before = before,
                                 .target_after = after,
                                 .moves_tried = search->tried,
                                 .moves_kept = search->kept,
                                 .thickness = search->clearance.level,
                                 .broken = broken,
                                 .apart_mm = apart,
                                 .stopped = refinement.stopped};
done:
    tree_release(&made);
    release(&refinement);
    return status;
}
