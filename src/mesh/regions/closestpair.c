/* Finds the two unconnected vessels with the smallest gap.
 *
 * The boxes about two segments are padded by their radii and half a reach. Such boxes meet whenever
 * the gap between the vessels is at most the reach. The search begins with a small reach, and
 * doubles the reach until it finds a gap of at most the reach. */
#include "mesh/regions/junctions.h"

#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

/* The limit of threads_try on the number of threads. */
enum { MAX_WORKERS = 256 };

typedef struct GapSearch {
    const VesselTree *tree;
    Junctions junctions;
    double reach_mm;
    NearPair best[MAX_WORKERS]; /* per thread */
} GapSearch;

static FloatBox box_of(uint32_t item, const void *context)
{
    const GapSearch *search = context;
    const FieldSegment *segment = &search->tree->segments[item];
    return segment_floatbox(segment, segment->radius_mm + search->reach_mm / 2);
}

/* Returns true if two segments blend or share a region, so that they do not count as a pair. */
static bool belong_together(const GapSearch *search, uint32_t a, uint32_t b)
{
    const uint32_t *of_node = search->junctions.of_node;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t one = search->tree->nodes[a][i], other = search->tree->nodes[b][k];
            if (one == other || (of_node[one] != NO_JUNCTION && of_node[one] == of_node[other]))
                return true;
        }
    return false;
}

/* Orders pairs by gap, then by index, so that the result does not depend on the threads. */
static bool is_before(const NearPair *one, const NearPair *other)
{
    if (one->gap_mm != other->gap_mm)
        return one->gap_mm < other->gap_mm;
    int place = one->segments[0] == other->segments[0];
    return one->segments[place] < other->segments[place];
}

static void note_pair(uint32_t a, uint32_t b, int worker, void *context)
{
    GapSearch *search = context;
    const FieldSegment *segments = search->tree->segments;
    const NearPair pair = {{a, b}, segments_gap(&segments[a], &segments[b])};
    if (is_before(&pair, &search->best[worker]) && !belong_together(search, a, b))
        search->best[worker] = pair;
}

/* Finds the closest pair whose boxes, padded by half the reach, meet. */
static Status search_within(GapSearch *search, int threads, NearPair *best, Err *err)
{
    const BoxPairs boxes = {(uint32_t)search->tree->n_segments, box_of, note_pair, search, threads};
    for (int i = 0; i < MAX_WORKERS; i++)
        search->best[i] = (NearPair){.gap_mm = HUGE_VAL};
    TRY(boxpairs_find(&boxes, err));
    *best = search->best[0];
    for (int i = 1; i < MAX_WORKERS; i++)
        if (is_before(&search->best[i], best))
            *best = search->best[i];
    return STATUS_OK;
}

/* Returns an upper bound of all gaps: the diagonal of the tree's box. */
static double extent_of(const VesselTree *tree)
{
    Box box = box_empty();
    for (size_t i = 0; i < tree->n_segments; i++)
        box = box_union(box, segment_box(&tree->segments[i], 0));
    return vec3_distance(box.low, box.high);
}

Status vesseltree_closest_pair(const VesselTree *tree, const MeshParams *params, NearPair *pair,
                               bool *found, Err *err)
{
    GapSearch *search;
    double extent = extent_of(tree);
    Status status;
    TRY(mem_calloc(&search, 1, sizeof *search, "near vessels", err));
    search->tree = tree;
    TRY_GOTO(junctions_find(tree, params, &search->junctions, err));
    *pair = (NearPair){.gap_mm = HUGE_VAL};
    search->reach_mm = extent;
    for (size_t i = 0; i < tree->n_segments; i++)
        search->reach_mm = fmin(search->reach_mm, tree->segments[i].radius_mm);
    while (pair->gap_mm > search->reach_mm && search->reach_mm < extent) {
        search->reach_mm = fmin(2 * search->reach_mm, extent);
        TRY_GOTO(search_within(search, params->threads, pair, err));
    }
    *found = pair->gap_mm < HUGE_VAL;
done:
    junctions_release(&search->junctions);
    free(search);
    return status;
}
