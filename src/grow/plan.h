/* Plans: where tossed points may be connected, found without changing anything. */
#ifndef CORCAST_GROW_PLAN_H
#define CORCAST_GROW_PLAN_H

#include "domain/domain.h"
#include "grow/grid.h"
#include "grow/network.h"
#include "grow/place.h"

typedef enum PlanState {
    PLAN_TOO_NEAR,  /* nearer to the tree than the toss distance */
    PLAN_IN_VESSEL, /* at the toss distance, but in a thick vessel */
    PLAN_AHEAD,     /* a tree is in the way that may get no more terminals for now */
    PLAN_OUTSIDE,   /* every way leads through what is not tissue */
    PLAN_CROWDED,   /* vessels are in the way */
    PLAN_READY,
} PlanState;

/* What becomes of one tossed point. */
typedef struct Plan {
    Vec3 terminal;
    PlanState state;
    /* Only when ready: */
    int planner; /* who made it, for the cells */
    Connection connection;
    /* Of the planner's footprint: cells that must not have changed, those up to `end_changed` being
     * those that it changes. */
    size_t first_cell, end_changed, end_cell;
} Plan;

/* What all plans of a batch are made for. */
typedef struct Site {
    const Network *net;
    const size_t *limit; /* by tree: terminals that it may get in this batch */
    const Grid *grid;
    const Domain *domain;
    const Rules *rules;
    double toss_distance; /* mm */
    bool terminals_only;  /* the toss distance is one from terminals, not segments */
    int candidates;
} Site;

/* One thread's workspace. */
typedef struct Planner {
    Near *near; /* candidates of each */
    Connection *connection;
    Footprint footprint; /* of all plans since the caller emptied it */
    Status status;       /* of all plans since planner_init */
    Err err;
} Planner;

MUST_CHECK Status planner_init(Planner *planner, int candidates, Err *err);
void planner_release(Planner *planner);

/* Plans the connection of plan->terminal: the cheapest there is room for. */
void plan_make(const Site *site, Planner *planner, Plan *plan);

#endif
