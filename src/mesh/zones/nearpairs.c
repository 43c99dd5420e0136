/* The distance of two segments is the least of those of their ends to the other segment, unless
 * the common perpendicular of their lines meets both. */
#include "mesh/zones/nearpairs.h"

#include "mesh/proof/boxpairs.h"
#include <stdlib.h>

enum { MAX_WORKERS = 256 };

typedef struct PairList {
    NearPair *pairs;
    size_t n, capacity;
    Status status;
    Err err;
} PairList;

typedef struct NearSearch {
    const VesselTree *tree;
    PairList lists[MAX_WORKERS];
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
    if (det <= 1e-12 * dd * ee)
        return least;
    double s = (vec3_dot(between, d) * ee - vec3_dot(between, e) * de) / det;
    double t = (vec3_dot(between, d) * de - vec3_dot(between, e) * dd) / det;
    if (s < 0 || s > 1 || t < 0 || t > 1)
        return least;
    Vec3 apart = vec3_sub(vec3_add_scaled(between, e, t), vec3_scale(d, s));
    return fmin(least, vec3_length(apart));
}

/* Of the wall and half the gap that counts as near. */
static FloatBox near_box(uint32_t item, const void *context)
{
    const NearSearch *search = context;
    const FieldSegment *segment = &search->tree->segments[item];
    double reach = (1 + NEAR_GAP / 2) * segment->radius_mm;
    Box box = box_with_ball(box_with_ball(box_empty(), segment->a, reach), segment->b, reach);
    return (FloatBox){
        {nextafterf((float)box.low.x, -INFINITY), nextafterf((float)box.low.y, -INFINITY),
         nextafterf((float)box.low.z, -INFINITY)},
        {nextafterf((float)box.high.x, INFINITY), nextafterf((float)box.high.y, INFINITY),
         nextafterf((float)box.high.z, INFINITY)}};
}

static bool share_node(const VesselTree *tree, uint32_t a, uint32_t b)
{
    const uint32_t *one = tree->nodes[a], *other = tree->nodes[b];
    return one[0] == other[0] || one[0] == other[1] || one[1] == other[0] || one[1] == other[1];
}

static void note_pair(uint32_t a, uint32_t b, int worker, void *context)
{
    NearSearch *search = context;
    PairList *list = &search->lists[worker];
    const FieldSegment *one = &search->tree->segments[a], *other = &search->tree->segments[b];
    if (share_node(search->tree, a, b) || list->status != STATUS_OK)
        return;
    double gap = segments_distance(one, other) - one->radius_mm - other->radius_mm;
    if (gap >= NEAR_GAP * fmin(one->radius_mm, other->radius_mm))
        return;
    list->status = mem_reserve(&list->pairs, &list->capacity, list->n + 1, sizeof *list->pairs,
                               "near vessels", &list->err);
    if (list->status == STATUS_OK)
        list->pairs[list->n++] = (NearPair){{a, b}, gap};
}

static int compare_pairs(const void *a, const void *b)
{
    const uint32_t *one = ((const NearPair *)a)->segments, *other = ((const NearPair *)b)->segments;
    int axis = one[0] == other[0];
    return (one[axis] > other[axis]) - (one[axis] < other[axis]);
}

/* All lists in one, in order. */
static Status gather(const NearSearch *search, NearPair **pairs, size_t *n, Err *err)
{
    size_t total = 0;
    for (int i = 0; i < MAX_WORKERS; i++) {
        if (search->lists[i].status != STATUS_OK)
            return err_set(err, search->lists[i].status, "%s", search->lists[i].err.text);
        total += search->lists[i].n;
    }
    NearPair *all;
    TRY(mem_calloc(&all, total, sizeof *all, "near vessels", err));
    *n = 0;
    for (int i = 0; i < MAX_WORKERS; i++)
        for (size_t j = 0; j < search->lists[i].n; j++)
            all[(*n)++] = search->lists[i].pairs[j];
    qsort(all, total, sizeof *all, compare_pairs);
    *pairs = all;
    return STATUS_OK;
}

Status nearpairs_find(const VesselTree *tree, int threads, NearPair **pairs, size_t *n, Err *err)
{
    NearSearch *search;
    TRY(mem_calloc(&search, 1, sizeof *search, "near vessels", err));
    search->tree = tree;
    const BoxPairs boxes = {(uint32_t)tree->n_segments, near_box, note_pair, search, threads};
    Status status = boxpairs_find(&boxes, err);
    if (status == STATUS_OK)
        status = gather(search, pairs, n, err);
    for (int i = 0; i < MAX_WORKERS; i++)
        free(search->lists[i].pairs);
    free(search);
    return status;
}

Box segment_box(const FieldSegment *segment, double radius_mm)
{
    return box_with_ball(box_with_ball(box_empty(), segment->a, radius_mm), segment->b, radius_mm);
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
