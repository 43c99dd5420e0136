/* Of two vessels that overlap though they do not belong together, both are thinned by the same
 * factor, and with them what blends with them and is not much thicker: in a centre line of short
 * steps the wall is that of many segments. Zones are smaller then, so that pairs may come up that
 * were in one before; it is repeated until there is none. */
#include "mesh/zones/adjust.h"

#include "mesh/zones/junctions.h"

#include <stdlib.h>

/* What is left free between the walls, over the sum of the radii; what a radius must keep; radii
 * over the thinned one's that are thinned with it. */
static const double free_part = 0.08, least_kept = 0.05, alike = 1.3;
enum { MOST_ROUNDS = 12 };

typedef struct Parting {
    VesselTree *tree;
    NumberLists incident, blending;
    Zones zones;
    double *kept;  /* one a segment: of its radius in this round */
    double *radii; /* as they were at first */
} Parting;

static void thin_about(const Parting *parting, uint32_t segment, double factor)
{
    const VesselTree *tree = parting->tree;
    double most = alike * tree->segments[segment].radius_mm;
    for (int end = 0; end < 2; end++) {
        const uint32_t *first = &parting->blending.first[tree->nodes[segment][end]];
        for (uint32_t i = first[0]; i < first[1]; i++) {
            uint32_t other = parting->blending.items[i];
            if (tree->segments[other].radius_mm <= most)
                parting->kept[other] = fmin(parting->kept[other], factor);
        }
    }
}

static Status thin_pairs(Parting *parting, Err *err)
{
    VesselTree *tree = parting->tree;
    for (size_t i = 0; i < tree->n_segments; i++)
        parting->kept[i] = 1;
    for (size_t i = 0; i < parting->zones.n_overlapping; i++) {
        const NearPair *pair = &parting->zones.strangers[i];
        double radii = tree->segments[pair->segments[0]].radius_mm +
                       tree->segments[pair->segments[1]].radius_mm;
        double factor = (pair->gap_mm + radii) / radii * (1 - free_part);
        for (int k = 0; k < 2; k++)
            thin_about(parting, pair->segments[k], factor);
    }
    for (size_t i = 0; i < tree->n_segments; i++) {
        tree->segments[i].radius_mm *= parting->kept[i];
        if (tree->segments[i].radius_mm < least_kept * parting->radii[i])
            return err_set(err, STATUS_INPUT,
                           "segment %u and one that it does not belong with come so near that it "
                           "would keep less than %g of its radius; their walls cannot be parted",
                           tree->ids[i], least_kept);
    }
    return STATUS_OK;
}

static void release_round(Parting *parting)
{
    numberlists_release(&parting->incident);
    numberlists_release(&parting->blending);
    zones_release(&parting->zones);
}

static Status find_overlaps(Parting *parting, const MeshParams *params, Err *err)
{
    release_round(parting);
    TRY(vesseltree_incident(parting->tree, &parting->incident, err));
    TRY(vesseltree_blending(parting->tree, &parting->incident, &parting->blending, err));
    return zones_find(parting->tree, &parting->incident, &parting->blending, params,
                      &parting->zones, err);
}

static Status list_thinned(const Parting *parting, uint32_t **list, size_t *n, Err *err)
{
    const VesselTree *tree = parting->tree;
    TRY(mem_calloc(list, tree->n_segments, sizeof **list, "segments", err));
    *n = 0;
    for (uint32_t i = 0; i < tree->n_segments; i++)
        if (tree->segments[i].radius_mm < parting->radii[i])
            (*list)[(*n)++] = i;
    return STATUS_OK;
}

Status vesseltree_part(VesselTree *tree, const MeshParams *params, uint32_t **thinned, size_t *n,
                       Err *err)
{
    Parting parting = {.tree = tree};
    Status status;
    TRY_GOTO(mem_calloc(&parting.kept, tree->n_segments, sizeof *parting.kept, "segments", err));
    TRY_GOTO(mem_calloc(&parting.radii, tree->n_segments, sizeof *parting.radii, "segments", err));
    for (size_t i = 0; i < tree->n_segments; i++)
        parting.radii[i] = tree->segments[i].radius_mm;
    TRY_GOTO(find_overlaps(&parting, params, err));
    for (int round = 0; round < MOST_ROUNDS && parting.zones.n_overlapping; round++) {
        TRY_GOTO(thin_pairs(&parting, err));
        TRY_GOTO(find_overlaps(&parting, params, err));
    }
    TRY_GOTO(list_thinned(&parting, thinned, n, err));
done:
    release_round(&parting);
    free(parting.kept);
    free(parting.radii);
    return status;
}
