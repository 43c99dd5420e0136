/* A tree as lines with radii; see stage_vessels. Nodes that segments of no length join are one, and
 * what lies within a twin is left out [places.h], so that no two segments coincide. */
#include "stage/places.h"
#include "stage/stage.h"

static Status reserve(const Tree *tree, VesselTree *vessels, Err *err)
{
    TRY(mem_calloc(&vessels->segments, tree->n, sizeof *vessels->segments, "segments", err));
    TRY(mem_calloc(&vessels->ids, tree->n, sizeof *vessels->ids, "segments", err));
    return mem_calloc(&vessels->nodes, tree->n, sizeof *vessels->nodes, "segments", err);
}

static void add_segment(const Tree *tree, const Places *places, size_t i, VesselTree *vessels)
{
    size_t n = vessels->n_segments++;
    vessels->segments[n] = (FieldSegment){.a = tree->position[tree->parent[i]],
                                          .b = tree->position[i],
                                          .radius_mm = tree->radius_mm[i],
                                          .segment = (uint32_t)i};
    vessels->nodes[n][0] = (uint32_t)places->place[tree->parent[i]];
    vessels->nodes[n][1] = (uint32_t)places->place[i];
    vessels->ids[n] = (uint32_t)tree->id[i];
}

Status stage_vessels(const Tree *tree, VesselTree *vessels, StageReport *report, Err *err)
{
    VesselTree made = {.n_nodes = tree->n};
    Places places = {0};
    StageReport counted;
    Status status;
    TRY_GOTO(places_find(tree, &places, err));
    TRY_GOTO(reserve(tree, &made, err));
    counted = places_count(tree, &places);
    for (size_t i = 0; i < tree->n; i++)
        if (places_draw(&places, i))
            add_segment(tree, &places, i, &made);
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
    places_release(&places);
    vesseltree_release(&made);
    return status;
}
