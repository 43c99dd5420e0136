/* Plans: where tossed points may be connected, found without changing anything. */
#ifndef CORCAST_GROW_PLAN_H
#define CORCAST_GROW_PLAN_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/connection.h"
#include "grow/network.h"

typedef enum PlanState {
    PLAN_BEYOND,   /* it takes more than the zone, or more terminals than there are left, to tell */
    PLAN_TOO_NEAR, /* nearer to the tree than the toss distance */
    PLAN_IN_VESSEL, /* at the toss distance, but in a thick vessel */
    PLAN_AHEAD,     /* a tree is in the way that may get no more terminals for now */
    PLAN_OUTSIDE,   /* every way leads through what is not tissue */
    PLAN_CROWDED,   /* vessels are in the way */
    PLAN_READY,
    PLAN_STATES
} PlanState;

/* What all points of a round are planned for. */
typedef struct Site {
    Network *net;
    Grid *grid;
    const Domain *domain;
    const Rules *rules;
    size_t *limit;        /* by tree: terminals that it may get */
    double toss_distance; /* mm */
    bool terminals_only;  /* the toss distance is one from terminals, not segments */
    int candidates;
} Site;

/* One thread's workspace. */
typedef struct Planner {
    Near *near; /* candidates of each */
    Connection *connection;
    double reach; /* mm; a guess of how far away they are, 0: none; the caller's to begin with */
} Planner;

MUST_CHECK Status planner_init(Planner *planner, int candidates, Err *err);
void planner_release(Planner *planner);

/* Plans the connection of `terminal`, which is in the zone, in *out: the cheapest there is room
 * for. Looks at nothing but what is in the zone. left[k], at most limit[k]: terminals that tree k
 * may get from the caller. */
PlanState plan_make(const Site *site, Planner *planner, Box zone, const size_t *left, Vec3 terminal,
                    Connection *out);

#endif
