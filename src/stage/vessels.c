/* Lists a tree's vessels as lines with radii [stage_vessels]. Nodes that segments without length
 * connect become one node, and segments with a twin are left out [coincidence.h], so that no two
 * segments coincide. */
#include "stage/coincidence.h"
#include "stage/stage.h"

static Status reserve(const Tree *tree, VesselTree *vessels, Err *err)
{
    TRY(mem_calloc(&vessels->segments, tree->n, sizeof *vessels->segments, "segments", err));
    TRY(mem_calloc(&vessels->ids, tree->n, sizeof *vessels->ids, "segments", err));
    return mem_calloc(&vessels->nodes, tree->n, sizeof *vessels->nodes, "segments", err);
}

static void add_segment(const Tree *tree, const Coincidence *coincidence, size_t i,
                        VesselTree *vessels)
{
    size_t n = vessels->n_segments++;
    vessels->segments[n] = (FieldSegment){.a = tree->position[tree->parent[i]],
                                          .b = tree->position[i],
                                          .radius_mm = tree->radius_mm[i],
                                          .segment = (uint32_t)i};
    vessels->nodes[n][0] = (uint32_t)coincidence->junction[tree->parent[i]];
    vessels->nodes[n][1] = (uint32_t)coincidence->junction[i];
    vessels->ids[n] = (uint32_t)tree->id[i];
}

/* Adds the segments that are drawn of a tree, or of the pieces of a smooth tree. */
static Status add_segments(const Tree *tree, const Coincidence *coincidence, VesselTree *made,
                           Err *err)
{
    made->n_nodes = tree->n;
    TRY(reserve(tree, made, err));
    for (size_t i = 0; i < tree->n; i++)
        if (coincidence_draws(coincidence, i))
            add_segment(tree, coincidence, i, made);
    return STATUS_OK;
}

Status stage_vessels(const Tree *tree, const SmoothTree *smooth, VesselTree *vessels,
                     StageReport *report, Err *err)
{
    VesselTree made = {0};
    Coincidence coincidence = {0};
    StageReport counted;
    Status status;
    TRY_GOTO(coincidence_find(tree, &coincidence, err));
    counted = coincidence_count(tree, &coincidence);
    if (smooth) {
        const Coincidence of_pieces = coincidence_of_smooth(smooth);
        TRY_GOTO(add_segments(&smooth->tree, &of_pieces, &made, err));
    } else {
        TRY_GOTO(add_segments(tree, &coincidence, &made, err));
    }
    if (made.n_segments == 0)
        TRY_GOTO(
            err_set(err, STATUS_INPUT,
                    "the tree has no surface: no segment is longer than %g mm and has a radius "
                    "above 0",
                    SHORTEST_MM));
    if (report)
        *report = counted;
    *vessels = made;
    made = (VesselTree){0};
done:
    coincidence_release(&coincidence);
    vesseltree_release(&made);
    return status;
}
