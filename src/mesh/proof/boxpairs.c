/* Finds all pairs of items whose boxes overlap, with a hierarchy of boxes and several threads.
 *
 * Eight items of consecutive indices are a run. The runs are the leaves of a complete binary tree
 * of boxes, ordered by the Morton codes of their centres. Node i has the children 2 i and 2 i + 1.
 * The search descends into every pair of nodes whose boxes meet. The pairs of nodes of one level
 * are the units of work that threads share. */
#include "mesh/proof/boxpairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Items per run: more items make a smaller hierarchy, but more tests of single boxes. Nodes of the
 * level whose pairs are the units of work: enough units to keep all threads busy to the end. Runs
 * whose boxes a unit caches: their boxes take 49 kB, about as much as a first-level cache holds.
 * None of the three numbers changes the result. */
enum { RUN = 8, UNIT_NODES = 256, CACHED_RUNS = 256 };

typedef struct RunLeaf {
    uint64_t code;
    uint32_t number;
} RunLeaf;

/* The boxes of the items of runs that one unit of work has met. A run with the index r is stored at
 * r modulo CACHED_RUNS, until another run takes its position. */
typedef struct RunCache {
    uint32_t runs[CACHED_RUNS]; /* index of the run plus 1; 0: none yet */
    FloatBox boxes[CACHED_RUNS][RUN];
} RunCache;

typedef struct UnitPair {
    uint32_t a, b; /* nodes, a <= b */
} UnitPair;

typedef struct RunTree {
    const BoxPairs *pairs;
    RunLeaf *leaves;
    FloatBox *boxes;         /* per node, from 1 on */
    uint32_t n_leaves, size; /* a power of 2, at least n_leaves: the first node that is a leaf */
    UnitPair *units;
    size_t n_units;
} RunTree;

static const FloatBox nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void widen(FloatBox *box, const FloatBox *by)
{
    for (int axis = 0; axis < 3; axis++) {
        box->low[axis] = box->low[axis] < by->low[axis] ? box->low[axis] : by->low[axis];
        box->high[axis] = box->high[axis] > by->high[axis] ? box->high[axis] : by->high[axis];
    }
}

static uint32_t run_length(const RunTree *forest, uint32_t leaf)
{
    uint32_t rest = forest->pairs->count - leaf * RUN;
    return rest < RUN ? rest : RUN;
}

static FloatBox box_of_run(const RunTree *forest, uint32_t leaf)
{
    FloatBox box = nothing;
    for (uint32_t i = 0; i < run_length(forest, leaf); i++) {
        FloatBox one = forest->pairs->box(leaf * RUN + i, forest->pairs->context);
        widen(&box, &one);
    }
    return box;
}

static uint64_t morton_code(const FloatBox *box, const FloatBox *all)
{
    uint64_t code = 0;
    for (int axis = 0; axis < 3; axis++) {
        double size = (double)all->high[axis] - (double)all->low[axis];
        double middle = 0.5 * ((double)box->low[axis] + (double)box->high[axis]);
        double place = size > 0 ? (middle - (double)all->low[axis]) / size : 0;
        code |= morton_spread((uint64_t)(place * 0x1fffff)) << axis;
    }
    return code;
}

static int compare_leaves(const void *a, const void *b)
{
    const RunLeaf *one = a, *other = b;
    if (one->code != other->code)
        return one->code < other->code ? -1 : 1;
    return (one->number > other->number) - (one->number < other->number);
}

/* Fills the leaves and the boxes of all nodes. The boxes of the runs first stand in the order of
 * the runs, and are computed again in the order of the leaves. */
static void order_leaves(RunTree *forest)
{
    FloatBox all = nothing, *runs = &forest->boxes[forest->size];
    for (uint32_t i = 0; i < forest->n_leaves; i++) {
        runs[i] = box_of_run(forest, i);
        widen(&all, &runs[i]);
    }
    for (uint32_t i = 0; i < forest->n_leaves; i++)
        forest->leaves[i] = (RunLeaf){morton_code(&runs[i], &all), i};
    qsort(forest->leaves, forest->n_leaves, sizeof *forest->leaves, compare_leaves);
    for (uint32_t i = 0; i < forest->size; i++)
        runs[i] = i < forest->n_leaves ? box_of_run(forest, forest->leaves[i].number) : nothing;
    for (uint32_t i = forest->size - 1; i > 0; i--) {
        forest->boxes[i] = forest->boxes[2 * i];
        widen(&forest->boxes[i], &forest->boxes[2 * i + 1]);
    }
}

/* Returns the boxes of the items of a run, from the cache if they are in it. */
static const FloatBox *boxes_of(const RunTree *forest, RunCache *cache, uint32_t run)
{
    uint32_t *place = &cache->runs[run % CACHED_RUNS];
    FloatBox *boxes = cache->boxes[run % CACHED_RUNS];
    for (uint32_t i = 0; i < run_length(forest, run) && *place != run + 1; i++)
        boxes[i] = forest->pairs->box(run * RUN + i, forest->pairs->context);
    *place = run + 1;
    return boxes;
}

/* Lists the items of a run whose boxes meet `other`, and their boxes. Returns their number. */
static uint32_t boxes_near(const RunTree *forest, RunCache *cache, uint32_t run,
                           const FloatBox *other, FloatBox near[RUN], uint32_t items[RUN])
{
    uint32_t n = 0;
    const FloatBox *boxes = boxes_of(forest, cache, run);
    for (uint32_t i = 0; i < run_length(forest, run); i++)
        if (floatbox_meets(&boxes[i], other)) {
            near[n] = boxes[i];
            items[n++] = run * RUN + i;
        }
    return n;
}

/* One unit of work. */
typedef struct Descent {
    const RunTree *forest;
    RunCache cache;
    int worker;
} Descent;

/* Reports the pairs of items of two runs whose boxes meet; of one run, each pair once. */
static void report_pairs(Descent *descent, uint32_t node_a, uint32_t node_b)
{
    const RunTree *forest = descent->forest;
    const BoxPairs *pairs = forest->pairs;
    uint32_t items[2][RUN], n[2] = {0};
    FloatBox boxes[2][RUN];
    n[0] = boxes_near(forest, &descent->cache, forest->leaves[node_a - forest->size].number,
                      &forest->boxes[node_b], boxes[0], items[0]);
    if (n[0] > 0)
        n[1] = boxes_near(forest, &descent->cache, forest->leaves[node_b - forest->size].number,
                          &forest->boxes[node_a], boxes[1], items[1]);
    for (uint32_t i = 0; i < n[0]; i++)
        for (uint32_t j = node_a == node_b ? i + 1 : 0; j < n[1]; j++) {
            uint32_t a = items[0][i], b = items[1][j];
            if (floatbox_meets(&boxes[0][i], &boxes[1][j]))
                pairs->found(a < b ? a : b, a < b ? b : a, descent->worker, pairs->context);
        }
}

/* Descends from a pair of nodes of one level, a <= b. */
static void descend(Descent *descent, uint32_t a, uint32_t b)
{
    const RunTree *forest = descent->forest;
    if (!floatbox_meets(&forest->boxes[a], &forest->boxes[b]))
        return;
    if (a >= forest->size) {
        if (b - forest->size < forest->n_leaves)
            report_pairs(descent, a, b);
        return;
    }
    descend(descent, 2 * a, 2 * b);
    descend(descent, 2 * a, 2 * b + 1);
    if (a != b)
        descend(descent, 2 * a + 1, 2 * b);
    descend(descent, 2 * a + 1, 2 * b + 1);
}

static void descend_unit(size_t index, int worker, void *context)
{
    const RunTree *forest = context;
    Descent descent;
    descent.forest = forest;
    descent.worker = worker;
    memset(descent.cache.runs, 0, sizeof descent.cache.runs); /* the boxes need no clearing */
    descend(&descent, forest->units[index].a, forest->units[index].b);
}

/* Lists the pairs of nodes of one level whose boxes meet: the units of work. */
static Status find_units(RunTree *forest, Err *err)
{
    uint32_t first = forest->size < UNIT_NODES ? forest->size : UNIT_NODES;
    size_t capacity = 0;
    for (uint32_t a = first; a < 2 * first; a++)
        for (uint32_t b = a; b < 2 * first; b++) {
            if (!floatbox_meets(&forest->boxes[a], &forest->boxes[b]))
                continue;
            TRY(mem_reserve(&forest->units, &capacity, forest->n_units + 1, sizeof *forest->units,
                            "boxes", err));
            forest->units[forest->n_units++] = (UnitPair){a, b};
        }
    return STATUS_OK;
}

Status boxpairs_find(const BoxPairs *pairs, Err *err)
{
    if (pairs->count == 0)
        return STATUS_OK;
    RunTree forest = {.pairs = pairs, .n_leaves = (pairs->count + RUN - 1) / RUN, .size = 1};
    while (forest.size < forest.n_leaves)
        forest.size *= 2;
    Status status;
    TRY_GOTO(mem_calloc(&forest.leaves, forest.n_leaves, sizeof *forest.leaves, "boxes", err));
    TRY_GOTO(
        mem_calloc(&forest.boxes, 2 * (size_t)forest.size, sizeof *forest.boxes, "boxes", err));
    order_leaves(&forest);
    TRY_GOTO(find_units(&forest, err));
    threads_for(forest.n_units, pairs->threads, descend_unit, &forest);
done:
    free(forest.leaves);
    free(forest.boxes);
    free(forest.units);
    return status;
}
