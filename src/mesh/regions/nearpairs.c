/* Finds pairs of unconnected segments whose surfaces are near each other.
 *
 * Each thread lists the pairs that it finds, so that threads need no lock. The lists are then
 * joined and sorted, so that the order does not depend on the threads.
 *
 * The distance of two segments is the smallest distance of one of their four ends from the other
 * segment, unless the common perpendicular of their lines meets both segments. */
#include "mesh/regions/nearpairs.h"

#include <stdlib.h>

/* The limit of threads_run on the number of threads. */
enum { MAX_WORKERS = 256 };

typedef struct NearSearch {
    const VesselTree *tree;
    ARRAY(NearPair) lists[MAX_WORKERS]; /* per thread */
    FirstFail fail;
} NearSearch;

double segment_distance_to(const FieldSegment *segment, Vec3 x)
{
    return sqrt(vec3_distance2_along(vec3_sub(x, segment->a), vec3_sub(segment->b, segment->a)));
}

double segments_distance(const FieldSegment *a, const FieldSegment *b)
{
    double least = fmin(fmin(segment_distance_to(b, a->a), segment_distance_to(b, a->b)),
                        fmin(segment_distance_to(a, b->a), segment_distance_to(a, b->b)));
    Vec3 d = vec3_sub(a->b, a->a), e = vec3_sub(b->b, b->a), between = vec3_sub(b->a, a->a);
    double dd = vec3_dot(d, d), ee = vec3_dot(e, e), de = vec3_dot(d, e);
    double det = dd * ee - de * de;
    if (det <=
        1e-12 * dd * ee) /* parallel: sin^2 of the angle is below rounding, and an end is nearest */
        return least;
    double s = (vec3_dot(between, d) * ee - vec3_dot(between, e) * de) / det;
    double t = (vec3_dot(between, d) * de - vec3_dot(between, e) * dd) / det;
    if (s < 0 || s > 1 || t < 0 || t > 1)
        return least;
    Vec3 apart = vec3_sub(vec3_add_scaled(between, e, t), vec3_scale(d, s));
    return fmin(least, vec3_length(apart));
}

double segments_gap(const FieldSegment *a, const FieldSegment *b)
{
    return segments_distance(a, b) - a->radius_mm - b->radius_mm;
}

Box segment_box(const FieldSegment *segment, double radius_mm)
{
    return box_with_ball(box_with_ball(box_empty(), segment->a, radius_mm), segment->b, radius_mm);
}

FloatBox segment_floatbox(const FieldSegment *segment, double radius_mm)
{
    Box box = segment_box(segment, radius_mm);
    FloatBox wide;
    for (int axis = 0; axis < 3; axis++) {
        wide.low[axis] = nextafterf((float)vec3_component(box.low, axis), -INFINITY);
        wide.high[axis] = nextafterf((float)vec3_component(box.high, axis), INFINITY);
    }
    return wide;
}

/* Returns a box so large that the boxes of two segments meet if the gap is below NEAR_GAP times the
 * smaller radius. */
static FloatBox near_box(uint32_t item, const void *context)
{
    const FieldSegment *segment = &((const NearSearch *)context)->tree->segments[item];
    return segment_floatbox(segment, (1 + NEAR_GAP / 2) * segment->radius_mm);
}

static bool share_node(const VesselTree *tree, uint32_t a, uint32_t b)
{
    const uint32_t *one = tree->nodes[a], *other = tree->nodes[b];
    return one[0] == other[0] || one[0] == other[1] || one[1] == other[0] || one[1] == other[1];
}

/* Lists a pair of segments if they share no node and are near. Called for each pair whose boxes
 * meet. */
static void note_pair(uint32_t a, uint32_t b, int worker, void *context)
{
    NearSearch *search = context;
    const FieldSegment *one = &search->tree->segments[a], *other = &search->tree->segments[b];
    Err err;
    if (share_node(search->tree, a, b))
        return;
    double gap = segments_gap(one, other);
    if (gap < NEAR_GAP * fmin(one->radius_mm, other->radius_mm))
        firstfail_note(
            &search->fail, 0,
            ARRAY_PUSH(&search->lists[worker], "near vessels", &err, (NearPair){{a, b}, gap}),
            &err);
}

static int compare_pairs(const void *a, const void *b)
{
    const uint32_t *one = ((const NearPair *)a)->segments, *other = ((const NearPair *)b)->segments;
    int axis = one[0] == other[0];
    return (one[axis] > other[axis]) - (one[axis] < other[axis]);
}

/* Joins the lists of all threads, in order. */
static Status gather(const NearSearch *search, NearPair **pairs, size_t *n, Err *err)
{
    size_t total = 0;
    for (int i = 0; i < MAX_WORKERS; i++)
        total += search->lists[i].n;
    NearPair *all;
    TRY(mem_calloc(&all, total, sizeof *all, "near vessels", err));
    *n = 0;
    for (int i = 0; i < MAX_WORKERS; i++)
        for (size_t j = 0; j < search->lists[i].n; j++)
            all[(*n)++] = search->lists[i].items[j];
    qsort(all, total, sizeof *all, compare_pairs);
    *pairs = all;
    return STATUS_OK;
}

Status nearpairs_find(const VesselTree *tree, int threads, NearPair **pairs, size_t *n, Err *err)
{
    NearSearch *search;
    Status status;
    TRY(mem_calloc(&search, 1, sizeof *search, "near vessels", err));
    search->tree = tree;
    const BoxPairs boxes = {(uint32_t)tree->n_segments, near_box, note_pair, search, threads};
    TRY_GOTO(boxpairs_find(&boxes, err));
    TRY_GOTO(firstfail_status(&search->fail, err));
    TRY_GOTO(gather(search, pairs, n, err));
done:
    for (int i = 0; i < MAX_WORKERS; i++)
        ARRAY_RELEASE(&search->lists[i]);
    free(search);
    return status;
}

Box vesseltree_box(const VesselTree *tree, double margin_mm)
{
    Box box = box_empty();
    for (size_t i = 0; i < tree->n_segments; i++) {
        const FieldSegment *segment = &tree->segments[i];
        box = box_union(box, segment_box(segment, segment->radius_mm + margin_mm));
    }
    return box;
}

Status segments_boxtree(const VesselTree *tree, BoxTree *out, Err *err)
{
    Box *boxes = NULL;
    TRY(mem_calloc(&boxes, tree->n_segments, sizeof *boxes, "segments", err));
    for (size_t i = 0; i < tree->n_segments; i++)
        boxes[i] = segment_box(&tree->segments[i], tree->segments[i].radius_mm);
    Status status = boxtree_build(boxes, tree->n_segments, out, err);
    free(boxes);
    return status;
}
