/* The uniform grid of segments: enters segments in the cells that they may reach, and removes them.
 *
 * A cell lists its segments in one block of memory, of one of a few sizes. A block that has become
 * too small for its cell is reused for another cell. Distance queries read a separate table, in
 * which a segment takes half a cache line. A cell therefore costs four bytes per segment, and a
 * query reads a few cache lines.
 *
 * A segment is entered wherever its capsule may reach, so that two capsules that meet always share
 * a cell. The number of entries grows with the total length of the segments, not with their
 * bounding boxes: the walk cuts the capsule into slabs of cells across its longest axis, and bounds
 * each piece on its own. The walk reads only the item, so that it visits the same cells again when
 * the segment is removed.
 *
 * Coordinates are floats relative to the grid's low corner. Rounding changes them by less than 3e-8
 * of the grid's size, which distances tolerate. Callers that must keep segments from crossing keep
 * them further apart than that.
 *
 * Threads that touch different cells need no locks: each worker has its own arena of blocks. Which
 * block holds the tags of a cell, and in what order, does not influence any result. */
#include "grow/cco/grid.h"

#include <stdlib.h>
#include <string.h>

/* Number of block sizes: the largest block holds 3 * 2^28 tags [block_tags]. */
enum { BLOCK_SIZES = 56 };
/* Tags of a slab of memory from which blocks are taken: 64 KB. */
enum { SLAB_TAGS = 1 << 14 };
/* Number of cells up to which a capsule is entered in its bounding box, without slabs: in so few
 * cells, slabs would leave hardly any out. */
enum { SMALL_BOX = 4 };

struct GridArena {
    Slabs slabs;                /* of blocks */
    int32_t *free[BLOCK_SIZES]; /* per size: the first free block, which begins with the address of
                                 * the next one */
};

static double clamp01(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* A grid has at most CELLS_PER_ASKED times the requested number of cells, plus LEAST_CELLS. A long
 * and thin box has that many, because cells are cubes. */
enum { CELLS_PER_ASKED = 8, LEAST_CELLS = 512 };

/* Returns the edge of the cells, mm: that of `cells` cubes, or more if the box is so thin relative
 * to its length that there would be far more cells. */
static double edge_for(Vec3 size, double cells)
{
    double edge = size.z > 0 ? elementary_cbrt(size.x * size.y * size.z / cells)
                             : sqrt(size.x * size.y / cells);
    while ((size.x / edge + 1) * (size.y / edge + 1) * (size.z / edge + 1) >
           LEAST_CELLS + CELLS_PER_ASKED * cells)
        edge *= 1.25;
    return edge;
}

Status grid_reset(Grid *grid, Box box, double cells, size_t segments, int workers, Err *err)
{
    grid_release(grid);
    Vec3 size = vec3_sub(box.high, box.low);
    Grid made = {.low = box.low, .workers = workers};
    made.edge = edge_for(size, cells);
    made.inverse = 1 / made.edge;
    for (int axis = 0; axis < 3; axis++)
        made.count[axis] = (int)(vec3_component(size, axis) / made.edge) + 1;
    made.rounding = 1e-7 * vec3_length(size);
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.item, segments, sizeof *made.item, "segments", err));
    TRY_GOTO(mem_calloc(&made.arena, (size_t)workers, sizeof *made.arena, "threads", err));
    TRY_GOTO(mem_calloc(&made.cell, grid_cells(&made), sizeof *made.cell, "grid cells", err));
    *grid = made;
    return STATUS_OK;
done:
    grid_release(&made);
    return status;
}

void grid_release(Grid *grid)
{
    for (int i = 0; grid->arena && i < grid->workers; i++)
        slabs_release(&grid->arena[i].slabs);
    free(grid->cell);
    free(grid->item);
    free(grid->arena);
    *grid = (Grid){0};
}

size_t grid_cells(const Grid *grid)
{
    return (size_t)grid->count[0] * grid->count[1] * grid->count[2];
}

/* Returns the cell coordinate at the distance `value` mm from the low corner along `axis`, clamped
 * to the grid. */
static int cell_of(const Grid *grid, double value, int axis)
{
    double at = value * grid->inverse;
    return at <= 0 ? 0 : at >= grid->count[axis] ? grid->count[axis] - 1 : (int)at;
}

Box grid_zone(const Grid *grid, GridBox box)
{
    double low[3], high[3], inset = 4 * grid->rounding;
    for (int axis = 0; axis < 3; axis++) {
        double from = vec3_component(grid->low, axis);
        bool first = box.low[axis] <= 0, last = box.high[axis] >= grid->count[axis] - 1;
        low[axis] = first ? -(double)INFINITY : from + box.low[axis] * grid->edge + inset;
        high[axis] = last ? (double)INFINITY : from + (box.high[axis] + 1) * grid->edge - inset;
    }
    return (Box){vec3(low[0], low[1], low[2]), vec3(high[0], high[1], high[2])};
}

double grid_clearance(Box zone, Vec3 point)
{
    Vec3 low = vec3_sub(point, zone.low), high = vec3_sub(zone.high, point);
    return box_min(box_min(box_min(low.x, high.x), box_min(low.y, high.y)), box_min(low.z, high.z));
}

bool grid_zone_holds(const Grid *grid, Box zone, const GridItem *item)
{
    for (int axis = 0; axis < 3; axis++) {
        double from = vec3_component(grid->low, axis), reach = (double)item->reach;
        double a = from + (double)item->proximal[axis], b = from + (double)item->distal[axis];
        if (box_min(a, b) - reach < vec3_component(zone.low, axis) ||
            box_max(a, b) + reach > vec3_component(zone.high, axis))
            return false;
    }
    return true;
}

GridItem grid_item(const Grid *grid, Capsule capsule, double radius)
{
    GridItem item = {.radius = (float)radius, .reach = (float)capsule.radius};
    grid_store(grid, capsule.a, item.proximal);
    grid_store(grid, capsule.b, item.distal);
    return item;
}

/* Sets the walk to the cells of its slab that may meet the capsule. These are the cells of the
 * bounding box of the part of the centreline that is within the radius of the slab. */
static void enter_slab(GridWalk *walk)
{
    const Grid *grid = walk->grid;
    int axis = walk->axis;
    double near = walk->slab * grid->edge - walk->from[axis];
    double t0 = 0, t1 = 1;
    if (walk->span[axis] != 0) {
        double ta = (near - walk->radius) / walk->span[axis];
        double tb = (near + grid->edge + walk->radius) / walk->span[axis];
        t0 = clamp01(box_min(ta, tb));
        t1 = clamp01(box_max(ta, tb));
    }
    for (int i = 0; i < 3; i++) {
        double first = walk->from[i] + t0 * walk->span[i];
        double last = walk->from[i] + t1 * walk->span[i];
        walk->box.low[i] = cell_of(grid, box_min(first, last) - walk->radius, i);
        walk->box.high[i] = cell_of(grid, box_max(first, last) + walk->radius, i);
    }
    walk->box.low[axis] = walk->box.high[axis] = walk->slab;
    for (int i = 0; i < 3; i++)
        walk->at[i] = walk->box.low[i];
}

/* Sets the walk to the bounding box of the capsule, if that has few cells. Most capsules are so
 * short that the box is as good as slabs. Returns false if there are more cells. */
static bool enter_small_box(GridWalk *walk)
{
    int cells = 1;
    for (int i = 0; i < 3; i++) {
        double a = walk->from[i], b = a + walk->span[i];
        walk->box.low[i] = walk->at[i] = cell_of(walk->grid, box_min(a, b) - walk->radius, i);
        walk->box.high[i] = cell_of(walk->grid, box_max(a, b) + walk->radius, i);
        cells *= walk->box.high[i] - walk->box.low[i] + 1;
        if (cells > SMALL_BOX)
            return false;
    }
    return true;
}

GridWalk grid_walk(const Grid *grid, const GridItem *item)
{
    /* Wider by the rounding error of positions on cell borders. */
    GridWalk walk = {.grid = grid, .radius = (double)item->reach + grid->rounding};
    for (int i = 0; i < 3; i++) {
        walk.from[i] = (double)item->proximal[i];
        walk.span[i] = (double)item->distal[i] - walk.from[i];
    }
    if (enter_small_box(&walk))
        return walk;
    for (int i = 1; i < 3; i++)
        if (fabs(walk.span[i]) > fabs(walk.span[walk.axis]))
            walk.axis = i;
    double a = walk.from[walk.axis], b = a + walk.span[walk.axis];
    walk.slab = cell_of(grid, box_min(a, b) - walk.radius, walk.axis);
    walk.last_slab = cell_of(grid, box_max(a, b) + walk.radius, walk.axis);
    enter_slab(&walk);
    return walk;
}

bool grid_walk_next(GridWalk *walk, size_t *cell)
{
    if (walk->slab > walk->last_slab)
        return false;
    *cell = grid_index(walk->grid, walk->at[0], walk->at[1], walk->at[2]);
    for (int axis = 0; axis < 3; axis++) {
        if (walk->at[axis] < walk->box.high[axis]) {
            walk->at[axis]++;
            return true;
        }
        walk->at[axis] = walk->box.low[axis];
    }
    walk->slab++;
    if (walk->slab <= walk->last_slab)
        enter_slab(walk);
    return true;
}

/* Returns the number of tags in a block of a size from 1: 4, 6, 8, 12, 16, 24, ... */
static size_t block_tags(uint32_t size)
{
    return (size_t)(2 + (size - 1) % 2) << ((size - 1) / 2 + 1);
}

/* Takes a block of a size from the arena. */
static Status take_block(GridArena *arena, uint32_t size, int32_t **out, Err *err)
{
    int32_t *block = arena->free[size - 1];
    if (block) {
        memcpy(&arena->free[size - 1], block, sizeof arena->free[size - 1]);
        *out = block;
        return STATUS_OK;
    }
    *out = slabs_alloc(&arena->slabs, block_tags(size) * sizeof **out, SLAB_TAGS * sizeof **out);
    if (!*out)
        return err_set(err, STATUS_MEMORY, "no memory for the entries of the grid");
    return STATUS_OK;
}

/* Returns a block to the arena. */
static void give_block(GridArena *arena, uint32_t size, int32_t *block)
{
    memcpy(block, &arena->free[size - 1], sizeof arena->free[size - 1]);
    arena->free[size - 1] = block;
}

/* Moves the tags of a cell to a block of the next size. */
static Status widen(GridArena *arena, GridCell *cell, Err *err)
{
    int32_t *block = NULL;
    TRY(take_block(arena, cell->size + 1, &block, err));
    if (cell->size > 0) {
        memcpy(block, cell->tag, cell->count * sizeof *block);
        give_block(arena, cell->size, cell->tag);
    }
    cell->tag = block;
    cell->size++;
    return STATUS_OK;
}

Status grid_add(Grid *grid, int worker, int32_t segment, bool terminal, GridItem item, Err *err)
{
    grid->item[segment] = item;
    size_t index;
    for (GridWalk walk = grid_walk(grid, &item); grid_walk_next(&walk, &index);) {
        GridCell *cell = &grid->cell[index];
        if (cell->size == 0 || cell->count == block_tags(cell->size))
            TRY(widen(&grid->arena[worker], cell, err));
        cell->tag[cell->count++] = 2 * segment + terminal;
    }
    return STATUS_OK;
}

void grid_remove(Grid *grid, int32_t segment)
{
    size_t index;
    for (GridWalk walk = grid_walk(grid, &grid->item[segment]); grid_walk_next(&walk, &index);) {
        GridCell *cell = &grid->cell[index];
        int32_t *tag = cell->tag;
        while (*tag >> 1 != segment)
            tag++;
        *tag = cell->tag[--cell->count];
    }
}

SegmentGap segment_gap(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1)
{
    Vec3 u = vec3_sub(a1, a0), v = vec3_sub(b1, b0), w = vec3_sub(a0, b0);
    double uu = vec3_dot(u, u), vv = vec3_dot(v, v), uv = vec3_dot(u, v);
    double uw = vec3_dot(u, w), vw = vec3_dot(v, w);
    double denominator = uu * vv - uv * uv;
    double s = denominator > 0 ? clamp01((uv * vw - uw * vv) / denominator) : 0;
    double t = (uv * s + vw) / vv;
    if (t < 0 || t > 1) {
        t = clamp01(t);
        s = clamp01((uv * t - uw) / uu);
    }
    return (SegmentGap){s, t, vec3_add_scaled(vec3_add_scaled(w, u, s), v, -t)};
}

double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1)
{
    Vec3 apart = segment_gap(a0, a1, b0, b1).apart;
    return vec3_dot(apart, apart);
}

static Vec3 load(const float v[3])
{
    return vec3((double)v[0], (double)v[1], (double)v[2]);
}

double grid_distance2(const GridItem *a, const GridItem *b)
{
    return segment_distance2(load(a->proximal), load(a->distal), load(b->proximal),
                             load(b->distal));
}

double grid_length2(const GridItem *item)
{
    Vec3 along = vec3_sub(load(item->distal), load(item->proximal));
    return vec3_dot(along, along);
}

size_t grid_cell_at(const Grid *grid, Vec3 point)
{
    return grid_index(grid, cell_of(grid, point.x - grid->low.x, 0),
                      cell_of(grid, point.y - grid->low.y, 1),
                      cell_of(grid, point.z - grid->low.z, 2));
}

GridBox grid_box(const Grid *grid, Vec3 point, double distance)
{
    GridBox box;
    for (int axis = 0; axis < 3; axis++) {
        double at = vec3_component(point, axis) - vec3_component(grid->low, axis);
        box.low[axis] = cell_of(grid, at - distance, axis);
        box.high[axis] = cell_of(grid, at + distance, axis);
    }
    return box;
}
