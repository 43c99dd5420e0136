/* Queries of the grid of segments: the nearest segments of a point, and whether a segment is within
 * a distance.
 *
 * The cells around a point list more segments than are near it, so that most of the work is to find
 * that a segment is not near. The search tests four segments at a time, without branches, which no
 * processor could predict.
 *
 * grid_nearest_quick searches within a guessed distance. A segment counts only in the one cell that
 * holds its point nearest to the query, so that each is found once. Segments are ranked by counting
 * how many are nearer (sort_found). If the guess was too small, grid_nearest searches rings of
 * cells around the point, one after another, with a sorted list of the nearest segments. */
#include "grow/cco/grid.h"

#include <assert.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Maximum number of segments that the quick search finds. Ranking them takes 64^2 comparisons at
 * most; with more segments, grid_nearest is as fast. */
enum { MAX_FOUND = 64 };

/* Vectors of the compiler's own kind, which gcc and clang compile for any machine. */
enum { LANES = GRID_LANES };
typedef float Floats __attribute__((vector_size(16)));
typedef int32_t Ints __attribute__((vector_size(16)));

/* Of four segments: their points nearest to a given point, and the squared distances of these. */
typedef struct GridFoot {
    Ints segment;
    Floats at[3], distance2, radius;
} GridFoot;

/* Transposes a matrix of four rows. */
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

/* Returns `yes` in the lanes of the mask, `no` in the others. */
static inline Floats pick(Ints mask, Floats yes, Floats no)
{
    return (Floats)((mask & (Ints)yes) | (~mask & (Ints)no));
}

/* Loads the items of four segments of a cell, from the k-th on, transposed: out[c] is number c of
 * the four items. Past the end of the cell's list, the last segment is repeated. */
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

/* Finds the nearest points of four segments of a cell, from the k-th on. */
static inline GridFoot foot_of(const Grid *grid, const GridCell *cell, uint32_t k,
                               const float point[3])
{
    GridFoot out;
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

GridBoxQuery grid_box_query(const GridItem *item, double apart, double per_radius)
{
    const double more = 1 + 1e-5;
    GridBoxQuery out = {.apart = (float)(apart * more), .per_radius = (float)(per_radius * more)};
    for (int axis = 0; axis < 3; axis++) {
        float a = item->proximal[axis], b = item->distal[axis];
        out.low[axis] = a < b ? a : b;
        out.high[axis] = a < b ? b : a;
    }
    return out;
}

unsigned grid_boxes_near(const Grid *grid, const GridCell *cell, uint32_t k,
                         const GridBoxQuery *probe)
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

/* The arguments of grid_vicinity. */
typedef struct Query {
    float at[3]; /* the point */
    float distance2, thickness;
    bool terminals_only;
} Query;

/* Returns true if one of four segments of a cell, from the k-th on, is a terminal whose end is too
 * near to the point. */
static bool is_end_near(const Grid *grid, const GridCell *cell, uint32_t k, const Query *query)
{
    for (uint32_t i = k; i < k + LANES && i < cell->count; i++) {
        const float *end = grid->item[cell->tag[i] >> 1].distal, *at = query->at;
        float dx = at[0] - end[0], dy = at[1] - end[1], dz = at[2] - end[2];
        if ((cell->tag[i] & 1) && dx * dx + dy * dy + dz * dz < query->distance2)
            return true;
    }
    return false;
}

/* Answers grid_vicinity for the segments of one cell. */
static GridVicinity cell_vicinity(const Grid *grid, size_t index, const Query *query)
{
    const GridCell *cell = &grid->cell[index];
    Ints in = {0};
    for (uint32_t k = 0; k < cell->count; k += LANES) {
        GridFoot foot = foot_of(grid, cell, k, query->at);
        if (query->terminals_only ? is_end_near(grid, cell, k, query)
                                  : any(foot.distance2 < query->distance2))
            return GRID_TOO_NEAR;
        Floats radius = query->thickness * foot.radius;
        in |= foot.distance2 < radius * radius;
    }
    return any(in) ? GRID_IN_VESSEL : GRID_FREE;
}

GridVicinity grid_vicinity(const Grid *grid, Vec3 point, double distance, bool terminals_only,
                           double thickness)
{
    Query query = {.distance2 = (float)(distance * distance),
                   .thickness = (float)thickness,
                   .terminals_only = terminals_only};
    grid_store(grid, point, query.at);
    /* The point's own cell lists every vessel that may contain the point, and most segments that
     * are too near. */
    size_t home = grid_cell_at(grid, point);
    GridVicinity room = cell_vicinity(grid, home, &query);
    if (room == GRID_TOO_NEAR)
        return room;
    GridBox box = grid_box(grid, point, distance);
    for (int z = box.low[2]; z <= box.high[2]; z++)
        for (int y = box.low[1]; y <= box.high[1]; y++)
            for (int x = box.low[0]; x <= box.high[0]; x++) {
                size_t index = grid_index(grid, x, y, z);
                if (index != home && cell_vicinity(grid, index, &query) == GRID_TOO_NEAR)
                    return GRID_TOO_NEAR;
            }
    return room;
}

static bool nearer(Near a, Near b)
{
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.segment < b.segment);
}

/* A search for the nearest segments, those found so far sorted in `list`. */
typedef struct NearestSearch {
    const Grid *grid;
    float at[3]; /* the point */
    int home[3]; /* its cell */
    int limit, count;
    Near *list;
} NearestSearch;

/* Inserts a segment into the list if it is among the nearest and not yet there. */
static void insert(NearestSearch *search, Near found)
{
    Near *list = search->list;
    if (search->count == search->limit && !nearer(found, list[search->count - 1]))
        return;
    for (int i = 0; i < search->count; i++)
        if (list[i].segment == found.segment)
            return;
    int place = search->count < search->limit ? search->count++ : search->count - 1;
    for (; place > 0 && nearer(found, list[place - 1]); place--)
        list[place] = list[place - 1];
    list[place] = found;
}

/* Inserts all segments of a cell into the list. */
static void gather_cell(NearestSearch *search, size_t index)
{
    const GridCell *cell = &search->grid->cell[index];
    for (uint32_t k = 0; k < cell->count; k += LANES) {
        GridFoot foot = foot_of(search->grid, cell, k, search->at);
        for (uint32_t lane = 0; lane < LANES && k + lane < cell->count; lane++)
            insert(search, (Near){foot.distance2[lane], foot.segment[lane]});
    }
}

/* Returns the squared distance, mm^2, along one axis, of the point from the cells with the index
 * `cell` along this axis. */
static double excess2(const NearestSearch *search, int cell, int axis)
{
    double low = cell * search->grid->edge, at = (double)search->at[axis];
    double excess = box_max(0, box_max(low - at, at - low - search->grid->edge));
    return excess * excess;
}

/* Returns the first of `low`, `low` + `step`, ... that is not below 0. */
static int first_from(int low, int step)
{
    return low >= 0 ? low : low + (step - 1 - low) / step * step;
}

/* Gathers every `step`-th cell of a row, except cells that are further away than the last segment
 * of a full list. */
static void gather_row(NearestSearch *search, int ring, int step, int y, int z)
{
    const Grid *grid = search->grid;
    double across2 = excess2(search, y, 1) + excess2(search, z, 2);
    int last = search->home[0] + ring;
    for (int x = first_from(search->home[0] - ring, step); x <= last && x < grid->count[0];
         x += step)
        if (search->count < search->limit ||
            across2 + excess2(search, x, 0) <= (double)search->list[search->count - 1].distance2)
            gather_cell(search, grid_index(grid, x, y, z));
}

/* Returns true if one of the ring's two faces across `axis` is in the grid. */
static bool has_face(const NearestSearch *search, int ring, int axis)
{
    int home = search->home[axis];
    return home >= ring || search->grid->count[axis] - home > ring;
}

/* Gathers the cells at `ring` steps from the point's own cell: the six faces of a cube. The faces
 * across z are visited as layers, those across y as rows, and those across x as the two ends of
 * rows. Layers and rows that hold no cell of the ring are skipped; in a long and thin grid, a ring
 * would otherwise take as many steps as its number. */
static void gather_ring(NearestSearch *search, int ring)
{
    const int *home = search->home, *count = search->grid->count;
    int apart = ring > 0 ? 2 * ring : 1; /* of two faces */
    bool face_x = has_face(search, ring, 0), face_y = has_face(search, ring, 1);
    int step_z = face_x || face_y ? 1 : apart;
    for (int z = first_from(home[2] - ring, step_z); z <= home[2] + ring && z < count[2];
         z += step_z) {
        bool layer = abs(z - home[2]) == ring;
        int step_y = layer || face_x ? 1 : apart;
        for (int y = first_from(home[1] - ring, step_y); y <= home[1] + ring && y < count[1];
             y += step_y)
            gather_row(search, ring, layer || abs(y - home[1]) == ring ? 1 : apart, y, z);
    }
}

int grid_nearest(const Grid *grid, Vec3 point, double within, int limit, Near *out)
{
    NearestSearch search = {.grid = grid, .limit = limit, .list = out};
    grid_store(grid, point, search.at);
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

/* Segments found by the quick search, as numbers that order like nearer(): the bits of the squared
 * distance, which is not negative, then the segment. */
typedef struct FoundSegments {
    uint64_t key[MAX_FOUND + LANES];
    size_t n;
} FoundSegments;

/* Sets the bounds of a cell along an axis; outer faces of the grid have no bound. */
static void bounds_of(const Grid *grid, int cell, int axis, float out[2])
{
    out[0] = cell > 0 ? (float)(cell * grid->edge) : -FLT_MAX;
    out[1] = cell < grid->count[axis] - 1 ? (float)((cell + 1) * grid->edge) : FLT_MAX;
}

/* Adds the segments of a cell whose nearest point to `point` is in this cell, so that each segment
 * is added once. */
static void find_in_cell(const Grid *grid, const GridCell *cell, float bounds[3][2],
                         const float point[3], float reach2, FoundSegments *out)
{
    size_t n = out->n;
    for (uint32_t k = 0; k < cell->count; k += LANES) {
        GridFoot foot = foot_of(grid, cell, k, point);
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

/* Stores the nearest `limit` segments, sorted. The place of a segment is the number of lower keys,
 * which is found without branches. */
static void sort_found(const FoundSegments *found, int limit, Near *out)
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
    FoundSegments found;
    float at[3], reach2 = (float)(reach * reach), bounds[3][2];
    found.n = 0;
    grid_store(grid, point, at);
    GridBox box = grid_box(grid, point, reach * (1 + 1e-6) + grid->rounding);
    for (int z = box.low[2]; z <= box.high[2]; z++) {
        bounds_of(grid, z, 2, bounds[2]);
        for (int y = box.low[1]; y <= box.high[1]; y++) {
            bounds_of(grid, y, 1, bounds[1]);
            for (int x = box.low[0]; x <= box.high[0]; x++) {
                const GridCell *cell = &grid->cell[grid_index(grid, x, y, z)];
                bounds_of(grid, x, 0, bounds[0]);
                if (found.n + cell->count > MAX_FOUND)
                    return false;
                find_in_cell(grid, cell, bounds, at, reach2, &found);
            }
        }
    }
    if (found.n < (size_t)limit)
        return false;
    sort_found(&found, limit, out);
    return true;
}

int grid_nearest_adaptive(const Grid *grid, Vec3 point, double within, int limit, double *reach,
                          Near *out)
{
    int count = limit;
    if (!(*reach + grid->edge < within) || !grid_nearest_quick(grid, point, *reach, limit, out))
        count = grid_nearest(grid, point, within, limit, out);
    if (count < limit)
        return count;
    double last = sqrt((double)out[limit - 1].distance2);
    /* The next guess: a running mean of 1.25 times the distance of the last segment. */
    *reach += (*reach > 0 ? 0.1 : 1) * (1.25 * last - *reach);
    /* The same condition for both searches, so that the result does not depend on *reach. */
    return last + 2 * grid->edge < within ? count : -1;
}
