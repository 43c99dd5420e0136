/* The tree while it grows: adds terminals, and keeps the reduced values of the law [cco/law.h] of
 * all segments up to date.
 *
 * Every segment stores rho_gamma and cost of its daughters. A change at one segment is carried
 * towards the root by recomputing only the segments on the path: one cache line each. The result is
 * exact, because no running sum is added to or subtracted from.
 *
 * network_split carries a new terminal to the nearest LEVELS ancestors at once, where it is a large
 * part of the subtree. Further up it is a small part, and the sums wait for network_refresh. So a
 * split costs O(1), and threads can split segments far apart without a lock.
 *
 * network_refresh sums up all segments in post-order (sum_up), and then hands gauges and
 * derivatives down in pre-order (refresh_daughters). Threads process the subtrees that have less
 * than 1 / SUBTREES of the terminals (find_tops) in parallel; one thread processes the few segments
 * above them, between the two passes. Each segment is computed only from its daughters or its
 * parent, so the result does not depend on the number of threads.
 *
 * The sensitivities are the derivatives of the root's cost, carried down by the chain rule. They
 * give the price of a change below a segment in O(1). They grow out of date as the tree grows. That
 * only makes the choice between candidates less exact; the tree's own values are not affected. */
#include "grow/network.h"

#include <float.h>
#include <stdlib.h>

/* Number of ancestors that a split updates at once. Eight levels up, a subtree of a balanced tree
 * has 2^8 terminals, of which a new one is a small part. More levels make a split slower; fewer let
 * the next connections nearby see older sums. */
enum { LEVELS = 8 };
/* A subtree that one thread refreshes has less than 1 / SUBTREES of the terminals. */
enum { SUBTREES = 128 };

Status network_init(Network *net, Law law, double radius_scale, NetworkSize size, Err *err)
{
    size_t n = size.capacity;
    Network made = {
        .law = law, .radius_scale = radius_scale, .capacity = n, .new_terminal_weight = 1};
    Status status;
    TRY_GOTO(mem_calloc(&made.segment, n, sizeof *made.segment, "segments", err));
    TRY_GOTO(mem_calloc(&made.sensitivity, n, sizeof *made.sensitivity, "segments", err));
    if (size.has_traits)
        TRY_GOTO(mem_calloc(&made.trait, n, sizeof *made.trait, "segments", err));
    TRY_GOTO(mem_calloc(&made.position, n, sizeof *made.position, "positions", err));
    TRY_GOTO(mem_calloc(&made.spare, n, sizeof *made.spare, "segments", err));
    TRY_GOTO(mem_calloc(&made.tops, n, sizeof *made.tops, "segments", err));
    TRY_GOTO(mem_calloc(&made.inlet, size.inlets, sizeof *made.inlet, "inlets", err));
    *net = made;
    return STATUS_OK;
done:
    network_release(&made);
    return status;
}

Status network_add_trunk(Network *net, Err *err)
{
    TRY(mem_calloc(&net->trunk, 1, sizeof *net->trunk, "segments", err));
    Trunk *trunk = net->trunk;
    TRY(mem_calloc(&trunk->radius, net->capacity, sizeof *trunk->radius, "radii", err));
    TRY(mem_calloc(&trunk->drop_cost, net->capacity, sizeof *trunk->drop_cost, "segments", err));
    return mem_calloc(&trunk->order, net->capacity, sizeof *trunk->order, "segments", err);
}

static void release_trunk(Network *net)
{
    if (!net->trunk)
        return;
    free(net->trunk->radius);
    free(net->trunk->drop_cost);
    free(net->trunk->order);
    free(net->trunk);
}

void network_release(Network *net)
{
    release_trunk(net);
    free(net->segment);
    free(net->sensitivity);
    free(net->trait);
    free(net->position);
    free(net->spare);
    free(net->tops);
    free(net->inlet);
    *net = (Network){0};
}

void network_free_workspace(Network *net)
{
    free(net->sensitivity);
    free(net->spare);
    free(net->tops);
    net->sensitivity = NULL;
    net->spare = net->tops = NULL;
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

/* Returns the value as a float. A radius that a float cannot hold becomes FLT_MAX, which is also
 * wider than any domain. */
static float narrow(double value)
{
    return (float)fmin(value, (double)FLT_MAX);
}

/* Stores the sums of segment i in its parent. */
static void tell_parent(Network *net, int32_t i, const Reduced *reduced)
{
    Segment *parent = &net->segment[net->segment[i].parent];
    int slot = parent->child[1] == i;
    parent->rho_gamma[slot] = reduced->rho_gamma;
    parent->cost[slot] = reduced->cost;
}

/* Sets the length of segment i from the positions of its ends. */
static void measure(Network *net, int32_t i)
{
    Segment *segment = &net->segment[i];
    segment->length = vec3_distance(net->position[segment->parent], net->position[i]);
}

/* Computes the sums of segment i from its daughters, and stores them in its parent. */
static void recompute(Network *net, int32_t i)
{
    Reduced reduced = network_reduce(net, i);
    tell_parent(net, i, &reduced);
}

/* Computes gauge, radius and sensitivity of segment i, which sums up to `reduced`, from those of
 * its mother `parent`, which sums up to `above`. */
static void set_from_parent(Network *net, int32_t i, const Reduced *reduced, int32_t parent,
                            const Reduced *above)
{
    if (network_kept_radius(net, parent) > 0) {
        trunk_set_daughter(net, i, reduced, parent);
        return;
    }
    const Segment *mother = &net->segment[parent];
    double gauge = (double)mother->gauge;
    Adjoint adjoint = {net->sensitivity[parent].load, law_lambda_power(&net->law, gauge)};
    Segment *segment = &net->segment[i];
    double own_gauge = gauge * above->widening;
    segment->gauge = narrow(own_gauge);
    segment->radius = narrow(net->radius_unit * own_gauge * reduced->rho);
    net->sensitivity[i] = (Sensitivity){
        law_daughter_adjoint(&net->law, above, adjoint, reduced).load,
        net->sensitivity[parent].extra + law_load_derivative(&net->law, above, adjoint) *
                                             mother->length * network_burden(net, parent, 1)};
}

static void set_root_from_parent(Network *net, int32_t root, const Reduced *reduced)
{
    double kept = network_kept_radius(net, root);
    net->segment[root].gauge = 1;
    net->segment[root].radius = narrow(kept > 0 ? kept : net->radius_unit * reduced->rho);
    net->sensitivity[root] = (Sensitivity){0, 0};
}

/* The trait of a segment that is not part of the tree that is continued. */
static Trait new_trait(const Network *net, int32_t tree, double gamma)
{
    return (Trait){
        .weight = net->new_terminal_weight, .gamma = gamma, .mate = -1, .tree = tree, .origin = -1};
}

int32_t network_append(Network *net, int32_t parent, Vec3 position)
{
    int32_t i = (int32_t)net->n++;
    net->position[i] = position;
    net->segment[i] = (Segment){.child = {-1, -1}, .parent = parent};
    if (net->trait)
        net->trait[i] = new_trait(net, parent < 0 ? (int32_t)net->inlets : net->trait[parent].tree,
                                  net->law.gamma);
    if (parent < 0) {
        net->inlet[net->inlets++] = i;
    } else {
        int32_t *child = net->segment[parent].child;
        child[child[0] >= 0] = i;
    }
    return i;
}

void network_add_spares(Network *net, size_t nodes)
{
    while (net->spares < nodes) {
        net->segment[net->n] = (Segment){.child = {-1, -1}, .parent = -1};
        net->spare[net->spares++] = (int32_t)net->n++;
    }
}

void network_add_terminals(Network *net, size_t terminals)
{
    set_terminals(net, net->terminals + terminals);
}

/* Adds a terminal to the sums of up to LEVELS ancestors of segment i, as long as they are in `zone`
 * [network_split]. `reduced` is the sums of segment i. */
static void tell_ancestors(Network *net, int32_t i, const Reduced *reduced, Box zone)
{
    Reduced here = *reduced;
    for (int level = 0; level < LEVELS; level++) {
        int32_t above = net->segment[i].parent;
        if (!box_contains(zone, net->position[above], 0))
            return;
        tell_parent(net, i, &here);
        net->segment[above].terminals++;
        if (net->segment[above].parent < 0)
            return;
        i = above;
        here = network_reduce(net, i);
    }
}

void network_split(Network *net, const NetworkSplit *split, Box zone)
{
    int32_t segment = split->segment, proximal = split->made[0], fresh = split->made[1];
    Segment *distal = &net->segment[segment];
    int32_t above = distal->parent;
    net->position[proximal] = split->bifurcation;
    net->position[fresh] = split->terminal;
    net->segment[above].child[net->segment[above].child[1] == segment] = proximal;
    net->segment[proximal] =
        (Segment){.length = vec3_distance(net->position[above], split->bifurcation),
                  .child = {segment, fresh},
                  .parent = above,
                  .terminals = distal->terminals + 1,
                  .gauge = distal->gauge};
    net->sensitivity[proximal] = net->sensitivity[segment];
    net->segment[fresh] = (Segment){.length = vec3_distance(split->bifurcation, split->terminal),
                                    .child = {-1, -1},
                                    .parent = proximal,
                                    .terminals = 1};
    distal->parent = proximal;
    distal->length = vec3_distance(split->bifurcation, net->position[segment]);
    if (net->trait) {
        net->trait[proximal] = net->trait[segment];
        net->trait[proximal].origin = net->trait[proximal].mate = -1;
        net->trait[fresh] = new_trait(net, net->trait[segment].tree, net->trait[segment].gamma);
    }
    if (net->trunk) {
        net->trunk->radius[proximal] = net->trunk->radius[segment];
        net->trunk->drop_cost[proximal] = net->trunk->drop_cost[segment];
        net->trunk->radius[fresh] = 0;
    }

    Reduced daughters[2] = {network_reduce(net, segment), network_reduce(net, fresh)};
    tell_parent(net, segment, &daughters[0]);
    tell_parent(net, fresh, &daughters[1]);
    Reduced mother = network_reduce(net, proximal);
    double kept = network_kept_radius(net, proximal);
    net->segment[proximal].radius = narrow(
        kept > 0 ? kept : net->radius_unit * (double)net->segment[proximal].gauge * mother.rho);
    set_from_parent(net, segment, &daughters[0], proximal, &mother);
    set_from_parent(net, fresh, &daughters[1], proximal, &mother);
    tell_ancestors(net, proximal, &mother, zone);
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

/* Returns the node after `i` in depth-first order below `top`, among the nodes with at least
 * `terminals` terminals; -1 after the last. */
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

/* Replaces items[k] by items[order[k]] for all k. Does nothing if `items` is NULL. */
static Status permute(void *items, size_t size, const int32_t *order, size_t n, Err *err)
{
    char *scratch = NULL, *bytes = items;
    if (!items)
        return STATUS_OK;
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

/* Sets the terminals of node i from those of its daughters. */
static void count_terminals(Network *net, int32_t i)
{
    Segment *segment = &net->segment[i];
    segment->terminals = segment->child[0] < 0 && segment->parent >= 0;
    for (int slot = 0; slot < 2 && segment->child[slot] >= 0; slot++)
        segment->terminals += net->segment[segment->child[slot]].terminals;
}

/* Sums up segment i from its daughters and stores the sums in its parent. Stores rho in the
 * sensitivity, from which summed reads it, until refresh_daughters overwrites it. */
static void sum_up(Network *net, int32_t i)
{
    count_terminals(net, i);
    Reduced reduced = network_reduce(net, i);
    tell_parent(net, i, &reduced);
    net->sensitivity[i].load = reduced.rho;
}

/* Returns the sums that sum_up found for a daughter, as far as refresh_daughters needs them. */
static Reduced summed(const Network *net, const Segment *mother, int slot)
{
    double rho = net->sensitivity[mother->child[slot]].load, rho2 = rho * rho;
    return (Reduced){.load = rho2 * rho2, .rho_gamma = mother->rho_gamma[slot], .rho = rho};
}

/* Computes gauge, radius and sensitivity of the daughters of node i from those of the node. */
static void refresh_daughters(Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i];
    if (segment->child[0] < 0)
        return;
    Reduced mother = {0};
    if (segment->parent >= 0)
        mother = network_reduce(net, i);
    for (int slot = 0; slot < 2 && segment->child[slot] >= 0; slot++) {
        Reduced daughter = summed(net, segment, slot);
        if (segment->parent >= 0)
            set_from_parent(net, segment->child[slot], &daughter, i, &mother);
        else
            set_root_from_parent(net, segment->child[slot], &daughter);
    }
}

static void sum_up_subtree(size_t index, int worker, void *context)
{
    (void)worker;
    Network *net = context;
    int32_t top = net->tops[index];
    for (int32_t i = network_first_upward(net, top); i != top; i = network_next_upward(net, i))
        sum_up(net, i);
    sum_up(net, top);
}

static void refresh_subtree(size_t index, int worker, void *context)
{
    (void)worker;
    Network *net = context;
    int32_t top = net->tops[index];
    for (int32_t i = top; i >= 0; i = next_below(net, i, top, 1))
        refresh_daughters(net, i);
}

/* Divides the trees into subtrees of less than `least` terminals and the nodes above them. Lists
 * the top nodes of the subtrees at the beginning of the workspace `tops`, and returns their number.
 * Lists the nodes above at the end of `tops`, the mother behind her daughters; *upper receives
 * their number. */
static size_t find_tops(const Network *net, int32_t least, size_t *upper)
{
    size_t count = 0;
    *upper = 0;
    for (size_t k = 0; k < net->inlets; k++)
        for (int32_t i = net->inlet[k]; i >= 0; i = next_below(net, i, net->inlet[k], least)) {
            net->tops[net->capacity - ++*upper] = i;
            for (int slot = 0; slot < 2; slot++) {
                int32_t child = net->segment[i].child[slot];
                if (child >= 0 && net->segment[child].terminals < least)
                    net->tops[count++] = child;
            }
        }
    return count;
}

void network_refresh(Network *net, int threads)
{
    size_t upper, count = find_tops(net, (int32_t)(net->terminals / SUBTREES) + 1, &upper);
    const int32_t *end = net->tops + net->capacity, *first = end - upper;
    threads_for(count, threads, sum_up_subtree, net);
    for (const int32_t *i = first; i < end; i++) {
        if (net->segment[*i].parent >= 0)
            sum_up(net, *i);
        else
            count_terminals(net, *i);
    }
    if (net->trunk)
        trunk_refresh(net);
    while (end-- > first)
        refresh_daughters(net, *end);
    threads_for(count, threads, refresh_subtree, net);
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
    int32_t *order = NULL, *place = NULL; /* old index per new index, and new index per old index */
    size_t n = net->n - net->spares;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&order, n, sizeof *order, "nodes to renumber", err));
    TRY_GOTO(mem_calloc(&place, net->n, sizeof *place, "nodes to renumber", err));
    int32_t count = 0;
    for (size_t k = 0; k < net->inlets; k++)
        for (int32_t i = net->inlet[k]; i >= 0; i = next_below(net, i, net->inlet[k], 1)) {
            place[i] = count;
            order[count++] = i;
        }
    for (size_t k = 0; k < net->inlets; k++)
        net->inlet[k] = place[net->inlet[k]];
    TRY_GOTO(permute(net->segment, sizeof *net->segment, order, n, err));
    TRY_GOTO(permute(net->sensitivity, sizeof *net->sensitivity, order, n, err));
    TRY_GOTO(permute(net->trait, sizeof *net->trait, order, n, err));
    TRY_GOTO(permute(net->position, sizeof *net->position, order, n, err));
    if (net->trunk) {
        TRY_GOTO(permute(net->trunk->radius, sizeof *net->trunk->radius, order, n, err));
        TRY_GOTO(permute(net->trunk->drop_cost, sizeof *net->trunk->drop_cost, order, n, err));
    }
    net->n = n;
    net->spares = 0;
    for (size_t k = 0; k < n; k++) {
        Segment *segment = &net->segment[k];
        if (segment->parent >= 0)
            segment->parent = place[segment->parent];
        for (int slot = 0; slot < 2; slot++)
            if (segment->child[slot] >= 0)
                segment->child[slot] = place[segment->child[slot]];
        if (network_mate(net, (int32_t)k) >= 0)
            net->trait[k].mate = place[net->trait[k].mate];
    }
done:
    free(order);
    free(place);
    return status;
}
