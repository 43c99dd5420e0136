/* Plans whether and where a random point is connected to the tree. Planning changes nothing, so
 * that threads can plan points far apart at the same time.
 *
 * A plan either finds a connection (PLAN_READY) or states why there is none. Planning reads only
 * segments in the plan's zone, a box of grid cells. */
#ifndef CORCAST_GROW_PLAN_H
#define CORCAST_GROW_PLAN_H

#include "grow/connection.h"
#include "grow/site.h"

typedef enum PlanState {
    PLAN_BEYOND,    /* undecided: needs cells outside the zone, or more terminals than are left */
    PLAN_TOO_NEAR,  /* nearer to the tree than the toss distance */
    PLAN_IN_VESSEL, /* far enough from all centrelines, but inside a thick vessel */
    PLAN_AHEAD,     /* next to a tree that may get no more terminals for now [forest.h] */
    PLAN_OUTSIDE,   /* every connection leaves the domain */
    PLAN_CROWDED,   /* other vessels are in the way of every connection */
    PLAN_READY,     /* there is a connection */
    PLAN_STATES
} PlanState;

/* What all points of a round have in common. The network is as of the last refresh, with the splits
 * since then; the grid holds its segments. All is borrowed. */
typedef struct PlanCommon {
    Site *site;
    size_t *limit;        /* per tree: how many more terminals it may get */
    double toss_distance; /* mm, where demand is greatest; larger elsewhere */
    const Demand *demand; /* NULL: the same everywhere */
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

/* Makes room for `candidates` nearest segments. Release with planner_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status planner_init(Planner *planner, int candidates, Err *err);
void planner_release(Planner *planner);

/* Plans the connection of `terminal`, mm, which is in the zone: the cheapest of its candidates that
 * has room. If the rules pair terminals, plans the connection of `terminal` to the first tree, and
 * a mate of the terminal for the second tree, which is sought in a few directions.
 *
 * connection   receives the connection, and the connection of the mate, if the result is
 *              PLAN_READY. */
PlanState plan_make(const Plan *plan, Planner *planner, Vec3 terminal, Connection connection[2]);

#endif
