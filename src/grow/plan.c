/* Connections are tested for room cheapest first, so most tests are never made. */
#include "grow/plan.h"

#include <stdlib.h>

Status planner_init(Planner *planner, int candidates, Err *err)
{
    size_t n = (size_t)candidates;
    *planner = (Planner){.status = STATUS_OK};
    TRY(mem_calloc(&planner->near, n, sizeof *planner->near, "candidates", err));
    return mem_calloc(&planner->connection, n, sizeof *planner->connection, "candidates", err);
}

void planner_release(Planner *planner)
{
    free(planner->near);
    free(planner->connection);
    footprint_release(&planner->footprint);
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

/* Whether plan->connection is free. If so, notes the cells in which nothing may change before it is
 * made: those it changes itself, and those in which a segment would be too near to the terminal. */
static Status claim(const Site *site, Planner *planner, Plan *plan, bool *is_free, Err *err)
{
    Footprint *footprint = &planner->footprint;
    plan->first_cell = footprint->n;
    TRY(place_is_free(site->net, site->grid, site->rules, &plan->connection, plan->terminal,
                      footprint, is_free, err));
    plan->end_changed = footprint->n;
    if (*is_free)
        TRY(footprint_add_box(footprint, site->grid,
                              grid_box(site->grid, plan->terminal, site->toss_distance), err));
    plan->end_cell = footprint->n;
    return STATUS_OK;
}

/* Sets plan->connection to the cheapest with room, or tells why there is none. */
static Status choose(const Site *site, Planner *planner, Plan *plan, Err *err)
{
    Connection *connection = planner->connection;
    int near = grid_nearest(site->grid, plan->terminal, site->candidates, planner->near);
    int count = 0;
    bool ahead = false;
    for (int i = 0; i < near; i++) {
        int32_t segment = planner->near[i].segment;
        if (site->limit[network_tree(site->net, segment)] == 0)
            ahead = true;
        else if (place_is_splittable(site->net, site->grid, site->rules, segment) &&
                 place_connection(site->net, site->rules, segment, plan->terminal,
                                  &connection[count]))
            count++;
    }
    bool inside = false, outside = false, is_free = false;
    for (; count > 0 && !is_free; count--) {
        int best = cheapest(connection, count);
        plan->connection = connection[best];
        connection[best] = connection[count - 1];
        if (!place_settle(site->net, site->rules, plan->terminal, &plan->connection))
            continue;
        if (place_is_inside(site->net, site->domain, &plan->connection, plan->terminal)) {
            inside = true;
            TRY(claim(site, planner, plan, &is_free, err));
        } else {
            outside = true;
        }
    }
    plan->state = is_free              ? PLAN_READY
                  : ahead              ? PLAN_AHEAD
                  : outside && !inside ? PLAN_OUTSIDE
                                       : PLAN_CROWDED;
    return STATUS_OK;
}

void plan_make(const Site *site, Planner *planner, Plan *plan)
{
    GridRoom room = grid_room(site->grid, plan->terminal, site->toss_distance, site->terminals_only,
                              site->rules->thickness);
    plan->state = room == GRID_TOO_NEAR ? PLAN_TOO_NEAR : PLAN_IN_VESSEL;
    if (room != GRID_FREE || planner->status != STATUS_OK)
        return;
    planner->status = choose(site, planner, plan, &planner->err);
}
