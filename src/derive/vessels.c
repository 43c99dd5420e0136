/* One forward sweep: a segment that starts at a root or at a branching begins a vessel; any other
 * segment continues the vessel of its parent. The radius is a running mean weighted by length. For
 * a vessel of one segment, it is the segment's radius to the last bit. */
#include "derive/vessels.h"

#include "derive/fields.h"
#include <stdlib.h>

static void extend(Vessel *vessel, double radius, double length)
{
    vessel->length_mm += length;
    if (length > 0)
        vessel->radius_mm += (radius - vessel->radius_mm) * (length / vessel->length_mm);
}

/* `made` has room for as many vessels as there are nodes. */
static void find_vessels(const Tree *tree, const int32_t *children, const double *level,
                         const double *strahler, Vessels *made)
{
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            made->of_node[i] = NO_VESSEL;
            continue;
        }
        int32_t start = tree->parent[i], above = made->of_node[start];
        bool begins = above == NO_VESSEL || children[start] >= 2;
        if (begins)
            made->vessel[made->n] = (Vessel){.parent = above,
                                             .start = start,
                                             .level = (int32_t)level[i],
                                             .strahler = (int32_t)strahler[i],
                                             .radius_mm = tree->radius_mm[i]};
        made->of_node[i] = begins ? (int32_t)made->n++ : above;
        made->vessel[made->of_node[i]].end = (int32_t)tree_place(tree, i);
        extend(&made->vessel[made->of_node[i]], tree->radius_mm[i], tree_segment_length(tree, i));
    }
}

Status vessels_init(Vessels *vessels, const Tree *tree, Err *err)
{
    const TreeMeta none = {0};
    Vessels made = {0};
    int32_t *children = NULL;
    double *level = NULL, *strahler = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.vessel, tree->n, sizeof *made.vessel, "vessels", err));
    TRY_GOTO(mem_calloc(&made.of_node, tree->n, sizeof *made.of_node, "vessels of nodes", err));
    TRY_GOTO(mem_calloc(&level, tree->n, sizeof *level, "levels", err));
    TRY_GOTO(mem_calloc(&strahler, tree->n, sizeof *strahler, "Strahler orders", err));
    TRY_GOTO(tree_child_counts(tree, &children, err));
    TRY_GOTO(field_level(tree, &none, level, err));
    if (!tree->link)
        TRY_GOTO(field_strahler(tree, &none, strahler, err));
    find_vessels(tree, children, level, strahler, &made);
    *vessels = made;
    made = (Vessels){0};
done:
    vessels_release(&made);
    free(children);
    free(level);
    free(strahler);
    return status;
}

void vessels_release(Vessels *vessels)
{
    free(vessels->vessel);
    free(vessels->of_node);
    *vessels = (Vessels){0};
}

Status vessels_heirs(const Vessels *vessels, const int32_t *order, int32_t **heir, Err *err)
{
    int32_t *made = NULL;
    TRY(mem_calloc(&made, vessels->n, sizeof *made, "continued vessels", err));
    for (size_t v = 0; v < vessels->n; v++) {
        made[v] = NO_VESSEL;
        int32_t parent = vessels->vessel[v].parent;
        if (parent == NO_VESSEL || order[parent] != order[v])
            continue;
        int32_t *best = &made[parent];
        if (*best == NO_VESSEL || vessels->vessel[v].radius_mm > vessels->vessel[*best].radius_mm)
            *best = (int32_t)v;
    }
    *heir = made;
    return STATUS_OK;
}
