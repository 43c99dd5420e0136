/* All points of a batch are planned for the tree as the batch found it, so that any number of threads
 * makes the same plans. A plan names the grid cells it was made for [plan.h]; it is accepted, in the
 * order of tossing, unless a plan accepted before it changes one of them, and then it is put off to
 * the next batch. What accepted plans change lies in different cells, so that no two of them share a
 * segment or a node, and they, too, are carried out by any number of threads. */
#include "grow/batch.h"

#include <stdlib.h>

/* Points or connections that a thread takes at a time, and the least that are worth starting threads
 * for. */
enum { CHUNK = 64, LEAST_SHARED = 256 };
/* How many points ahead memory is asked for. */
enum { AHEAD = 2 };

Status batch_init(Batch *batch, size_t capacity, int candidates, int threads, Err *err)
{
    *batch = (Batch){.capacity = capacity, .threads = threads};
    TRY(mem_calloc(&batch->plan, capacity, sizeof *batch->plan, "random points", err));
    TRY(mem_calloc(&batch->waiting, capacity, sizeof *batch->waiting, "random points", err));
    TRY(mem_calloc(&batch->accepted, capacity, sizeof *batch->accepted, "random points", err));
    TRY(mem_calloc(&batch->planner, (size_t)threads, sizeof *batch->planner, "threads", err));
    for (int i = 0; i < threads; i++)
        TRY(planner_init(&batch->planner[i], candidates, err));
    return STATUS_OK;
}

void batch_release(Batch *batch)
{
    for (int i = 0; batch->planner && i < batch->threads; i++)
        planner_release(&batch->planner[i]);
    free(batch->planner);
    free(batch->accepted);
    free(batch->waiting);
    free(batch->plan);
    free(batch->stamp);
    free(batch->misses);
    *batch = (Batch){0};
}

Status batch_use_grid(Batch *batch, const Grid *grid, Err *err)
{
    size_t cells = grid_cells(grid);
    free(batch->stamp);
    free(batch->misses);
    batch->stamp = NULL;
    batch->misses = NULL;
    TRY(mem_calloc(&batch->stamp, cells, sizeof *batch->stamp, "grid cells", err));
    return mem_calloc(&batch->misses, cells, sizeof *batch->misses, "grid cells", err);
}

size_t batch_start(Batch *batch, size_t tosses)
{
    size_t first = batch->n_waiting;
    for (size_t i = 0; i < first; i++)
        batch->plan[i].terminal = batch->waiting[i];
    batch->n = first + tosses < batch->capacity ? first + tosses : batch->capacity;
    batch->n_waiting = batch->n_accepted = 0;
    batch->number++;
    return first;
}

/* Calls body for every chunk of `count` items. */
static void in_chunks(const Batch *batch, size_t count,
                      void (*body)(size_t index, int worker, void *context), void *context)
{
    threads_for((count + CHUNK - 1) / CHUNK, count < LEAST_SHARED ? 1 : batch->threads, body,
                context);
}

static size_t chunk_end(size_t index, size_t count)
{
    return (index + 1) * CHUNK < count ? (index + 1) * CHUNK : count;
}

static Status check_planners(const Batch *batch, Err *err)
{
    for (int i = 0; i < batch->threads; i++)
        if (batch->planner[i].status != STATUS_OK)
            return err_set(err, batch->planner[i].status, "%s", batch->planner[i].err.text);
    return STATUS_OK;
}

typedef struct Planning {
    Batch *batch;
    const Site *site;
} Planning;

static void plan_chunk(size_t index, int worker, void *context)
{
    const Planning *planning = context;
    Batch *batch = planning->batch;
    const Grid *grid = planning->site->grid;
    size_t end = chunk_end(index, batch->n);
    for (size_t i = index * CHUNK; i < end; i++) {
        if (i + 3 * AHEAD < end)
            grid_fetch_cell(grid, batch->plan[i + 3 * AHEAD].terminal);
        if (i + 2 * AHEAD < end)
            grid_fetch_tags(grid, batch->plan[i + 2 * AHEAD].terminal);
        if (i + AHEAD < end)
            grid_fetch_items(grid, batch->plan[i + AHEAD].terminal);
        batch->plan[i].planner = worker;
        plan_make(planning->site, &batch->planner[worker], &batch->plan[i]);
    }
}

Status batch_plan(Batch *batch, const Site *site, Err *err)
{
    Planning planning = {batch, site};
    for (int i = 0; i < batch->threads; i++)
        batch->planner[i].footprint.n = 0;
    in_chunks(batch, batch->n, plan_chunk, &planning);
    return check_planners(batch, err);
}

/* Whether a plan accepted before has changed what this one was made for. */
static bool is_outdated(const Batch *batch, const Plan *plan)
{
    const uint32_t *cell = batch->planner[plan->planner].footprint.cell;
    for (size_t i = plan->first_cell; i < plan->end_cell; i++)
        if (batch->stamp[cell[i]] == batch->number)
            return true;
    return false;
}

static void accept(Batch *batch, size_t index)
{
    const Plan *plan = &batch->plan[index];
    const uint32_t *cell = batch->planner[plan->planner].footprint.cell;
    for (size_t i = plan->first_cell; i < plan->end_changed; i++)
        batch->stamp[cell[i]] = batch->number;
    batch->accepted[batch->n_accepted++] = index;
}

void batch_accept(Batch *batch, const Network *net, const Grid *grid, size_t *limit)
{
    for (size_t i = 0; i < batch->n; i++) {
        const Plan *plan = &batch->plan[i];
        if (plan->state < PLAN_CROWDED)
            continue;
        uint8_t *misses = &batch->misses[grid_cell_at(grid, plan->terminal)];
        if (plan->state == PLAN_CROWDED) {
            *misses = (uint8_t)(*misses + (*misses < BATCH_FULL));
            continue;
        }
        size_t *left = &limit[network_tree(net, plan->connection.segment)];
        if (*left == 0)
            continue;
        if (is_outdated(batch, plan)) {
            batch->waiting[batch->n_waiting++] = plan->terminal;
        } else {
            *misses = 0;
            accept(batch, i);
            --*left;
        }
    }
}

typedef struct Work {
    Batch *batch;
    Network *net;
    Grid *grid;
    const Rules *rules;
    size_t first_node;
} Work;

/* Makes a connection whose new segment is `fresh`. */
static Status make(const Work *work, int worker, const Plan *plan, int32_t fresh, Err *err)
{
    const Connection *connection = &plan->connection;
    const int32_t segment[PARTS] = {
        [PROXIMAL] = fresh - 1, [DISTAL] = connection->segment, [FRESH] = fresh};
    GridItem item[PARTS];
    for (int i = 0; i < PARTS; i++)
        item[i] = place_item(work->net, work->grid, work->rules, connection, plan->terminal, i);
    grid_remove(work->grid, connection->segment);
    network_split(work->net, connection->segment, connection->bifurcation, plan->terminal, fresh);
    for (int i = 0; i < PARTS; i++) {
        bool terminal = work->net->segment[segment[i]].child[0] < 0;
        TRY(grid_add(work->grid, worker, segment[i], terminal, item[i], err));
    }
    return STATUS_OK;
}

static void make_chunk(size_t index, int worker, void *context)
{
    const Work *work = context;
    Batch *batch = work->batch;
    Planner *planner = &batch->planner[worker];
    for (size_t k = index * CHUNK; k < chunk_end(index, batch->n_accepted); k++) {
        int32_t fresh = (int32_t)(work->first_node + 2 * k + 1);
        if (planner->status == STATUS_OK)
            planner->status =
                make(work, worker, &batch->plan[batch->accepted[k]], fresh, &planner->err);
    }
}

Status batch_carry_out(Batch *batch, Network *net, Grid *grid, const Rules *rules, Err *err)
{
    Work work = {batch, net, grid, rules, net->n};
    network_extend(net, batch->n_accepted);
    in_chunks(batch, batch->n_accepted, make_chunk, &work);
    TRY(check_planners(batch, err));
    network_carry(net, batch->n_accepted, batch->threads);
    return STATUS_OK;
}
