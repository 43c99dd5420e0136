/* An end is cut off flat where its vessel is a tube up to there; what meets at the other end, or
 * passes by, leaves a short vessel no room for that. Each end that is not flat goes on by a step at
 * a time, and zones are found anew; one that would then overlap a stranger, or that is not flat at
 * the last, goes back to where it was. */
#include "mesh/zones/adjust.h"

#include "mesh/zones/junctions.h"

#include <stdlib.h>

/* Over the radius. */
static const double step = 0.5;

typedef struct FreeTip {
    uint32_t segment;
    int end;
    bool stuck;
    int steps; /* that it is longer by */
    Vec3 was;
} FreeTip;

typedef struct Lengthening {
    VesselTree *tree;
    NumberLists incident, blending;
    Zones zones;
    FreeTip *tips;
    size_t n_tips;
} Lengthening;

static Vec3 *tip_place(const Lengthening *all, const FreeTip *tip)
{
    FieldSegment *segment = &all->tree->segments[tip->segment];
    return tip->end ? &segment->b : &segment->a;
}

static Status list_tips(Lengthening *all, Err *err)
{
    const VesselTree *tree = all->tree;
    size_t capacity = 0;
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            const uint32_t *first = &all->incident.first[tree->nodes[i][end]];
            if (first[1] - first[0] != 1)
                continue;
            TRY(mem_reserve(&all->tips, &capacity, all->n_tips + 1, sizeof *all->tips, "ends",
                            err));
            FreeTip *tip = &all->tips[all->n_tips++];
            *tip = (FreeTip){.segment = i, .end = end};
            tip->was = *tip_place(all, tip);
        }
    return STATUS_OK;
}

static Status find_zones(Lengthening *all, const MeshParams *params, Err *err)
{
    zones_release(&all->zones);
    numberlists_release(&all->blending);
    TRY(vesseltree_blending(all->tree, &all->incident, &all->blending, err));
    return zones_find(all->tree, &all->incident, &all->blending, params, &all->zones, err);
}

static bool is_flat(const Lengthening *all, const FreeTip *tip)
{
    return all->zones.zone[all->tree->nodes[tip->segment][tip->end]] == NO_ZONE;
}

static void put_back(const Lengthening *all, FreeTip *tip)
{
    *tip_place(all, tip) = tip->was;
    tip->steps = 0;
    tip->stuck = true;
}

/* Puts back the tips that overlap others; whether there are any. */
static bool put_back_overlapping(const Lengthening *all)
{
    bool any = false;
    for (size_t i = 0; i < all->n_tips; i++)
        for (size_t k = 0; k < all->zones.n_overlapping && all->tips[i].steps; k++) {
            const uint32_t *pair = all->zones.strangers[k].segments;
            if (pair[0] != all->tips[i].segment && pair[1] != all->tips[i].segment)
                continue;
            put_back(all, &all->tips[i]);
            any = true;
        }
    return any;
}

/* Whether a tip was moved. */
static bool lengthen(const Lengthening *all)
{
    bool any = false;
    for (size_t i = 0; i < all->n_tips; i++) {
        FreeTip *tip = &all->tips[i];
        const FieldSegment *segment = &all->tree->segments[tip->segment];
        Vec3 other = tip->end ? segment->a : segment->b;
        if (tip->stuck || is_flat(all, tip))
            continue;
        if ((tip->steps + 1) * step > LENGTHENED_MOST) {
            put_back(all, tip);
        } else {
            tip->steps++;
            *tip_place(all, tip) =
                vec3_add_scaled(tip->was, vec3_normalized(vec3_sub(tip->was, other)),
                                tip->steps * step * segment->radius_mm);
        }
        any = true;
    }
    return any;
}

static Status list_longer(const Lengthening *all, uint32_t **list, size_t *n, Err *err)
{
    TRY(mem_calloc(list, all->n_tips, sizeof **list, "ends", err));
    *n = 0;
    for (size_t i = 0; i < all->n_tips; i++)
        if (all->tips[i].steps && (*n == 0 || (*list)[*n - 1] != all->tips[i].segment))
            (*list)[(*n)++] = all->tips[i].segment;
    return STATUS_OK;
}

Status vesseltree_free_ends(VesselTree *tree, const MeshParams *params, uint32_t **lengthened,
                            size_t *n, Err *err)
{
    Lengthening all = {.tree = tree};
    Status status;
    TRY_GOTO(vesseltree_incident(tree, &all.incident, err));
    TRY_GOTO(list_tips(&all, err));
    do {
        TRY_GOTO(find_zones(&all, params, err));
    } while (put_back_overlapping(&all) || lengthen(&all));
    TRY_GOTO(list_longer(&all, lengthened, n, err));
done:
    numberlists_release(&all.incident);
    numberlists_release(&all.blending);
    zones_release(&all.zones);
    free(all.tips);
    return status;
}
