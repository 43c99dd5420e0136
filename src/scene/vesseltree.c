/* The list of a node is found by walks from segments. A walk leaves a segment at each of its two
 * ends and adds the segment to the list of every node that it reaches. In a tree one path leads to
 * each node, so a walk remembers nothing except the segment it came through. Pairs of node and
 * segment come out by rising segment, and the lists keep this order. */
#include "scene/vesseltree.h"

#include <stdlib.h>

typedef struct NodePair {
    uint32_t node, segment;
} NodePair;

/* A node that a walk reached, the segment it came through, and the length of the path. */
typedef struct WalkStep {
    uint32_t node, from;
    double path_mm;
} WalkStep;

typedef struct Walker {
    const VesselTree *tree;
    const IndexLists *incident;
    ARRAY(NodePair) pairs;
    ARRAY(WalkStep) stack;
} Walker;

void vesseltree_release(VesselTree *tree)
{
    free(tree->segments);
    free(tree->nodes);
    free(tree->ids);
    *tree = (VesselTree){0};
}

Status vesseltree_incident(const VesselTree *tree, IndexLists *out, Err *err)
{
    const ItemKeys nodes = {&tree->nodes[0][0], tree->n_segments, 2};
    *out = (IndexLists){0};
    return indexlists_sort(out, tree->n_nodes, nodes, "nodes", err);
}

static Status walk_out(Walker *walker, uint32_t segment, int end, Err *err)
{
    const VesselTree *tree = walker->tree;
    const uint32_t *first = walker->incident->first;
    double limit = BLEND_REACH * tree->segments[segment].radius_mm;
    TRY(ARRAY_PUSH(&walker->stack, "steps", err,
                   (WalkStep){tree->nodes[segment][end], segment, 0}));
    while (walker->stack.n) {
        WalkStep step = walker->stack.items[--walker->stack.n];
        TRY(ARRAY_PUSH(&walker->pairs, "blending segments", err, (NodePair){step.node, segment}));
        for (uint32_t i = first[step.node]; i < first[step.node + 1]; i++) {
            uint32_t next = walker->incident->items[i];
            const FieldSegment *passed = &tree->segments[next];
            double path_mm = step.path_mm + vec3_distance(passed->a, passed->b);
            uint32_t beyond = tree->nodes[next][!segment_end_at(tree, next, step.node)];
            if (next != step.from && path_mm <= limit)
                TRY(ARRAY_PUSH(&walker->stack, "steps", err, (WalkStep){beyond, next, path_mm}));
        }
    }
    return STATUS_OK;
}

Status vesseltree_blending(const VesselTree *tree, const IndexLists *incident, IndexLists *out,
                           Err *err)
{
    Walker walker = {.tree = tree, .incident = incident};
    Status status;
    *out = (IndexLists){0};
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++)
            TRY_GOTO(walk_out(&walker, i, end, err));
    TRY_GOTO(indexlists_begin(out, tree->n_nodes, "nodes", err));
    for (size_t i = 0; i < walker.pairs.n; i++)
        indexlists_count(out, walker.pairs.items[i].node);
    TRY_GOTO(indexlists_allot(out, "nodes", err));
    for (size_t i = 0; i < walker.pairs.n; i++)
        indexlists_put(out, walker.pairs.items[i].node, walker.pairs.items[i].segment);
done:
    ARRAY_RELEASE(&walker.pairs);
    ARRAY_RELEASE(&walker.stack);
    return status;
}
