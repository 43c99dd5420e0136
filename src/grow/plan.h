/* Plans whether and where a random point is connected to the tree. Planning changes nothing, so
 * that threads can plan points far apart at the same time.
 *
 * A plan either finds a connection (PLAN_READY) or states why there is none. Planning reads only
 * segments in the plan's zone, a box of grid cells. */
#ifndef CORCAST_GROW_PLAN_H
#define CORCAST_GROW_PLAN_H

#include "grow/connection.h"
#include "grow/site.h"

/* The result of a plan. */
typedef enum PlanState {
    PLAN_BEYOND,   /* undecided: a decision needs cells outside the zone, or more terminals than are
                    * left */
    PLAN_TOO_NEAR, /* nearer to the tree than the toss distance */
    PLAN_IN_VESSEL, /* far enough from all centrelines, but inside a thick vessel */
    PLAN_AHEAD,     /* next to a tree that may get no more terminals for now [forest.h] */
    PLAN_OUTSIDE,   /* every connection leaves the domain */
    PLAN_CROWDED,   /* every connection is blocked by other vessels or too short */
    PLAN_READY,     /* there is a connection */
    PLAN_STATES
} PlanState;

/* What all points of a round [round.h] have in common. The network has the values of the last
 * network_refresh and the splits since then; the grid holds its segments. All pointers are
 * borrowed. */
typedef struct PlanCommon {
    Site *site;
    size_t *limit;        /* per tree: how many more terminals it may get */
    double toss_distance; /* mm; minimum distance of a new terminal from the tree where demand is
                           * greatest; larger elsewhere */
    const Demand *demand; /* map of the density of terminals; NULL: the same everywhere */
    bool terminals_only;  /* the toss distance is kept from terminals' ends, not from segments */
    int candidates;       /* number of nearest segments that are tried */
} PlanCommon;

/* Where points are planned. */
typedef struct Plan {
    const PlanCommon *common;
    Box zone;           /* plans read nothing outside of it */
    const size_t *left; /* per tree: how many terminals it may still get here, at most its limit */
} Plan;

/* The workspace of one thread. */
typedef struct Planner {
    Near *near;             /* the nearest segments of the present point */
    Connection *connection; /* their connections */
    double reach;           /* mm; estimated distance of the nearest segments, which adapts from
                             * point to point; 0: none yet. The caller sets the first. */
} Planner;

/* Allocates arrays for `candidates` nearest segments. *planner is zeroed before; release it with
 * planner_release, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status planner_init(Planner *planner, int candidates, Err *err);
void planner_release(Planner *planner);

/* Plans the connection of `terminal`, mm, which is in the zone: the cheapest of its candidates that
 * keeps the rules. If the rules pair terminals (rules.pair > 0), plans the connection of `terminal`
 * to the first tree, and the connection of a mate of the terminal to the second tree. Tries mates
 * in 8 random directions, which depend only on the position of `terminal`.
 *
 * connection   receives the connection and, for pairs, the mate's connection in [1]; undefined
 *              unless the result is PLAN_READY.
 * Threads      Threads may plan at the same time, each with a planner of its own. */
PlanState plan_make(const Plan *plan, Planner *planner, Vec3 terminal, Connection connection[2]);

#endif
