/* Grows arterial trees by constrained constructive optimisation (CCO): random points of the domain
 * become terminals, each connected where that raises the target least [docs/METHODS.md 1.2].
 *
 * Terminals are added in rounds (add_terminals) until there are enough. A round calls:
 *
 * - check_range: ends growth if the radii span more than a double can hold.
 * - keep_up: updates sums, radii and weights after every fifth of growth. Whenever the number of
 *   terminals has doubled, it makes a new grid and, in small trees, relaxes bifurcations
 *   [repair.c].
 * - run_round: draws random points (tosses), and connects those that can be connected [round.c],
 *   each to the one of its nearest segments where that is cheapest, if there is space [plan.c].
 * - adapt_toss_distance: controls the minimum distance of points from the tree (the toss distance)
 *   so that one point in three is far enough. The distance falls as the tree fills the domain. It
 *   also falls if no connection of the points stays in the domain, because points nearer to the
 *   tree may have one.
 * - be_patient: if hardly any point finds space at the vessels' real thickness, counts vessels as
 *   half as thick, finally only their centrelines, and then gives up.
 *
 * At the end all radii are computed again, the few segments that widened too much are repaired
 * [repair.c], and the network becomes a Tree [finish.c].
 *
 * The domain has its final size from the beginning. In the original method the domain grows with
 * the tree. Scaling all lengths scales all costs by the same factor, so the choices are the
 * same. */
#include "grow/grow.h"

#include "grow/continue_tree.h"
#include "grow/finish.h"
#include "grow/first_segments.h"
#include "grow/forest.h"
#include "grow/mates.h"
#include "grow/repair.h"
#include "grow/round.h"
#include "grow/segment_weights.h"
#include <stdlib.h>

/* Number of grid cells per terminal when a grid is made. A new grid is made whenever the number of
 * terminals has doubled. */
static const double cells_per_terminal = 1;
/* Factor by which the number of terminals grows until radii and sensitivities are computed again.
 * Larger factors save time, but candidates are then chosen by older values. With 1.2, the refreshes
 * of the whole growth process 1 / (1 - 1 / 1.2) = 6 times as many segments as the last one. */
static const double refresh_growth = 1.2;
/* The same if growth ends at a mean terminal radius (min_radius_mm), which is only known after a
 * refresh. */
static const double fine_growth = 1.03;
/* Vessels of different trees keep this many times clearance_mm apart, because they still widen. */
static const double clearance_spare = 1.05;
/* A round adds about one terminal for every TERMINALS_PER_ADDED that there are. The terminals of a
 * round do not know each other's effect on the sums near the root; smaller rounds cost time. In
 * tiles [round.c], a round must have enough points for each tile. */
enum { TERMINALS_PER_ADDED = 64, TERMINALS_PER_ADDED_IN_TILES = 12 };
/* Random points drawn per terminal that should be added. */
enum { TOSSES_PER_ADDED = 3 };
/* Fraction by which the toss distance falls after a round in which no point is far enough from the
 * tree. With tiles there are fewer rounds until the tree has doubled, so that each must adapt the
 * distance more. */
static const double toss_notch = 0.1, toss_notch_in_tiles = 0.5;
/* Segments are no shorter than this share of the toss distance. */
static const double least_length_share = 0.1;
/* With fewer terminals, the grid's cells are so large that a few points without space do not mean
 * that a cell is full. */
enum { LEAST_WITH_FULL_CELLS = 1000 };
/* After PATIENCE crowded points (without space for a connection) in succession, vessels count as
 * half as thick; below least_thickness they count as lines. After LAST_PATIENCE such points the
 * domain counts as full. Larger numbers waste time in a full domain, smaller ones give up by bad
 * luck. */
enum { PATIENCE = 200, LAST_PATIENCE = 20000 };
/* Growth ends after this many rounds in succession that added nothing, for any reason. */
enum { IDLE_ROUNDS = 5000 };
static const double least_thickness = 1.0 / 64;
/* Memory that growth needs for each terminal, as measured with 10^6 and with 10^7 terminals. */
static const double bytes_per_terminal = 340;

/* The state of growth. */
typedef struct Growth {
    const GrowParams *params;
    Site site;
    double size; /* of the domain's box, mm; on a surface, of vessels */
    Forest forest;
    Random random;
    /* Numbers of terminals at which a new grid is made, radii are refreshed, and bifurcations
     * are relaxed. */
    size_t grid_until, refresh_until, relax_until;
    double toss_distance; /* mm */
    Round round;
    double skipped; /* share of the last round's points that were in full cells */
    uint64_t tosses, rejected;
    double end_radius;       /* mm; the terminals' mean as of the last refresh */
    size_t crowded, outside; /* points far enough from the tree since one was connected */
    size_t idle;             /* rounds since one was connected */
} Growth;

/* Returns the maximum number of terminals that one round adds to a tree of `terminals`. */
static size_t most_added(size_t terminals)
{
    return 2 * (terminals / TERMINALS_PER_ADDED_IN_TILES + 1);
}

/* Makes a grid for up to twice the present number of terminals, and enters all segments. Renumbers
 * the nodes first, so that neighbours in the tree are neighbours in memory. */
static Status make_grid(Growth *growth, Err *err)
{
    Network *net = &growth->site.net;
    size_t terminals = net->terminals;
    grid_release(&growth->site.grid);
    TRY(network_reorder(net, err));
    growth->grid_until = 2 * terminals;
    size_t most = growth->grid_until + most_added(growth->grid_until);
    if (most > growth->params->terminals)
        most = growth->params->terminals;
    TRY(grid_reset(&growth->site.grid, growth->site.domain->bounds,
                   cells_per_terminal * (double)terminals, net->n + 2 * (most - terminals),
                   growth->round.threads, err));
    TRY(round_use_grid(&growth->round, &growth->site.grid, err));
    for (size_t i = 0; i < net->n; i++)
        if (net->segment[i].parent >= 0)
            TRY(site_enter(&growth->site, (int32_t)i, err));
    return STATUS_OK;
}

/* Brings sums and radii up to date, and weights where they are needed. */
static Status refresh(Growth *growth, WeightsPrecision precision, Err *err)
{
    if (weights_are_needed(growth->params))
        return weights_refresh(&growth->site.net, growth->params, growth->site.domain, precision,
                               err);
    network_refresh(&growth->site.net, growth->round.threads);
    return STATUS_OK;
}

/* Returns the mean radius of the terminals whose radii follow the law, mm; 0 if there are none. */
static double mean_end_radius(const Network *net)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < net->n; i++)
        if (network_is_terminal(net, (int32_t)i) && network_kept_radius(net, (int32_t)i) == 0) {
            sum += (double)net->segment[i].radius;
            count++;
        }
    return count > 0 ? sum / (double)count : 0;
}

/* Moves all bifurcations to better positions, if the tree has at most params->relax terminals. */
static Status relax(Growth *growth, Err *err)
{
    Network *net = &growth->site.net;
    if (net->terminals > growth->params->relax || !growth->site.grid.item || net->trunk)
        return STATUS_OK;
    growth->relax_until = 2 * net->terminals;
    TRY(relax_network(&growth->site, err));
    network_refresh(net, growth->round.threads);
    return site_update_radii(&growth->site, err);
}

/* Updates sums, radii, weights, relaxed bifurcations and the grid, each when it is due. */
static Status keep_up(Growth *growth, Err *err)
{
    Network *net = &growth->site.net;
    size_t terminals = net->terminals;
    if (terminals >= growth->refresh_until) {
        TRY(refresh(growth, WEIGHTS_ROUGH, err));
        if (growth->site.grid.item)
            TRY(site_update_radii(&growth->site, err));
        if (terminals >= growth->relax_until)
            TRY(relax(growth, err));
        if (growth->params->min_radius_mm > 0)
            growth->end_radius = mean_end_radius(net);
        /* With min_radius_mm, radii are refreshed more often, so that growth ends near it. */
        double factor = growth->params->min_radius_mm > 0 ? fine_growth : refresh_growth;
        growth->refresh_until = (size_t)(factor * (double)terminals) + 1;
    }
    return terminals >= growth->grid_until ? make_grid(growth, err) : STATUS_OK;
}

/* Sets the toss distance, and the minimum length of segments, which is a share of it. */
static void set_toss_distance(Growth *growth, double distance)
{
    growth->toss_distance = fmin(distance, growth->size);
    growth->site.rules.min_length = least_length_share * growth->toss_distance;
}

/* Returns the map of the density of terminals; NULL: the same density everywhere. */
static const Demand *density(const GrowParams *params)
{
    return params->blood.terminal_flow == TERMINAL_FLOW_DEMAND ? NULL : params->demand;
}

/* Draws a random point, with a probability proportional to the density map. The mean of a map is at
 * least 1e-4 of its maximum (demand_check), so that the probability that MOST_TOSSES draws all fail
 * is e^-100; then the last point is used. */
static Vec3 toss(Growth *growth)
{
    enum { MOST_TOSSES = 1000000 };
    const Demand *demand = growth->params->demand;
    bool dense = density(growth->params) != NULL;
    Vec3 point;
    for (int i = 0; i < MOST_TOSSES; i++) {
        growth->tosses++;
        point = domain_sample(growth->site.domain, &growth->random);
        if (!demand || demand_at(demand, point) > (dense ? random_uniform(&growth->random) : 0))
            break;
    }
    return point;
}

/* Returns the number of terminals the next round should add. */
static size_t to_be_added(const Growth *growth, bool tiled)
{
    size_t terminals = growth->site.net.terminals, left = growth->params->terminals - terminals;
    size_t added = terminals / (tiled ? TERMINALS_PER_ADDED_IN_TILES : TERMINALS_PER_ADDED);
    added = added < 1 ? 1 : added;
    added += growth->site.rules.pair_mm > 0 ? added % 2 : 0;
    return added < left ? added : left;
}

/* Tosses points for about `added` terminals and connects those that can be connected. */
static Status run_round(Growth *growth, size_t added, Err *err)
{
    const GrowParams *params = growth->params;
    Site *site = &growth->site;
    Round *round = &growth->round;
    size_t left = params->terminals - site->net.terminals;
    double tosses = site->rules.pair_mm > 0 ? TOSSES_PER_ADDED / 2.0 : TOSSES_PER_ADDED;
    size_t points = (size_t)(tosses * (double)added / (1 - fmin(growth->skipped, 0.75)));
    TRY(round_start(round, points, err));
    for (size_t i = 0; i < points; i++)
        round->point[i] = toss(growth);
    forest_limit(&growth->forest, site->net.terminals);
    const PlanCommon common = {.site = site,
                               .limit = growth->forest.limit,
                               .toss_distance = growth->toss_distance,
                               .demand = density(params),
                               .terminals_only = params->toss == GROW_TOSS_TERMINAL,
                               .candidates = params->candidates};
    const RoundLimits limits = {.most = 2 * added < left ? 2 * added : left,
                                .skip = site->net.terminals >= LEAST_WITH_FULL_CELLS};
    TRY(round_run(round, &common, limits, err));
    forest_count(&growth->forest);
    network_add_terminals(&site->net, round->connected);
    growth->skipped = (double)round->count[PLAN_STATES] / (double)points;
    return STATUS_OK;
}

/* Steers the share of points that are far enough from the tree to one in TOSSES_PER_ADDED. */
static void adapt_toss_distance(Growth *growth, bool tiled)
{
    const size_t *count = growth->round.count;
    size_t far = count[PLAN_CROWDED] + count[PLAN_READY];
    double free = (double)(far + count[PLAN_TOO_NEAR] + count[PLAN_OUTSIDE]);
    if (free > 0) {
        double share = TOSSES_PER_ADDED * (double)far / free;
        double notch = tiled ? toss_notch_in_tiles : toss_notch;
        set_toss_distance(growth, growth->toss_distance * (1 + notch * (share - 1)));
    }
}

/* Counts the points that were not connected. When there are too many in succession, counts vessels
 * as thinner, and at last ends growth with STATUS_INFEASIBLE. */
static Status be_patient(Growth *growth, Err *err)
{
    Rules *rules = &growth->site.rules;
    const size_t *count = growth->round.count, made = growth->round.connected;
    size_t before = growth->crowded, troubled = growth->crowded + growth->outside;
    size_t crowded = count[PLAN_STATES] + count[PLAN_IN_VESSEL] + count[PLAN_CROWDED];
    growth->rejected += crowded + count[PLAN_OUTSIDE];
    growth->crowded += crowded;
    growth->outside += count[PLAN_OUTSIDE] + count[PLAN_AHEAD];
    if (made * PATIENCE > growth->crowded) {
        growth->crowded = growth->outside = 0;
    } else if (growth->crowded / PATIENCE > before / PATIENCE) {
        rules->thickness = rules->thickness > least_thickness ? rules->thickness / 2 : 0;
        TRY(round_use_grid(&growth->round, &growth->site.grid, err));
    }
    growth->idle = made > 0 ? 0 : growth->idle + 1;
    bool is_patient = troubled == 0 || growth->crowded + growth->outside < LAST_PATIENCE;
    if (is_patient && growth->idle < IDLE_ROUNDS)
        return STATUS_OK;
    size_t farthest = 0, outside = 0;
    double mm = 0;
    if (growth->params->from)
        outside = continue_count_outside(growth->params->from, growth->site.domain, &farthest, &mm);
    if (outside > 0)
        return err_set(
            err, STATUS_INFEASIBLE,
            "gave up placing terminal %zu of `terminals` %zu after %zu attempts: the domain does "
            "not contain the tree of `from`; %zu of %zu nodes are outside, node %d by %.3g mm",
            growth->site.net.terminals + 1, growth->params->terminals,
            growth->crowded + growth->outside, outside, growth->params->from->n,
            growth->params->from->id[farthest], mm);
    bool shut_out = rules->pair_mm > 0 && growth->site.domain->dimension == 2;
    return err_set(err, STATUS_INFEASIBLE,
                   "gave up placing terminal %zu of `terminals` %zu after %zu attempts: %s",
                   growth->site.net.terminals + 1, growth->params->terminals,
                   growth->crowded + growth->outside,
                   shut_out ? "in a plane, two trees that must not cross block each other; "
                              "`pair_mm` needs a `domain` of three dimensions"
                            : "lower `terminals`, choose a larger `domain`, or move `gamma` and "
                              "`lambda` towards 3 and 2");
}

static Status check_range(const Growth *growth, Err *err)
{
    double cost = network_cost(&growth->site.net);
    if (cost > 0 && isfinite(cost))
        return STATUS_OK;
    return err_set(err, STATUS_INFEASIBLE,
                   "with this `gamma` and `lambda` %g the radii of %zu terminals span more than a "
                   "double can hold; move `gamma` towards 3, or lower `lambda`",
                   growth->params->lambda, growth->params->terminals);
}

static Status add_terminals(Growth *growth, Err *err)
{
    TRY(check_range(growth, err));
    TRY(keep_up(growth, err));
    bool tiled = growth->round.is_tiled && growth->crowded + growth->outside == 0;
    TRY(run_round(growth, to_be_added(growth, tiled), err));
    adapt_toss_distance(growth, tiled);
    return be_patient(growth, err);
}

/* Begins a new tree at each inlet. */
static Status start_trees(Growth *growth, Err *err)
{
    const GrowParams *params = growth->params;
    Network *net = &growth->site.net;
    FirstTosses tosses = {&growth->random, growth->toss_distance, 0};
    if (params->inlets == 0)
        network_append(net, -1, growth->site.domain->inlet);
    for (size_t k = 0; k < params->inlets; k++)
        network_append(net, -1, params->inlet[k]);
    TRY(first_segments_add(&growth->site, &tosses, err));
    growth->tosses += tosses.count;
    if (domain_has_projection(growth->site.domain)) /* where no straight vessel is longer */
        growth->size = tosses.distance;
    set_toss_distance(growth, tosses.distance);
    return STATUS_OK;
}

/* Shares the terminals among the trees of the network. */
static Status start_forest(Growth *growth, Err *err)
{
    const GrowParams *params = growth->params;
    const Network *net = &growth->site.net;
    Forest *forest = &growth->forest;
    double share[GROW_MAX_INLETS];
    for (size_t k = 0; k < net->inlets; k++)
        share[k] = params->inlet_shares > 0 ? params->inlet_share[k]
                   : params->from           ? net->segment[net->inlet[k]].terminals
                                            : 1;
    TRY(forest_init(forest, net->inlets, share, params->terminals, err));
    for (size_t k = 0; k < net->inlets; k++) {
        int has = net->segment[net->inlet[k]].terminals;
        forest->has[k] = (size_t)has;
        if ((size_t)has > forest->quota[k])
            return err_set(err, STATUS_USAGE,
                           "`inlet_shares`: tree %zu of `from` already has %d terminals; its share "
                           "of `terminals` %zu allows only %zu",
                           k + 1, has, params->terminals, forest->quota[k]);
    }
    return STATUS_OK;
}

static Status start(Growth *growth, Err *err)
{
    const GrowParams *params = growth->params;
    Box box = growth->site.domain->bounds;
    growth->size = vec3_distance(box.low, box.high);
    growth->site.rules = (Rules){.thickness = 1,
                                 .gap = 1e-7 * growth->size,
                                 .tree_gap = clearance_spare * params->clearance_mm,
                                 .pair_mm = params->pair_mm,
                                 .max_radius = growth->size};
    set_toss_distance(growth, growth->size);
    growth->refresh_until = growth->grid_until = 1;
    /* A tree that is continued was often grown with the same seed. Its length changes the seed, so
     * that the random points differ from those that made the tree. */
    uint64_t turn = params->from ? 0x9e3779b97f4a7c15 * (uint64_t)params->from->n : 0;
    random_seed(&growth->random, params->seed ^ turn);
    int threads = params->threads > 0 ? params->threads : threads_available();
    size_t inlets = params->from ? continue_count_roots(params->from) : params->inlets;
    inlets = inlets > 0 ? inlets : 1;
    TRY(round_init(&growth->round, params->candidates, inlets, threads, err));

    double drop = pa_from_mmhg(params->blood.p_perf_mmhg) - pa_from_mmhg(params->blood.p_term_mmhg);
    double scale = law_radius_unit(weights_reference_pa_s(params),
                                   mm3_s_from_ml_min(params->blood.q_perf_ml_min), drop);
    bool traits = params->from || params->inlets > 1 || weights_are_needed(params);
    size_t given = params->from ? params->from->n : 0;
    const NetworkSize size = {given + 2 * params->terminals, inlets, traits};
    TRY(network_init(&growth->site.net, (Law){params->gamma.value[0], params->lambda}, scale, size,
                     err));
    if (params->keep_radii)
        TRY(network_add_trunk(&growth->site.net, err));
    if (params->from)
        continue_copy(params->from, &growth->site.net);
    else
        TRY(start_trees(growth, err));
    return start_forest(growth, err);
}

/* Returns true if the terminals' mean radius has come down to min_radius_mm. */
static bool is_fine_enough(const Growth *growth)
{
    return growth->end_radius > 0 && growth->end_radius <= growth->params->min_radius_mm;
}

/* Proves the clearance of different trees and the distance of pairs, if the parameters
 * require them. */
static Status check_apart(const GrowParams *params, const Tree *tree, double *apart, Err *err)
{
    *apart = INFINITY;
    if (!(params->clearance_mm > 0) && !(params->pair_mm > 0))
        return STATUS_OK;
    if (params->pair_mm > 0)
        TRY(mates_check(params, tree, err));
    return trees_prove_clearance(
        tree, params->clearance_mm, fmax(2 * params->clearance_mm, params->pair_mm),
        "; lower `terminals` or `q_perf`, or choose a larger `domain`", apart, err);
}

/* Number of terminals from one report of progress to the next. */
enum { TERMINALS_PER_REPORT = 256 };

static Status report_progress(const Growth *growth, size_t before, Err *err)
{
    const GrowParams *params = growth->params;
    const size_t terminals = growth->site.net.terminals;
    if (!params->progress || terminals / TERMINALS_PER_REPORT == before / TERMINALS_PER_REPORT)
        return STATUS_OK;
    const double fraction = (double)terminals / (double)params->terminals;
    return params->progress(fraction, params->progress_context) ? STATUS_OK : err_cancelled(err);
}

static double target_of(const Tree *tree)
{
    double target = 0;
    for (size_t i = 0; i < tree->n; i++)
        target += tree_segment_length(tree, i) *
                  elementary_pow(tree->radius_mm[i], tree->meta.number[META_LAMBDA]);
    return target;
}

Status grow_tree(const GrowParams *params, const Domain *domain, Tree *out, GrowReport *report,
                 Err *err)
{
    TRY(grow_params_check(params, domain, err));
    TRY(mem_check(bytes_per_terminal * (double)params->terminals, "the tree", err));
    double begun = clock_seconds();
    Growth growth = {.params = params, .site.domain = domain};
    Tree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(start(&growth, err));
    size_t terminals;
    while ((terminals = growth.site.net.terminals) < params->terminals &&
           !is_fine_enough(&growth)) {
        status = add_terminals(&growth, err);
        if (status == STATUS_INFEASIBLE && params->partial)
            break;
        TRY_GOTO(status);
        TRY_GOTO(report_progress(&growth, terminals, err));
    }
    bool complete = status == STATUS_OK;
    size_t broken = 0;
    TRY_GOTO(refresh(&growth, WEIGHTS_FINE, err));
    TRY_GOTO(check_range(&growth, err));
    TRY_GOTO(relax(&growth, err));
    if (growth.site.grid.item)
        TRY_GOTO(repair_network(&growth.site, growth.round.threads, &broken, err));
    grid_release(&growth.site.grid);
    TRY_GOTO(finish_tree(&growth.site.net, params, domain, &made, err));
    double apart;
    TRY_GOTO(check_apart(params, &made, &apart, err));
    GrowReport found = {.seconds = clock_seconds() - begun,
                        .terminals = growth.site.net.terminals,
                        .target = target_of(&made),
                        .root_radius_mm = tree_root_radius(&made),
                        .tosses = growth.tosses,
                        .rejected = growth.rejected,
                        .thickness = growth.site.rules.thickness,
                        .broken = broken,
                        .apart_mm = apart,
                        .complete = complete};
    if (report && params->from)
        TRY_GOTO(continue_radius_changes(params->from, &made, &found, err));
    if (report)
        *report = found;
    *out = made;
    made = (Tree){0};
done:
    tree_release(&made);
    round_release(&growth.round);
    grid_release(&growth.site.grid);
    forest_release(&growth.forest);
    network_release(&growth.site.net);
    return status;
}
