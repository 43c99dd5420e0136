/* A round of growth: random points all over the domain are connected to the tree where there
 * is room.
 *
 * The grid is cut into tiles. The points of one tile are connected one after another; threads
 * work on tiles that are far enough apart at the same time. The result does not depend on the
 * number of threads.
 *
 *     TRY(round_start(&round, n, err));                  (then set round.point[0 .. n - 1])
 *     TRY(round_run(&round, &common, limits, err));      (connects points)
 *     network_grown(&net, round.made); */
#ifndef CORCAST_GROW_ROUND_H
#define CORCAST_GROW_ROUND_H

#include "grow/plan.h"

typedef struct Tile Tile;

/* All arrays are owned. */
typedef struct Round {
    Vec3 *point;        /* mm; the caller sets them */
    size_t n, capacity; /* number of points, and number that the arrays have room for */
    uint32_t *tile_of;  /* per point: its tile */
    uint32_t *order;    /* indices of the points, tile by tile */
    Tile *tile;
    int tile_edge;       /* in cells of the grid */
    size_t tiles;        /* maximum number of tiles in the grid, wherever their seams are */
    bool is_tiled;       /* there are enough tiles to work on several at a time */
    size_t trees, *left; /* left, per tile and tree: how many terminals the tree may still get in
                          * the tile */
    Planner *planner;    /* per thread */
    int threads;
    uint32_t number; /* number of rounds so far */
    double reach;    /* mm; the first value of Planner.reach [plan.h] */
    uint8_t *misses; /* per grid cell: number of its points that were PLAN_CROWDED since one of its
                      * points was connected, at most ROUND_FULL */
    /* Results of the last round: */
    size_t made;                   /* number of terminals that were connected */
    size_t count[PLAN_STATES + 1]; /* number of points by their PlanState; the last entry counts
                                    * points that were skipped because they are in full cells */
} Round;

/* A cell with this many crowded points in succession counts as full: its points are skipped. Reason
 * for 2 not recorded. */
enum { ROUND_FULL = 2 };

/* Sets up *round, which may hold anything, for a forest of `trees`, `candidates` candidates
 * for each point and `threads` threads. Release it with round_release, also after an error.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status round_init(Round *round, int candidates, size_t trees, int threads, Err *err);
void round_release(Round *round);

/* Cuts a grid into tiles, and forgets which cells are full. Call it for every new grid, and when
 * the rules change. Errors: STATUS_MEMORY. */
MUST_CHECK Status round_use_grid(Round *round, const Grid *grid, Err *err);

/* Begins a round: makes room for `points` points, which the caller then sets.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status round_start(Round *round, size_t points, Err *err);

typedef struct RoundLimits {
    size_t most; /* maximum number of terminals to connect */
    bool skip;   /* skip points in full cells */
} RoundLimits;

/* Connects points, for each tree at most common->limit, which is counted down. Needs the radii and
 * sensitivities of the last refresh. Afterwards the sums do not include new terminals except near
 * them [network_split], and the caller must call network_grown. The connected segments are in the
 * grid.
 *
 * Errors   STATUS_MEMORY; the network is then only fit for network_release.
 * Threads  The result does not depend on the number of threads. */
MUST_CHECK Status round_run(Round *round, const PlanCommon *common, RoundLimits limits, Err *err);

#endif
