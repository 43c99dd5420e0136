/* Lists, per node of a tree of vessels, the segments that meet there, and the segments whose
 * surfaces blend there.
 *
 * The list of blending segments is found by walks from segments. A walk leaves a segment at each of
 * its two ends and adds the segment to the list of every node that it reaches. In a loop several
 * paths lead to one node, so a walk stores the shortest path to each node and adds the segment
 * once. Pairs of node and segment come out by rising segment, and the lists keep this order. */
#include "scene/vesseltree.h"

#include <stdlib.h>

/* A node, and a segment that blends there. */
typedef struct NodePair {
    uint32_t node, segment;
} NodePair;

/* The last segment whose walks reached a node, and the length of the shortest path to it. */
typedef struct NodeVisit {
    uint32_t segment;
    double path_mm;
} NodeVisit;

typedef struct Walker {
    const VesselTree *tree;
    const IndexLists *incident;
    NodeVisit *visits; /* per node; owned */
    ARRAY(NodePair) pairs;
    ARRAY(uint32_t) queue; /* nodes that the present walk reached */
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

/* Records a path to a node, unless a path that is not longer is known. */
static Status reach(Walker *walker, uint32_t node, uint32_t segment, double path_mm, Err *err)
{
    NodeVisit *visit = &walker->visits[node];
    const bool is_first = visit->segment != segment;
    if (!is_first && visit->path_mm <= path_mm)
        return STATUS_OK;
    *visit = (NodeVisit){segment, path_mm};
    if (is_first)
        TRY(ARRAY_PUSH(&walker->pairs, "blending segments", err, (NodePair){node, segment}));
    return ARRAY_PUSH(&walker->queue, "steps", err, node);
}

/* Walks from both ends of a segment along other segments. */
static Status walk_out(Walker *walker, uint32_t segment, Err *err)
{
    const VesselTree *tree = walker->tree;
    const uint32_t *first = walker->incident->first;
    double limit = BLEND_REACH * tree->segments[segment].radius_mm;
    walker->queue.n = 0;
    for (int end = 0; end < 2; end++)
        TRY(reach(walker, tree->nodes[segment][end], segment, 0, err));
    for (size_t at = 0; at < walker->queue.n; at++) {
        const uint32_t node = walker->queue.items[at];
        for (uint32_t i = first[node]; i < first[node + 1]; i++) {
            uint32_t next = walker->incident->items[i];
            const FieldSegment *passed = &tree->segments[next];
            double path_mm = walker->visits[node].path_mm + vec3_distance(passed->a, passed->b);
            uint32_t beyond = tree->nodes[next][!segment_end_at(tree, next, node)];
            if (path_mm <= limit)
                TRY(reach(walker, beyond, segment, path_mm, err));
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
    TRY_GOTO(mem_calloc(&walker.visits, tree->n_nodes, sizeof *walker.visits, "nodes", err));
    for (size_t i = 0; i < tree->n_nodes; i++)
        walker.visits[i].segment = UINT32_MAX;
    for (uint32_t i = 0; i < tree->n_segments; i++)
        TRY_GOTO(walk_out(&walker, i, err));
    TRY_GOTO(indexlists_begin(out, tree->n_nodes, "nodes", err));
    for (size_t i = 0; i < walker.pairs.n; i++)
        indexlists_count(out, walker.pairs.items[i].node);
    TRY_GOTO(indexlists_allot(out, "nodes", err));
    for (size_t i = 0; i < walker.pairs.n; i++)
        indexlists_put(out, walker.pairs.items[i].node, walker.pairs.items[i].segment);
done:
    free(walker.visits);
    ARRAY_RELEASE(&walker.pairs);
    ARRAY_RELEASE(&walker.queue);
    return status;
}
