/* A segment that is clear of both its ends somewhere [freeends.h], with room for the planes to
 * move, is a tube. So is one that is not, as many are along a trunk: it is cut by two planes close
 * together, each clear of the end beyond the other and where the wall is nearly round; that rim is
 * no circle then. Where that cannot be, the two nodes of the segment lie in one zone.
 *
 * Inside a zone two vessels without a common node may pass each other closely, where the tube of
 * one, made of long triangles, could cut the other: so the planes of both are pushed past the near
 * part. That can make a tube too short, which joins zones, which can make more pairs lie in one
 * zone; it is repeated until nothing changes. A plane is pushed to one of few places only, so that
 * this ends. */
#include "mesh/zones/junctions.h"

#include "mesh/precision.h"
#include "mesh/zones/freeends.h"
#include "mesh/zones/nearpairs.h"
#include <stdlib.h>

/* Of the radius: what a plane needs to move in, and what is left between two then; the step in
 * which parts near others are searched for. */
static const double plane_room = PLANE_MOVE, plane_gap = 0.05, search_step = 0.15;
/* Of the radius: where a segment's own term is within a hundredth of what it is far from its end.
 */
static const double term_room = 1.17;
/* Of the radius: what is left between planes that are close, at least and at most. */
static const double close_least = 0.2, close_most = 0.35;
/* Of the radius: how far planes stay off the ends of a round body. */
static const double round_room = 0.375;

typedef struct Divider {
    const VesselTree *tree;
    const NumberLists *incident, *blending;
    uint32_t *root; /* union-find over nodes */
    bool *joined;   /* whether a node is in a zone with others */
    FreeEnd (*ends)[2];
    TreeOrder order;
    double (*plane)[2];
    bool *is_tube, *is_close;
    bool *is_whole; /* one a segment: it must not be a tube */
} Divider;

void zones_release(Zones *zones)
{
    free(zones->zone);
    numberlists_release(&zones->nodes);
    free(zones->plane);
    free(zones->is_tube);
    free(zones->is_close);
    free(zones->strangers);
    *zones = (Zones){0};
}

static double length_of(const FieldSegment *segment)
{
    return vec3_distance(segment->a, segment->b);
}

/* The point of the segment so far from its end. */
static Vec3 point_from(const FieldSegment *segment, int end, double mm)
{
    Vec3 from = end ? segment->b : segment->a, to = end ? segment->a : segment->b;
    return vec3_add_scaled(from, vec3_normalized(vec3_sub(to, from)), mm);
}

static bool is_end(const NumberLists *incident, uint32_t node)
{
    return incident->first[node + 1] - incident->first[node] == 1;
}

/* Ends of a round body are zones: the plane stays off the ball. */
static bool is_flat_end(const Divider *divider, uint32_t node)
{
    return divider->tree->body != BODY_ROUND && is_end(divider->incident, node);
}

/* The planes of a round body stay off the balls at its ends. */
static void keep_off_ends(const Divider *divider)
{
    const VesselTree *tree = divider->tree;
    for (uint32_t i = 0; i < tree->n_segments && tree->body == BODY_ROUND; i++)
        for (int end = 0; end < 2; end++) {
            double least = round_room * tree->segments[i].radius_mm;
            FreeEnd *own = &divider->ends[i][end];
            if (is_end(divider->incident, tree->nodes[i][end]))
                *own = (FreeEnd){fmax(own->even_mm, least), fmax(own->clear_mm, least)};
        }
}

static uint32_t root_of(const Divider *divider, uint32_t node)
{
    uint32_t *root = divider->root;
    while (root[node] != node)
        node = root[node] = root[root[node]];
    return node;
}

/* The lower node stands for both. */
static bool join_nodes(const Divider *divider, uint32_t a, uint32_t b)
{
    divider->joined[a] = divider->joined[b] = true;
    a = root_of(divider, a);
    b = root_of(divider, b);
    divider->root[a > b ? a : b] = a < b ? a : b;
    return a != b;
}

/* Joins all nodes on the way between two. */
static bool join_way(const Divider *divider, uint32_t a, uint32_t b)
{
    const TreeOrder *order = &divider->order;
    bool changed = false;
    while (a != b) {
        uint32_t *later = order->place[a] > order->place[b] ? &a : &b;
        changed |= join_nodes(divider, *later, order->up[*later]);
        *later = order->up[*later];
    }
    return changed;
}

/* What the planes of a segment need between them. */
static double room_needed(const Divider *divider, uint32_t segment)
{
    double radii = 2 * plane_gap;
    for (int end = 0; end < 2; end++)
        if (!is_flat_end(divider, divider->tree->nodes[segment][end]))
            radii += plane_room;
    return radii * divider->tree->segments[segment].radius_mm;
}

/* Finds the planes of a segment that is not clear of both its ends anywhere. Each is where the wall
 * is even, with room to move, and clear of the end beyond the other; they are as far from both ends
 * as they may be, but for what is left between them. */
static bool place_close(const Divider *divider, uint32_t segment, double length)
{
    const FreeEnd *ends = divider->ends[segment];
    double radius = divider->tree->segments[segment].radius_mm, low[2], high[2];
    for (int end = 0; end < 2; end++) {
        if (divider->tree->body == BODY_ROUND ||
            is_flat_end(divider, divider->tree->nodes[segment][end]))
            return false;
        low[end] = ends[end].even_mm + CLOSE_MOVE * radius;
        high[end] = length - fmax(ends[!end].clear_mm, term_room * radius);
        if (low[end] > high[end])
            return false;
    }
    double spare = length - close_most * radius - low[0] - low[1];
    for (int end = 0; end < 2; end++)
        divider->plane[segment][end] = fmin(high[end], low[end] + fmax(0, 0.5 * spare));
    return low[0] + low[1] + close_least * radius <= length;
}

/* Finds the planes of a segment. False when it has no room for them. */
static bool place_planes(const Divider *divider, uint32_t segment)
{
    const FreeEnd *ends = divider->ends[segment];
    double length = length_of(&divider->tree->segments[segment]);
    double room = room_needed(divider, segment);
    bool is_clear = ends[0].clear_mm + ends[1].clear_mm + room <= length;
    divider->is_close[segment] = !is_clear && place_close(divider, segment, length);
    for (int end = 0; end < 2 && !divider->is_close[segment]; end++)
        divider->plane[segment][end] = ends[end].clear_mm;
    return is_clear || divider->is_close[segment];
}

/* Joins the nodes of segments that are no tubes. */
static bool join_short(Divider *divider)
{
    const VesselTree *tree = divider->tree;
    bool changed = false;
    for (uint32_t i = 0; i < tree->n_segments; i++) {
        uint32_t a = tree->nodes[i][0], b = tree->nodes[i][1];
        divider->is_tube[i] = !divider->is_whole[i] && place_planes(divider, i) &&
                              root_of(divider, a) != root_of(divider, b);
        if (!divider->is_tube[i])
            changed |= join_nodes(divider, a, b);
    }
    return changed;
}

static bool ends_share_zone(const Divider *divider, uint32_t node, uint32_t segment)
{
    const uint32_t *nodes = divider->tree->nodes[segment];
    uint32_t root = root_of(divider, node);
    return root == root_of(divider, nodes[0]) || root == root_of(divider, nodes[1]);
}

/* The part of segment `a` that lies near `b`, from its first end on, mm, widened by a step. */
static void near_part(const FieldSegment *a, const FieldSegment *b, double part[2])
{
    double length = length_of(a), step = search_step * fmin(a->radius_mm, b->radius_mm);
    double limit = a->radius_mm + b->radius_mm + NEAR_GAP * fmin(a->radius_mm, b->radius_mm);
    int steps = (int)fmin(ceil(length / step), 1000);
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

/* Pushes the plane of tube `a` past the part near `b`, at the end that lies in a zone of `b`; at
 * the nearer one if both do. */
static bool push_plane(Divider *divider, uint32_t a, uint32_t b)
{
    const VesselTree *tree = divider->tree;
    double part[2], length = length_of(&tree->segments[a]), needed[2];
    if (!divider->is_tube[a])
        return false;
    near_part(&tree->segments[a], &tree->segments[b], part);
    if (part[1] < 0)
        return false;
    needed[0] = part[1];
    needed[1] = length - part[0];
    for (int end = 0; end < 2; end++)
        if (!ends_share_zone(divider, tree->nodes[a][end], b))
            needed[end] = HUGE_VAL;
    int end = needed[1] < needed[0];
    FreeEnd *own = &divider->ends[a][end];
    if (!isfinite(needed[end]) || needed[end] <= own->even_mm)
        return false;
    *own = (FreeEnd){needed[end], fmax(own->clear_mm, needed[end])};
    return true;
}

/* Whether two segments blend at an end of one of them. */
static bool blend_somewhere(const Divider *divider, uint32_t a, uint32_t b)
{
    for (int end = 0; end < 2; end++)
        if (numberlists_hold(divider->blending, divider->tree->nodes[a][end], b) ||
            numberlists_hold(divider->blending, divider->tree->nodes[b][end], a))
            return true;
    return false;
}

static bool share_zone(const Divider *divider, uint32_t a, uint32_t b)
{
    const uint32_t *nodes = divider->tree->nodes[a];
    return ends_share_zone(divider, nodes[0], b) || ends_share_zone(divider, nodes[1], b);
}

/* The end of segment a that is nearer to segment b. */
static uint32_t nearer_node(const VesselTree *tree, uint32_t a, uint32_t b)
{
    Vec3 middle = vec3_scale(vec3_add(tree->segments[b].a, tree->segments[b].b), 0.5);
    int end =
        vec3_distance(tree->segments[a].b, middle) < vec3_distance(tree->segments[a].a, middle);
    return tree->nodes[a][end];
}

static bool part_near(Divider *divider, const NearPair *pairs, size_t n)
{
    bool changed = false;
    for (size_t i = 0; i < n; i++) {
        uint32_t a = pairs[i].segments[0], b = pairs[i].segments[1];
        if (!share_zone(divider, a, b) && blend_somewhere(divider, a, b))
            changed |= join_way(divider, nearer_node(divider->tree, a, b),
                                nearer_node(divider->tree, b, a));
        if (share_zone(divider, a, b)) {
            changed |= push_plane(divider, a, b);
            changed |= push_plane(divider, b, a);
        }
    }
    return changed;
}

/* Lists the nodes of each zone under its root. */
static Status list_nodes(const Divider *divider, NumberLists *lists, Err *err)
{
    size_t n = divider->tree->n_nodes;
    TRY(mem_calloc(&lists->first, n + 2, sizeof *lists->first, "zones", err));
    TRY(mem_calloc(&lists->items, n, sizeof *lists->items, "zones", err));
    for (uint32_t i = 0; i < n; i++)
        lists->first[root_of(divider, i) + 2]++;
    for (size_t i = 2; i < n + 2; i++)
        lists->first[i] += lists->first[i - 1];
    for (uint32_t i = 0; i < n; i++)
        lists->items[lists->first[root_of(divider, i) + 1]++] = i;
    return STATUS_OK;
}

/* A segment as it is in the zone that it has an end in: as an arm it ends behind its plane. */
static FieldSegment part_in_zone(const Divider *divider, uint32_t segment, int end, double from)
{
    FieldSegment part = divider->tree->segments[segment];
    double to = divider->plane[segment][end] + ARM_TAIL * part.radius_mm;
    if (!divider->is_tube[segment])
        to = length_of(&part);
    Vec3 a = point_from(&part, end, from), b = point_from(&part, end, to);
    part.a = a;
    part.b = b;
    return part;
}

/* Whether what lies behind the plane of an arm keeps off the vessels of the zone that do not blend
 * with it. */
static bool is_off(const Divider *divider, const NumberLists *nodes, uint32_t segment, int end)
{
    uint32_t node = divider->tree->nodes[segment][end], root = root_of(divider, node);
    FieldSegment tail = part_in_zone(divider, segment, end, divider->plane[segment][end]);
    for (uint32_t i = nodes->first[root]; i < nodes->first[root + 1]; i++) {
        const uint32_t *first = &divider->incident->first[nodes->items[i]];
        for (uint32_t k = first[0]; k < first[1]; k++) {
            uint32_t other = divider->incident->items[k];
            if (other == segment || numberlists_hold(divider->blending, node, other))
                continue;
            int its_end = segment_end_at(divider->tree, other, nodes->items[i]);
            FieldSegment part = part_in_zone(divider, other, its_end, 0);
            double gap = segments_distance(&tail, &part) - tail.radius_mm - part.radius_mm;
            if (gap < NEAR_GAP * fmin(tail.radius_mm, part.radius_mm))
                return false;
        }
    }
    return true;
}

/* Has the nodes of tubes joined that are too short for what lies behind their planes. */
static Status join_crowded(Divider *divider, bool *changed, Err *err)
{
    const VesselTree *tree = divider->tree;
    NumberLists nodes = {0};
    Status status;
    TRY_GOTO(list_nodes(divider, &nodes, err));
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2 && divider->is_tube[i]; end++) {
            double tail = divider->plane[i][end] + ARM_TAIL * tree->segments[i].radius_mm;
            if (is_flat_end(divider, tree->nodes[i][end]) ||
                tail <= length_of(&tree->segments[i]) || is_off(divider, &nodes, i, end))
                continue;
            divider->is_whole[i] = *changed = true;
        }
done:
    numberlists_release(&nodes);
    return status;
}

/* Joins nodes until nothing changes. */
static Status divide(Divider *divider, const NearPair *pairs, size_t n_pairs, Err *err)
{
    bool changed = true;
    while (changed) {
        changed = join_short(divider);
        changed |= part_near(divider, pairs, n_pairs);
        if (!changed)
            TRY(join_crowded(divider, &changed, err));
    }
    return STATUS_OK;
}

/* Gives the zones numbers by their first nodes. An end that a tube reaches is cut off flat. */
static Status number_zones(const Divider *divider, Zones *zones, Err *err)
{
    const VesselTree *tree = divider->tree;
    NumberLists *lists = &zones->nodes;
    TRY(mem_calloc(&zones->zone, tree->n_nodes, sizeof *zones->zone, "nodes", err));
    for (uint32_t i = 0; i < tree->n_nodes; i++) {
        uint32_t first = divider->incident->first[i], root = root_of(divider, i);
        bool flat = is_flat_end(divider, i) && divider->is_tube[divider->incident->items[first]] &&
                    !divider->joined[i];
        bool used = divider->incident->first[i + 1] > first;
        zones->zone[i] = flat || !used ? NO_ZONE : root == i ? zones->n_zones++ : zones->zone[root];
    }
    TRY(mem_calloc(&lists->first, zones->n_zones + 2, sizeof *lists->first, "zones", err));
    TRY(mem_calloc(&lists->items, tree->n_nodes, sizeof *lists->items, "zones", err));
    for (size_t i = 0; i < tree->n_nodes; i++)
        if (zones->zone[i] != NO_ZONE)
            lists->first[zones->zone[i] + 2]++;
    for (size_t z = 2; z <= zones->n_zones; z++)
        lists->first[z] += lists->first[z - 1];
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        if (zones->zone[i] != NO_ZONE)
            lists->items[lists->first[zones->zone[i] + 1]++] = i;
    return STATUS_OK;
}

static int compare_gaps(const void *a, const void *b)
{
    const NearPair *one = a, *other = b;
    if (one->gap_mm != other->gap_mm)
        return one->gap_mm < other->gap_mm ? -1 : 1;
    return (one->segments[0] > other->segments[0]) - (one->segments[0] < other->segments[0]);
}

static void keep_strangers(const Divider *divider, NearPair *pairs, size_t n, Zones *zones)
{
    zones->strangers = pairs;
    for (size_t i = 0; i < n; i++) {
        if (share_zone(divider, pairs[i].segments[0], pairs[i].segments[1]))
            continue;
        zones->n_overlapping += pairs[i].gap_mm < 0;
        zones->strangers[zones->n_strangers++] = pairs[i];
    }
    qsort(pairs, zones->n_strangers, sizeof *pairs, compare_gaps);
}

Status zones_find(const VesselTree *tree, const NumberLists *incident, const NumberLists *blending,
                  const MeshParams *params, Zones *out, Err *err)
{
    Zones zones = {.moved = freeends_moved(params)};
    NearPair *pairs = NULL;
    size_t n_pairs = 0;
    Divider divider = {.tree = tree, .incident = incident, .blending = blending};
    Status status;
    TRY_GOTO(reach_check(tree, params->reach_mm, err));
    TRY_GOTO(mem_calloc(&zones.plane, tree->n_segments, sizeof *zones.plane, "segments", err));
    TRY_GOTO(mem_calloc(&zones.is_tube, tree->n_segments, sizeof *zones.is_tube, "segments", err));
    TRY_GOTO(
        mem_calloc(&zones.is_close, tree->n_segments, sizeof *zones.is_close, "segments", err));
    TRY_GOTO(mem_calloc(&divider.ends, tree->n_segments, sizeof *divider.ends, "segments", err));
    TRY_GOTO(
        mem_calloc(&divider.is_whole, tree->n_segments, sizeof *divider.is_whole, "segments", err));
    TRY_GOTO(mem_calloc(&divider.root, tree->n_nodes, sizeof *divider.root, "nodes", err));
    TRY_GOTO(mem_calloc(&divider.joined, tree->n_nodes, sizeof *divider.joined, "nodes", err));
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        divider.root[i] = i;
    divider.plane = zones.plane;
    divider.is_tube = zones.is_tube;
    divider.is_close = zones.is_close;
    TRY_GOTO(treeorder_make(tree, incident, &divider.order, err));
    TRY_GOTO(freeends_find(tree, incident, blending, &divider.order, params, divider.ends, err));
    keep_off_ends(&divider);
    TRY_GOTO(nearpairs_find(tree, params->threads, &pairs, &n_pairs, err));
    TRY_GOTO(divide(&divider, pairs, n_pairs, err));
    TRY_GOTO(number_zones(&divider, &zones, err));
    keep_strangers(&divider, pairs, n_pairs, &zones);
    pairs = NULL;
    *out = zones;
    zones = (Zones){0};
done:
    free(divider.ends);
    free(divider.is_whole);
    free(divider.root);
    free(divider.joined);
    treeorder_release(&divider.order);
    free(pairs);
    zones_release(&zones);
    return status;
}
