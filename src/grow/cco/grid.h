/* A uniform grid of cells over the domain that answers which segments are near. */
#ifndef CORCAST_GROW_GRID_H
#define CORCAST_GROW_GRID_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A straight tube with round ends. */
typedef struct Capsule {
    Vec3 a, b;
    double radius;
} Capsule;

/* A segment as the grid knows it, in half a cache line. */
typedef struct GridItem {
    float proximal[3], distal[3]; /* mm, from the grid's low corner */
    float radius;                 /* of the vessel, mm; the caller may bring it up to date */
    float reach;                  /* it is entered where the capsule of this radius may be, mm */
} GridItem;

/* The segments in one cell: 2 * segment + (1 at a terminal) of each. */
typedef struct GridCell {
    int32_t *tag;
    uint32_t count, size; /* `size`: of the block that holds them, 0: none */
} GridCell;

typedef struct GridArena GridArena;

typedef struct Grid {
    Vec3 low;
    double edge;     /* of a cell, mm */
    double inverse;  /* 1 / edge */
    double rounding; /* mm; more than the rounding of coordinates */
    int count[3];
    GridCell *cell; /* x fastest */
    GridItem *item; /* by segment */
    GridArena *arena;
    int workers;
} Grid;

/* A box of cells, both ends included. */
typedef struct GridBox {
    int low[3], high[3];
} GridBox;

typedef struct Near {
    float distance2; /* mm^2 */
    int32_t segment;
} Near;

/* Where a point is. */
typedef enum GridVicinity {
    GRID_FREE,
    GRID_IN_VESSEL,
    GRID_TOO_NEAR, /* to the tree */
} GridVicinity;

/* An empty grid over `box` with about `cells` cells for segments below `segments`; a flat box gives
 * one layer. Releases what `grid` held before, so start from (Grid){0}. Up to `workers` threads may
 * enter and take out segments at a time, as long as no two of them touch the same cell. */
MUST_CHECK Status grid_reset(Grid *grid, Box box, double cells, size_t segments, int workers,
                             Err *err);
void grid_release(Grid *grid);

/* The number of cells. */
size_t grid_cells(const Grid *grid);

/* The cell that holds `point`. */
size_t grid_cell_at(const Grid *grid, Vec3 point);

/* Ask for memory ahead of a query at `point`: for its cell, then for what the cell lists, then for
 * those items. Far apart points of a large tree are otherwise found one cache miss after
 * another. */
static inline void grid_fetch_cell(const Grid *grid, Vec3 point)
{
    __builtin_prefetch(&grid->cell[grid_cell_at(grid, point)]);
}

static inline void grid_fetch_tags(const Grid *grid, Vec3 point)
{
    __builtin_prefetch(grid->cell[grid_cell_at(grid, point)].tag);
}

static inline void grid_fetch_items(const Grid *grid, Vec3 point)
{
    const GridCell *cell = &grid->cell[grid_cell_at(grid, point)];
    for (uint32_t i = 0; i < cell->count; i++)
        __builtin_prefetch(&grid->item[cell->tag[i] >> 1]);
}

/* What lies inside these cells, by more than rounding; without bounds where they are the grid's
 * first or last. */
Box grid_zone(const Grid *grid, GridBox box);
/* How far `point`, in the zone, is from its bounds, along the axes, mm. */
double grid_clearance(Box zone, Vec3 point);
/* Whether all cells that an item's capsule may meet are in the zone. */
bool grid_zone_holds(const Grid *grid, Box zone, const GridItem *item);

/* The item of a vessel of `radius` from capsule.a (proximal) to capsule.b that reaches as far as
 * the capsule. */
GridItem grid_item(const Grid *grid, Capsule capsule, double radius);

/* Enters a segment in every cell that may meet its item's capsule. `worker` is below the number of
 * workers, and each thread has its own. */
MUST_CHECK Status grid_add(Grid *grid, int worker, int32_t segment, bool terminal, GridItem item,
                           Err *err);
/* Takes a segment out. */
void grid_remove(Grid *grid, int32_t segment);

/* Whether some segment's centreline, or with `terminals_only` some terminal's end point, is nearer
 * to `point` than `distance`; if not, whether a vessel of `thickness` times its radius holds it. */
GridVicinity grid_vicinity(const Grid *grid, Vec3 point, double distance, bool terminals_only,
                           double thickness);

/* The up to `limit` segments whose centrelines are nearest to `point`, nearest first; returns how
 * many. Equal distances are ordered by segment. -1 when it takes cells that are not wholly within
 * `within` mm, along each axis, to tell. */
int grid_nearest(const Grid *grid, Vec3 point, double within, int limit, Near *out);

/* The same if there are `limit` within `reach` mm, and not very many more; else false, with *out
 * undefined. */
bool grid_nearest_quick(const Grid *grid, Vec3 point, double reach, int limit, Near *out);

/* Squared distance of two straight segments of positive length [Ericson, Real-Time Collision
 * Detection, 2005, sec. 5.1.9]. */
double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

/* Squared distance of two items' centrelines, and squared length of one's, mm^2. */
double grid_distance2(const GridItem *a, const GridItem *b);
double grid_length2(const GridItem *item);

/* What is to be met: the box around an item's centreline, and how near to it, mm: `apart` and
 * `per_radius` of the other's radius. */
typedef struct GridBoxQuery {
    float low[3], high[3], apart, per_radius;
} GridBoxQuery;

GridBoxQuery grid_box_query(const GridItem *item, double apart, double per_radius);

/* Which of the next GRID_LANES segments of a cell, from its k-th on, have boxes that near, as bits;
 * a little more is allowed for rounding. */
enum { GRID_LANES = 4 };
unsigned grid_boxes_near(const Grid *grid, const GridCell *cell, uint32_t k,
                         const GridBoxQuery *probe);

/* The cells that meet the cube of twice `distance` about `point`. */
GridBox grid_box(const Grid *grid, Vec3 point, double distance);

/* A place as items have it. */
static inline void grid_store(const Grid *grid, Vec3 v, float out[3])
{
    out[0] = (float)(v.x - grid->low.x);
    out[1] = (float)(v.y - grid->low.y);
    out[2] = (float)(v.z - grid->low.z);
}

static inline size_t grid_index(const Grid *grid, int x, int y, int z)
{
    return ((size_t)z * grid->count[1] + y) * grid->count[0] + x;
}

/* Iterates over the cells that may meet an item's capsule, each once. Two capsules that meet have a
 * cell in common. */
typedef struct GridWalk {
    const Grid *grid;
    double from[3], span[3], radius;
    int axis;            /* the one along which the capsule is longest */
    int slab, last_slab; /* of cells across that axis */
    GridBox box;         /* within the slab */
    int at[3];
} GridWalk;

GridWalk grid_walk(const Grid *grid, const GridItem *item);
/* The next cell in *cell; false when there is none. */
bool grid_walk_next(GridWalk *walk, size_t *cell);

#endif
