/* Entries are linked lists in one pool, one list a cell. A segment is entered wherever its capsule
 * may reach, so that two capsules that meet always share a cell, and so that the number of entries
 * grows with the segments' total length and not with the boxes around them: the walk cuts the
 * capsule into slabs of cells across its longest axis and bounds each piece by itself.
 *
 * Distances are computed in single precision, relative to nothing: they rank candidates and compare
 * with the toss distance, where an error of 1e-7 of the domain's size is of no account. What must
 * not cross is tested in double precision from the nodes themselves. */
#include "grow/grid.h"

#include <stdlib.h>

static double component(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

Status grid_reset(Grid *grid, Box box, double cells, size_t segments, Err *err)
{
    grid_release(grid);
    Vec3 size = vec3_sub(box.high, box.low);
    Grid made = {.low = box.low, .free = -1};
    made.cell = size.z > 0 ? cbrt(size.x * size.y * size.z / cells) : sqrt(size.x * size.y / cells);
    size_t total = 1;
    for (int axis = 0; axis < 3; axis++) {
        made.count[axis] = (int)(component(size, axis) / made.cell) + 1;
        total *= (size_t)made.count[axis];
    }
    TRY(mem_calloc(&made.reach, segments, sizeof *made.reach, "segments", err));
    Status status = mem_calloc(&made.head, total, sizeof *made.head, "grid cells", err);
    if (status != STATUS_OK) {
        grid_release(&made);
        return status;
    }
    for (size_t i = 0; i < total; i++)
        made.head[i] = -1;
    *grid = made;
    return STATUS_OK;
}

void grid_release(Grid *grid)
{
    free(grid->head);
    free(grid->entry);
    free(grid->reach);
    *grid = (Grid){0};
}

/* The cell coordinate of `value` along `axis`, moved into the grid. */
static int cell_of(const Grid *grid, double value, int axis)
{
    double at = (value - component(grid->low, axis)) / grid->cell;
    return at <= 0 ? 0 : at >= grid->count[axis] ? grid->count[axis] - 1 : (int)at;
}

static size_t cell_index(const Grid *grid, int x, int y, int z)
{
    return ((size_t)z * grid->count[1] + y) * grid->count[0] + x;
}

size_t grid_cell_at(const Grid *grid, Vec3 point)
{
    return cell_index(grid, cell_of(grid, point.x, 0), cell_of(grid, point.y, 1),
                      cell_of(grid, point.z, 2));
}

/* Bounds the part of the capsule in the walk's slab and starts there. */
static void enter_slab(GridWalk *walk)
{
    const Grid *grid = walk->grid;
    const Capsule *capsule = &walk->capsule;
    int axis = walk->axis;
    double from = component(capsule->a, axis), span = component(capsule->b, axis) - from;
    double start = component(grid->low, axis) + walk->slab * grid->cell;
    double t0 = 0, t1 = 1; /* along the centreline, for the slab widened by the radius */
    if (span != 0) {
        double ta = (start - capsule->radius - from) / span;
        double tb = (start + grid->cell + capsule->radius - from) / span;
        t0 = fmin(1, fmax(0, fmin(ta, tb)));
        t1 = fmin(1, fmax(0, fmax(ta, tb)));
    }
    for (int i = 0; i < 3; i++) {
        if (i == axis) {
            walk->low[i] = walk->high[i] = walk->slab;
        } else {
            double base = component(capsule->a, i), across = component(capsule->b, i) - base;
            double first = base + t0 * across, last = base + t1 * across;
            walk->low[i] = cell_of(grid, fmin(first, last) - capsule->radius, i);
            walk->high[i] = cell_of(grid, fmax(first, last) + capsule->radius, i);
        }
        walk->at[i] = walk->low[i];
    }
}

GridWalk grid_walk(const Grid *grid, Capsule capsule)
{
    /* Wider by the rounding of positions on cell borders. */
    capsule.radius += 1e-9 * grid->cell;
    GridWalk walk = {.grid = grid, .capsule = capsule};
    Vec3 span = vec3_sub(capsule.b, capsule.a);
    for (int axis = 1; axis < 3; axis++)
        if (fabs(component(span, axis)) > fabs(component(span, walk.axis)))
            walk.axis = axis;
    double a = component(capsule.a, walk.axis), b = component(capsule.b, walk.axis);
    walk.slab = cell_of(grid, fmin(a, b) - capsule.radius, walk.axis);
    walk.last_slab = cell_of(grid, fmax(a, b) + capsule.radius, walk.axis);
    enter_slab(&walk);
    return walk;
}

bool grid_walk_next(GridWalk *walk, size_t *cell)
{
    if (walk->slab > walk->last_slab)
        return false;
    *cell = cell_index(walk->grid, walk->at[0], walk->at[1], walk->at[2]);
    for (int axis = 0; axis < 3; axis++) {
        if (walk->at[axis] < walk->high[axis]) {
            walk->at[axis]++;
            return true;
        }
        walk->at[axis] = walk->low[axis];
    }
    walk->slab++;
    if (walk->slab <= walk->last_slab)
        enter_slab(walk);
    return true;
}

static void store(Vec3 v, float out[3])
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

Status grid_add(Grid *grid, int32_t segment, bool terminal, Capsule capsule, Err *err)
{
    GridEntry entry = {.tag = 2 * segment + terminal};
    store(capsule.a, entry.proximal);
    store(capsule.b, entry.distal);
    grid->reach[segment] = (float)capsule.radius;
    capsule.radius = (double)grid->reach[segment];
    size_t cell;
    for (GridWalk walk = grid_walk(grid, capsule); grid_walk_next(&walk, &cell);) {
        int32_t at = grid->free;
        if (at >= 0) {
            grid->free = grid->entry[at].next;
        } else {
            TRY(mem_reserve(&grid->entry, &grid->capacity, grid->used + 1, sizeof *grid->entry,
                            "grid entries", err));
            at = (int32_t)grid->used++;
        }
        entry.next = grid->head[cell];
        grid->entry[at] = entry;
        grid->head[cell] = at;
    }
    return STATUS_OK;
}

void grid_remove(Grid *grid, int32_t segment, Vec3 a, Vec3 b)
{
    Capsule capsule = {a, b, (double)grid->reach[segment]};
    size_t cell;
    for (GridWalk walk = grid_walk(grid, capsule); grid_walk_next(&walk, &cell);) {
        int32_t *link = &grid->head[cell];
        while (grid->entry[*link].tag >> 1 != segment)
            link = &grid->entry[*link].next;
        int32_t at = *link;
        *link = grid->entry[at].next;
        grid->entry[at].next = grid->free;
        grid->free = at;
    }
}

static float point_distance2(const GridEntry *entry, const float point[3])
{
    const float *a = entry->proximal, *b = entry->distal;
    float ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    float wx = point[0] - a[0], wy = point[1] - a[1], wz = point[2] - a[2];
    float dot = ux * wx + uy * wy + uz * wz;
    float length2 = ux * ux + uy * uy + uz * uz;
    float t = dot <= 0 ? 0 : dot >= length2 ? 1 : dot / length2;
    float dx = wx - t * ux, dy = wy - t * uy, dz = wz - t * uz;
    return dx * dx + dy * dy + dz * dz;
}

static float end_distance2(const GridEntry *entry, const float point[3])
{
    const float *end = entry->distal;
    float dx = point[0] - end[0], dy = point[1] - end[1], dz = point[2] - end[2];
    return dx * dx + dy * dy + dz * dz;
}

static bool cell_any_within(const Grid *grid, size_t cell, const float point[3], float limit2,
                            bool terminals_only)
{
    for (int32_t at = grid->head[cell]; at >= 0; at = grid->entry[at].next) {
        const GridEntry *entry = &grid->entry[at];
        if (terminals_only) {
            if ((entry->tag & 1) && end_distance2(entry, point) < limit2)
                return true;
        } else if (point_distance2(entry, point) < limit2) {
            return true;
        }
    }
    return false;
}

bool grid_any_within(const Grid *grid, Vec3 point, double distance, bool terminals_only)
{
    float at[3], limit2 = (float)(distance * distance);
    store(point, at);
    /* Most points that are too near something are so within their own cell. */
    if (cell_any_within(grid, grid_cell_at(grid, point), at, limit2, terminals_only))
        return true;
    int low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = cell_of(grid, component(point, axis) - distance, axis);
        high[axis] = cell_of(grid, component(point, axis) + distance, axis);
    }
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int x = low[0]; x <= high[0]; x++)
                if (cell_any_within(grid, cell_index(grid, x, y, z), at, limit2, terminals_only))
                    return true;
    return false;
}

static bool nearer(Near a, Near b)
{
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.segment < b.segment);
}

/* A search for the nearest segments, those found so far sorted in `list`. */
typedef struct Search {
    const Grid *grid;
    Vec3 point;
    float at[3]; /* the point */
    int home[3]; /* its cell */
    int limit, count;
    Near *list;
} Search;

static void gather_cell(Search *search, size_t cell)
{
    Near *list = search->list;
    const GridEntry *entry;
    for (int32_t at = search->grid->head[cell]; at >= 0; at = entry->next) {
        entry = &search->grid->entry[at];
        Near found = {point_distance2(entry, search->at), entry->tag >> 1};
        if (search->count == search->limit && !nearer(found, list[search->count - 1]))
            continue;
        bool known = false;
        for (int i = 0; i < search->count && !known; i++)
            known = list[i].segment == found.segment;
        if (known)
            continue;
        int place = search->count < search->limit ? search->count++ : search->count - 1;
        for (; place > 0 && nearer(found, list[place - 1]); place--)
            list[place] = list[place - 1];
        list[place] = found;
    }
}

/* Squared distance of a value from an interval of one cell's length. */
static double excess2(const Grid *grid, double value, int cell, int axis)
{
    double low = component(grid->low, axis) + cell * grid->cell;
    double excess = fmax(0, fmax(low - value, value - low - grid->cell));
    return excess * excess;
}

/* Gathers every `step`-th cell of a row, except what is further than all that is wanted. */
static void gather_row(Search *search, int first, int last, int step, int y, int z)
{
    const Grid *grid = search->grid;
    double across2 = excess2(grid, search->point.y, y, 1) + excess2(grid, search->point.z, z, 2);
    for (int x = first; x <= last; x += step) {
        if (x < 0 || x >= grid->count[0])
            continue;
        double distance2 = across2 + excess2(grid, search->point.x, x, 0);
        if (search->count < search->limit ||
            distance2 <= (double)search->list[search->count - 1].distance2)
            gather_cell(search, cell_index(grid, x, y, z));
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

int grid_nearest(const Grid *grid, Vec3 point, int limit, Near *out)
{
    Search search = {.grid = grid, .point = point, .limit = limit, .list = out};
    store(point, search.at);
    int farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
        search.home[axis] = cell_of(grid, component(point, axis), axis);
        int other_side = grid->count[axis] - 1 - search.home[axis];
        farthest = search.home[axis] > farthest ? search.home[axis] : farthest;
        farthest = other_side > farthest ? other_side : farthest;
    }
    for (int ring = 0; ring <= farthest; ring++) {
        double clear = (ring - 1) * grid->cell; /* a ring's cells are further than this */
        if (search.count == limit && clear > 0 &&
            clear * clear > (double)out[search.count - 1].distance2)
            break;
        gather_ring(&search, ring);
    }
    return search.count;
}
