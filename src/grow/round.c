/* Connects the random points of one round of growth to the tree, on several threads.
 *
 * The points are sorted into square tiles of grid cells. The points of a tile are planned and
 * connected one after another. The data that they need then stays in the processor's cache, for a
 * tree of any size.
 *
 * Threads work on different tiles in parallel. The points of a tile may read and change what is in
 * the tile's zone, which extends half a tile beyond it on all sides. Tiles have 2 x 2 (x 2)
 * colors, like a chessboard, and the colors are processed one after another. Zones of one color
 * have no point in common, so the tree does not depend on the number of threads. The few points
 * that would need more than the zone are left over; one thread connects them at the end. The seams
 * between tiles move from round to round, so that no position is always on a seam. A small tree is
 * one tile.
 *
 * round_run calls run_tiles, which divides the grid (make_cut), sorts the points (sort_points),
 * distributes nodes and limits (endow), and connects the points of each tile (run_tile: run_point,
 * connect). gather sums the results. The points that are left over then go through run_tile as one
 * tile that covers the domain. */
#include "grow/round.h"

#include <stdlib.h>
#include <string.h>

/* Number of cells along a tile's edge: a tile then has about 1,000 terminals, whose data fit into a
 * processor's cache. Larger tiles leave fewer points over, and fewer tiles for threads. */
enum { EDGE_2D = 34, EDGE_3D = 10 };
/* With fewer tiles, or fewer points in a tile, one thread connects all points: threads would wait
 * for each other longer than they work. */
enum { LEAST_TILES = 4, LEAST_POINTS = 16 };
/* In a tile, at most one point in POINTS_PER_CONNECTED may be connected; one in three
 * is expected. */
enum { POINTS_PER_CONNECTED = 2 };
/* Number of points by which prefetching is ahead; fetch prefetches 1, 2, 3 and 8 times this number
 * ahead. It changes speed only. */
enum { AHEAD = 2 };

struct Tile {
    size_t first, end; /* points in `order` */
    Box zone;
    GridBox box;                   /* slightly more than its own cells, for warm */
    const int32_t *spare;          /* nodes that it may use */
    size_t most, made;             /* terminals */
    size_t over;                   /* points left over; they are then the first ones in `order` */
    size_t *left;                  /* per tree: number of terminals that it may still get here */
    double reach;                  /* its planner's at the end [plan.h] */
    size_t count[PLAN_STATES + 1]; /* as Round.count */
};

Status round_init(Round *round, int candidates, size_t trees, int threads, Err *err)
{
    *round = (Round){.trees = trees, .threads = threads};
    TRY(mem_calloc(&round->planner, (size_t)threads, sizeof *round->planner, "threads", err));
    for (int i = 0; i < threads; i++)
        TRY(planner_init(&round->planner[i], candidates, err));
    return STATUS_OK;
}

void round_release(Round *round)
{
    for (int i = 0; round->planner && i < round->threads; i++)
        planner_release(&round->planner[i]);
    free(round->planner);
    free(round->point);
    free(round->tile_of);
    free(round->order);
    free(round->tile);
    free(round->left);
    free(round->misses);
    *round = (Round){0};
}

Status round_use_grid(Round *round, const Grid *grid, Err *err)
{
    free(round->misses);
    free(round->tile);
    free(round->left);
    round->misses = NULL;
    round->tile = NULL;
    round->left = NULL;
    round->tile_edge = grid->count[2] > 1 ? EDGE_3D : EDGE_2D;
    round->tiles = 1;
    size_t whole = 1;
    for (int axis = 0; axis < 3; axis++) {
        size_t tiles = (size_t)(grid->count[axis] / round->tile_edge);
        whole *= tiles > 1 ? tiles : 1;
        round->tiles *= grid->count[axis] > 1 ? tiles + 2 : 1; /* with those that stick out */
    }
    round->is_tiled = whole >= LEAST_TILES;
    TRY(mem_calloc(&round->tile, round->tiles, sizeof *round->tile, "tiles", err));
    TRY(mem_calloc(&round->left, round->tiles * round->trees, sizeof *round->left, "tiles", err));
    return mem_calloc(&round->misses, grid_cells(grid), sizeof *round->misses, "grid cells", err);
}

Status round_start(Round *round, size_t points, Err *err)
{
    round->n = points;
    round->number++;
    if (points <= round->capacity)
        return STATUS_OK;
    free(round->tile_of);
    free(round->order);
    round->tile_of = round->order = NULL;
    TRY(mem_reserve(&round->point, &round->capacity, points, sizeof *round->point, "points", err));
    TRY(mem_calloc(&round->tile_of, round->capacity, sizeof *round->tile_of, "points", err));
    return mem_calloc(&round->order, round->capacity, sizeof *round->order, "points", err);
}

/* Returns the number of terminals that a point becomes: 2 if terminals are paired. */
static size_t terminals_of_point(const PlanCommon *common)
{
    return common->site->rules.pair_mm > 0 ? 2 : 1;
}

/* What the threads of a turn share. */
typedef struct Running {
    Round *round;
    const PlanCommon *common;
    bool skip;            /* points in full cells are skipped */
    const uint32_t *turn; /* the tiles of one color; NULL: one tile, whose zone is all space */
} Running;

/* Prefetches the memory that the next points will need. The chain of pointers leads from the point
 * to its cell, to the cell's list, to the segments; each step is prefetched a few points later than
 * the one before. */
static void fetch(const Round *round, const Tile *tile, const Grid *grid, size_t k)
{
    if (k + 8 * AHEAD < tile->end)
        __builtin_prefetch(&round->point[round->order[k + 8 * AHEAD]]);
    if (k + 3 * AHEAD < tile->end)
        grid_fetch_cell(grid, round->point[round->order[k + 3 * AHEAD]]);
    if (k + 2 * AHEAD < tile->end)
        grid_fetch_tags(grid, round->point[round->order[k + 2 * AHEAD]]);
    if (k + AHEAD < tile->end)
        grid_fetch_items(grid, round->point[round->order[k + AHEAD]]);
}

/* Makes a connection in the network and in the grid, with the tile's next two spare nodes. *end
 * becomes the terminal. */
static Status connect(const Running *running, int worker, Tile *tile, const Connection *connection,
                      int32_t *end, Err *err)
{
    Site *site = running->common->site;
    const int32_t *made = tile->spare + 2 * tile->made++;
    const int32_t host = connection->segment, segment[ENDS] = {made[0], host, made[1]};
    const NetworkSplit split = {
        host, connection->bifurcation, connection->terminal, {made[0], made[1]}};
    GridItem item[ENDS];
    tile->left[network_tree(&site->net, host)]--;
    for (int i = 0; i < ENDS; i++)
        item[i] = connection_item(site, connection, i);
    grid_remove(&site->grid, host);
    network_split(&site->net, &split, tile->zone);
    for (int i = 0; i < ENDS; i++) {
        bool is_end = site->net.segment[segment[i]].child[0] < 0;
        TRY(grid_add(&site->grid, worker, segment[i], is_end, item[i], err));
    }
    *end = made[1];
    return STATUS_OK;
}

/* Plans the point, and its mate where terminals are paired, and makes the connections if the plan
 * is PLAN_READY. */
static Status connect_point(const Running *running, int worker, Tile *tile, Vec3 point,
                            PlanState *state, Err *err)
{
    const Plan plan = {running->common, tile->zone, tile->left};
    Connection connection[2];
    int32_t end[2];
    *state = plan_make(&plan, &running->round->planner[worker], point, connection);
    if (*state != PLAN_READY)
        return STATUS_OK;
    TRY(connect(running, worker, tile, &connection[0], &end[0], err));
    if (!(running->common->site->rules.pair_mm > 0))
        return STATUS_OK;
    TRY(connect(running, worker, tile, &connection[1], &end[1], err));
    network_pair(&running->common->site->net, end[0], end[1]);
    return STATUS_OK;
}

/* Sets *state to what became of the point; PLAN_STATES: it was skipped. */
static Status run_point(const Running *running, int worker, Tile *tile, Vec3 point,
                        PlanState *state, Err *err)
{
    const PlanCommon *common = running->common;
    uint8_t *misses = &running->round->misses[grid_cell_at(&common->site->grid, point)];
    bool is_skipped = running->skip && *misses == ROUND_FULL;
    *state = is_skipped ? PLAN_STATES : PLAN_UNDECIDED;
    if (is_skipped || tile->made + terminals_of_point(common) > tile->most)
        return STATUS_OK;
    TRY(connect_point(running, worker, tile, point, state, err));
    if (*state == PLAN_CROWDED)
        *misses = (uint8_t)(*misses + (*misses < ROUND_FULL));
    if (*state == PLAN_READY)
        *misses = 0;
    return STATUS_OK;
}

/* Prefetches the contents of all cells of a box at once. If they were read one by one, each read
 * would wait for memory. The box may extend beyond the grid. */
static void warm(const Site *site, const GridBox *box)
{
    const Grid *grid = &site->grid;
    int low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        int last = grid->count[axis] - 1;
        low[axis] = box->low[axis] > 0 ? box->low[axis] : 0;
        high[axis] = box->high[axis] < last ? box->high[axis] : last;
    }
    for (int step = 0; step < 2; step++)
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++) {
                    const GridCell *cell = &grid->cell[grid_index(grid, x, y, z)];
                    if (step == 0)
                        __builtin_prefetch(cell->tag);
                    for (uint32_t i = 0; step == 1 && i < cell->count; i++) {
                        int32_t segment = cell->tag[i] >> 1;
                        __builtin_prefetch(&grid->item[segment]);
                        __builtin_prefetch(&site->net.segment[segment]);
                    }
                }
}

/* Connects the points of a tile. Moves the points that are left over, which need more than the
 * tile's zone, to the beginning of its part of round->order. */
static Status run_tile(const Running *running, int worker, Tile *tile, Err *err)
{
    Round *round = running->round;
    Planner *planner = &round->planner[worker];
    const Site *site = running->common->site;
    planner->reach = round->reach;
    if (running->turn)
        warm(site, &tile->box);
    for (size_t k = tile->first; k < tile->end; k++) {
        PlanState state;
        fetch(round, tile, &site->grid, k);
        TRY(run_point(running, worker, tile, round->point[round->order[k]], &state, err));
        if (state == PLAN_UNDECIDED)
            round->order[tile->first + tile->over++] = round->order[k];
        else
            tile->count[state]++;
    }
    tile->reach = planner->reach;
    return STATUS_OK;
}

static Status run_turn(size_t index, int worker, void *context, Err *err)
{
    const Running *running = context;
    return run_tile(running, worker, &running->round->tile[running->turn[index]], err);
}

/* The division of the grid into tiles for one round: edge of a tile in cells, shift of the seams
 * along each axis in cells, and number of tiles along each axis. */
typedef struct TileCut {
    int edge, shift[3], count[3];
    size_t tiles;
} TileCut;

/* Divides the grid into tiles. Every round shifts the seams by a further golden section of a tile
 * along each axis, which spreads the seams of successive rounds evenly. */
static TileCut make_cut(const Round *round, const Grid *grid)
{
    const double golden = 0.618033988749895;
    TileCut cut = {.edge = round->tile_edge, .tiles = 1};
    double at = golden * round->number;
    for (int axis = 0; axis < 3; axis++) {
        int cells = grid->count[axis];
        cut.shift[axis] = cells > 1 ? (int)((at - floor(at)) * cut.edge) : 0;
        cut.count[axis] = (cells - 1 + cut.shift[axis]) / cut.edge + 1;
        cut.tiles *= (size_t)cut.count[axis];
    }
    return cut;
}

static size_t tile_at(const TileCut *cut, const Grid *grid, Vec3 point)
{
    GridBox own = grid_box(grid, point, 0);
    size_t index = 0;
    for (int axis = 2; axis >= 0; axis--)
        index = index * cut->count[axis] + (own.low[axis] + cut->shift[axis]) / cut->edge;
    return index;
}

/* Returns the cells of a tile and of a margin of `margin` cells on all sides. The box may extend
 * beyond the grid. */
static GridBox box_of(const TileCut *cut, size_t index, int margin)
{
    GridBox box;
    for (int axis = 0; axis < 3; axis++) {
        int at = (int)(index % cut->count[axis]) * cut->edge - cut->shift[axis];
        index /= cut->count[axis];
        box.low[axis] = at - margin;
        box.high[axis] = at + cut->edge - 1 + margin;
    }
    return box;
}

static int color_of(const TileCut *cut, size_t index)
{
    int x = (int)(index % cut->count[0]), y = (int)(index / cut->count[0] % cut->count[1]);
    int z = (int)(index / cut->count[0] / cut->count[1]);
    return (x & 1) | (y & 1) << 1 | (z & 1) << 2;
}

/* Sorts the points by tile, by counting. */
static void sort_points(Round *round, const TileCut *cut, const Grid *grid)
{
    for (size_t t = 0; t < cut->tiles; t++)
        round->tile[t] = (Tile){0};
    for (size_t i = 0; i < round->n; i++) {
        size_t t = tile_at(cut, grid, round->point[i]);
        round->tile_of[i] = (uint32_t)t;
        round->tile[t].end++;
    }
    size_t sum = 0;
    for (size_t t = 0; t < cut->tiles; t++) {
        size_t points = round->tile[t].end;
        round->tile[t].first = round->tile[t].end = sum;
        sum += points;
    }
    for (size_t i = 0; i < round->n; i++)
        round->order[round->tile[round->tile_of[i]].end++] = (uint32_t)i;
}

/* Returns the part of `whole` that a tile gets, in proportion to its points. */
static size_t part_of(const Round *round, const Tile *tile, size_t whole)
{
    return whole * (tile->end - tile->first) / round->n;
}

/* Gives every tile its zone and, in proportion to its points, spare nodes and its part of the
 * terminals that may be connected, in all and per tree. */
static void endow(Round *round, const PlanCommon *common, const TileCut *cut, size_t most)
{
    Site *site = common->site;
    size_t nodes = 0;
    for (size_t t = 0; t < cut->tiles; t++) {
        Tile *tile = &round->tile[t];
        size_t points = tile->end - tile->first, part = part_of(round, tile, most);
        tile->zone = grid_zone(&site->grid, box_of(cut, t, cut->edge / 2));
        tile->box = box_of(cut, t, 1);
        tile->most = terminals_of_point(common) * points / POINTS_PER_CONNECTED;
        tile->most = tile->most < part ? tile->most : part;
        tile->left = round->left + t * round->trees;
        for (size_t k = 0; k < round->trees; k++)
            tile->left[k] = part_of(round, tile, common->limit[k]);
        nodes += 2 * tile->most;
    }
    network_add_spares(&site->net, nodes);
    nodes = 0;
    for (size_t t = 0; t < cut->tiles; t++) {
        round->tile[t].spare = site->net.spare + nodes;
        nodes += 2 * round->tile[t].most;
    }
}

/* Removes the nodes that tiles have used from the spare nodes. */
static void settle_nodes(const Round *round, Network *net, size_t tiles)
{
    size_t kept = 0, k = 0;
    for (size_t t = 0; t < tiles; t++) {
        const Tile *tile = &round->tile[t];
        for (k += 2 * tile->made; net->spare + k < tile->spare + 2 * tile->most; k++)
            net->spare[kept++] = net->spare[k];
    }
    for (; k < net->spares; k++)
        net->spare[kept++] = net->spare[k];
    net->spares = kept;
}

/* Subtracts from the limits the number of terminals that each tree got in tiles. */
static void settle_limits(const Round *round, const PlanCommon *common, size_t tiles)
{
    for (size_t k = 0; k < round->trees; k++) {
        size_t got = 0;
        for (size_t t = 0; t < tiles; t++) {
            const Tile *tile = &round->tile[t];
            got += part_of(round, tile, common->limit[k]) - tile->left[k];
        }
        common->limit[k] -= got;
    }
}

/* Sums the results of the tiles. Lists the points that are left over at the beginning of `order`,
 * and returns their number. */
static size_t gather(Round *round, Network *net, size_t tiles)
{
    double reach = 0;
    size_t points = 0, over = 0;
    for (size_t t = 0; t < tiles; t++) {
        const Tile *tile = &round->tile[t];
        reach += tile->reach * (double)(tile->end - tile->first);
        points += tile->end - tile->first;
        round->connected += tile->made;
        for (int state = 0; state <= PLAN_STATES; state++)
            round->count[state] += tile->count[state];
        for (size_t k = 0; k < tile->over; k++)
            round->order[over++] = round->order[tile->first + k];
    }
    if (points > 0)
        round->reach = reach / (double)points;
    settle_nodes(round, net, tiles);
    return over;
}

/* Connects the points in tiles, and lists the *over points that are left over. */
static Status run_tiles(Round *round, const PlanCommon *common, RoundLimits limits, size_t *over,
                        Err *err)
{
    enum { COLORS = 8 };
    Site *site = common->site;
    TileCut cut = make_cut(round, &site->grid);
    sort_points(round, &cut, &site->grid);
    endow(round, common, &cut, limits.most);
    uint32_t *turn = round->tile_of; /* reuses memory that only sort_points needed */
    for (int color = 0; color < COLORS; color++) {
        size_t count = 0;
        for (size_t t = 0; t < cut.tiles; t++)
            if (color_of(&cut, t) == color)
                turn[count++] = (uint32_t)t;
        Running running = {round, common, limits.skip, turn};
        TRY(threads_try(count, round->threads, run_turn, &running, err));
    }
    settle_limits(round, common, cut.tiles);
    *over = gather(round, &site->net, cut.tiles);
    return STATUS_OK;
}

Status round_run(Round *round, const PlanCommon *common, RoundLimits limits, Err *err)
{
    Network *net = &common->site->net;
    round->connected = 0;
    memset(round->count, 0, sizeof round->count);
    size_t over = round->n;
    if (round->is_tiled && round->n >= LEAST_POINTS * round->tiles)
        TRY(run_tiles(round, common, limits, &over, err));
    else
        for (size_t i = 0; i < round->n; i++)
            round->order[i] = (uint32_t)i;
    size_t rest = limits.most - round->connected < over ? limits.most - round->connected : over;
    network_add_spares(net, 2 * rest);
    const Vec3 everywhere = vec3(INFINITY, INFINITY, INFINITY);
    round->tile[0] = (Tile){.end = over,
                            .zone = {vec3_scale(everywhere, -1), everywhere},
                            .spare = net->spare,
                            .most = rest,
                            .left = common->limit};
    Running running = {round, common, limits.skip, NULL};
    TRY(run_tile(&running, 0, &round->tile[0], err));
    gather(round, net, 1);
    return STATUS_OK;
}
