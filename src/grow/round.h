/* A round of growth: connects random points of the domain to the tree. round_start makes space for
 * the points, the caller sets them, and round_run connects those for which plan.h finds a
 * connection.
 *
 * The grid of segments [site.h] is divided into tiles, which are boxes of cells. The points of one
 * tile are connected one after another. Threads work at the same time on tiles that are far enough
 * apart. The result does not depend on the number of threads.
 *
 *     TRY(round_start(&round, n, err));                  (then set round.point[0 .. n - 1])
 *     TRY(round_run(&round, &common, limits, err));
 *     network_add_terminals(&net, round.connected); */
#ifndef CORCAST_GROW_ROUND_H
#define CORCAST_GROW_ROUND_H

#include "grow/plan.h"

typedef struct Tile Tile;

/* The state of the rounds. All arrays are owned. */
typedef struct Round {
    Vec3 *point;        /* mm; set by the caller */
    size_t n, capacity; /* number of points, and its maximum for the present arrays */
    uint32_t *tile_of;  /* per point: its tile */
    uint32_t *order;    /* indices of the points, tile by tile */
    Tile *tile;
    int tile_edge;    /* edge of a tile, in cells of the grid */
    size_t tiles;     /* number of tiles that are allocated; a round may use fewer, because the
                       * boundaries between tiles move from round to round */
    bool is_tiled;    /* true: several tiles can be worked on at the same time */
    size_t trees;     /* number of trees of the forest */
    size_t *left;     /* per tile and tree: number of terminals that the tree may still get in
                       * the tile */
    Planner *planner; /* per thread */
    int threads;
    uint32_t number; /* number of rounds so far */
    double reach;    /* mm; the first value of Planner.reach [plan.h] */
    uint8_t *misses; /* per grid cell: number of successive PLAN_CROWDED points since a point in the
                      * cell was connected, at most ROUND_FULL */
    /* Results of the last round: */
    size_t connected;              /* number of terminals that were connected */
    size_t count[PLAN_STATES + 1]; /* per PlanState: number of points; last entry: number of points
                                    * that were skipped because their cells are full */
} Round;

/* Number of successive PLAN_CROWDED points after which a cell is full. Points in full cells can be
 * skipped. With 1, a single point at an unlucky position would close a cell. */
enum { ROUND_FULL = 2 };

/* Initialises *round, which may be uninitialised, for `trees` trees, `candidates` candidates per
 * point and `threads` threads. Release it with round_release, also after an error. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status round_init(Round *round, int candidates, size_t trees, int threads, Err *err);
void round_release(Round *round);

/* Divides a grid into tiles, and marks no cell as full. Call it for every new grid, and whenever
 * Site.rules have changed. Errors: STATUS_MEMORY. */
MUST_CHECK Status round_use_grid(Round *round, const Grid *grid, Err *err);

/* Begins a round of `points` points. Afterwards the caller sets round->point. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status round_start(Round *round, size_t points, Err *err);

/* The limits of one round. */
typedef struct RoundLimits {
    size_t most; /* maximum number of terminals to connect, of all trees together */
    bool skip;   /* true: skips points in full cells */
} RoundLimits;

/* Connects points. Needs the radii of the last network_refresh. Enters the new segments in the
 * grid. The sums over subtrees (flow, cost) then include a new terminal only at its nearest
 * ancestors [network_split]; all other sums do so after the next network_refresh. The caller must
 * call network_add_terminals with round->connected.
 *
 * common   the inputs of plan_make. common->limit has, per tree, the number of terminals that the
 *          tree may still get; the function subtracts the new terminals.
 * Errors   STATUS_MEMORY; the network is then only fit for network_release.
 * Threads  The result does not depend on the number of threads. */
MUST_CHECK Status round_run(Round *round, const PlanCommon *common, RoundLimits limits, Err *err);

#endif
