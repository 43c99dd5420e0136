/* Tossed points are sorted into square tiles of grid cells, and the points of a tile are planned
 * and connected one after the other. What they need of the tree then stays in the processor's
 * cache, however large the tree is.
 *
 * Threads work on tiles side by side. The points of a tile may read and change what lies in its
 * zone, which reaches half a tile beyond it on all sides. Tiles have 2 x 2 (x 2) colours, like a
 * chessboard's, and one colour is done after the other: zones of one colour have nothing in common,
 * so the tree does not depend on the number of threads. The few points that would need more than
 * the zone are left over, and connected by one thread at the end. The seams between tiles move from
 * round to round, so that no place is always on one. Small trees are one tile.
 *
 * round_run: run_tiles cuts the grid (make_cut), sorts the points (sort), shares out nodes and
 * limits (endow), and has each tile's points connected (run_tile: run_point, connect); gather adds
 * up what became of them. What is left over then goes through run_tile as one tile that is
 * everywhere. */
#include "grow/round.h"

#include <stdlib.h>

/* Cells along a tile: about 1,000 terminals. */
enum { EDGE_2D = 34, EDGE_3D = 10 };
/* With fewer tiles, or fewer points in a tile, one thread connects all points. */
enum { LEAST_TILES = 4, LEAST_POINTS = 16 };
/* In a tile, at most one point in POINTS_PER_CONNECTED may be connected; one in three is expected.
 */
enum { POINTS_PER_CONNECTED = 2 };
/* How many points ahead memory is asked for. */
enum { AHEAD = 2 };

struct Tile {
    size_t first, end; /* points in `order` */
    Box zone;
    GridBox box;          /* a little more than its own cells, for warm */
    const int32_t *spare; /* nodes that it may use */
    size_t most, made;    /* terminals */
    size_t over;          /* points left over, which are then the first ones in `order` */
    size_t *left;         /* by tree: how many terminals it may still get here */
    double reach;         /* its planner's at the end [plan.h] */
    Tally tally;
    Status status;
    Err err;
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

/* How many terminals a point becomes. */
static size_t terminals_of_point(const Site *site)
{
    return site->rules->pair > 0 ? 2 : 1;
}

/* Connects a terminal with the two spare nodes `made`: in the network, and in the grid. */
static Status connect(const Site *site, int worker, Box zone, const Connection *connection,
                      Vec3 terminal, const int32_t made[2], Err *err)
{
    const int32_t segment[ENDS] = {made[0], connection->segment, made[1]};
    GridItem item[ENDS];
    for (int i = 0; i < ENDS; i++)
        item[i] = connection_item(site->net, site->grid, site->rules, connection, terminal, i);
    grid_remove(site->grid, connection->segment);
    network_split(site->net, connection->segment, connection->bifurcation, terminal, made, zone);
    for (int i = 0; i < ENDS; i++) {
        bool is_end = site->net->segment[segment[i]].child[0] < 0;
        TRY(grid_add(site->grid, worker, segment[i], is_end, item[i], err));
    }
    return STATUS_OK;
}

/* What threads are working on. */
typedef struct Running {
    Round *round;
    const Site *site;
    bool skip;            /* whether points in full cells are skipped */
    const uint32_t *turn; /* the tiles of one colour; NULL: one tile, whose zone is all space */
} Running;

/* Prefetches what the next points will need: the further ahead the point, the earlier the step. */
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

/* Connects a terminal in the tile. */
static void add_terminal(const Running *running, int worker, Tile *tile,
                         const Connection *connection, Vec3 terminal)
{
    if (tile->status != STATUS_OK)
        return;
    tile->left[network_tree(running->site->net, connection->segment)]--;
    tile->status = connect(running->site, worker, tile->zone, connection, terminal,
                           tile->spare + 2 * tile->made++, &tile->err);
}

/* Plans the point, and its mate where terminals are pairs, and connects what can be. */
static PlanState plan_point(const Running *running, int worker, Tile *tile, Vec3 point)
{
    const Site *site = running->site;
    Planner *planner = &running->round->planner[worker];
    PlanPair pair = {.terminal = {point}};
    PlanState state =
        site->rules->pair > 0
            ? plan_pair(site, planner, tile->zone, tile->left, point, &pair)
            : plan_make(site, planner, tile->zone, tile->left, point, &pair.connection[0]);
    if (state != PLAN_READY)
        return state;
    int32_t ends[2] = {tile->spare[2 * tile->made + 1], -1};
    add_terminal(running, worker, tile, &pair.connection[0], point);
    if (site->rules->pair > 0) {
        ends[1] = tile->spare[2 * tile->made + 1];
        add_terminal(running, worker, tile, &pair.connection[1], pair.terminal[1]);
        network_pair(site->net, ends[0], ends[1]);
    }
    return state;
}

static PlanState run_point(const Running *running, int worker, Tile *tile, Vec3 point)
{
    const Site *site = running->site;
    uint8_t *misses = &running->round->misses[grid_cell_at(site->grid, point)];
    if (running->skip && *misses == ROUND_FULL) {
        tile->tally.skipped++;
        return PLAN_STATES;
    }
    if (tile->made + terminals_of_point(site) > tile->most)
        return PLAN_BEYOND;
    PlanState state = plan_point(running, worker, tile, point);
    if (state == PLAN_CROWDED)
        *misses = (uint8_t)(*misses + (*misses < ROUND_FULL));
    if (state == PLAN_READY)
        *misses = 0;
    return state;
}

/* Prefetches all that lies in those cells of a box that there are at once: looked up one by one,
 * each would be waited for. */
static void warm(const Site *site, const GridBox *box)
{
    const Grid *grid = site->grid;
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
                        __builtin_prefetch(&site->net->segment[segment]);
                    }
                }
}

static void run_tile(const Running *running, int worker, Tile *tile)
{
    Round *round = running->round;
    Planner *planner = &round->planner[worker];
    planner->reach = round->reach;
    if (running->turn)
        warm(running->site, &tile->box);
    for (size_t k = tile->first; k < tile->end && tile->status == STATUS_OK; k++) {
        fetch(round, tile, running->site->grid, k);
        PlanState state = run_point(running, worker, tile, round->point[round->order[k]]);
        if (state == PLAN_BEYOND)
            round->order[tile->first + tile->over++] = round->order[k];
        else if (state < PLAN_STATES)
            tile->tally.count[state]++;
    }
    tile->reach = planner->reach;
}

static void run_turn(size_t index, int worker, void *context)
{
    const Running *running = context;
    run_tile(running, worker, &running->round->tile[running->turn[index]]);
}

/* How the grid is cut into tiles for one round. */
typedef struct Cut {
    int edge, shift[3], count[3];
} Cut;

/* Every round moves the seams on by the golden section of a tile, along each axis. */
static Cut make_cut(const Round *round, const Grid *grid)
{
    const double golden = 0.618033988749895;
    Cut cut = {.edge = round->tile_edge};
    double at = golden * round->number;
    for (int axis = 0; axis < 3; axis++) {
        int cells = grid->count[axis];
        cut.shift[axis] = cells > 1 ? (int)((at - floor(at)) * cut.edge) : 0;
        cut.count[axis] = (cells - 1 + cut.shift[axis]) / cut.edge + 1;
    }
    return cut;
}

static size_t tile_at(const Cut *cut, const Grid *grid, Vec3 point)
{
    GridBox own = grid_box(grid, point, 0);
    size_t index = 0;
    for (int axis = 2; axis >= 0; axis--)
        index = index * cut->count[axis] + (own.low[axis] + cut->shift[axis]) / cut->edge;
    return index;
}

/* A tile's cells and `margin` more on all sides, also where the grid has none. */
static GridBox box_of(const Cut *cut, size_t index, int margin)
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

static int colour_of(const Cut *cut, size_t index)
{
    int x = (int)(index % cut->count[0]), y = (int)(index / cut->count[0] % cut->count[1]);
    int z = (int)(index / cut->count[0] / cut->count[1]);
    return (x & 1) | (y & 1) << 1 | (z & 1) << 2;
}

/* Sorts the points by tile. */
static void sort(Round *round, const Cut *cut, const Grid *grid, size_t tiles)
{
    for (size_t t = 0; t < tiles; t++)
        round->tile[t] = (Tile){0};
    for (size_t i = 0; i < round->n; i++) {
        size_t t = tile_at(cut, grid, round->point[i]);
        round->tile_of[i] = (uint32_t)t;
        round->tile[t].end++;
    }
    size_t sum = 0;
    for (size_t t = 0; t < tiles; t++) {
        size_t points = round->tile[t].end;
        round->tile[t].first = round->tile[t].end = sum;
        sum += points;
    }
    for (size_t i = 0; i < round->n; i++)
        round->order[round->tile[round->tile_of[i]].end++] = (uint32_t)i;
}

/* A tile's part of a whole, by its points. */
static size_t part_of(const Round *round, const Tile *tile, size_t whole)
{
    return whole * (tile->end - tile->first) / round->n;
}

/* Gives every tile its zone, and in proportion to its points spare nodes and its part of the
 * terminals that may be connected, of all trees and of each. */
static void endow(Round *round, const Site *site, const Cut *cut, size_t tiles, size_t most)
{
    size_t nodes = 0;
    for (size_t t = 0; t < tiles; t++) {
        Tile *tile = &round->tile[t];
        size_t points = tile->end - tile->first, part = part_of(round, tile, most);
        tile->zone = grid_zone(site->grid, box_of(cut, t, cut->edge / 2));
        tile->box = box_of(cut, t, 1);
        tile->most = terminals_of_point(site) * points / POINTS_PER_CONNECTED;
        tile->most = tile->most < part ? tile->most : part;
        tile->left = round->left + t * round->trees;
        for (size_t k = 0; k < round->trees; k++)
            tile->left[k] = part_of(round, tile, site->limit[k]);
        nodes += 2 * tile->most;
    }
    network_spare(site->net, nodes);
    nodes = 0;
    for (size_t t = 0; t < tiles; t++) {
        round->tile[t].spare = site->net->spare + nodes;
        nodes += 2 * round->tile[t].most;
    }
}

/* Takes the nodes that tiles have used off the spare ones. */
static void settle_nodes(Round *round, Network *net, size_t tiles)
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

/* Takes off the limits what trees got in tiles. */
static void settle_limits(const Round *round, const Site *site, size_t tiles)
{
    for (size_t k = 0; k < round->trees; k++) {
        size_t got = 0;
        for (size_t t = 0; t < tiles; t++) {
            const Tile *tile = &round->tile[t];
            got += part_of(round, tile, site->limit[k]) - tile->left[k];
        }
        site->limit[k] -= got;
    }
}

/* Adds up what became of the points; those left over are listed at the beginning of `order`. */
static Status gather(Round *round, const Site *site, size_t tiles, size_t *made, size_t *over,
                     Err *err)
{
    double reach = 0;
    size_t points = 0;
    *over = 0;
    for (size_t t = 0; t < tiles; t++) {
        const Tile *tile = &round->tile[t];
        reach += tile->reach * (double)(tile->end - tile->first);
        points += tile->end - tile->first;
        if (tile->status != STATUS_OK)
            return err_set(err, tile->status, "%s", tile->err.text);
        *made += tile->made;
        round->tally.skipped += tile->tally.skipped;
        for (int state = 0; state < PLAN_STATES; state++)
            round->tally.count[state] += tile->tally.count[state];
        for (size_t k = 0; k < tile->over; k++)
            round->order[(*over)++] = round->order[tile->first + k];
    }
    if (points > 0)
        round->reach = reach / (double)points;
    settle_nodes(round, site->net, tiles);
    return STATUS_OK;
}

/* Connects the points in tiles, and lists those left over. */
static Status run_tiles(Round *round, const Site *site, size_t most, bool skip, size_t *made,
                        size_t *over, Err *err)
{
    enum { COLOURS = 8 };
    Cut cut = make_cut(round, site->grid);
    size_t tiles = (size_t)cut.count[0] * cut.count[1] * cut.count[2];
    sort(round, &cut, site->grid, tiles);
    endow(round, site, &cut, tiles, most);
    uint32_t *turn = round->tile_of; /* which only `sort` needed */
    for (int colour = 0; colour < COLOURS; colour++) {
        size_t count = 0;
        for (size_t t = 0; t < tiles; t++)
            if (colour_of(&cut, t) == colour)
                turn[count++] = (uint32_t)t;
        Running running = {round, site, skip, turn};
        threads_for(count, round->threads, run_turn, &running);
    }
    settle_limits(round, site, tiles);
    return gather(round, site, tiles, made, over, err);
}

Status round_run(Round *round, const Site *site, size_t most, bool skip, size_t *made, Err *err)
{
    *made = 0;
    round->tally = (Tally){0};
    size_t over = round->n;
    if (round->is_tiled && round->n >= LEAST_POINTS * round->tiles)
        TRY(run_tiles(round, site, most, skip, made, &over, err));
    else
        for (size_t i = 0; i < round->n; i++)
            round->order[i] = (uint32_t)i;
    size_t rest = most - *made < over ? most - *made : over;
    network_spare(site->net, 2 * rest);
    const Vec3 everywhere = vec3(INFINITY, INFINITY, INFINITY);
    round->tile[0] = (Tile){.end = over,
                            .zone = {vec3_scale(everywhere, -1), everywhere},
                            .spare = site->net->spare,
                            .most = rest,
                            .left = site->limit};
    Running running = {round, site, skip, NULL};
    run_tile(&running, 0, &round->tile[0]);
    return gather(round, site, 1, made, &over, err);
}
