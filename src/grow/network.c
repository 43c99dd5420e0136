/* Every segment holds flare and cost of its daughters, so a change at one place is carried to the
 * root by recomputing the segments on the way and nothing else: O(depth), one cache line each, and
 * exact, because nothing is added to or taken from a running sum.
 *
 * Splits come in batches, whose ways to the root soon join. First every changed segment announces
 * itself to its parent, up to one that others have announced before; then values go up, and at a
 * node where more than one way arrives only the last to come goes on. So every segment is recomputed
 * once and sees final daughters, whatever thread comes last.
 *
 * The sensitivities are the derivatives of the root's cost, carried down by the chain rule. They
 * price a change below a segment in O(1). They age as the tree grows, which only blurs the choice
 * between candidates, never the tree's own figures. */
#include "grow/network.h"

#include <float.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Splits that a thread carries at a time, and the least that are worth starting threads for. */
enum { CHUNK = 32, LEAST_SHARED = 256 };
/* Refreshing goes by subtrees of at most one in so many terminals, by the place where they begin. */
enum { SUBTREES = 128, REFRESHED = 4096 };

struct Arrivals {
    atomic_int gain;    /* terminals more */
    atomic_schar below; /* changed daughters that have not arrived */
    atomic_bool announced;
};

Status network_init(Network *net, Law law, double radius_scale, size_t capacity, size_t inlets,
                    bool traits, Err *err)
{
    Network made = {
        .law = law, .radius_scale = radius_scale, .capacity = capacity, .fresh_weight = 1};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.segment, capacity, sizeof *made.segment, "segments", err));
    TRY_GOTO(mem_calloc(&made.sensitivity, capacity, sizeof *made.sensitivity, "segments", err));
    if (traits)
        TRY_GOTO(mem_calloc(&made.trait, capacity, sizeof *made.trait, "segments", err));
    TRY_GOTO(mem_calloc(&made.position, capacity, sizeof *made.position, "positions", err));
    TRY_GOTO(mem_calloc(&made.coming, capacity, sizeof *made.coming, "segments", err));
    TRY_GOTO(mem_calloc(&made.inlet, inlets, sizeof *made.inlet, "inlets", err));
    *net = made;
done:
    if (status != STATUS_OK)
        network_release(&made);
    return status;
}

void network_release(Network *net)
{
    free(net->segment);
    free(net->sensitivity);
    free(net->trait);
    free(net->position);
    free(net->coming);
    free(net->inlet);
    *net = (Network){0};
}

void network_retire(Network *net)
{
    free(net->sensitivity);
    free(net->coming);
    net->sensitivity = NULL;
    net->coming = NULL;
}

static void set_terminals(Network *net, size_t terminals)
{
    net->terminals = terminals;
    net->radius_unit = net->radius_scale / sqrt(sqrt((double)terminals));
}

double network_cost(const Network *net)
{
    double cost = 0;
    for (size_t k = 0; k < net->inlets; k++) {
        const Segment *inlet = &net->segment[net->inlet[k]];
        cost += inlet->cost[0] + inlet->cost[1];
    }
    return cost;
}

/* Radii beyond what a float holds are wider than any domain all the same. */
static float narrow(double value)
{
    return (float)fmin(value, (double)FLT_MAX);
}

/* Tells the parent of `i` what hangs there now. */
static void report(Network *net, int32_t i, const Reduced *reduced)
{
    Segment *parent = &net->segment[net->segment[i].parent];
    int slot = parent->child[1] == i;
    parent->flare[slot] = reduced->flare;
    parent->cost[slot] = reduced->cost;
}

static void measure(Network *net, int32_t i)
{
    Segment *segment = &net->segment[i];
    segment->length = vec3_distance(net->position[segment->parent], net->position[i]);
}

static void recompute(Network *net, int32_t i)
{
    Reduced reduced = network_reduce(net, i);
    report(net, i, &reduced);
}

/* Gives a segment the adjoint it has as a daughter of `parent`. */
static void adopt(Network *net, int32_t i, const Reduced *reduced, int32_t parent,
                  const Reduced *above)
{
    const Segment *mother = &net->segment[parent];
    double gauge = (double)mother->gauge;
    Adjoint adjoint = {net->sensitivity[parent].load, law_lambda_power(&net->law, gauge)};
    Segment *segment = &net->segment[i];
    double own_gauge = gauge * above->widening;
    segment->gauge = narrow(own_gauge);
    segment->radius = narrow(net->radius_unit * own_gauge * reduced->rho);
    net->sensitivity[i] = (Sensitivity){law_descend(&net->law, above, adjoint, reduced).load,
                                        net->sensitivity[parent].extra +
                                            law_total(&net->law, above, adjoint) * mother->length *
                                                network_burden(net, parent, 1)};
}

static void adopt_root(Network *net, int32_t root, const Reduced *reduced)
{
    net->segment[root].gauge = 1;
    net->segment[root].radius = narrow(net->radius_unit * reduced->rho);
    net->sensitivity[root] = (Sensitivity){0, 0};
}

int32_t network_append(Network *net, int32_t parent, Vec3 position)
{
    int32_t i = (int32_t)net->n++;
    net->position[i] = position;
    net->segment[i] = (Segment){.child = {-1, -1}, .parent = parent};
    if (net->trait)
        net->trait[i] = (Trait){.weight = net->fresh_weight,
                                .tree = parent < 0 ? (int32_t)net->inlets : net->trait[parent].tree,
                                .origin = -1};
    if (parent < 0) {
        net->inlet[net->inlets++] = i;
    } else {
        int32_t *child = net->segment[parent].child;
        child[child[0] >= 0] = i;
    }
    return i;
}

void network_extend(Network *net, size_t splits)
{
    net->n += 2 * splits;
    set_terminals(net, net->terminals + splits);
}

void network_split(Network *net, int32_t segment, Vec3 bifurcation, Vec3 terminal, int32_t fresh)
{
    Segment *distal = &net->segment[segment];
    int32_t above = distal->parent, proximal = fresh - 1;
    net->position[proximal] = bifurcation;
    net->position[fresh] = terminal;
    net->segment[above].child[net->segment[above].child[1] == segment] = proximal;
    net->segment[proximal] = (Segment){.length = vec3_distance(net->position[above], bifurcation),
                                       .child = {segment, fresh},
                                       .parent = above,
                                       .terminals = distal->terminals,
                                       .gauge = distal->gauge};
    net->sensitivity[proximal] = net->sensitivity[segment];
    atomic_init(&net->coming[proximal].gain, 1); /* the new terminal, on its way up */
    atomic_init(&net->coming[proximal].below, 1);
    net->segment[fresh] = (Segment){.length = vec3_distance(bifurcation, terminal),
                                    .child = {-1, -1},
                                    .parent = proximal,
                                    .terminals = 1};
    distal->parent = proximal;
    distal->length = vec3_distance(bifurcation, net->position[segment]);
    if (net->trait) {
        net->trait[proximal] = net->trait[segment];
        net->trait[proximal].origin = -1;
        net->trait[fresh] =
            (Trait){.weight = net->fresh_weight, .tree = net->trait[segment].tree, .origin = -1};
    }

    Reduced daughters[2] = {network_reduce(net, segment), network_reduce(net, fresh)};
    report(net, segment, &daughters[0]);
    report(net, fresh, &daughters[1]);
    Below below = network_below(net, proximal);
    Reduced mother =
        law_extend(&net->law, network_burden(net, proximal, net->segment[proximal].terminals + 1),
                   net->segment[proximal].length, &below);
    net->segment[proximal].radius =
        narrow(net->radius_unit * (double)net->segment[proximal].gauge * mother.rho);
    adopt(net, segment, &daughters[0], proximal, &mother);
    adopt(net, fresh, &daughters[1], proximal, &mother);
}

static size_t chunk_end(size_t index, size_t count)
{
    size_t end = (index + 1) * CHUNK;
    return end < count ? end : count;
}

/* The splits of one call of network_carry. */
typedef struct Carrying {
    Network *net;
    size_t splits;
} Carrying;

/* The proximal segment that the k-th of them made. */
static int32_t split_proximal(const Carrying *carrying, size_t k)
{
    return (int32_t)(carrying->net->n - 2 * (carrying->splits - k));
}

static void announce(size_t index, int worker, void *context)
{
    (void)worker;
    const Carrying *carrying = context;
    Network *net = carrying->net;
    size_t end = chunk_end(index, carrying->splits);
    for (size_t k = index * CHUNK; k < end; k++) {
        int32_t i = split_proximal(carrying, k);
        while (net->segment[i].parent >= 0 &&
               !atomic_exchange_explicit(&net->coming[i].announced, true, memory_order_relaxed)) {
            i = net->segment[i].parent;
            atomic_fetch_add_explicit(&net->coming[i].below, 1, memory_order_relaxed);
        }
    }
}

/* Whether nothing that `i` waits for is missing, now that one more has come. */
static bool arrive(Network *net, int32_t i)
{
    return atomic_fetch_sub_explicit(&net->coming[i].below, 1, memory_order_acq_rel) == 1;
}

static void ascend(size_t index, int worker, void *context)
{
    (void)worker;
    const Carrying *carrying = context;
    Network *net = carrying->net;
    size_t end = chunk_end(index, carrying->splits);
    for (size_t k = index * CHUNK; k < end; k++)
        for (int32_t i = split_proximal(carrying, k);
             arrive(net, i) && net->segment[i].parent >= 0;) {
            Arrivals *here = &net->coming[i];
            int gain = atomic_load_explicit(&here->gain, memory_order_relaxed);
            atomic_store_explicit(&here->gain, 0, memory_order_relaxed);
            atomic_store_explicit(&here->announced, false, memory_order_relaxed);
            net->segment[i].terminals += gain;
            recompute(net, i);
            i = net->segment[i].parent;
            atomic_fetch_add_explicit(&net->coming[i].gain, gain, memory_order_relaxed);
        }
}

void network_carry(Network *net, size_t splits, int threads)
{
    Carrying carrying = {net, splits};
    size_t chunks = (splits + CHUNK - 1) / CHUNK;
    if (splits < LEAST_SHARED)
        threads = 1;
    threads_for(chunks, threads, announce, &carrying);
    threads_for(chunks, threads, ascend, &carrying);
    for (size_t k = 0; k < net->inlets; k++) {
        int32_t inlet = net->inlet[k];
        net->segment[inlet].terminals +=
            atomic_exchange_explicit(&net->coming[inlet].gain, 0, memory_order_relaxed);
    }
}

void network_move(Network *net, int32_t node, Vec3 place)
{
    const int32_t *child = net->segment[node].child;
    net->position[node] = place;
    for (int slot = 0; slot < 2; slot++) {
        measure(net, child[slot]);
        recompute(net, child[slot]);
    }
    measure(net, node);
    for (int32_t i = node; net->segment[i].parent >= 0; i = net->segment[i].parent)
        recompute(net, i);
}

/* The node after `i` in depth-first order below `top`, among those with at least so many terminals;
 * -1 after the last. */
static int32_t next_below(const Network *net, int32_t i, int32_t top, int32_t terminals)
{
    for (int slot = 0; slot < 2; slot++) {
        int32_t child = net->segment[i].child[slot];
        if (child >= 0 && net->segment[child].terminals >= terminals)
            return child;
    }
    for (; i != top; i = net->segment[i].parent) {
        const Segment *parent = &net->segment[net->segment[i].parent];
        int32_t sister = parent->child[1];
        if (parent->child[0] == i && sister >= 0 && net->segment[sister].terminals >= terminals)
            return sister;
    }
    return -1;
}

/* Passes on to its daughters what a node has itself. */
static void refresh_daughters(Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    if (segment->child[0] < 0)
        return;
    Reduced mother = {0};
    if (segment->parent >= 0)
        mother = network_reduce(net, i);
    for (int slot = 0; slot < 2 && segment->child[slot] >= 0; slot++) {
        int32_t child = segment->child[slot];
        Reduced daughter = network_reduce(net, child);
        if (segment->parent >= 0)
            adopt(net, child, &daughter, i, &mother);
        else
            adopt_root(net, child, &daughter);
    }
}

typedef struct Refreshing {
    Network *net;
    int32_t least; /* terminals of the segments that are refreshed already */
} Refreshing;

/* Whether node i, no inlet, is the first on its way from the inlet that is still to be refreshed. */
static bool begins_subtree(const Refreshing *refreshing, int32_t i)
{
    const Segment *segment = refreshing->net->segment;
    const Segment *above = &segment[segment[i].parent];
    return segment[i].terminals < refreshing->least &&
           (above->parent < 0 || above->terminals >= refreshing->least);
}

static void refresh_chunk(size_t index, int worker, void *context)
{
    (void)worker;
    const Refreshing *refreshing = context;
    Network *net = refreshing->net;
    size_t end = (index + 1) * REFRESHED < net->n ? (index + 1) * REFRESHED : net->n;
    for (size_t k = index * REFRESHED; k < end; k++) {
        int32_t top = (int32_t)k;
        if (net->segment[k].parent < 0 || !begins_subtree(refreshing, top))
            continue;
        for (int32_t i = top; i >= 0; i = next_below(net, i, top, 1))
            refresh_daughters(net, i);
    }
}

void network_refresh(Network *net, int threads)
{
    Refreshing refreshing = {net, (int32_t)(net->terminals / SUBTREES) + 1};
    for (size_t k = 0; k < net->inlets; k++)
        for (int32_t i = net->inlet[k]; i >= 0;
             i = next_below(net, i, net->inlet[k], refreshing.least))
            refresh_daughters(net, i);
    threads_for((net->n + REFRESHED - 1) / REFRESHED, threads, refresh_chunk, &refreshing);
}

/* Replaces items[k] by items[order[k]] for all k. */
static Status permute(void *items, size_t size, const int32_t *order, size_t n, Err *err)
{
    char *scratch = NULL, *bytes = items;
    TRY(mem_calloc(&scratch, n, size, "nodes to renumber", err));
    for (size_t k = 0; k < n; k++)
        memcpy(scratch + k * size, bytes + (size_t)order[k] * size, size);
    memcpy(bytes, scratch, n * size);
    free(scratch);
    return STATUS_OK;
}

int32_t network_first_upward(const Network *net, int32_t i)
{
    while (net->segment[i].child[0] >= 0)
        i = net->segment[i].child[0];
    return i;
}

int32_t network_next_upward(const Network *net, int32_t i)
{
    int32_t above = net->segment[i].parent;
    const int32_t *child = net->segment[above].child;
    return child[0] == i && child[1] >= 0 ? network_first_upward(net, child[1]) : above;
}

/* Counts the terminals of node i from those of its daughters. */
static void count_terminals(Network *net, int32_t i)
{
    Segment *segment = &net->segment[i];
    segment->terminals = segment->child[0] < 0 && segment->parent >= 0;
    for (int slot = 0; slot < 2 && segment->child[slot] >= 0; slot++)
        segment->terminals += net->segment[segment->child[slot]].terminals;
}

void network_resum(Network *net)
{
    size_t terminals = 0;
    for (size_t k = 0; k < net->inlets; k++) {
        int32_t inlet = net->inlet[k];
        for (int32_t i = network_first_upward(net, inlet); i != inlet;
             i = network_next_upward(net, i)) {
            measure(net, i);
            count_terminals(net, i);
            recompute(net, i);
        }
        count_terminals(net, inlet);
        terminals += (size_t)net->segment[inlet].terminals;
    }
    set_terminals(net, terminals);
}

Status network_reorder(Network *net, Err *err)
{
    int32_t *order = NULL, *place = NULL; /* old index of the new one, and new of the old */
    size_t n = net->n;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&order, n, sizeof *order, "nodes to renumber", err));
    TRY_GOTO(mem_calloc(&place, n, sizeof *place, "nodes to renumber", err));
    int32_t count = 0;
    for (size_t k = 0; k < net->inlets; k++)
        for (int32_t i = net->inlet[k]; i >= 0; i = next_below(net, i, net->inlet[k], 1)) {
            place[i] = count;
            order[count++] = i;
        }
    for (size_t k = 0; k < net->inlets; k++)
        net->inlet[k] = place[net->inlet[k]];
    TRY_GOTO(permute(net->segment, sizeof *net->segment, order, n, err));
    if (net->sensitivity)
        TRY_GOTO(permute(net->sensitivity, sizeof *net->sensitivity, order, n, err));
    if (net->trait)
        TRY_GOTO(permute(net->trait, sizeof *net->trait, order, n, err));
    TRY_GOTO(permute(net->position, sizeof *net->position, order, n, err));
    for (size_t k = 0; k < n; k++) {
        Segment *segment = &net->segment[k];
        if (segment->parent >= 0)
            segment->parent = place[segment->parent];
        for (int slot = 0; slot < 2; slot++)
            if (segment->child[slot] >= 0)
                segment->child[slot] = place[segment->child[slot]];
    }
done:
    free(order);
    free(place);
    return status;
}
