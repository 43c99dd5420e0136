/* Cuts a tree into junction regions and tubes.
 *
 * A segment is a tube if a part of it is clear of the vessels at both its ends [freeends.h], and if
 * this part is long enough for two planes that may be shifted. Many segments along a trunk have no
 * clear part. Such a segment is still a tube if two planes fit close together where the surface is
 * nearly a cylinder. Each of these planes must be clear of the vessels at the end beyond the other
 * plane. Their rims are not circles. If no planes fit, both nodes of the segment belong to one
 * region.
 *
 * In a region, two vessels that share no node may pass close to each other. The tube of one vessel
 * has long triangles, which could cut the other vessel. So the planes of both vessels are pushed
 * past the part where they are near. A tube that becomes too short joins two regions, and then more
 * pairs may share a region. The steps are repeated until nothing changes. They end, because a plane
 * is only pushed to one of a few positions. */
#include "mesh/regions/junctions.h"

#include "mesh/precision.h"
#include "mesh/regions/freeends.h"
#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

/* In units of the radius: how far a plane may be shifted later; and the minimum gap left between
 * two shifted planes, so that the tube between them has some length. */
static const double plane_shift = PLANE_MOVE, plane_gap = 0.05;
/* In units of the smaller radius: the step of the search for the part of a segment that is near
 * another one. The part is widened by one step, so a larger step makes tubes shorter than
 * necessary. */
static const double search_step = 0.15;
/* In units of the radius: beyond this distance from a segment's end, its own term is within a
 * hundredth of its value far from the end. */
static const double full_term_distance = 1.17;
/* In units of the radius: minimum and maximum gap left between close planes. The minimum leaves
 * 0.08 radii for the tube after both planes have moved by CLOSE_MOVE. With a larger minimum, more
 * nodes of a trunk are joined to one large region. The maximum keeps both planes near the middle
 * between the segment's ends, where other vessels disturb the surface least. */
static const double min_close_gap = 0.2, max_close_gap = 0.35;
/* In units of the radius: minimum distance of a plane from the end of a round body, so that the
 * plane does not cut the half ball there: it stays a quarter radius away even if it moves by
 * PLANE_MOVE. */
static const double round_end_distance = 0.375;

typedef struct Divider {
    const VesselTree *tree;
    Junctions *junctions;
    uint32_t *root; /* per node: sets of nodes in one region [base/sets.h] */
    bool *joined;   /* per node: it shares a region with another node */
    bool *is_whole; /* per segment: it must not be a tube */
    FreeEnd (*ends)[2];
    TreeOrder order;
} Divider;

void junctions_release(Junctions *junctions)
{
    indexlists_release(&junctions->incident);
    indexlists_release(&junctions->blending);
    indexlists_release(&junctions->nodes);
    free(junctions->of_node);
    free(junctions->plane);
    free(junctions->is_tube);
    free(junctions->is_close);
    free(junctions->unconnected);
    *junctions = (Junctions){0};
}

/* Returns the point of the segment at a distance from its end. */
static Vec3 point_from(const FieldSegment *segment, int end, double mm)
{
    return vec3_add_scaled(segment_end(segment, end), segment_inward(segment, end), mm);
}

static bool is_end(const Junctions *junctions, uint32_t node)
{
    return junctions->incident.first[node + 1] - junctions->incident.first[node] == 1;
}

/* Returns true if the node is an end that may be cut off flat. A round body has none: its end is a
 * ball, which needs a region. */
static bool is_flat_end(const Divider *divider, uint32_t node)
{
    return divider->tree->body != BODY_ROUND && is_end(divider->junctions, node);
}

/* Moves the planes of a round body off the balls at its ends. */
static void keep_off_ends(const Divider *divider)
{
    const VesselTree *tree = divider->tree;
    for (uint32_t i = 0; i < tree->n_segments && tree->body == BODY_ROUND; i++)
        for (int end = 0; end < 2; end++) {
            double least = round_end_distance * tree->segments[i].radius_mm;
            FreeEnd *own = &divider->ends[i][end];
            if (is_end(divider->junctions, tree->nodes[i][end]))
                *own = (FreeEnd){fmax(own->near_cylinder_mm, least), fmax(own->cylinder_mm, least)};
        }
}

static uint32_t root_of(const Divider *divider, uint32_t node)
{
    return sets_find(divider->root, node);
}

static bool join_nodes(const Divider *divider, uint32_t a, uint32_t b)
{
    divider->joined[a] = divider->joined[b] = true;
    return sets_join(divider->root, a, b);
}

/* Joins all nodes on the path between two nodes of one tree. Returns true if a region changes. */
static bool join_path(const Divider *divider, uint32_t a, uint32_t b)
{
    const TreeOrder *order = &divider->order;
    bool changed = false;
    while (a != b) {
        uint32_t *later = order->position[a] > order->position[b] ? &a : &b;
        changed |= join_nodes(divider, *later, order->parent[*later]);
        *later = order->parent[*later];
    }
    return changed;
}

/* Returns the length that the planes of a segment need between them, mm. */
static double room_needed(const Divider *divider, uint32_t segment)
{
    double radii = 2 * plane_gap;
    for (int end = 0; end < 2; end++)
        if (!is_flat_end(divider, divider->tree->nodes[segment][end]))
            radii += plane_shift;
    return radii * divider->tree->segments[segment].radius_mm;
}

/* Finds close planes of a segment that is not clear of both its ends anywhere. Each plane is where
 * the surface is even, with room to shift, and is clear of the vessels at the end beyond the other
 * plane. The planes are as far from both ends as possible, with at most max_close_gap between them.
 */
static bool place_close(const Divider *divider, uint32_t segment, double length)
{
    const FreeEnd *ends = divider->ends[segment];
    double radius = divider->tree->segments[segment].radius_mm, low[2], high[2];
    for (int end = 0; end < 2; end++) {
        if (divider->tree->body == BODY_ROUND ||
            is_flat_end(divider, divider->tree->nodes[segment][end]))
            return false;
        low[end] = ends[end].near_cylinder_mm + CLOSE_MOVE * radius;
        high[end] = length - fmax(ends[!end].cylinder_mm, full_term_distance * radius);
        if (low[end] > high[end])
            return false;
    }
    double spare = length - max_close_gap * radius - low[0] - low[1];
    for (int end = 0; end < 2; end++)
        divider->junctions->plane[segment][end] = fmin(high[end], low[end] + fmax(0, 0.5 * spare));
    return low[0] + low[1] + min_close_gap * radius <= length;
}

/* Finds the planes of a segment. Returns false if it has no room for them. */
static bool place_planes(const Divider *divider, uint32_t segment)
{
    const FreeEnd *ends = divider->ends[segment];
    double length = segment_length(&divider->tree->segments[segment]);
    double room = room_needed(divider, segment);
    bool is_clear = ends[0].cylinder_mm + ends[1].cylinder_mm + room <= length;
    divider->junctions->is_close[segment] = !is_clear && place_close(divider, segment, length);
    for (int end = 0; end < 2 && !divider->junctions->is_close[segment]; end++)
        divider->junctions->plane[segment][end] = ends[end].cylinder_mm;
    return is_clear || divider->junctions->is_close[segment];
}

/* Returns true if a segment with both its ends in one region may be a tube all the same, so that it
 * closes a loop. Its two stubs must not overlap. The region's nodes must be connected without it;
 * they are if the segment is not in the spanning forest, along which nodes are joined. */
static bool may_be_loop_tube(const Divider *divider, uint32_t segment)
{
    const FieldSegment *self = &divider->tree->segments[segment];
    const double *plane = divider->junctions->plane[segment];
    return !treeorder_has_segment(&divider->order, divider->tree, segment) &&
           plane[0] + plane[1] + 2 * STUB_TAIL * self->radius_mm <= segment_length(self);
}

/* Joins the nodes of each segment that is not a tube. Returns true if a region changes. */
static bool join_short(Divider *divider)
{
    const VesselTree *tree = divider->tree;
    bool changed = false;
    for (uint32_t i = 0; i < tree->n_segments; i++) {
        uint32_t a = tree->nodes[i][0], b = tree->nodes[i][1];
        divider->junctions->is_tube[i] =
            !divider->is_whole[i] && place_planes(divider, i) &&
            (root_of(divider, a) != root_of(divider, b) || may_be_loop_tube(divider, i));
        if (!divider->junctions->is_tube[i])
            changed |= join_nodes(divider, a, b);
    }
    return changed;
}

static bool ends_share_junction(const Divider *divider, uint32_t node, uint32_t segment)
{
    const uint32_t *nodes = divider->tree->nodes[segment];
    uint32_t root = root_of(divider, node);
    return root == root_of(divider, nodes[0]) || root == root_of(divider, nodes[1]);
}

/* Finds the part of segment `a` that is near `b`: an interval of distances from its first end, mm,
 * widened by one step. */
static void near_part(const FieldSegment *a, const FieldSegment *b, double part[2])
{
    double length = segment_length(a), step = search_step * fmin(a->radius_mm, b->radius_mm);
    double limit = a->radius_mm + b->radius_mm + NEAR_GAP * fmin(a->radius_mm, b->radius_mm);
    int steps = (int)fmin(ceil(length / step), 1000); /* bounds the time of very long segments */
    part[0] = HUGE_VAL;
    part[1] = -HUGE_VAL;
    for (int i = 0; i <= steps; i++) {
        double t = length * i / steps;
        if (segment_distance_to(b, point_from(a, 0, t)) >= limit)
            continue;
        part[0] = fmin(part[0], t - length / steps);
        part[1] = fmax(part[1], t + length / steps);
    }
}

/* Pushes the plane of tube `a` past the part near `b`, at the end that is in a region of `b`. If
 * both ends are, the plane that needs the shorter push is pushed. Returns true if the plane moves.
 */
static bool push_plane(Divider *divider, uint32_t a, uint32_t b)
{
    const VesselTree *tree = divider->tree;
    double part[2], length = segment_length(&tree->segments[a]), needed[2];
    if (!divider->junctions->is_tube[a])
        return false;
    near_part(&tree->segments[a], &tree->segments[b], part);
    if (part[1] < 0)
        return false;
    needed[0] = part[1];
    needed[1] = length - part[0];
    for (int end = 0; end < 2; end++)
        if (!ends_share_junction(divider, tree->nodes[a][end], b))
            needed[end] = HUGE_VAL;
    int end = needed[1] < needed[0];
    FreeEnd *own = &divider->ends[a][end];
    if (!isfinite(needed[end]) || needed[end] <= own->near_cylinder_mm)
        return false;
    *own = (FreeEnd){needed[end], fmax(own->cylinder_mm, needed[end])};
    return true;
}

/* Returns true if two segments blend at an end of one of them. */
static bool blend_somewhere(const Divider *divider, uint32_t a, uint32_t b)
{
    for (int end = 0; end < 2; end++)
        if (indexlists_hold(&divider->junctions->blending, divider->tree->nodes[a][end], b) ||
            indexlists_hold(&divider->junctions->blending, divider->tree->nodes[b][end], a))
            return true;
    return false;
}

static bool share_junction(const Divider *divider, uint32_t a, uint32_t b)
{
    const uint32_t *nodes = divider->tree->nodes[a];
    return ends_share_junction(divider, nodes[0], b) || ends_share_junction(divider, nodes[1], b);
}

/* Returns the node at the end of segment `a` that is nearer to segment `b`. */
static uint32_t nearer_node(const VesselTree *tree, uint32_t a, uint32_t b)
{
    return tree->nodes[a][segment_nearer_end(&tree->segments[a], &tree->segments[b])];
}

/* Joins near vessels that blend but share no region, and pushes the planes of near vessels that
 * share one. Returns true if something changes. */
static bool separate_near_vessels(Divider *divider, const NearPair *pairs, size_t n)
{
    bool changed = false;
    for (size_t i = 0; i < n; i++) {
        uint32_t a = pairs[i].segments[0], b = pairs[i].segments[1];
        if (!share_junction(divider, a, b) && blend_somewhere(divider, a, b))
            changed |= join_path(divider, nearer_node(divider->tree, a, b),
                                 nearer_node(divider->tree, b, a));
        if (share_junction(divider, a, b)) {
            changed |= push_plane(divider, a, b);
            changed |= push_plane(divider, b, a);
        }
    }
    return changed;
}

/* Lists, for each node that represents a region, the region's nodes. */
static Status list_nodes(const Divider *divider, IndexLists *lists, Err *err)
{
    const size_t n = divider->tree->n_nodes;
    for (uint32_t i = 0; i < n; i++)
        divider->root[i] = root_of(divider, i);
    return indexlists_sort(lists, n, (ItemKeys){divider->root, n, 1}, "junctions", err);
}

/* Returns the part of a segment in the region of one of its ends, from a distance `from` on. A stub
 * ends behind its plane. */
static FieldSegment part_in_region(const Divider *divider, uint32_t segment, int end, double from)
{
    FieldSegment part = divider->tree->segments[segment];
    double to = divider->junctions->plane[segment][end] + STUB_TAIL * part.radius_mm;
    if (!divider->junctions->is_tube[segment])
        to = segment_length(&part);
    Vec3 a = point_from(&part, end, from), b = point_from(&part, end, to);
    part.a = a;
    part.b = b;
    return part;
}

/* Returns true if the part of a stub behind its plane keeps clear of the region's vessels that do
 * not blend with it. */
static bool tail_is_clear(const Divider *divider, const IndexLists *nodes, uint32_t segment,
                          int end)
{
    uint32_t node = divider->tree->nodes[segment][end], root = root_of(divider, node);
    FieldSegment tail =
        part_in_region(divider, segment, end, divider->junctions->plane[segment][end]);
    for (uint32_t i = nodes->first[root]; i < nodes->first[root + 1]; i++) {
        const uint32_t *first = &divider->junctions->incident.first[nodes->items[i]];
        for (uint32_t k = first[0]; k < first[1]; k++) {
            uint32_t other = divider->junctions->incident.items[k];
            if (other == segment || indexlists_hold(&divider->junctions->blending, node, other))
                continue;
            int its_end = segment_end_at(divider->tree, other, nodes->items[i]);
            FieldSegment part = part_in_region(divider, other, its_end, 0);
            double gap = segments_gap(&tail, &part);
            if (gap < NEAR_GAP * fmin(tail.radius_mm, part.radius_mm))
                return false;
        }
    }
    return true;
}

/* Marks tubes that are too short for the stubs' parts behind their planes, so that their nodes are
 * joined. */
static Status join_crowded(Divider *divider, bool *changed, Err *err)
{
    const VesselTree *tree = divider->tree;
    IndexLists nodes = {0};
    Status status;
    TRY_GOTO(list_nodes(divider, &nodes, err));
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2 && divider->junctions->is_tube[i]; end++) {
            double tail =
                divider->junctions->plane[i][end] + STUB_TAIL * tree->segments[i].radius_mm;
            if (is_flat_end(divider, tree->nodes[i][end]) ||
                tail <= segment_length(&tree->segments[i]) ||
                tail_is_clear(divider, &nodes, i, end))
                continue;
            divider->is_whole[i] = *changed = true;
        }
done:
    indexlists_release(&nodes);
    return status;
}

/* Joins nodes until nothing changes. */
static Status divide(Divider *divider, const NearPair *pairs, size_t n_pairs, Err *err)
{
    bool changed = true;
    while (changed) {
        changed = join_short(divider);
        changed |= separate_near_vessels(divider, pairs, n_pairs);
        if (!changed)
            TRY(join_crowded(divider, &changed, err));
    }
    return STATUS_OK;
}

/* Numbers the regions by their first nodes. An end that a tube reaches is cut off flat, and has no
 * region. */
static Status number_junctions(const Divider *divider, Err *err)
{
    const VesselTree *tree = divider->tree;
    Junctions *junctions = divider->junctions;
    uint32_t *of_node = junctions->of_node;
    IndexLists *lists = &junctions->nodes;
    for (uint32_t i = 0; i < tree->n_nodes; i++) {
        const uint32_t *first = &junctions->incident.first[i], root = root_of(divider, i);
        bool flat = is_flat_end(divider, i) && !divider->joined[i] &&
                    junctions->is_tube[junctions->incident.items[first[0]]];
        bool used = first[1] > first[0];
        of_node[i] = flat || !used ? NO_JUNCTION
                     : root == i   ? junctions->n_junctions++
                                   : of_node[root];
    }
    TRY(indexlists_begin(lists, junctions->n_junctions, "junctions", err));
    for (size_t i = 0; i < tree->n_nodes; i++)
        if (of_node[i] != NO_JUNCTION)
            indexlists_count(lists, of_node[i]);
    TRY(indexlists_allot(lists, "junctions", err));
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        if (of_node[i] != NO_JUNCTION)
            indexlists_put(lists, of_node[i], i);
    return STATUS_OK;
}

static int compare_gaps(const void *a, const void *b)
{
    const NearPair *one = a, *other = b;
    if (one->gap_mm != other->gap_mm)
        return one->gap_mm < other->gap_mm ? -1 : 1;
    return (one->segments[0] > other->segments[0]) - (one->segments[0] < other->segments[0]);
}

/* Removes the near pairs that share a region, and orders the others by gap. */
static void keep_unconnected(const Divider *divider, size_t n)
{
    Junctions *junctions = divider->junctions;
    NearPair *pairs = junctions->unconnected;
    for (size_t i = 0; i < n; i++) {
        if (share_junction(divider, pairs[i].segments[0], pairs[i].segments[1]))
            continue;
        junctions->n_overlapping += pairs[i].gap_mm < 0;
        pairs[junctions->n_unconnected++] = pairs[i];
    }
    qsort(pairs, junctions->n_unconnected, sizeof *pairs, compare_gaps);
}

static Status reserve(Divider *divider, Err *err)
{
    const size_t n = divider->tree->n_segments, n_nodes = divider->tree->n_nodes;
    Junctions *junctions = divider->junctions;
    TRY(mem_calloc(&junctions->plane, n, sizeof *junctions->plane, "segments", err));
    TRY(mem_calloc(&junctions->is_tube, n, sizeof *junctions->is_tube, "segments", err));
    TRY(mem_calloc(&junctions->is_close, n, sizeof *junctions->is_close, "segments", err));
    TRY(mem_calloc(&junctions->of_node, n_nodes, sizeof *junctions->of_node, "nodes", err));
    TRY(mem_calloc(&divider->ends, n, sizeof *divider->ends, "segments", err));
    TRY(mem_calloc(&divider->is_whole, n, sizeof *divider->is_whole, "segments", err));
    TRY(mem_calloc(&divider->root, n_nodes, sizeof *divider->root, "nodes", err));
    TRY(mem_calloc(&divider->joined, n_nodes, sizeof *divider->joined, "nodes", err));
    sets_begin(divider->root, n_nodes);
    return STATUS_OK;
}

Status junctions_find(const VesselTree *tree, const MeshParams *params, Junctions *out, Err *err)
{
    Junctions found = {.max_shift = freeends_max_shift(params)};
    Divider divider = {.tree = tree, .junctions = &found};
    size_t n_pairs = 0;
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &found.incident, err));
    TRY_GOTO(vesseltree_blending(tree, &found.incident, &found.blending, err));
    TRY_GOTO(precision_check(tree, params->max_coordinate_mm, err));
    TRY_GOTO(reserve(&divider, err));
    TRY_GOTO(treeorder_make(tree, &found.incident, &divider.order, err));
    TRY_GOTO(freeends_find(
        &(const FreeEndInput){tree, &found.incident, &found.blending, &divider.order, params},
        divider.ends, err));
    keep_off_ends(&divider);
    TRY_GOTO(nearpairs_find(tree, params->threads, &found.unconnected, &n_pairs, err));
    TRY_GOTO(divide(&divider, found.unconnected, n_pairs, err));
    TRY_GOTO(number_junctions(&divider, err));
    keep_unconnected(&divider, n_pairs);
    *out = found;
    found = (Junctions){0};
done:
    free(divider.ends);
    free(divider.is_whole);
    free(divider.root);
    free(divider.joined);
    treeorder_release(&divider.order);
    junctions_release(&found);
    return status;
}
