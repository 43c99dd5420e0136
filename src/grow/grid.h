/* A uniform grid of cells over the domain that answers which segments are near. */
#ifndef CORCAST_GROW_GRID_H
#define CORCAST_GROW_GRID_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A segment in one cell, its ends at hand so that distance queries touch nothing else. */
typedef struct GridEntry {
    float proximal[3], distal[3]; /* mm */
    int32_t tag;                  /* 2 * segment + (1 at a terminal) */
    int32_t next;                 /* entry of the same cell or of the free list, -1: none */
} GridEntry;

typedef struct Grid {
    Vec3 low;
    double cell; /* edge length, mm */
    int count[3];
    int32_t *head; /* first entry of each cell, -1: none; x fastest */
    GridEntry *entry;
    size_t used, capacity;
    int32_t free;
    float *reach; /* radius each segment was entered with, mm */
} Grid;

/* A straight tube with round ends. */
typedef struct Capsule {
    Vec3 a, b;
    double radius;
} Capsule;

typedef struct Near {
    float distance2; /* mm^2 */
    int32_t segment;
} Near;

/* An empty grid over `box` with about `cells` cells for segments below `segments`; a flat box gives
 * one layer. Releases what `grid` held before, so start from (Grid){0}. */
MUST_CHECK Status grid_reset(Grid *grid, Box box, double cells, size_t segments, Err *err);
void grid_release(Grid *grid);

/* Enters a segment, from capsule.a (proximal) to capsule.b, in every cell that may meet its
 * capsule. */
MUST_CHECK Status grid_add(Grid *grid, int32_t segment, bool terminal, Capsule capsule, Err *err);
/* Takes out the segment that was entered from `a` to `b`. */
void grid_remove(Grid *grid, int32_t segment, Vec3 a, Vec3 b);

/* Whether some segment's centreline, or with `terminals_only` some terminal's end point, is nearer
 * to `point` than `distance`. */
bool grid_any_within(const Grid *grid, Vec3 point, double distance, bool terminals_only);

/* The up to `limit` segments whose centrelines are nearest to `point`, nearest first; returns how
 * many. Equal distances are ordered by segment. */
int grid_nearest(const Grid *grid, Vec3 point, int limit, Near *out);

/* The cell that holds `point`. Every segment whose capsule holds it is entered there. */
size_t grid_cell_at(const Grid *grid, Vec3 point);

/* Iterates over the cells that may meet a capsule, each once. */
typedef struct GridWalk {
    const Grid *grid;
    Capsule capsule;
    int axis;                   /* the one along which the capsule is longest */
    int slab, last_slab;        /* of cells across that axis */
    int low[3], high[3], at[3]; /* within the slab */
} GridWalk;

GridWalk grid_walk(const Grid *grid, Capsule capsule);
/* The next cell in *cell; false when there is none. */
bool grid_walk_next(GridWalk *walk, size_t *cell);

#endif
