/* Batches of tossed points, planned together and carried out together. */
#ifndef CORCAST_GROW_BATCH_H
#define CORCAST_GROW_BATCH_H

#include "grow/plan.h"

typedef struct Batch {
    Plan *plan;
    size_t n, capacity;
    Vec3 *waiting; /* points put off to the next batch, which begins with them */
    size_t n_waiting;
    size_t *accepted, n_accepted;
    Planner *planner; /* by thread */
    int threads;
    uint32_t number; /* how many there have been, from 1 */
    uint32_t *stamp; /* by cell of the grid: the number of the batch that last changed it */
    uint8_t *misses; /* by cell: crowded points in it since one was connected, up to BATCH_FULL */
} Batch;

/* A cell with so many misses counts as full. */
enum { BATCH_FULL = 2 };

/* Room for `capacity` points at a time. */
MUST_CHECK Status batch_init(Batch *batch, size_t capacity, int candidates, int threads, Err *err);
void batch_release(Batch *batch);

/* Forgets what it knew of the cells; to be called for every new grid, and when the rules change. */
MUST_CHECK Status batch_use_grid(Batch *batch, const Grid *grid, Err *err);

/* Starts a batch with the points that wait and `tosses` new ones, fewer when there is no space,
 * whose places the caller sets: from plan[the result] on. */
size_t batch_start(Batch *batch, size_t tosses);

/* Plans all points. */
MUST_CHECK Status batch_plan(Batch *batch, const Site *site, Err *err);

/* Whether points at this place are not worth planning. */
static inline bool batch_is_full(const Batch *batch, const Grid *grid, Vec3 point)
{
    return batch->misses[grid_cell_at(grid, point)] == BATCH_FULL;
}

/* Chooses the plans that go together, in order and no more for each tree of `net` than its `limit`,
 * from which they are taken off; those that a tree may not get are given up, and the points of all
 * others that are ready are put off. Counts misses. */
void batch_accept(Batch *batch, const Network *net, const Grid *grid, size_t *limit);

/* Makes the connections that were accepted. */
MUST_CHECK Status batch_carry_out(Batch *batch, Network *net, Grid *grid, const Rules *rules,
                                  Err *err);

#endif
