/* Pairs whose boxes, widened by half a reach, meet have all gaps up to the reach among them; a
 * reach that finds none, or none so near, is doubled. */
#include "mesh/zones/closestpair.h"

#include "mesh/proof/boxpairs.h"
#include "mesh/zones/junctions.h"
#include "mesh/zones/nearpairs.h"
#include <stdlib.h>

enum { MAX_WORKERS = 256 };

typedef struct GapSearch {
    const VesselTree *tree;
    const Zones *zones;
    double reach_mm;
    NearPair best[MAX_WORKERS]; /* of each thread */
} GapSearch;

static FloatBox box_of(uint32_t item, const void *context)
{
    const GapSearch *search = context;
    const FieldSegment *segment = &search->tree->segments[item];
    double reach = segment->radius_mm + search->reach_mm / 2;
    Box box = box_with_ball(box_with_ball(box_empty(), segment->a, reach), segment->b, reach);
    FloatBox wide;
    for (int axis = 0; axis < 3; axis++) {
        wide.low[axis] = nextafterf((float)vec3_component(box.low, axis), -INFINITY);
        wide.high[axis] = nextafterf((float)vec3_component(box.high, axis), INFINITY);
    }
    return wide;
}

static bool belong_together(const GapSearch *search, uint32_t a, uint32_t b)
{
    const uint32_t *zone = search->zones->zone;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t one = search->tree->nodes[a][i], other = search->tree->nodes[b][k];
            if (one == other || (zone[one] != NO_ZONE && zone[one] == zone[other]))
                return true;
        }
    return false;
}

/* Whether a pair comes before another: the nearer one, or that of the lower numbers. */
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
    const FieldSegment *one = &search->tree->segments[a], *other = &search->tree->segments[b];
    const NearPair pair = {{a, b},
                           segments_distance(one, other) - one->radius_mm - other->radius_mm};
    if (is_before(&pair, &search->best[worker]) && !belong_together(search, a, b))
        search->best[worker] = pair;
}

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

static double extent_of(const VesselTree *tree)
{
    Box box = box_empty();
    for (size_t i = 0; i < tree->n_segments; i++) {
        box = box_with_ball(box, tree->segments[i].a, 0);
        box = box_with_ball(box, tree->segments[i].b, 0);
    }
    return vec3_distance(box.low, box.high);
}

static Status search_wider(GapSearch *search, int threads, NearPair *pair, bool *found, Err *err)
{
    double extent = extent_of(search->tree);
    NearPair best = {.gap_mm = HUGE_VAL};
    search->reach_mm = extent;
    for (size_t i = 0; i < search->tree->n_segments; i++)
        search->reach_mm = fmin(search->reach_mm, search->tree->segments[i].radius_mm);
    while (best.gap_mm > search->reach_mm && search->reach_mm < extent) {
        search->reach_mm = fmin(2 * search->reach_mm, extent);
        TRY(search_within(search, threads, &best, err));
    }
    *found = best.gap_mm < HUGE_VAL;
    *pair = best;
    return STATUS_OK;
}

Status leastgap_find(const VesselTree *tree, const MeshParams *params, NearPair *pair, bool *found,
                     Err *err)
{
    NumberLists incident = {0}, blending = {0};
    Zones zones = {0};
    GapSearch *search = NULL;
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &incident, err));
    TRY_GOTO(vesseltree_blending(tree, &incident, &blending, err));
    TRY_GOTO(zones_find(tree, &incident, &blending, params, &zones, err));
    TRY_GOTO(mem_calloc(&search, 1, sizeof *search, "near vessels", err));
    search->tree = tree;
    search->zones = &zones;
    TRY_GOTO(search_wider(search, params->threads, pair, found, err));
done:
    numberlists_release(&incident);
    numberlists_release(&blending);
    zones_release(&zones);
    free(search);
    return status;
}
