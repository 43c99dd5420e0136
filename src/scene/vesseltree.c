/* A segment walks out of both its ends, away from itself, and adds itself to the list of each node
 * that it reaches. In a tree each node is reached by one way only, so nothing needs to be
 * remembered but where the walk came from. Pairs of node and segment come out by rising segment; a
 * counting sort by node keeps that order. */
#include "scene/vesseltree.h"

#include <stdlib.h>

typedef struct NodePair {
    uint32_t node, segment;
} NodePair;

typedef struct Step {
    uint32_t node, from; /* reached through this segment */
    double way_mm;
} Step;

typedef struct Walker {
    const VesselTree *tree;
    const IndexLists *incident;
    NodePair *pairs;
    Step *stack;
    size_t n_pairs, pair_capacity, stack_capacity;
} Walker;

void vesseltree_release(VesselTree *tree)
{
    free(tree->segments);
    free(tree->nodes);
    free(tree->ids);
    *tree = (VesselTree){0};
}

static Status sort_by_node(const NodePair *pairs, size_t n_pairs, size_t n_nodes, IndexLists *out,
                           Err *err)
{
    IndexLists lists = {0};
    Status status;
    TRY_GOTO(mem_calloc(&lists.first, n_nodes + 2, sizeof *lists.first, "nodes", err));
    TRY_GOTO(mem_calloc(&lists.items, n_pairs, sizeof *lists.items, "nodes", err));
    for (size_t i = 0; i < n_pairs; i++)
        lists.first[pairs[i].node + 2]++;
    for (size_t n = 2; n <= n_nodes; n++)
        lists.first[n] += lists.first[n - 1];
    for (size_t i = 0; i < n_pairs; i++)
        lists.items[lists.first[pairs[i].node + 1]++] = pairs[i].segment;
    *out = lists;
    return STATUS_OK;
done:
    indexlists_release(&lists);
    return status;
}

Status vesseltree_incident(const VesselTree *tree, IndexLists *out, Err *err)
{
    NodePair *pairs;
    TRY(mem_calloc(&pairs, 2 * tree->n_segments, sizeof *pairs, "segments", err));
    for (size_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++)
            pairs[2 * i + (size_t)end] = (NodePair){tree->nodes[i][end], (uint32_t)i};
    Status status = sort_by_node(pairs, 2 * tree->n_segments, tree->n_nodes, out, err);
    free(pairs);
    return status;
}

static Status push_step(Walker *walker, size_t *top, Step step, Err *err)
{
    TRY(mem_reserve(&walker->stack, &walker->stack_capacity, *top + 1, sizeof *walker->stack,
                    "steps", err));
    walker->stack[(*top)++] = step;
    return STATUS_OK;
}

static Status walk_out(Walker *walker, uint32_t segment, int end, Err *err)
{
    const VesselTree *tree = walker->tree;
    double limit = BLEND_REACH * tree->segments[segment].radius_mm;
    size_t top = 0;
    TRY(push_step(walker, &top, (Step){tree->nodes[segment][end], segment, 0}, err));
    while (top) {
        Step step = walker->stack[--top];
        TRY(mem_reserve(&walker->pairs, &walker->pair_capacity, walker->n_pairs + 1,
                        sizeof *walker->pairs, "blending segments", err));
        walker->pairs[walker->n_pairs++] = (NodePair){step.node, segment};
        const uint32_t *first = walker->incident->first;
        for (uint32_t i = first[step.node]; i < first[step.node + 1]; i++) {
            uint32_t next = walker->incident->items[i];
            const FieldSegment *way = &tree->segments[next];
            double way_mm = step.way_mm + vec3_distance(way->a, way->b);
            uint32_t beyond = tree->nodes[next][!segment_end_at(tree, next, step.node)];
            if (next != step.from && way_mm <= limit)
                TRY(push_step(walker, &top, (Step){beyond, next, way_mm}, err));
        }
    }
    return STATUS_OK;
}

Status vesseltree_blending(const VesselTree *tree, const IndexLists *incident, IndexLists *out,
                           Err *err)
{
    Walker walker = {.tree = tree, .incident = incident};
    Status status = STATUS_OK;
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++)
            TRY_GOTO(walk_out(&walker, i, end, err));
    TRY_GOTO(sort_by_node(walker.pairs, walker.n_pairs, tree->n_nodes, out, err));
done:
    free(walker.pairs);
    free(walker.stack);
    return status;
}
