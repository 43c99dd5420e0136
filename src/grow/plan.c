/* plan_make goes from the cheap to the dear. It asks the grid whether the point is far enough from
 * the tree; collects the nearest segments (find_near) and what connecting to each would cost, to
 * first order (collect); and then takes these connections cheapest first (choose): optimises the
 * bifurcation, and tests whether the domain holds the segments and whether they are clear of
 * others. The first that passes is taken, so most of the dear tests are never made. */
#include "grow/plan.h"

#include "grow/mates.h"
#include <stdlib.h>
#include <string.h>

/* Directions in which a mate is sought. */
enum { DIRECTIONS = 8 };

/* What is planned: a terminal, mm, of the tree `tree`, or of any if that is -1, and how far from
 * the tree it has to be, mm. */
typedef struct Wish {
    Vec3 terminal;
    int32_t tree;
    double distance;
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

/* Finds the nearest segments; -1 when that needs more than what is within `within` mm. Looks first
 * as far as was enough for the last points, and a little more. */
static int find_near(const Site *site, Planner *planner, double within, Vec3 terminal)
{
    const Grid *grid = site->grid;
    int limit = site->candidates;
    double reach = planner->reach;
    int count = limit;
    if (!(reach + grid->edge < within) ||
        !grid_nearest_quick(grid, terminal, reach, limit, planner->near))
        count = grid_nearest(grid, terminal, within, limit, planner->near);
    if (count < limit)
        return count;
    double last = sqrt((double)planner->near[limit - 1].distance2);
    planner->reach += (reach > 0 ? 0.1 : 1) * (1.25 * last - reach);
    return last + 2 * grid->edge < within ? count : -1; /* whichever search it was */
}

/* What the nearest segments have to offer to a terminal: their connections are in the planner. */
typedef struct Offers {
    int count;   /* of connections */
    bool ahead;  /* whether a tree is among them that may get no more terminals for now */
    bool beyond; /* whether that cannot be told within the zone */
} Offers;

static Offers collect(const Site *site, Planner *planner, Box zone, const size_t *left,
                      const Wish *wish)
{
    Offers out = {0};
    Vec3 terminal = wish->terminal;
    int near = find_near(site, planner, grid_clearance(zone, terminal), terminal);
    out.beyond = near < 0;
    for (int i = 0; i < near && !out.beyond; i++) {
        int32_t segment = planner->near[i].segment, tree = network_tree(site->net, segment);
        bool spent = left[tree] == 0;
        if (wish->tree >= 0 && tree != wish->tree)
            continue;
        out.ahead |= spent;
        out.beyond = (spent && site->limit[tree] > 0) ||
                     !grid_zone_holds(site->grid, zone, &site->grid->item[segment]);
        if (!spent && !out.beyond &&
            connection_may_split(site->net, site->grid, site->rules, segment) &&
            connection_estimate(site->net, site->rules, segment, terminal,
                                &planner->connection[out.count]))
            out.count++;
    }
    return out;
}

/* The cheapest of the planner's connections with room, or why there is none. */
static PlanState choose(const Site *site, Planner *planner, Box zone, Vec3 terminal, Offers offers,
                        Connection *out)
{
    Connection *connection = planner->connection;
    bool inside = false, outside = false, settles = domain_settles(site->domain);
    for (int count = offers.count; count > 0; count--) {
        int best = cheapest(connection, count);
        *out = connection[best];
        connection[best] = connection[count - 1];
        if (!connection_optimise(site->net, site->rules, terminal, out))
            continue;
        if (settles && !connection_settle(site->net, site->rules, site->domain, terminal, out)) {
            outside = true; /* no place on the surface is good */
            continue;
        }
        if (!connection_is_inside(site->net, site->domain, out, terminal)) {
            outside = true;
            continue;
        }
        inside = true;
        ConnectionClearance room =
            connection_clearance(site->net, site->grid, site->rules, zone, out, terminal);
        if (room != CONNECTION_BLOCKED)
            return room == CONNECTION_CLEAR ? PLAN_READY : PLAN_BEYOND;
    }
    return offers.ahead ? PLAN_AHEAD : outside && !inside ? PLAN_OUTSIDE : PLAN_CROWDED;
}

/* The toss distance at a point: terminals that are to stand half as densely are further apart. */
static double toss_distance_at(const Site *site, Vec3 point)
{
    const double most = 8;
    if (!site->demand)
        return site->toss_distance;
    double share = demand_at(site->demand, point);
    double spread = site->domain->dimension == 2 ? 1 / sqrt(share) : 1 / elementary_cbrt(share);
    return site->toss_distance * fmin(spread, most);
}

static PlanState plan(const Site *site, Planner *planner, Box zone, const size_t *left,
                      const Wish *wish, Connection *out)
{
    if (!(grid_clearance(zone, wish->terminal) > wish->distance))
        return PLAN_BEYOND;
    GridVicinity room = grid_vicinity(site->grid, wish->terminal, wish->distance,
                                      site->terminals_only, site->rules->thickness);
    if (room != GRID_FREE)
        return room == GRID_TOO_NEAR ? PLAN_TOO_NEAR : PLAN_IN_VESSEL;
    Offers offers = collect(site, planner, zone, left, wish);
    return offers.beyond ? PLAN_BEYOND : choose(site, planner, zone, wish->terminal, offers, out);
}

PlanState plan_make(const Site *site, Planner *planner, Box zone, const size_t *left, Vec3 terminal,
                    Connection *out)
{
    const Wish wish = {terminal, -1, toss_distance_at(site, terminal)};
    return plan(site, planner, zone, left, &wish, out);
}

/* A stream of its own for every place, so that it does not depend on what was planned before. */
static Random random_at(Vec3 place)
{
    uint64_t bits[3];
    Random random;
    memcpy(bits, &place, sizeof bits);
    random_seed(&random,
                bits[0] ^ (bits[1] << 21 | bits[1] >> 43) ^ (bits[2] << 42 | bits[2] >> 22));
    return random;
}

PlanState plan_pair(const Site *site, Planner *planner, Box zone, const size_t *left, Vec3 terminal,
                    PlanPair *out)
{
    const Wish first = {terminal, 0, toss_distance_at(site, terminal)};
    PlanState state = plan(site, planner, zone, left, &first, &out->connection[0]);
    if (state != PLAN_READY)
        return state;
    Random random = random_at(terminal);
    out->terminal[0] = terminal;
    for (int k = 0; k < DIRECTIONS; k++) {
        const Wish second = {
            mates_place(terminal, site->rules->pair, site->domain->dimension, &random), 1, 0};
        if (!domain_inside(site->domain, second.terminal, 0))
            continue;
        out->terminal[1] = second.terminal;
        state = plan(site, planner, zone, left, &second, &out->connection[1]);
        if (state == PLAN_BEYOND ||
            (state == PLAN_READY &&
             connections_are_clear(site->net, site->rules, out->connection, out->terminal)))
            return state;
    }
    return PLAN_CROWDED;
}
