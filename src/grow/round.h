/* A round of growth: points tossed all over the domain are connected where there is room,
 * neighbourhood after neighbourhood, by threads side by side. */
#ifndef CORCAST_GROW_ROUND_H
#define CORCAST_GROW_ROUND_H

#include "grow/plan.h"

typedef struct Tile Tile;

/* What became of the points of a round. */
typedef struct Tally {
    size_t skipped;            /* in cells that count as full */
    size_t count[PLAN_STATES]; /* of the others */
} Tally;

typedef struct Round {
    Vec3 *point;        /* mm; the caller fills them in */
    size_t n, capacity; /* of points */
    uint32_t *tile_of;  /* by point: its tile */
    uint32_t *order;    /* the points' indices, tile by tile */
    Tile *tile;
    int tile_edge;       /* in cells of the grid */
    size_t tiles;        /* the most that the grid is cut into, wherever their seams are */
    bool is_tiled;       /* whether there are enough to work on several at a time */
    size_t trees, *left; /* by tile and tree: how many terminals it may still get there */
    Planner *planner;    /* by thread */
    int threads;
    uint32_t number; /* of rounds so far */
    double reach;    /* mm; what planners begin with [plan.h] */
    uint8_t *misses; /* by cell: crowded points in it since one was connected, up to ROUND_FULL */
    Tally tally;     /* of the last round */
} Round;

/* A cell with this many crowded points in succession counts as full: its points are skipped. */
enum { ROUND_FULL = 2 };

/* Initialises *round, whatever it holds, for a forest of `trees`, with `candidates` candidates for
 * each point and on `threads` threads. To be released also on failure, STATUS_MEMORY. */
MUST_CHECK Status round_init(Round *round, int candidates, size_t trees, int threads, Err *err);
void round_release(Round *round);

/* To be called for every new grid, and when the rules change: cuts the grid into tiles, and forgets
 * which cells are full. */
MUST_CHECK Status round_use_grid(Round *round, const Grid *grid, Err *err);

/* Begins a round: makes room for `points` points, which the caller then sets. */
MUST_CHECK Status round_start(Round *round, size_t points, Err *err);

/* Connects points: at most `most`, and for each tree no more than site->limit allows, which is
 * counted down. *made: how many terminals were connected. Skips points in full cells if `skip`.
 * Fills the tally. Needs the radii and sensitivities of the last refresh. Afterwards the sums miss
 * new terminals except near them [network_split], and the caller has to call network_grown. The
 * result does not depend on the number of threads. STATUS_MEMORY. */
MUST_CHECK Status round_run(Round *round, const Site *site, size_t most, bool skip, size_t *made,
                            Err *err);

#endif
