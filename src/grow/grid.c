/* A cell lists its segments in one block of memory, in a few block sizes; a block that is outgrown
 * is kept for another cell. What distance queries need of a segment lies in one table of half cache
 * lines, so that a cell costs four bytes a segment and a neighbourhood a few cache lines.
 *
 * A segment is entered wherever its capsule may reach, so that two capsules that meet always share a
 * cell, and so that the number of entries grows with the segments' total length and not with the
 * boxes around them: the walk cuts the capsule into slabs of cells across its longest axis and
 * bounds each piece by itself. It reads the item alone, so that the same cells come out again when
 * the segment is taken out.
 *
 * Coordinates are in single precision from the grid's low corner, where rounding moves them by less
 * than 3e-8 of the grid's size. That is of no account for distances; who wants segments not to
 * cross keeps them further apart than that.
 *
 * Threads that touch different cells need no locks: each worker has an arena of blocks. Which block
 * holds a cell, and in what order, has no influence on any answer. */
#include "grow/grid.h"

#include <assert.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_SIZES = 56, SLAB_TAGS = 1 << 14, SMALL_BOX = 4, CATCH = 64 };

/* Memory for blocks that never moves. */
typedef struct GridSlab {
    struct GridSlab *next;
    int32_t tags[];
} GridSlab;

struct GridArena {
    GridSlab *slab;        /* the one in use, and those before it */
    size_t used, capacity; /* tags of that one */
    int32_t
        *free[BLOCK_SIZES]; /* a free block of each size; it begins with the next one's address */
};

static double component(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static double least(double a, double b)
{
    return a < b ? a : b;
}

static double greatest(double a, double b)
{
    return a > b ? a : b;
}

static double clamp01(double t)
{
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

Status grid_reset(Grid *grid, Box box, double cells, size_t segments, int workers, Err *err)
{
    grid_release(grid);
    Vec3 size = vec3_sub(box.high, box.low);
    Grid made = {.low = box.low, .workers = workers};
    made.edge = size.z > 0 ? cbrt(size.x * size.y * size.z / cells) : sqrt(size.x * size.y / cells);
    made.inverse = 1 / made.edge;
    for (int axis = 0; axis < 3; axis++)
        made.count[axis] = (int)(component(size, axis) / made.edge) + 1;
    made.rounding = 1e-7 * vec3_length(size);
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.item, segments, sizeof *made.item, "segments", err));
    TRY_GOTO(mem_calloc(&made.arena, (size_t)workers, sizeof *made.arena, "threads", err));
    TRY_GOTO(mem_calloc(&made.cell, grid_cells(&made), sizeof *made.cell, "grid cells", err));
    *grid = made;
done:
    if (status != STATUS_OK)
        grid_release(&made);
    return status;
}

void grid_release(Grid *grid)
{
    for (int i = 0; grid->arena && i < grid->workers; i++) {
        for (GridSlab *slab = grid->arena[i].slab, *next; slab; slab = next) {
            next = slab->next;
            free(slab);
        }
    }
    free(grid->cell);
    free(grid->item);
    free(grid->arena);
    *grid = (Grid){0};
}

size_t grid_cells(const Grid *grid)
{
    return (size_t)grid->count[0] * grid->count[1] * grid->count[2];
}

/* The cell coordinate of a distance from the low corner along `axis`, moved into the grid. */
static int cell_of(const Grid *grid, double value, int axis)
{
    double at = value * grid->inverse;
    return at <= 0 ? 0 : at >= grid->count[axis] ? grid->count[axis] - 1 : (int)at;
}

static void store(const Grid *grid, Vec3 v, float out[3])
{
    out[0] = (float)(v.x - grid->low.x);
    out[1] = (float)(v.y - grid->low.y);
    out[2] = (float)(v.z - grid->low.z);
}

Box grid_zone(const Grid *grid, GridBox box)
{
    double low[3], high[3], inset = 4 * grid->rounding;
    for (int axis = 0; axis < 3; axis++) {
        double from = component(grid->low, axis);
        bool first = box.low[axis] <= 0, last = box.high[axis] >= grid->count[axis] - 1;
        low[axis] = first ? -(double)INFINITY : from + box.low[axis] * grid->edge + inset;
        high[axis] = last ? (double)INFINITY : from + (box.high[axis] + 1) * grid->edge - inset;
    }
    return (Box){vec3(low[0], low[1], low[2]), vec3(high[0], high[1], high[2])};
}

double grid_clearance(Box zone, Vec3 point)
{
    Vec3 low = vec3_sub(point, zone.low), high = vec3_sub(zone.high, point);
    return least(least(least(low.x, high.x), least(low.y, high.y)), least(low.z, high.z));
}

bool grid_zone_holds(const Grid *grid, Box zone, const GridItem *item)
{
    for (int axis = 0; axis < 3; axis++) {
        double from = component(grid->low, axis), reach = (double)item->reach;
        double a = from + (double)item->proximal[axis], b = from + (double)item->distal[axis];
        if (least(a, b) - reach < component(zone.low, axis) ||
            greatest(a, b) + reach > component(zone.high, axis))
            return false;
    }
    return true;
}

GridItem grid_item(const Grid *grid, Capsule capsule, double radius)
{
    GridItem item = {.radius = (float)radius, .reach = (float)capsule.radius};
    store(grid, capsule.a, item.proximal);
    store(grid, capsule.b, item.distal);
    return item;
}

/* Goes to the cells of the slab that may meet the capsule: those of the box around the part of the
 * centreline within the radius of the slab. */
static void enter_slab(GridWalk *walk)
{
    const Grid *grid = walk->grid;
    int axis = walk->axis;
    double near = walk->slab * grid->edge - walk->from[axis];
    double t0 = 0, t1 = 1;
    if (walk->span[axis] != 0) {
        double ta = (near - walk->radius) / walk->span[axis];
        double tb = (near + grid->edge + walk->radius) / walk->span[axis];
        t0 = clamp01(least(ta, tb));
        t1 = clamp01(greatest(ta, tb));
    }
    for (int i = 0; i < 3; i++) {
        double first = walk->from[i] + t0 * walk->span[i];
        double last = walk->from[i] + t1 * walk->span[i];
        walk->box.low[i] = cell_of(grid, least(first, last) - walk->radius, i);
        walk->box.high[i] = cell_of(grid, greatest(first, last) + walk->radius, i);
    }
    walk->box.low[axis] = walk->box.high[axis] = walk->slab;
    for (int i = 0; i < 3; i++)
        walk->at[i] = walk->box.low[i];
}

/* Most capsules are so short that the box around them is as good as slabs. */
static bool enter_small_box(GridWalk *walk)
{
    int cells = 1;
    for (int i = 0; i < 3; i++) {
        double a = walk->from[i], b = a + walk->span[i];
        walk->box.low[i] = walk->at[i] = cell_of(walk->grid, least(a, b) - walk->radius, i);
        walk->box.high[i] = cell_of(walk->grid, greatest(a, b) + walk->radius, i);
        cells *= walk->box.high[i] - walk->box.low[i] + 1;
        if (cells > SMALL_BOX)
            return false;
    }
    return true;
}

GridWalk grid_walk(const Grid *grid, const GridItem *item)
{
    /* Wider by the rounding of places on cell borders. */
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
    walk.slab = cell_of(grid, least(a, b) - walk.radius, walk.axis);
    walk.last_slab = cell_of(grid, greatest(a, b) + walk.radius, walk.axis);
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

/* Tags in a block of a size from 1: 4, 6, 8, 12, 16, 24, ... */
static size_t block_tags(uint32_t size)
{
    return (size_t)(2 + (size - 1) % 2) << ((size - 1) / 2 + 1);
}

/* A block of a size, off the arena. */
static Status take_block(GridArena *arena, uint32_t size, int32_t **out, Err *err)
{
    int32_t *block = arena->free[size - 1];
    if (block) {
        memcpy(&arena->free[size - 1], block, sizeof arena->free[size - 1]);
        *out = block;
        return STATUS_OK;
    }
    size_t tags = block_tags(size);
    if (!arena->slab || arena->used + tags > arena->capacity) {
        size_t capacity = tags > SLAB_TAGS ? tags : SLAB_TAGS;
        GridSlab *slab = malloc(sizeof *slab + capacity * sizeof *slab->tags);
        if (!slab)
            return err_set(err, STATUS_MEMORY, "no memory for the entries of the grid");
        slab->next = arena->slab;
        arena->slab = slab;
        arena->used = 0;
        arena->capacity = capacity;
    }
    *out = arena->slab->tags + arena->used;
    arena->used += tags;
    return STATUS_OK;
}

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

double segment_distance2(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1)
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
    Vec3 apart = vec3_add_scaled(vec3_add_scaled(w, u, s), v, -t);
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

static inline float point_distance2(const GridItem *item, const float point[3])
{
    const float *a = item->proximal, *b = item->distal;
    float ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    float wx = point[0] - a[0], wy = point[1] - a[1], wz = point[2] - a[2];
    float dot = ux * wx + uy * wy + uz * wz;
    float length2 = ux * ux + uy * uy + uz * uz;
    float along =
        dot > 0 ? dot : 0; /* selected, not branched to: which end is near is anyone's guess */
    along = along < length2 ? along : length2;
    float t = along / (length2 > FLT_MIN ? length2 : FLT_MIN);
    float dx = wx - t * ux, dy = wy - t * uy, dz = wz - t * uz;
    return dx * dx + dy * dy + dz * dz;
}

static inline float end_distance2(const GridItem *item, const float point[3])
{
    const float *end = item->distal;
    float dx = point[0] - end[0], dy = point[1] - end[1], dz = point[2] - end[2];
    return dx * dx + dy * dy + dz * dz;
}

/* A few numbers at a time; every compiler knows how, on any machine. */
enum { LANES = GRID_LANES };
typedef float Floats __attribute__((vector_size(16)));
typedef int32_t Ints __attribute__((vector_size(16)));

/* The points of segments next to a point. */
typedef struct Foot {
    Ints segment;
    Floats at[3], distance2, radius;
} Foot;

static inline void transpose(Floats row[LANES])
{
    Floats a = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
    Floats b = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
    Floats c = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
    Floats d = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
    row[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    row[1] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    row[2] = __builtin_shufflevector(c, d, 0, 1, 4, 5);
    row[3] = __builtin_shufflevector(c, d, 2, 3, 6, 7);
}

static inline Floats pick(Ints mask, Floats yes, Floats no)
{
    return (Floats)((mask & (Ints)yes) | (~mask & (Ints)no));
}

/* The items of the k-th and the next segments of a cell, number by number; the last one's again where
 * there are no more. */
static inline void load_items(const Grid *grid, const GridCell *cell, uint32_t k,
                              Floats out[2 * LANES], Ints *segments)
{
    static_assert(sizeof(GridItem) == 2 * sizeof(Floats), "two rows of a matrix");
    for (uint32_t lane = 0; lane < LANES; lane++) {
        int32_t segment = cell->tag[k + lane < cell->count ? k + lane : cell->count - 1] >> 1;
        const char *item = (const char *)&grid->item[segment];
        (*segments)[lane] = segment;
        memcpy(&out[lane], item, sizeof *out);
        memcpy(&out[LANES + lane], item + sizeof *out, sizeof *out);
    }
    transpose(out);
    transpose(out + LANES);
}

/* As point_distance2, of such segments. */
static inline Foot foot_of(const Grid *grid, const GridCell *cell, uint32_t k, const float point[3])
{
    Foot out;
    Floats item[2 * LANES];
    load_items(grid, cell, k, item, &out.segment);
    Floats ux = item[3] - item[0], uy = item[4] - item[1], uz = item[5] - item[2];
    Floats wx = point[0] - item[0], wy = point[1] - item[1], wz = point[2] - item[2];
    Floats dot = ux * wx + uy * wy + uz * wz, length2 = ux * ux + uy * uy + uz * uz;
    Floats zero = {0}, least = zero + FLT_MIN;
    Floats along = pick(dot > 0, dot, zero);
    along = pick(along < length2, along, length2);
    Floats t = along / pick(length2 > least, length2, least);
    Floats dx = wx - t * ux, dy = wy - t * uy, dz = wz - t * uz;
    out.at[0] = item[0] + t * ux;
    out.at[1] = item[1] + t * uy;
    out.at[2] = item[2] + t * uz;
    out.distance2 = dx * dx + dy * dy + dz * dz;
    out.radius = item[6];
    return out;
}

static inline bool any(Ints mask)
{
    uint64_t half[2];
    memcpy(half, &mask, sizeof half);
    return (half[0] | half[1]) != 0;
}

GridProbe grid_probe(const GridItem *item, double apart, double per_radius)
{
    const double more = 1 + 1e-5;
    GridProbe out = {.apart = (float)(apart * more), .per_radius = (float)(per_radius * more)};
    for (int axis = 0; axis < 3; axis++) {
        float a = item->proximal[axis], b = item->distal[axis];
        out.low[axis] = a < b ? a : b;
        out.high[axis] = a < b ? b : a;
    }
    return out;
}

unsigned grid_meet(const Grid *grid, const GridCell *cell, uint32_t k, const GridProbe *probe)
{
    Ints segments;
    Floats item[2 * LANES];
    load_items(grid, cell, k, item, &segments);
    Floats need = probe->apart + probe->per_radius * item[6];
    Ints off = {0};
    for (int axis = 0; axis < 3; axis++) {
        Floats a = item[axis], b = item[3 + axis];
        Floats low = pick(a < b, a, b), high = pick(a < b, b, a);
        off |= (probe->low[axis] - high > need) | (low - probe->high[axis] > need);
    }
    unsigned bits = 0;
    for (uint32_t lane = 0; lane < LANES && k + lane < cell->count; lane++)
        bits |= (unsigned)(1 + off[lane]) << lane;
    return bits;
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
        double at = component(point, axis) - component(grid->low, axis);
        box.low[axis] = cell_of(grid, at - distance, axis);
        box.high[axis] = cell_of(grid, at + distance, axis);
    }
    return box;
}

/* What grid_room looks for. */
typedef struct Query {
    float at[3]; /* the point */
    float distance2, thickness;
    bool terminals_only;
} Query;

/* As cell_room, with distances from segments. */
static GridRoom cell_room_along(const Grid *grid, const GridCell *cell, const Query *query)
{
    Ints in = {0};
    for (uint32_t k = 0; k < cell->count; k += LANES) {
        Foot foot = foot_of(grid, cell, k, query->at);
        if (any(foot.distance2 < query->distance2))
            return GRID_TOO_NEAR;
        Floats radius = query->thickness * foot.radius;
        in |= foot.distance2 < radius * radius;
    }
    return any(in) ? GRID_IN_VESSEL : GRID_FREE;
}

static GridRoom cell_room(const Grid *grid, size_t index, const Query *query)
{
    const GridCell *cell = &grid->cell[index];
    if (!query->terminals_only)
        return cell_room_along(grid, cell, query);
    GridRoom room = GRID_FREE;
    for (uint32_t i = 0; i < cell->count; i++) {
        const GridItem *item = &grid->item[cell->tag[i] >> 1];
        float distance2 = point_distance2(item, query->at);
        if ((cell->tag[i] & 1) && end_distance2(item, query->at) < query->distance2)
            return GRID_TOO_NEAR;
        float radius = query->thickness * item->radius;
        if (distance2 < radius * radius)
            room = GRID_IN_VESSEL;
    }
    return room;
}

GridRoom grid_room(const Grid *grid, Vec3 point, double distance, bool terminals_only,
                   double thickness)
{
    Query query = {.distance2 = (float)(distance * distance),
                   .thickness = (float)thickness,
                   .terminals_only = terminals_only};
    store(grid, point, query.at);
    /* Its own cell has every vessel that may hold the point, and most that are too near. */
    size_t home = grid_cell_at(grid, point);
    GridRoom room = cell_room(grid, home, &query);
    if (room == GRID_TOO_NEAR)
        return room;
    GridBox box = grid_box(grid, point, distance);
    for (int z = box.low[2]; z <= box.high[2]; z++)
        for (int y = box.low[1]; y <= box.high[1]; y++)
            for (int x = box.low[0]; x <= box.high[0]; x++) {
                size_t index = grid_index(grid, x, y, z);
                if (index != home && cell_room(grid, index, &query) == GRID_TOO_NEAR)
                    return GRID_TOO_NEAR;
            }
    return room;
}

static bool nearer(Near a, Near b)
{
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.segment < b.segment);
}

/* A search for the nearest segments, those found so far sorted in `list`. */
typedef struct Search {
    const Grid *grid;
    float at[3]; /* the point */
    int home[3]; /* its cell */
    int limit, count;
    Near *list;
} Search;

static void gather_cell(Search *search, size_t index)
{
    Near *list = search->list;
    const GridCell *cell = &search->grid->cell[index];
    for (uint32_t k = 0; k < cell->count; k++) {
        int32_t segment = cell->tag[k] >> 1;
        Near found = {point_distance2(&search->grid->item[segment], search->at), segment};
        if (search->count == search->limit && !nearer(found, list[search->count - 1]))
            continue;
        bool known = false;
        for (int i = 0; i < search->count && !known; i++)
            known = list[i].segment == segment;
        if (known)
            continue;
        int place = search->count < search->limit ? search->count++ : search->count - 1;
        for (; place > 0 && nearer(found, list[place - 1]); place--)
            list[place] = list[place - 1];
        list[place] = found;
    }
}

/* Squared distance of the point from a row of cells, or with all cells of that column, along one
 * axis. */
static double excess2(const Search *search, int cell, int axis)
{
    double low = cell * search->grid->edge, at = (double)search->at[axis];
    double excess = greatest(0, greatest(low - at, at - low - search->grid->edge));
    return excess * excess;
}

/* Gathers every `step`-th cell of a row, except what is further than all that is wanted. */
static void gather_row(Search *search, int first, int last, int step, int y, int z)
{
    const Grid *grid = search->grid;
    double across2 = excess2(search, y, 1) + excess2(search, z, 2);
    for (int x = first; x <= last; x += step) {
        if (x < 0 || x >= grid->count[0])
            continue;
        if (search->count < search->limit ||
            across2 + excess2(search, x, 0) <= (double)search->list[search->count - 1].distance2)
            gather_cell(search, grid_index(grid, x, y, z));
    }
}

/* Gathers the cells at `ring` steps from the point's own: whole rows at the faces of the cube, the
 * two ends of rows between them. */
static void gather_ring(Search *search, int ring)
{
    const int *home = search->home, *count = search->grid->count;
    for (int z = home[2] - ring; z <= home[2] + ring; z++)
        for (int y = home[1] - ring; y <= home[1] + ring; y++) {
            if (z < 0 || z >= count[2] || y < 0 || y >= count[1])
                continue;
            bool face = abs(z - home[2]) == ring || abs(y - home[1]) == ring;
            gather_row(search, home[0] - ring, home[0] + ring, face ? 1 : 2 * ring, y, z);
        }
}

int grid_nearest(const Grid *grid, Vec3 point, double within, int limit, Near *out)
{
    Search search = {.grid = grid, .limit = limit, .list = out};
    store(grid, point, search.at);
    GridBox own = grid_box(grid, point, 0);
    int farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
        search.home[axis] = own.low[axis];
        int other_side = grid->count[axis] - 1 - search.home[axis];
        farthest = search.home[axis] > farthest ? search.home[axis] : farthest;
        farthest = other_side > farthest ? other_side : farthest;
    }
    for (int ring = 0; ring <= farthest; ring++) {
        double clear = (ring - 1) * grid->edge; /* a ring's cells are further than this */
        if (search.count == limit && clear > 0 &&
            clear * clear > (double)out[search.count - 1].distance2)
            break;
        if ((ring + 1) * grid->edge > within)
            return -1;
        gather_ring(&search, ring);
    }
    return search.count;
}

/* Segments found, as numbers that order like nearer(): the bits of a distance that is not negative,
 * then the segment. */
typedef struct Catch {
    uint64_t key[CATCH + LANES];
    size_t n;
} Catch;

/* The bounds of a cell along an axis; the outermost ones have none. */
static void bounds_of(const Grid *grid, int cell, int axis, float out[2])
{
    out[0] = cell > 0 ? (float)(cell * grid->edge) : -FLT_MAX;
    out[1] = cell < grid->count[axis] - 1 ? (float)((cell + 1) * grid->edge) : FLT_MAX;
}

/* Catches those segments of a cell whose point next to `point` is in this very cell, so each once. */
static void catch_cell(const Grid *grid, const GridCell *cell, float bounds[3][2],
                       const float point[3], float reach2, Catch *out)
{
    size_t n = out->n;
    for (uint32_t k = 0; k < cell->count; k += LANES) {
        Foot foot = foot_of(grid, cell, k, point);
        Ints in = foot.distance2 <= reach2;
        for (int axis = 0; axis < 3; axis++)
            in &= (foot.at[axis] >= bounds[axis][0]) & (foot.at[axis] < bounds[axis][1]);
        Ints bits = (Ints)foot.distance2;
        for (int lane = 0; lane < LANES; lane++) {
            out->key[n] = (uint64_t)(uint32_t)bits[lane] << 32 | (uint32_t)foot.segment[lane];
            n += (k + lane < cell->count) & in[lane];
        }
    }
    out->n = n;
}

/* Sorts by counting how many are less, which needs no branches. */
static void sort_catch(const Catch *found, int limit, Near *out)
{
    for (size_t i = 0; i < found->n; i++) {
        int less = 0;
        for (size_t j = 0; j < found->n; j++)
            less += found->key[j] < found->key[i];
        if (less < limit) {
            uint32_t bits = (uint32_t)(found->key[i] >> 32);
            out[less].segment = (int32_t)(uint32_t)found->key[i];
            memcpy(&out[less].distance2, &bits, sizeof bits);
        }
    }
}

bool grid_nearest_quick(const Grid *grid, Vec3 point, double reach, int limit, Near *out)
{
    Catch found;
    float at[3], reach2 = (float)(reach * reach), bounds[3][2];
    found.n = 0;
    store(grid, point, at);
    GridBox box = grid_box(grid, point, reach * (1 + 1e-6) + grid->rounding);
    for (int z = box.low[2]; z <= box.high[2]; z++) {
        bounds_of(grid, z, 2, bounds[2]);
        for (int y = box.low[1]; y <= box.high[1]; y++) {
            bounds_of(grid, y, 1, bounds[1]);
            for (int x = box.low[0]; x <= box.high[0]; x++) {
                const GridCell *cell = &grid->cell[grid_index(grid, x, y, z)];
                bounds_of(grid, x, 0, bounds[0]);
                if (found.n + cell->count > CATCH)
                    return false;
                catch_cell(grid, cell, bounds, at, reach2, &found);
            }
        }
    }
    if (found.n < (size_t)limit)
        return false;
    sort_catch(&found, limit, out);
    return true;
}
