/* Plans the connection of a random point to the tree, and of its mate if terminals come in pairs.
 *
 * Cheap tests come first. plan_make searches the grid for segments that are too near to the point.
 * It then finds the nearest segments and what a connection to each of them would cost, to first
 * order (collect). It then takes these connections, cheapest first (choose): optimises the
 * bifurcation, and tests whether the segments are in the domain and clear of other segments. The
 * first connection that passes is used, so that most of the expensive tests are never made. */
#include "grow/plan.h"

#include "grow/mates.h"
#include <stdlib.h>
#include <string.h>

/* Maximum number of random directions in which a mate is searched. More let pairs fit into narrower
 * gaps, and take more time in a full domain. */
enum { DIRECTIONS = 8 };

/* The terminal that is planned. */
typedef struct Wish {
    Vec3 terminal;   /* mm */
    int32_t tree;    /* index of the tree that gets it; -1: any tree */
    double distance; /* its minimum distance from the trees, mm */
} Wish;

Status planner_init(Planner *planner, int candidates, Err *err)
{
    size_t n = (size_t)candidates;
    TRY(mem_calloc(&planner->near, n, sizeof *planner->near, "candidates", err));
    return mem_calloc(&planner->connection, n, sizeof *planner->connection, "candidates", err);
}

void planner_release(Planner *planner)
{
    free(planner->near);
    free(planner->connection);
    *planner = (Planner){0};
}

static int cheapest(const Connection *connection, int count)
{
    int best = 0;
    for (int i = 1; i < count; i++)
        if (connection[i].price < connection[best].price)
            best = i;
    return best;
}

/* The candidates of a terminal. Their connections are in the planner. */
typedef struct Offers {
    int count;   /* number of connections */
    bool ahead;  /* a candidate belongs to a tree that may get no more terminals for now */
    bool beyond; /* undecided, because segments outside the zone would have to be known */
} Offers;

/* Finds the nearest segments and estimates a connection to each. */
static Offers collect(const Plan *plan, Planner *planner, const Wish *wish)
{
    const Site *site = plan->common->site;
    Offers out = {0};
    double within = grid_clearance(plan->zone, wish->terminal);
    int near = grid_nearest_adaptive(&site->grid, wish->terminal, within, plan->common->candidates,
                                     &planner->reach, planner->near);
    out.beyond = near < 0;
    for (int i = 0; i < near && !out.beyond; i++) {
        int32_t segment = planner->near[i].segment, tree = network_tree(&site->net, segment);
        bool spent = plan->left[tree] == 0;
        if (wish->tree >= 0 && tree != wish->tree)
            continue;
        out.ahead |= spent;
        out.beyond = (spent && plan->common->limit[tree] > 0) ||
                     !grid_zone_holds(&site->grid, plan->zone, &site->grid.item[segment]);
        if (!spent && !out.beyond && connection_may_split(site, segment) &&
            connection_estimate(site, segment, wish->terminal, &planner->connection[out.count]))
            out.count++;
    }
    return out;
}

/* Finds the cheapest of the planner's connections for which there is space. Returns PLAN_READY, or
 * the reason why there is none. */
static PlanState choose(const Plan *plan, Planner *planner, Offers offers, Connection *out)
{
    const Site *site = plan->common->site;
    Connection *connection = planner->connection;
    bool inside = false, outside = false, settles = domain_has_projection(site->domain);
    for (int count = offers.count; count > 0; count--) {
        int best = cheapest(connection, count);
        *out = connection[best];
        connection[best] = connection[count - 1];
        if (!connection_optimise(site, out))
            continue;
        bool is_on_surface = !settles || connection_project(site, out);
        if (!is_on_surface || !connection_is_inside(site, out)) {
            outside = true;
            continue;
        }
        inside = true;
        ConnectionClearance room = connection_clearance(site, plan->zone, out);
        if (room != CONNECTION_BLOCKED)
            return room == CONNECTION_CLEAR ? PLAN_READY : PLAN_UNDECIDED;
    }
    return offers.ahead ? PLAN_AHEAD : outside && !inside ? PLAN_OUTSIDE : PLAN_CROWDED;
}

/* Returns the toss distance at a point, mm. Where the density of terminals is lower, the distance
 * is larger. */
static double toss_distance_at(const PlanCommon *common, Vec3 point)
{
    const double most =
        8; /* where the demand is near 0, points would otherwise never be accepted */
    if (!common->demand)
        return common->toss_distance;
    double share = demand_at(common->demand, point);
    bool is_flat = common->site->domain->dimension == 2;
    double spread = is_flat ? 1 / sqrt(share) : 1 / elementary_cbrt(share);
    return common->toss_distance * fmin(spread, most);
}

/* Plans the connection of one terminal. */
static PlanState connect(const Plan *plan, Planner *planner, const Wish *wish, Connection *out)
{
    const Site *site = plan->common->site;
    if (!(grid_clearance(plan->zone, wish->terminal) > wish->distance))
        return PLAN_UNDECIDED;
    GridVicinity room = grid_vicinity(&site->grid, wish->terminal, wish->distance,
                                      plan->common->terminals_only, site->rules.thickness);
    if (room != GRID_FREE)
        return room == GRID_TOO_NEAR ? PLAN_TOO_NEAR : PLAN_IN_VESSEL;
    Offers offers = collect(plan, planner, wish);
    return offers.beyond ? PLAN_UNDECIDED : choose(plan, planner, offers, out);
}

/* Returns a random number generator seeded by the bits of a point, so that the directions of a mate
 * do not depend on what was planned before. */
static Random random_at(Vec3 point)
{
    uint64_t bits[3];
    Random random;
    memcpy(bits, &point, sizeof bits);
    random_seed(&random,
                bits[0] ^ (bits[1] << 21 | bits[1] >> 43) ^ (bits[2] << 42 | bits[2] >> 22));
    return random;
}

/* Plans the mate, of the second tree, of a terminal whose connection is connection[0]. */
static PlanState plan_mate(const Plan *plan, Planner *planner, Vec3 terminal,
                           Connection connection[2])
{
    const Site *site = plan->common->site;
    Random random = random_at(terminal);
    for (int k = 0; k < DIRECTIONS; k++) {
        const Wish wish = {
            mates_place(terminal, site->rules.pair_mm, site->domain->dimension, &random), 1, 0};
        if (!domain_inside(site->domain, wish.terminal, 0))
            continue;
        PlanState state = connect(plan, planner, &wish, &connection[1]);
        if (state == PLAN_UNDECIDED ||
            (state == PLAN_READY && connections_are_clear(site, connection)))
            return state;
    }
    return PLAN_CROWDED;
}

PlanState plan_make(const Plan *plan, Planner *planner, Vec3 terminal, Connection connection[2])
{
    bool is_pair = plan->common->site->rules.pair_mm > 0;
    const Wish wish = {terminal, is_pair ? 0 : -1, toss_distance_at(plan->common, terminal)};
    PlanState state = connect(plan, planner, &wish, &connection[0]);
    return is_pair && state == PLAN_READY ? plan_mate(plan, planner, terminal, connection) : state;
}
