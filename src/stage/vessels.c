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

Status stage_vessels(const Tree *tree, VesselTree *vessels, StageReport *report, Err *err)
{
    VesselTree made = {.n_nodes = tree->n};
    Coincidence coincidence = {0};
    StageReport counted;
    Status status;
    TRY_GOTO(coincidence_find(tree, &coincidence, err));
    TRY_GOTO(reserve(tree, &made, err));
    counted = coincidence_count(tree, &coincidence);
    for (size_t i = 0; i < tree->n; i++)
        if (coincidence_draws(&coincidence, i))
            add_segment(tree, &coincidence, i, &made);
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
