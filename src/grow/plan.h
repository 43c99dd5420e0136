/* Plans the connection of a random point to the tree: chooses the segment to split and the position
 * of the new bifurcation, or states why the point cannot be connected. round.h carries out the
 * connections.
 *
 * Planning does not change the tree, and reads only segments in the plan's zone, a box of grid
 * cells. Other threads can therefore change the tree outside the zone at the same time. */
#ifndef CORCAST_GROW_PLAN_H
#define CORCAST_GROW_PLAN_H

#include "grow/connection.h"
#include "grow/site.h"

/* The result of a plan: a connection, or the reason why the point has none. */
typedef enum PlanState {
    PLAN_UNDECIDED, /* undecided: the decision needs cells outside the zone, or a tree would get
                     * more terminals than Plan.left */
    PLAN_TOO_NEAR,  /* the point is nearer to the tree than the toss distance [PlanCommon] */
    PLAN_IN_VESSEL, /* the point is far enough from all axes, but inside a thick vessel */
    PLAN_AHEAD,     /* the point is next to a tree that has reached its limit [forest.h] */
    PLAN_OUTSIDE,   /* every connection leaves the domain */
    PLAN_CROWDED,   /* every connection is too short, or blocked by other vessels */
    PLAN_READY,     /* a connection was found */
    PLAN_STATES
} PlanState;

/* The inputs that all points of a round [round.h] share. All pointers are borrowed. */
typedef struct PlanCommon {
    Site *site;    /* its network has the sums and radii of the last network_refresh and of later
                    * splits; its grid holds all segments */
    size_t *limit; /* per tree: number of terminals that it may still get in this round */
    double toss_distance; /* mm; minimum distance of a new terminal from the tree where demand is
                           * greatest; the minimum is larger where demand is lower */
    const Demand *demand; /* map of the density of terminals; NULL: the same everywhere */
    bool terminals_only;  /* the toss distance is measured to the ends of terminals; false: to the
                           * axes of all segments */
    int candidates;       /* number of nearest segments that are tried */
} PlanCommon;

/* The region in which points are planned. */
typedef struct Plan {
    const PlanCommon *common;
    Box zone;           /* mm; segments outside it are not read */
    const size_t *left; /* per tree: number of terminals that it may still get in this region, a
                         * part of `limit` */
} Plan;

/* The workspace of one thread. */
typedef struct Planner {
    Near *near;             /* the nearest segments of the present point */
    Connection *connection; /* per segment in `near`: its connection */
    double reach;           /* mm; estimated distance of the nearest segments; plan_make adapts it
                             * from point to point. The caller sets the first; 0: unknown */
} Planner;

/* Allocates arrays for `candidates` nearest segments. *planner must be zeroed. Release it with
 * planner_release, also after an error. Errors: STATUS_MEMORY. */
MUST_CHECK Status planner_init(Planner *planner, int candidates, Err *err);
void planner_release(Planner *planner);

/* Plans the connection of a new terminal at `terminal`, mm, which must be in the zone. Chooses, of
 * the connections to the nearest segments, the cheapest that keeps the rules.
 *
 * If terminals are paired (rules.pair_mm above 0), `terminal` is connected to the first tree, and a
 * mate of the terminal to the second tree. Mates in 8 random directions are tried; more would fit
 * into narrower gaps, and take more time in a full domain. The directions depend only on
 * `terminal`.
 *
 * connection   [0] receives the connection, and [1] the connection of the mate. Undefined unless
 *              the result is PLAN_READY.
 * Threads      Threads may plan at the same time, each with a planner of its own. */
PlanState plan_make(const Plan *plan, Planner *planner, Vec3 terminal, Connection connection[2]);

#endif
