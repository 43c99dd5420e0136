/* A uniform grid of cells over the domain, which finds the segments near a point or near a segment.
 * Call grid_reset first, then grid_add and grid_remove to change the grid, and the other functions
 * for queries.
 *
 * The grid does not know trees: a segment is an index that the caller chooses, and a GridItem with
 * the position and radius of the segment. The capsule of a segment is a tube around its centreline,
 * with round ends and the radius `reach`. A segment is entered in all cells that its capsule may
 * meet. Two capsules that meet therefore have a cell in common.
 *
 *     TRY(grid_reset(&grid, box, cells, n_segments, 1, err));       (grid must be zeroed)
 *     TRY(grid_add(&grid, 0, i, is_terminal, grid_item(&grid, capsule, radius), err));
 *     int found = grid_nearest(&grid, point, INFINITY, 8, near); */
#ifndef CORCAST_GROW_CCO_GRID_H
#define CORCAST_GROW_CCO_GRID_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A straight tube with hemispherical ends, mm. */
typedef struct Capsule {
    Vec3 a, b;
    double radius;
} Capsule;

/* A segment in the grid, in half a cache line of 64 bytes. */
typedef struct GridItem {
    float proximal[3], distal[3]; /* mm, from the grid's low corner */
    float radius;                 /* radius of the vessel, mm; the caller may change it */
    float reach;                  /* radius of the capsule, mm; at least `radius` when entered */
} GridItem;

/* The segments that are entered in one cell. */
typedef struct GridCell {
    int32_t *tag;   /* per segment: 2 * its index, plus 1 if it is a terminal segment */
    uint32_t count; /* number of tags */
    uint32_t size;  /* size class of the memory block that holds the tags; 0: no block */
} GridCell;

typedef struct GridArena GridArena;

/* A grid. Arrays are owned. Threads may query a grid at the same time while none changes it. */
typedef struct Grid {
    Vec3 low;         /* low corner, mm */
    double edge;      /* edge of a cell, mm */
    double inverse;   /* 1 / edge */
    double rounding;  /* upper bound of the error of rounding coordinates to floats, mm */
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
    float distance2; /* squared distance of its centreline from the point, mm^2 */
    int32_t segment;
} Near;

/* The result of grid_vicinity. */
typedef enum GridVicinity {
    GRID_FREE,      /* no segment is too near, and the point is in no vessel */
    GRID_IN_VESSEL, /* the point is inside a vessel */
    GRID_TOO_NEAR,  /* a segment is nearer than the required distance */
} GridVicinity;

/* Makes an empty grid over `box`, mm, with about `cells` cells, for segments with indices below
 * `segments`. A flat box gives one layer of cells.
 *
 * grid     must be zeroed before its first use; an earlier grid is released. Release it with
 *          grid_release, also after an error.
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

/* Prefetch memory for a later query at `point`, in three steps: the cell, the tags of the cell, and
 * the items of the tags. Without prefetching, queries at points far apart in a large tree wait for
 * one cache miss after another. */
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

/* Returns the zone of a box of cells: a box, mm, whose points are certainly in these cells, also
 * after rounding. The zone has no bound on a side where the cells are the outermost of the grid. */
Box grid_zone(const Grid *grid, GridBox box);
/* Returns the distance, mm, from `point` to the nearest bound of the zone, which contains it. */
double grid_clearance(Box zone, Vec3 point);
/* Returns true if all cells that the item's capsule may meet are in the zone. */
bool grid_zone_holds(const Grid *grid, Box zone, const GridItem *item);

/* Returns the item of a vessel of the radius `radius`, mm, from capsule.a (proximal) to capsule.b.
 * Its reach is capsule.radius. */
GridItem grid_item(const Grid *grid, Capsule capsule, double radius);

/* Adds a segment, which must not be in the grid, to every cell that its capsule may meet, and
 * stores its item.
 *
 * worker    index of the calling worker, below grid->workers.
 * terminal  true if the segment is a terminal segment.
 * Errors    STATUS_MEMORY; the segment is then in some of its cells. */
MUST_CHECK Status grid_add(Grid *grid, int worker, int32_t segment, bool terminal, GridItem item,
                           Err *err);
/* Removes a segment, which is in the grid. */
void grid_remove(Grid *grid, int32_t segment);

/* Tests `point`, mm, in this order. Returns GRID_TOO_NEAR if a centreline or, with
 * `terminals_only`, the distal end of a terminal is nearer to the point than `distance`, mm.
 * Returns GRID_IN_VESSEL if a centreline is nearer than its vessel's radius times `thickness`.
 * Returns GRID_FREE in all other cases. */
GridVicinity grid_vicinity(const Grid *grid, Vec3 point, double distance, bool terminals_only,
                           double thickness);

/* Finds the `limit` segments whose centrelines are nearest to `point`, or all segments if there are
 * fewer.
 *
 * within   the search reads no cell that is farther from the point than this along any axis, mm;
 *          INFINITY: no limit.
 * out      receives up to `limit` segments, sorted by distance, then by index.
 * Returns  the number of segments; -1 if the search needs cells beyond `within`. */
int grid_nearest(const Grid *grid, Vec3 point, double within, int limit, Near *out);

/* Finds the same segments as grid_nearest, but faster. Returns false, with *out undefined, if fewer
 * than `limit` segments are within `reach`, mm, or many more than `limit`. */
bool grid_nearest_quick(const Grid *grid, Vec3 point, double reach, int limit, Near *out);

/* Finds the same segments as grid_nearest, but faster for a series of nearby points.
 *
 * within   as in grid_nearest.
 * reach    distance, mm, that is searched first; the function adapts *reach to the density of
 *          segments. Begin with an estimate, or with 0.
 * Returns  the number of segments; -1 if `within` is finite and the grid has fewer than `limit`
 *          segments that are at least two cell edges nearer than `within`. With this margin, the
 *          result does not depend on *reach. */
int grid_nearest_adaptive(const Grid *grid, Vec3 point, double within, int limit, double *reach,
                          Near *out);

/* The nearest points of two segments. */
typedef struct SegmentGap {
    double s, t; /* positions of the points on the first and on the second segment, in [0, 1] */
    Vec3 apart;  /* vector from the point on the second segment to the point on the first, mm */
} SegmentGap;

/* Finds the nearest points of two straight segments of positive length. Source: Ericson, Real-Time
 * Collision Detection, 2005, section 5.1.9. */
SegmentGap segment_gap(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);
/* Returns the squared distance of two straight segments of positive length, mm^2. */
double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

/* Returns the squared distance between the centrelines of two items, mm^2. */
double grid_distance2(const GridItem *a, const GridItem *b);
/* Returns the squared length of an item's centreline, mm^2. */
double grid_length2(const GridItem *item);

/* A query for segments near a box. A segment is near if the distance of its bounding box from the
 * box, along each axis, is at most `apart` mm plus `per_radius` times the segment's radius. */
typedef struct GridBoxQuery {
    float low[3], high[3], apart, per_radius;
} GridBoxQuery;

/* Returns the query for the bounding box of an item's centreline. */
GridBoxQuery grid_box_query(const GridItem *item, double apart, double per_radius);

/* Tests the segments k to k + GRID_LANES - 1 of a cell, one vector of floats. Bit i of the result
 * is set if the cell has a segment k + i and it is near [GridBoxQuery]. Because of rounding, a
 * segment may count as near that is a little too far away. */
enum { GRID_LANES = 4 };
unsigned grid_boxes_near(const Grid *grid, const GridCell *cell, uint32_t k,
                         const GridBoxQuery *probe);

/* Returns the cells that meet the cube with the centre `point` and edges of 2 * `distance`, mm. */
GridBox grid_box(const Grid *grid, Vec3 point, double distance);

/* Converts a position to the coordinates of items: floats, in mm from the grid's low corner. */
static inline void grid_store(const Grid *grid, Vec3 v, float out[3])
{
    out[0] = (float)(v.x - grid->low.x);
    out[1] = (float)(v.y - grid->low.y);
    out[2] = (float)(v.z - grid->low.z);
}

/* Returns the index in grid->cell of the cell at (x, y, z). */
static inline size_t grid_index(const Grid *grid, int x, int y, int z)
{
    return ((size_t)z * grid->count[1] + y) * grid->count[0] + x;
}

/* A walk over the cells that may meet an item's capsule, each cell once:
 *     for (GridWalk walk = grid_walk(grid, item); grid_walk_next(&walk, &cell);) */
typedef struct GridWalk {
    const Grid *grid;
    double from[3], span[3], radius; /* the capsule: start, end minus start, and radius, mm */
    int axis;                        /* the axis along which the capsule is longest */
    int slab, last_slab;             /* present and last layer of cells perpendicular to `axis` */
    GridBox box;                     /* the cells of the present layer that the capsule may meet */
    int at[3];                       /* the next cell */
} GridWalk;

GridWalk grid_walk(const Grid *grid, const GridItem *item);
/* Sets *cell to the next cell; returns false if there is none. */
bool grid_walk_next(GridWalk *walk, size_t *cell);

/* An iteration over the segments in the cells that may meet an item's capsule: for (GridVisit visit
 * = grid_visit(grid, item); grid_visit_next(&visit, &segment);) A segment is visited once in each
 * of these cells in which it is entered. The grid must not change during the visit. */
typedef struct GridVisit {
    GridWalk walk;
    const GridCell *cell; /* the present cell; NULL: none yet */
    uint32_t k;           /* index in the cell of the next segment */
    unsigned near; /* bits of the GRID_LANES segments before k that are still to be visited */
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

/* Sets *segment to the next segment that is near [GridBoxQuery]; returns false if there is none. A
 * visit must use either this function or grid_visit_next, not both. */
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
