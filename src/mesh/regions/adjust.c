/* Changes a tree so that it can be meshed: thins unconnected vessels that overlap, and lengthens
 * free ends that cannot be cut off flat.
 *
 * Both functions change the tree a little, find its junction regions anew, and repeat. One step
 * does not suffice: a change of radii or lengths makes regions larger or smaller, so that vessels
 * that shared a region before may become unconnected.
 *
 * Two vessels that overlap are thinned by the same factor. The vessels that blend with them and are
 * not much thicker are thinned, too, because a finely sampled vessel consists of many segments.
 *
 * An end is cut off flat if its vessel is a tube up to the end. A short vessel is not if other
 * vessels are near. Each end that is not flat grows by a step at a time. An end that would then
 * overlap an unconnected vessel, or that is not flat at its maximum length, goes back to its first
 * position. */
#include "mesh/regions/adjust.h"

#include "mesh/regions/junctions.h"
#include "mesh/regions/nearpairs.h"
#include <stdlib.h>

/* In units of the distance between two axes: the gap left between the surfaces of two thinned
 * vessels. A larger gap thins more than needed; a smaller one needs finer cells in a region that
 * both vessels share. */
static const double parted_gap = 0.08;
/* In units of the original radius: the minimum radius of a thinned vessel. */
static const double min_kept = 0.05;
/* A vessel that blends with a thinned one is thinned, too, if its radius is at most this many times
 * as large. The factor includes the segments of one vessel, whose radii vary slowly, and the
 * parent of a symmetric bifurcation, whose radius is 2^(1/3) = 1.26 times its daughters'. A larger
 * factor spreads the thinning to thick trunks; a smaller one leaves steps along one vessel. */
static const double max_radius_ratio = 1.3;
/* Each round thins the pairs that still overlap. A pair is separated in one round; further rounds
 * serve vessels that became unconnected since. Pairs that still overlap after the last round are
 * refused later, by vesselmesh_build. */
enum { MAX_PARTING_ROUNDS = 12 };
/* In units of the radius: the length by which an end grows at a time. MAX_LENGTHENING is 6 steps.
 * Smaller steps lengthen less than needed, but search for the regions more often. */
static const double end_step = 0.5;

typedef struct Parting {
    VesselTree *tree;
    Junctions junctions;
    double *kept;  /* per segment: the fraction of its radius that it keeps in this round */
    double *radii; /* per segment: its radius before the first round */
} Parting;

/* Replaces the junction regions by those of the changed tree. */
static Status find_anew(const VesselTree *tree, const MeshParams *params, Junctions *junctions,
                        Err *err)
{
    junctions_release(junctions);
    return junctions_find(tree, params, junctions, err);
}

/* Thins the vessels that blend at the ends of a segment. */
static void thin_about(const Parting *parting, uint32_t segment, double factor)
{
    const VesselTree *tree = parting->tree;
    double most = max_radius_ratio * tree->segments[segment].radius_mm;
    for (int end = 0; end < 2; end++) {
        const uint32_t *first = &parting->junctions.blending.first[tree->nodes[segment][end]];
        for (uint32_t i = first[0]; i < first[1]; i++) {
            uint32_t other = parting->junctions.blending.items[i];
            if (tree->segments[other].radius_mm <= most)
                parting->kept[other] = fmin(parting->kept[other], factor);
        }
    }
}

/* Thins the vessels of all overlapping pairs. A vessel of several pairs keeps the smallest fraction
 * of its radius. */
static Status thin_pairs(Parting *parting, Err *err)
{
    VesselTree *tree = parting->tree;
    for (size_t i = 0; i < tree->n_segments; i++)
        parting->kept[i] = 1;
    for (size_t i = 0; i < parting->junctions.n_overlapping; i++) {
        const NearPair *pair = &parting->junctions.unconnected[i];
        double radii = tree->segments[pair->segments[0]].radius_mm +
                       tree->segments[pair->segments[1]].radius_mm;
        double factor = (pair->gap_mm + radii) / radii * (1 - parted_gap);
        for (int k = 0; k < 2; k++)
            thin_about(parting, pair->segments[k], factor);
    }
    for (size_t i = 0; i < tree->n_segments; i++) {
        tree->segments[i].radius_mm *= parting->kept[i];
        if (tree->segments[i].radius_mm < min_kept * parting->radii[i])
            return err_set(
                err, STATUS_INPUT,
                "segment %u overlaps an unconnected vessel; to separate them, its radius would "
                "have to be less than %g of its true radius",
                tree->ids[i], min_kept);
    }
    return STATUS_OK;
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

Status vesseltree_thin_overlaps(VesselTree *tree, const MeshParams *params, uint32_t **thinned,
                                size_t *n, Err *err)
{
    Parting parting = {.tree = tree};
    Status status;
    TRY_GOTO(mem_calloc(&parting.kept, tree->n_segments, sizeof *parting.kept, "segments", err));
    TRY_GOTO(mem_calloc(&parting.radii, tree->n_segments, sizeof *parting.radii, "segments", err));
    for (size_t i = 0; i < tree->n_segments; i++)
        parting.radii[i] = tree->segments[i].radius_mm;
    TRY_GOTO(find_anew(tree, params, &parting.junctions, err));
    for (int i = 0; i < MAX_PARTING_ROUNDS && parting.junctions.n_overlapping; i++) {
        TRY_GOTO(thin_pairs(&parting, err));
        TRY_GOTO(find_anew(tree, params, &parting.junctions, err));
    }
    TRY_GOTO(list_thinned(&parting, thinned, n, err));
done:
    junctions_release(&parting.junctions);
    free(parting.kept);
    free(parting.radii);
    return status;
}

/* An end of the tree. */
typedef struct TreeTip {
    uint32_t segment;
    int end;
    bool is_stuck; /* it is back at its first position, and stays there */
    int steps;     /* number of steps by which it is longer */
    Vec3 was;      /* its first position */
} TreeTip;

typedef struct Lengthening {
    VesselTree *tree;
    Junctions junctions;
    ARRAY(TreeTip) tips;
} Lengthening;

static Vec3 *tip_position(const Lengthening *all, const TreeTip *tip)
{
    FieldSegment *segment = &all->tree->segments[tip->segment];
    return tip->end ? &segment->b : &segment->a;
}

/* Lists the free ends of the tree. */
static Status list_tips(Lengthening *all, Err *err)
{
    const VesselTree *tree = all->tree;
    for (uint32_t i = 0; i < tree->n_segments; i++)
        for (int end = 0; end < 2; end++) {
            const uint32_t *first = &all->junctions.incident.first[tree->nodes[i][end]];
            if (first[1] - first[0] == 1)
                TRY(ARRAY_PUSH(&all->tips, "ends", err,
                               (TreeTip){i, end, .was = segment_end(&tree->segments[i], end)}));
        }
    return STATUS_OK;
}

/* Moves a tip back to its first position, for good. */
static void put_back(const Lengthening *all, TreeTip *tip)
{
    *tip_position(all, tip) = tip->was;
    tip->steps = 0;
    tip->is_stuck = true;
}

/* Puts back the tips that overlap other vessels. Returns true if there is one. */
static bool put_back_overlapping(const Lengthening *all)
{
    bool any = false;
    for (size_t i = 0; i < all->tips.n; i++) {
        TreeTip *tip = &all->tips.items[i];
        for (size_t k = 0; k < all->junctions.n_overlapping && tip->steps; k++) {
            const uint32_t *pair = all->junctions.unconnected[k].segments;
            if (pair[0] != tip->segment && pair[1] != tip->segment)
                continue;
            put_back(all, tip);
            any = true;
        }
    }
    return any;
}

/* Moves each tip that is not flat. Returns true if there is one. */
static bool lengthen(const Lengthening *all)
{
    bool any = false;
    for (size_t i = 0; i < all->tips.n; i++) {
        TreeTip *tip = &all->tips.items[i];
        const FieldSegment *segment = &all->tree->segments[tip->segment];
        uint32_t node = all->tree->nodes[tip->segment][tip->end];
        if (tip->is_stuck || all->junctions.of_node[node] == NO_JUNCTION)
            continue;
        if ((tip->steps + 1) * end_step > MAX_LENGTHENING) {
            put_back(all, tip);
        } else {
            tip->steps++;
            Vec3 outward = vec3_normalized(vec3_sub(tip->was, segment_end(segment, !tip->end)));
            *tip_position(all, tip) =
                vec3_add_scaled(tip->was, outward, tip->steps * end_step * segment->radius_mm);
        }
        any = true;
    }
    return any;
}

static Status list_longer(const Lengthening *all, uint32_t **list, size_t *n, Err *err)
{
    TRY(mem_calloc(list, all->tips.n, sizeof **list, "ends", err));
    *n = 0;
    for (size_t i = 0; i < all->tips.n; i++) {
        const TreeTip *tip = &all->tips.items[i];
        if (tip->steps && (*n == 0 || (*list)[*n - 1] != tip->segment))
            (*list)[(*n)++] = tip->segment;
    }
    return STATUS_OK;
}

Status vesseltree_lengthen_ends(VesselTree *tree, const MeshParams *params, uint32_t **lengthened,
                                size_t *n, Err *err)
{
    Lengthening all = {.tree = tree};
    Status status;
    TRY_GOTO(find_anew(tree, params, &all.junctions, err));
    TRY_GOTO(list_tips(&all, err));
    while (put_back_overlapping(&all) || lengthen(&all))
        TRY_GOTO(find_anew(tree, params, &all.junctions, err));
    TRY_GOTO(list_longer(&all, lengthened, n, err));
done:
    junctions_release(&all.junctions);
    ARRAY_RELEASE(&all.tips);
    return status;
}
