/* Orders of segments, each in one or two sweeps over the arrays of the tree, in which parents come
 * before children. A forward sweep computes what a segment inherits (level, branch); a backward
 * sweep computes what it gets from its subtree (Strahler order). There is no recursion, so a tree
 * of any depth needs no stack. */
#include "derive/fields.h"

#include <stdlib.h>

Status field_level(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    int32_t *children = NULL;
    TRY(tree_child_counts(tree, &children, err));
    for (size_t i = 0; i < tree->n; i++) {
        int32_t parent = tree->parent[i];
        value[i] = parent == TREE_NO_PARENT ? 0 : value[parent] + (children[parent] >= 2);
    }
    free(children);
    return STATUS_OK;
}

/* The backward sweep visits all children of a node before the node. Until then value[i] is
 * the largest order among its children so far, and alike[i] the number of children that have
 * this order. */
Status field_strahler(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    int32_t *alike = NULL;
    TRY(mem_calloc(&alike, tree->n, sizeof *alike, "counts of equal orders", err));
    for (size_t i = tree->n; i-- > 0;) {
        if (!tree_is_segment(tree, i))
            continue;
        if (alike[i] != 1) /* a terminal, or several daughters of the largest order */
            value[i]++;
        int32_t parent = tree->parent[i];
        if (value[i] > value[parent]) {
            value[parent] = value[i];
            alike[parent] = 1;
        } else if (value[i] == value[parent]) {
            alike[parent]++;
        }
    }
    free(alike);
    return STATUS_OK;
}

Status field_tree(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides, (void)err;
    double trees = 0;
    for (size_t i = 0; i < tree->n; i++)
        value[i] = tree_is_segment(tree, i) ? value[tree->parent[i]] : ++trees;
    return STATUS_OK;
}

Status field_branch(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    enum { NONE = 0 }; /* index 0 is a root, and no node's daughter */
    int32_t *thickest = NULL;
    TRY(mem_calloc(&thickest, tree->n, sizeof *thickest, "thickest daughters", err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        int32_t *best = &thickest[tree->parent[i]];
        if (*best == NONE || tree->radius_mm[i] > tree->radius_mm[*best])
            *best = (int32_t)i;
    }
    double branches = 0;
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        size_t parent = (size_t)tree->parent[i];
        bool continues = tree_is_segment(tree, parent) && thickest[parent] == (int32_t)i;
        value[i] = continues ? value[parent] : ++branches;
    }
    free(thickest);
    return STATUS_OK;
}
