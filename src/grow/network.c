/* Every segment holds flare and cost of its daughters, so a change at one place is carried to the
 * root by recomputing the segments on the way and nothing else: O(depth), one cache line each, and
 * exact, because nothing is added to or taken from a running sum.
 *
 * The sensitivities are the derivatives of the root's cost, carried down by the chain rule. They
 * price a change below a segment in O(1). They age as the tree grows, which only blurs the choice
 * between candidates, never the tree's own figures. */
#include "grow/network.h"

#include <float.h>
#include <stdlib.h>

Status network_init(Network *net, Law law, double radius_scale, size_t terminals, Vec3 inlet,
                    Err *err)
{
    Network made = {.law = law, .radius_scale = radius_scale, .n = 1, .capacity = 2 * terminals};
    size_t n = made.capacity;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.segment, n, sizeof *made.segment, "segments", err));
    TRY_GOTO(mem_calloc(&made.sensitivity, n, sizeof *made.sensitivity, "segments", err));
    TRY_GOTO(mem_calloc(&made.position, n, sizeof *made.position, "positions", err));
    made.segment[0] = (Segment){.child = {-1, -1}, .parent = -1};
    made.position[0] = inlet;
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
    free(net->position);
    *net = (Network){0};
}

double network_radius_unit(const Network *net)
{
    return net->radius_scale / sqrt(sqrt((double)network_terminals(net)));
}

double network_cost(const Network *net)
{
    return net->segment[0].cost[0];
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

/* Carries one more terminal below segment `i`, and what changed there, up to the inlet. */
static void walk_up(Network *net, int32_t i)
{
    for (; i != 0; i = net->segment[i].parent) {
        net->segment[i].terminals++;
        Reduced reduced = network_reduce(net, i);
        report(net, i, &reduced);
    }
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
    segment->radius = narrow(network_radius_unit(net) * own_gauge * reduced->rho);
    net->sensitivity[i] = (Sensitivity){law_descend(&net->law, above, adjoint, reduced).load,
                                        net->sensitivity[parent].extra +
                                            law_total(&net->law, above, adjoint) * mother->length};
}

static void set_root_radius(Network *net, int32_t root, const Reduced *reduced)
{
    net->segment[root].gauge = 1;
    net->segment[root].radius = narrow(network_radius_unit(net) * reduced->rho);
    net->sensitivity[root] = (Sensitivity){0, 0};
}

void network_plant(Network *net, Vec3 terminal)
{
    net->position[1] = terminal;
    net->segment[1] = (Segment){
        .length = vec3_distance(net->position[0], terminal), .child = {-1, -1}, .parent = 0};
    net->segment[0].child[0] = 1;
    net->n = 2;
    walk_up(net, 1);
    Reduced reduced = network_reduce(net, 1);
    set_root_radius(net, 1, &reduced);
}

void network_split(Network *net, int32_t segment, Vec3 bifurcation, Vec3 terminal)
{
    Segment *distal = &net->segment[segment];
    int32_t above = distal->parent;
    int32_t proximal = (int32_t)net->n, fresh = proximal + 1;
    net->n += 2;
    net->position[proximal] = bifurcation;
    net->position[fresh] = terminal;
    net->segment[above].child[net->segment[above].child[1] == segment] = proximal;
    net->segment[proximal] = (Segment){.length = vec3_distance(net->position[above], bifurcation),
                                       .child = {segment, fresh},
                                       .parent = above,
                                       .terminals = distal->terminals,
                                       .gauge = distal->gauge};
    net->sensitivity[proximal] = net->sensitivity[segment];
    net->segment[fresh] = (Segment){.length = vec3_distance(bifurcation, terminal),
                                    .child = {-1, -1},
                                    .parent = proximal,
                                    .terminals = 1};
    distal->parent = proximal;
    distal->length = vec3_distance(bifurcation, net->position[segment]);

    Reduced daughters[2] = {network_reduce(net, segment), network_reduce(net, fresh)};
    report(net, segment, &daughters[0]);
    report(net, fresh, &daughters[1]);
    walk_up(net, proximal);
    Reduced mother = network_reduce(net, proximal);
    net->segment[proximal].radius =
        narrow(network_radius_unit(net) * (double)net->segment[proximal].gauge * mother.rho);
    adopt(net, segment, &daughters[0], proximal, &mother);
    adopt(net, fresh, &daughters[1], proximal, &mother);
}

/* The segment after `i` in depth-first order, 0 after the last. */
static int32_t next_depth_first(const Network *net, int32_t i)
{
    if (net->segment[i].child[0] >= 0)
        return net->segment[i].child[0];
    for (; i != 0; i = net->segment[i].parent) {
        const Segment *parent = &net->segment[net->segment[i].parent];
        if (parent->child[0] == i && parent->child[1] >= 0)
            return parent->child[1];
    }
    return 0;
}

void network_refresh(Network *net)
{
    int32_t root = net->segment[0].child[0];
    Reduced reduced = network_reduce(net, root);
    set_root_radius(net, root, &reduced);
    for (int32_t i = root; i != 0; i = next_depth_first(net, i)) {
        if (net->segment[i].child[0] < 0)
            continue;
        Reduced mother = network_reduce(net, i);
        for (int slot = 0; slot < 2; slot++) {
            int32_t child = net->segment[i].child[slot];
            Reduced daughter = network_reduce(net, child);
            adopt(net, child, &daughter, i, &mother);
        }
    }
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

void network_resum(Network *net)
{
    for (int32_t i = (int32_t)net->n - 1; i > 0; i--) {
        Segment *segment = &net->segment[i];
        segment->length = vec3_distance(net->position[segment->parent], net->position[i]);
        Reduced reduced = network_reduce(net, i);
        report(net, i, &reduced);
    }
}

Status network_reorder(Network *net, Err *err)
{
    int32_t *order = NULL, *place = NULL; /* old index of the new one, and new of the old */
    size_t n = net->n;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&order, n, sizeof *order, "nodes to renumber", err));
    TRY_GOTO(mem_calloc(&place, n, sizeof *place, "nodes to renumber", err));
    int32_t count = 0, i = 0;
    do {
        place[i] = count;
        order[count++] = i;
        i = next_depth_first(net, i);
    } while (i != 0);
    TRY_GOTO(permute(net->segment, sizeof *net->segment, order, n, err));
    TRY_GOTO(permute(net->sensitivity, sizeof *net->sensitivity, order, n, err));
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
