/* A round tosses points all over the domain and connects those that can be, neighbourhood after
 * neighbourhood. */
#ifndef CORCAST_GROW_ROUND_H
#define CORCAST_GROW_ROUND_H

#include "grow/plan.h"

typedef struct Tile Tile;

/* What became of the points. */
typedef struct Tally {
    size_t skipped; /* in cells that are full */
    size_t count[PLAN_STATES];
} Tally;

typedef struct Round {
    Vec3 *point;
    size_t n, capacity; /* points */
    uint32_t *tile_of;  /* by point */
    uint32_t *order;    /* points, tile by tile */
    Tile *tile;
    int tile_edge;       /* in cells of the grid */
    size_t tiles;        /* at most */
    bool is_tiled;       /* whether there are enough to work on several at a time */
    size_t trees, *left; /* by tile and tree: terminals that it may get there */
    Planner *planner;    /* by thread */
    int threads;
    uint32_t number; /* of rounds so far */
    double reach;    /* mm; what planners begin with */
    uint8_t *misses; /* by cell: crowded points in it since one was connected, up to ROUND_FULL */
    Tally tally;
} Round;

/* A cell with so many misses counts as full. */
enum { ROUND_FULL = 2 };

/* Starts from (Round){0}; `trees` may have limits. */
MUST_CHECK Status round_init(Round *round, int candidates, size_t trees, int threads, Err *err);
void round_release(Round *round);

/* Forgets what it knew of the cells; to be called for every new grid, and when the rules change. */
MUST_CHECK Status round_use_grid(Round *round, const Grid *grid, Err *err);

/* Makes room for so many points, whose places the caller sets. */
MUST_CHECK Status round_start(Round *round, size_t points, Err *err);

/* Connects points, at most `most` and for each tree at most its limit, which goes down by what it
 * got; returns how many in *made. Points in full cells are skipped if `skip`. Fills the tally. */
MUST_CHECK Status round_run(Round *round, const Site *site, size_t most, bool skip, size_t *made,
                            Err *err);

#endif
