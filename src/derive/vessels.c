/* Merges the segments of a tree into vessels, the chains of segments between bifurcations.
 *
 * One forward sweep suffices: a segment that starts at a root or at a bifurcation begins a vessel;
 * any other segment continues the vessel of its parent. The radius of a vessel is the mean of its
 * segments' radii, weighted by length and updated segment by segment, so that the radius of a
 * vessel of one segment equals the segment's radius exactly. */
#include "derive/vessels.h"

#include "derive/fields.h"
#include <stdlib.h>

/* Adds a segment to vessel v. */
static void add_segment(Vessels *made, int32_t v, double radius, double length)
{
    made->row[v].length_mm += length;
    if (length > 0)
        made->radius_mm[v] += (radius - made->radius_mm[v]) * (length / made->row[v].length_mm);
}

/* Fills `made`, whose arrays have space for as many vessels as there are nodes. */
static void find_vessels(const Tree *tree, const int32_t *children, const double *level,
                         const double *strahler, Vessels *made)
{
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            made->of_node[i] = NO_VESSEL;
            continue;
        }
        int32_t start = tree->parent[i], parent = made->of_node[start];
        bool begins = parent == NO_VESSEL || children[start] >= 2;
        int32_t v = begins ? (int32_t)made->n++ : parent;
        if (begins) {
            made->row[v].start = start;
            made->parent[v] = parent;
            made->level[v] = (int32_t)level[i];
            made->strahler[v] = (int32_t)strahler[i];
            made->radius_mm[v] = tree->radius_mm[i];
        }
        made->of_node[i] = v;
        made->row[v].end = (int32_t)tree_linked_node(tree, i);
        add_segment(made, v, tree->radius_mm[i], tree_segment_length(tree, i));
    }
}

Status vessels_init(Vessels *vessels, const Tree *tree, Err *err)
{
    const TreeMeta none = {0};
    Vessels made = {0};
    int32_t *children = NULL;
    double *level = NULL, *strahler = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.row, tree->n, sizeof *made.row, "vessels", err));
    TRY_GOTO(mem_calloc(&made.parent, tree->n, sizeof *made.parent, "vessels", err));
    TRY_GOTO(mem_calloc(&made.level, tree->n, sizeof *made.level, "vessels", err));
    TRY_GOTO(mem_calloc(&made.strahler, tree->n, sizeof *made.strahler, "vessels", err));
    TRY_GOTO(mem_calloc(&made.radius_mm, tree->n, sizeof *made.radius_mm, "vessels", err));
    TRY_GOTO(mem_calloc(&made.of_node, tree->n, sizeof *made.of_node, "vessels of nodes", err));
    TRY_GOTO(mem_calloc(&level, tree->n, sizeof *level, "levels", err));
    TRY_GOTO(mem_calloc(&strahler, tree->n, sizeof *strahler, "Strahler orders", err));
    TRY_GOTO(tree_child_counts(tree, &children, err));
    TRY_GOTO(field_level(tree, &none, level, err));
    if (!tree->link) /* Strahler orders are undefined in a network with loops; they stay 0 */
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
    free(vessels->row);
    free(vessels->parent);
    free(vessels->level);
    free(vessels->strahler);
    free(vessels->radius_mm);
    free(vessels->of_node);
    *vessels = (Vessels){0};
}
