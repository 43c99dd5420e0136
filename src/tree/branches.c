/* Divides a tree into branches, the chains of segments between bifurcations.
 *
 * A branch begins at each segment that is not the only child of a segment, and follows only
 * children. So the children of each node are counted, and each only child is stored at its parent.
 */
#include "tree/tree.h"

#include <stdlib.h>

void branches_release(Branches *branches)
{
    free(branches->node);
    free(branches->end);
    *branches = (Branches){0};
}

enum { NONE = -1 };

/* Finds, per node, its only child, or NONE if it has no child or several. The caller frees *out. */
static Status only_children(const Tree *tree, const int32_t *children, int32_t **out, Err *err)
{
    int32_t *made = NULL;
    TRY(mem_alloc(&made, tree->n, sizeof *made, "children", err));
    for (size_t i = 0; i < tree->n; i++)
        made[i] = NONE;
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && children[tree->parent[i]] == 1)
            made[tree->parent[i]] = (int32_t)i;
    *out = made;
    return STATUS_OK;
}

static bool begins_branch(const Tree *tree, size_t i, const int32_t *children)
{
    int32_t parent = tree->parent[i];
    return tree_is_segment(tree, i) &&
           (children[parent] != 1 || !tree_is_segment(tree, (size_t)parent));
}

Status branches_find(const Tree *tree, Branches *branches, Err *err)
{
    int32_t *children = NULL, *only_child = NULL;
    Branches made = {0};
    size_t n = 0;
    Status status = STATUS_OK;
    TRY_GOTO(tree_child_counts(tree, &children, err));
    TRY_GOTO(only_children(tree, children, &only_child, err));
    TRY_GOTO(mem_calloc(&made.node, tree->n, sizeof *made.node, "branches", err));
    TRY_GOTO(mem_calloc(&made.end, tree->n, sizeof *made.end, "branches", err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!begins_branch(tree, i, children))
            continue;
        for (int32_t at = (int32_t)i; at != NONE; at = only_child[at])
            made.node[n++] = at;
        made.end[made.n++] = n;
    }
    *branches = made;
done:
    if (status != STATUS_OK)
        branches_release(&made);
    free(children);
    free(only_child);
    return status;
}
