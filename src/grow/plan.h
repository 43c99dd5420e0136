/* Whether and where a tossed point is connected to the tree: found without changing anything. */
#ifndef CORCAST_GROW_PLAN_H
#define CORCAST_GROW_PLAN_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/connection.h"
#include "grow/network.h"

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

/* What all points of a round share. The network is as of the last refresh and the splits since; the
 * grid holds its segments. */
typedef struct Site {
    Network *net;
    Grid *grid;
    const Domain *domain;
    const Rules *rules;
    size_t *limit;        /* by tree: how many more terminals it may get */
    double toss_distance; /* mm; where demand is greatest: elsewhere the distance is greater */
    const Demand *demand; /* NULL: the same everywhere */
    bool terminals_only;  /* the toss distance is kept from terminals' ends, not from segments */
    int candidates;       /* nearest segments that are tried */
} Site;

/* One thread's workspace. */
typedef struct Planner {
    Near *near;             /* the candidates of the point at hand */
    Connection *connection; /* and their connections */
    /* mm; an estimate of how far away the candidates are, learnt from point to point; 0: none yet.
     * The caller sets the first. */
    double reach;
} Planner;

MUST_CHECK Status planner_init(Planner *planner, int candidates, Err *err);
void planner_release(Planner *planner);

/* Plans the connection of `terminal`, mm, which lies in the zone: the cheapest of its candidates
 * for which there is room goes to *out if the result is PLAN_READY. Reads nothing that lies outside
 * the zone. left[k], at most limit[k], is how many terminals tree k may still get from the caller.
 */
PlanState plan_make(const Site *site, Planner *planner, Box zone, const size_t *left, Vec3 terminal,
                    Connection *out);

/* Two terminals, of the first and of the second tree, and their connections. */
typedef struct PlanPair {
    Vec3 terminal[2]; /* mm */
    Connection connection[2];
} PlanPair;

/* As plan_make, for the first tree, and with a mate of the terminal for the second, which is sought
 * in a few directions. */
PlanState plan_pair(const Site *site, Planner *planner, Box zone, const size_t *left, Vec3 terminal,
                    PlanPair *out);

#endif
