/* A uniform grid of cells over the domain. It finds the segments near a point or near a segment.
 *
 * The grid does not depend on trees: segments are indices that the caller chooses. Each segment has
 * a GridItem, its position and radius. Its capsule, a tube around the centreline with the radius
 * `reach`, decides in which cells it is entered: in all cells that the capsule may meet. Two
 * capsules that meet therefore have a cell in common.
 *
 *     TRY(grid_reset(&grid, box, cells, n_segments, 1, err));       (grid was zeroed)
 *     TRY(grid_add(&grid, 0, i, is_terminal, grid_item(&grid, capsule, radius), err));
 *     int found = grid_nearest(&grid, point, INFINITY, 8, near); */
#ifndef CORCAST_GROW_CCO_GRID_H
#define CORCAST_GROW_CCO_GRID_H

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

/* A segment in the grid, in half a cache line of 64 bytes. */
typedef struct GridItem {
    float proximal[3], distal[3]; /* mm, from the grid's low corner */
    float radius;                 /* of the vessel, mm; the caller may bring it up to date */
    float reach;                  /* mm; radius of the capsule in whose cells it is entered */
} GridItem;

/* The segments entered in one cell. The tag of a segment is 2 * segment, + 1 for a terminal. */
typedef struct GridCell {
    int32_t *tag;
    uint32_t count, size; /* `size`: size class of the block that holds the tags; 0: no block */
} GridCell;

typedef struct GridArena GridArena;

/* A grid. Arrays are owned. Threads may query a grid at the same time while none changes it. */
typedef struct Grid {
    Vec3 low;         /* low corner, mm */
    double edge;      /* of a cell, mm */
    double inverse;   /* 1 / edge */
    double rounding;  /* mm; bounds the rounding of coordinates to floats */
    int count[3];     /* cells along each axis */
    GridCell *cell;   /* x fastest */
    GridItem *item;   /* per segment */
    GridArena *arena; /* per worker: memory for tags */
    int workers;
} Grid;

/* A box of cells, both ends included. */
typedef struct GridBox {
    int low[3], high[3];
} GridBox;

/* A segment that was found near a point. */
typedef struct Near {
    float distance2; /* mm^2, of its centreline from the point */
    int32_t segment;
} Near;

/* The result of grid_vicinity. */
typedef enum GridVicinity {
    GRID_FREE,      /* neither of the two below */
    GRID_IN_VESSEL, /* the point is inside a vessel */
    GRID_TOO_NEAR,  /* a segment is nearer than the required distance */
} GridVicinity;

/* Makes an empty grid over `box` with about `cells` cells, for segments with indices below
 * `segments`. A flat box gives one layer of cells.
 *
 * grid     is released first, so it must be zeroed before the first call. Release it with
 *          grid_release.
 * Errors   STATUS_MEMORY.
 * Threads  Up to `workers` threads may add and remove segments at the same time if no two of them
 *          touch the same cell. */
MUST_CHECK Status grid_reset(Grid *grid, Box box, double cells, size_t segments, int workers,
                             Err *err);
void grid_release(Grid *grid);

/* Returns the number of cells. */
size_t grid_cells(const Grid *grid);

/* Returns the index of the cell that holds `point`, or of the nearest cell. */
size_t grid_cell_at(const Grid *grid, Vec3 point);

/* Prefetch memory for a query at `point`, step by step: its cell, the cell's tags, the items of the
 * tags. Without prefetching, queries at points far apart in a large tree wait for one cache miss
 * after another. */
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

/* Returns the zone of a box of cells: the part of space, mm, whose points are in these cells in
 * spite of rounding. It is unbounded where the cells are the grid's first or last. */
Box grid_zone(const Grid *grid, GridBox box);
/* Returns the distance, mm, of `point`, which is in the zone, from the zone's nearest bound. */
double grid_clearance(Box zone, Vec3 point);
/* Returns true if all cells that the item's capsule may meet are in the zone. */
bool grid_zone_holds(const Grid *grid, Box zone, const GridItem *item);

/* Returns the item of a vessel of `radius` mm from capsule.a (proximal) to capsule.b. Its reach
 * is capsule.radius. */
GridItem grid_item(const Grid *grid, Capsule capsule, double radius);

/* Adds a segment, which is not in the grid, to every cell that may meet its item's capsule, and
 * stores its item.
 *
 * worker    below the number of workers. Threads that add segments at the same time differ in it.
 * terminal  true if the segment is a terminal's.
 * Errors    STATUS_MEMORY; the segment is then in some of its cells. */
MUST_CHECK Status grid_add(Grid *grid, int worker, int32_t segment, bool terminal, GridItem item,
                           Err *err);
/* Removes a segment, which is in the grid. */
void grid_remove(Grid *grid, int32_t segment);

/* Returns GRID_TOO_NEAR if a segment's centreline, or with `terminals_only` a terminal's distal
 * end, is nearer to `point` than `distance`, both in mm. Otherwise returns GRID_IN_VESSEL if the
 * point is nearer to a centreline than that vessel's radius times `thickness`. */
GridVicinity grid_vicinity(const Grid *grid, Vec3 point, double distance, bool terminals_only,
                           double thickness);

/* Finds the `limit` segments whose centrelines are nearest to `point`, or all if there are fewer.
 * They are sorted by distance, and by index on a tie. Returns their number; -1 if the search needs
 * cells that reach beyond `within` mm from the point along some axis. */
int grid_nearest(const Grid *grid, Vec3 point, double within, int limit, Near *out);

/* As grid_nearest, but faster. Returns false, with *out undefined, if there are fewer than `limit`
 * segments within `reach` mm, or very many more. */
bool grid_nearest_quick(const Grid *grid, Vec3 point, double reach, int limit, Near *out);

/* As grid_nearest, but faster for many points one after another: searches first within *reach mm,
 * which was sufficient for the last points, and then adapts *reach. Begin with an estimate, or with
 * 0. Also returns -1 if the last of `limit` segments is not at least two cell edges nearer than
 * `within`, so that the result is the same whichever search found it. */
int grid_nearest_adaptive(const Grid *grid, Vec3 point, double within, int limit, double *reach,
                         Near *out);

/* The nearest points of two segments. */
typedef struct SegmentGap {
    double s, t; /* where the points are on the first and on the second segment, in [0, 1] */
    Vec3 apart;  /* mm; vector from the point on the second segment to that on the first */
} SegmentGap;

/* Finds the nearest points of two straight segments of positive length. Source: Ericson, Real-Time
 * Collision Detection, 2005, section 5.1.9. */
SegmentGap segment_gap(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);
/* Returns the squared distance of two such segments, mm^2. */
double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

/* Return the squared distance of two items' centrelines, and the squared length of one, mm^2. */
double grid_distance2(const GridItem *a, const GridItem *b);
double grid_length2(const GridItem *item);

/* A query for segments near a box. A segment is near if the distance of its bounding box from the
 * box, along each axis, is at most `apart` mm plus `per_radius` times the segment's radius. */
typedef struct GridBoxQuery {
    float low[3], high[3], apart, per_radius;
} GridBoxQuery;

/* Returns the query for the bounding box of an item's centreline. */
GridBoxQuery grid_box_query(const GridItem *item, double apart, double per_radius);

/* Returns which of the segments k to k + GRID_LANES - 1 of a cell are near by the query, as bits
 * from the lowest on. Distances are a little larger than asked for, because of rounding. */
enum { GRID_LANES = 4 };
unsigned grid_boxes_near(const Grid *grid, const GridCell *cell, uint32_t k,
                         const GridBoxQuery *probe);

/* Returns the cells that meet the cube with edges of twice `distance` centred at `point`. */
GridBox grid_box(const Grid *grid, Vec3 point, double distance);

/* Stores the coordinates of a point as items have them: in mm from the grid's low corner. */
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

/* A walk over the cells that may meet an item's capsule, each cell once:
 *     for (GridWalk walk = grid_walk(grid, item); grid_walk_next(&walk, &cell);)
 * Two capsules that meet have a cell in common. */
typedef struct GridWalk {
    const Grid *grid;
    double from[3], span[3], radius;
    int axis;            /* the axis along which the capsule is longest */
    int slab, last_slab; /* of cells across that axis */
    GridBox box;         /* within the slab */
    int at[3];
} GridWalk;

GridWalk grid_walk(const Grid *grid, const GridItem *item);
/* Sets *cell to the next cell; returns false if there is none. */
bool grid_walk_next(GridWalk *walk, size_t *cell);

/* A visit of the segments in the cells that may meet an item's capsule:
 *     for (GridVisit visit = grid_visit(grid, item); grid_visit_next(&visit, &segment);)
 * A segment comes once for each of these cells that it is in. The grid must not change. */
typedef struct GridVisit {
    GridWalk walk;
    const GridCell *cell; /* the present cell; NULL: none yet */
    uint32_t k;           /* index in the cell of the next segment */
    unsigned near;        /* of the GRID_LANES segments before k: those still to come, as bits */
} GridVisit;

static inline GridVisit grid_visit(const Grid *grid, const GridItem *item)
{
    return (GridVisit){.walk = grid_walk(grid, item)};
}

/* Goes to the next cell that has segments left; returns false if there is none. */
static inline bool grid_visit_cell(GridVisit *visit)
{
    size_t index;
    while (!visit->cell || visit->k >= visit->cell->count) {
        if (!grid_walk_next(&visit->walk, &index))
            return false;
        visit->cell = &visit->walk.grid->cell[index];
        visit->k = 0;
    }
    return true;
}

/* Sets *segment to the next segment; returns false if there is none. */
static inline bool grid_visit_next(GridVisit *visit, int32_t *segment)
{
    if (!grid_visit_cell(visit))
        return false;
    *segment = visit->cell->tag[visit->k++] >> 1;
    return true;
}

/* As grid_visit_next, but leaves out segments that are not near by the query. A visit uses one of
 * the two functions only. */
static inline bool grid_visit_near(GridVisit *visit, const GridBoxQuery *query, int32_t *segment)
{
    while (!visit->near) {
        if (!grid_visit_cell(visit))
            return false;
        visit->near = grid_boxes_near(visit->walk.grid, visit->cell, visit->k, query);
        visit->k += GRID_LANES;
    }
    *segment = visit->cell->tag[visit->k - GRID_LANES + (uint32_t)__builtin_ctz(visit->near)] >> 1;
    visit->near &= visit->near - 1;
    return true;
}

#endif
