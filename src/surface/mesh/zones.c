/* From each end a segment is free where, on the circle of its wall, all that blends with it there
 * adds at most `disturbance` to its own potential. Free from both ends, with room for the planes to
 * move, it is a tube; else its two nodes lie in one zone.
 *
 * Inside a zone two vessels without a common node may pass each other closely, where the tube of
 * one, made of long triangles, could cut the other: so the planes of both are pushed past the near
 * part. That can make a tube too short, which joins zones, which can make more pairs lie in one
 * zone; it is repeated until nothing changes. A plane is pushed to one of few places only, so that
 * this ends. */
#include "surface/mesh/zones.h"

#include "surface/mesh/nearpairs.h"
#include <stdlib.h>

static const double disturbance = 5e-3 * FIELD_LEVEL;
/* Of the radius: the step of the search, what planes at either end need to move in. */
static const double search_step = 0.15, plane_room = 0.375;
enum { CIRCLE_POINTS = 12 };
/* Beyond so many of its radii from its axis a vessel adds less than a tenth of `disturbance`:
 * e^(-2 x^2) = 5e-4 e^-2. */
static const double field_reach = 2.2;

typedef struct Divider {
    const VesselTree *tree;
    const NumberLists *incident, *blending;
    uint32_t *root; /* union-find over nodes */
    bool *joined;   /* whether a node is in a zone with others */
    double (*plane)[2];
    bool *is_tube;
} Divider;

void zones_release(Zones *zones)
{
    free(zones->zone);
    numberlists_release(&zones->nodes);
    free(zones->plane);
    free(zones->is_tube);
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

static bool is_disturbed_at(const ZoneTerm *others, size_t n, Vec3 x)
{
    double sum = 0;
    for (size_t i = 0; i < n && sum <= disturbance; i++)
        sum += zoneterm_value(&others[i], x);
    return sum > disturbance;
}

/* The point of the other vessel's axis that is nearest to x. */
static Vec3 nearest_of(const ZoneTerm *other, Vec3 x)
{
    double along = vec3_dot(vec3_sub(x, other->a), other->axis);
    return vec3_add_scaled(other->a, other->axis, fmin(fmax(along, 0), other->length_k / other->k));
}

/* Tries points all round the circle, and those that face each other vessel, which may be thinner
 * than the points are apart. */
static bool is_disturbed(const ZoneTerm *others, size_t n, Vec3 center, Vec3 axis, double radius)
{
    Vec3 u, v;
    vec3_across(axis, &u, &v);
    for (size_t i = 0; i < CIRCLE_POINTS + n; i++) {
        double angle = 6.283185307179586 * (double)i / CIRCLE_POINTS;
        if (i >= CIRCLE_POINTS) {
            Vec3 towards = vec3_sub(nearest_of(&others[i - CIRCLE_POINTS], center), center);
            angle = atan2(vec3_dot(towards, v), vec3_dot(towards, u));
        }
        Vec3 x = vec3_add_scaled(center, u, radius * cos(angle));
        if (is_disturbed_at(others, n, vec3_add_scaled(x, v, radius * sin(angle))))
            return true;
    }
    return false;
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

static double distance_at(const FieldSegment *self, int end, double mm, const FieldSegment *other)
{
    return segment_distance_to(other, point_from(self, end, mm));
}

/* How far from the end of a segment the place is that is nearest to another. The distance is convex
 * along a line. */
static double nearest_place(const FieldSegment *self, int end, double length,
                            const FieldSegment *other)
{
    double low = 0, high = length;
    for (int i = 0; i < 40; i++) {
        double one = low + (high - low) / 3, two = high - (high - low) / 3;
        if (distance_at(self, end, one, other) < distance_at(self, end, two, other))
            high = two;
        else
            low = one;
    }
    return low;
}

/* How far from the end of a segment another may disturb its wall: the last place whose distance
 * from the other's axis is within reach. */
static double last_near(const FieldSegment *self, int end, double length, const FieldSegment *other)
{
    double reach = self->radius_mm + field_reach * other->radius_mm, low = 0, high = length;
    if (distance_at(self, end, 0, other) > reach)
        low = nearest_place(self, end, length, other);
    if (distance_at(self, end, low, other) > reach)
        return 0;
    if (distance_at(self, end, length, other) <= reach)
        return length;
    while (high - low > 1e-3 * self->radius_mm) {
        double middle = 0.5 * (low + high);
        *(distance_at(self, end, middle, other) <= reach ? &low : &high) = middle;
    }
    return high;
}

/* A vessel that blends at the end of another, and how far from there it may disturb that one. */
typedef struct Neighbor {
    double last_mm;
    uint32_t segment;
} Neighbor;

static int compare_reach(const void *a, const void *b)
{
    const Neighbor *one = a, *other = b;
    if (one->last_mm != other->last_mm)
        return one->last_mm > other->last_mm ? -1 : 1;
    return (one->segment > other->segment) - (one->segment < other->segment);
}

/* The vessels that may disturb the segment near its end, those that reach farthest from there
 * first. */
static size_t find_neighbors(const Divider *divider, uint32_t segment, int end, Neighbor *neighbors)
{
    const VesselTree *tree = divider->tree;
    const FieldSegment *self = &tree->segments[segment];
    const uint32_t *first = &divider->blending->first[tree->nodes[segment][end]];
    double length = length_of(self);
    size_t n = 0;
    for (uint32_t i = first[0]; i < first[1]; i++) {
        uint32_t other = divider->blending->items[i];
        double last = other == segment ? 0 : last_near(self, end, length, &tree->segments[other]);
        if (last > 0)
            neighbors[n++] = (Neighbor){last, other};
    }
    qsort(neighbors, n, sizeof *neighbors, compare_reach);
    return n;
}

/* How far from its end the segment is free: beyond the last place that is disturbed, as a thin
 * vessel that leaves a thick one at a small angle comes out of its wall far from the node. */
static double last_disturbed(const VesselTree *tree, uint32_t segment, int end,
                             const Neighbor *neighbors, size_t n, ZoneTerm *others)
{
    const FieldSegment *self = &tree->segments[segment];
    Vec3 axis = vec3_normalized(vec3_sub(self->b, self->a));
    double step = search_step * self->radius_mm;
    size_t near = 0;
    for (double steps = n ? ceil(neighbors[0].last_mm / step) : 0; steps > 0; steps--) {
        double at = (steps - 1) * step;
        for (; near < n && neighbors[near].last_mm >= at; near++) {
            uint32_t number = neighbors[near].segment;
            const FieldSegment *other = &tree->segments[number];
            others[near] = zoneterm_of(other->a, other->b, other->radius_mm, number, tree->body);
        }
        if (is_disturbed(others, near, point_from(self, end, at), axis, self->radius_mm))
            return steps * step;
    }
    return 0;
}

static Status find_free(const Divider *divider, uint32_t segment, int end, double *free_mm,
                        Err *err)
{
    const VesselTree *tree = divider->tree;
    uint32_t node = tree->nodes[segment][end];
    const uint32_t *first = &divider->blending->first[node];
    Neighbor *neighbors = NULL;
    ZoneTerm *others = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&neighbors, first[1] - first[0], sizeof *neighbors, "terms", err));
    TRY_GOTO(mem_calloc(&others, first[1] - first[0], sizeof *others, "terms", err));
    size_t n = find_neighbors(divider, segment, end, neighbors);
    *free_mm = last_disturbed(tree, segment, end, neighbors, n, others);
    if (tree->body == BODY_ROUND && is_end(divider->incident, node))
        *free_mm = fmax(*free_mm, plane_room * tree->segments[segment].radius_mm);
done:
    free(neighbors);
    free(others);
    return status;
}

typedef struct FreeSearch {
    const Divider *divider;
    Status *statuses; /* one a segment */
} FreeSearch;

static void find_both_free(size_t index, int worker, void *context)
{
    (void)worker;
    const FreeSearch *search = context;
    for (int end = 0; end < 2 && search->statuses[index] == STATUS_OK; end++)
        search->statuses[index] = find_free(search->divider, (uint32_t)index, end,
                                            &search->divider->plane[index][end], NULL);
}

static Status find_all_free(const Divider *divider, int threads, Err *err)
{
    size_t n = divider->tree->n_segments;
    FreeSearch search = {.divider = divider};
    TRY(mem_calloc(&search.statuses, n, sizeof *search.statuses, "segments", err));
    threads_for(n, threads, find_both_free, &search);
    Status status = STATUS_OK;
    for (size_t i = 0; i < n && status == STATUS_OK; i++)
        if (search.statuses[i] != STATUS_OK)
            status = mem_out_of("for", "the terms of a junction", err);
    free(search.statuses);
    return status;
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

static double room_needed(const Divider *divider, uint32_t segment)
{
    double radii = 0.1;
    for (int end = 0; end < 2; end++)
        if (!is_flat_end(divider, divider->tree->nodes[segment][end]))
            radii += plane_room;
    return radii * divider->tree->segments[segment].radius_mm;
}

/* Joins the nodes of segments that are no tubes. */
static bool join_short(Divider *divider)
{
    const VesselTree *tree = divider->tree;
    bool changed = false;
    for (uint32_t i = 0; i < tree->n_segments; i++) {
        uint32_t a = tree->nodes[i][0], b = tree->nodes[i][1];
        double length = length_of(&tree->segments[i]);
        double taken = divider->plane[i][0] + divider->plane[i][1] + room_needed(divider, i);
        divider->is_tube[i] = taken <= length && root_of(divider, a) != root_of(divider, b);
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
    if (!isfinite(needed[end]) || needed[end] <= divider->plane[a][end])
        return false;
    divider->plane[a][end] = needed[end];
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
            changed |= join_nodes(divider, nearer_node(divider->tree, a, b),
                                  nearer_node(divider->tree, b, a));
        if (share_zone(divider, a, b)) {
            changed |= push_plane(divider, a, b);
            changed |= push_plane(divider, b, a);
        }
    }
    return changed;
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
                  int threads, Zones *out, Err *err)
{
    Zones zones = {0};
    NearPair *pairs = NULL;
    size_t n_pairs = 0;
    Divider divider = {.tree = tree, .incident = incident, .blending = blending};
    Status status;
    TRY_GOTO(mem_calloc(&zones.plane, tree->n_segments, sizeof *zones.plane, "segments", err));
    TRY_GOTO(mem_calloc(&zones.is_tube, tree->n_segments, sizeof *zones.is_tube, "segments", err));
    TRY_GOTO(mem_calloc(&divider.root, tree->n_nodes, sizeof *divider.root, "nodes", err));
    TRY_GOTO(mem_calloc(&divider.joined, tree->n_nodes, sizeof *divider.joined, "nodes", err));
    for (uint32_t i = 0; i < tree->n_nodes; i++)
        divider.root[i] = i;
    divider.plane = zones.plane;
    divider.is_tube = zones.is_tube;
    TRY_GOTO(find_all_free(&divider, threads, err));
    TRY_GOTO(nearpairs_find(tree, threads, &pairs, &n_pairs, err));
    bool changed = true;
    while (changed) {
        changed = join_short(&divider);
        changed |= part_near(&divider, pairs, n_pairs);
    }
    TRY_GOTO(number_zones(&divider, &zones, err));
    keep_strangers(&divider, pairs, n_pairs, &zones);
    pairs = NULL;
    *out = zones;
    zones = (Zones){0};
done:
    free(divider.root);
    free(divider.joined);
    free(pairs);
    zones_release(&zones);
    return status;
}
