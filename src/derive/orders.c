/* Computes the level, the Strahler order, the branch and the connected component of each segment.
 *
 * Each takes one or two sweeps over the arrays of the tree, in which parents come before children.
 * A forward sweep computes what depends on the path to the root (level, branch); a backward sweep
 * computes what depends on the subtree (Strahler order). There is no recursion, so a tree of any
 * depth needs no stack. */
#include "derive/fields.h"

#include <stdlib.h>
#include <string.h>

/* Lowers the level of a segment to the level of a path that comes from the node `from`, one of its
 * ends: one more than the lowest level there if paths branch there. Then lowers at[to]. `at` has,
 * per node, the lowest level of a segment there, 0 at roots. Returns true if a number changed. */
static bool lower_level(double *level, double *at, size_t from, size_t to, const int32_t *others)
{
    double behind = at[from] + (others[from] >= 2);
    bool lowers = behind < *level;
    if (lowers)
        *level = behind;
    if (!(*level < at[to]))
        return lowers;
    at[to] = *level;
    return true;
}

/* Lowers the levels of a network with loops: the path with the fewest bifurcations from a root may
 * lead along links and against the direction of segments. Sweeps in both directions of the arrays
 * are repeated until no level changes. */
static Status lower_levels(const Tree *tree, const int32_t *others, double *value, Err *err)
{
    double *at = NULL;
    bool changes = true;
    TRY(mem_alloc(&at, tree->n, sizeof *at, "levels", err));
    memcpy(at, value, tree->n * sizeof *at);
    for (bool forward = true; changes; forward = !forward) {
        changes = false;
        for (size_t k = 0; k < tree->n; k++) {
            size_t i = forward ? k : tree->n - 1 - k;
            if (!tree_is_segment(tree, i))
                continue;
            size_t start = (size_t)tree->parent[i], end = tree_linked_node(tree, i);
            changes |= lower_level(&value[i], at, start, end, others);
            changes |= lower_level(&value[i], at, end, start, others);
        }
    }
    free(at);
    return STATUS_OK;
}

Status field_level(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    int32_t *others = NULL;
    TRY(tree_child_counts(tree, &others, err));
    for (size_t i = 0; i < tree->n; i++) {
        int32_t parent = tree->parent[i];
        value[i] = parent == TREE_NO_PARENT ? 0 : value[parent] + (others[parent] >= 2);
    }
    Status status = tree->link ? lower_levels(tree, others, value, err) : STATUS_OK;
    free(others);
    return status;
}

void orders_set_unknown(const Tree *tree, double *value)
{
    for (size_t i = 0; i < tree->n; i++)
        value[i] = (double)NAN;
}

/* The backward sweep visits all children of a node before the node. Until then value[i] is
 * the largest order among its children so far, and alike[i] the number of children that have
 * this order. */
Status field_strahler(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    int32_t *alike = NULL;
    if (tree->link) {
        orders_set_unknown(tree, value);
        return STATUS_OK;
    }
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

void lineage_bounded_orders(const Lineage *lineage, const double *bound_mm, size_t n,
                            int32_t *order)
{
    memset(order, 0, lineage->n * sizeof *order);
    for (size_t i = lineage->n; i-- > 0;) {
        /* order[i] is the largest order among the daughters so far. */
        int32_t own = 1, parent = lineage->parent[i];
        for (size_t k = 0; k < n; k++)
            own += 2 * lineage->radius_mm[i] > bound_mm[k];
        order[i] = own > order[i] ? own : order[i];
        if (parent >= 0 && order[i] > order[parent])
            order[parent] = order[i];
    }
}

void lineage_main_daughters(const Lineage *lineage, const int32_t *order, int32_t *heir)
{
    const double *radius = lineage->radius_mm;
    for (size_t i = 0; i < lineage->n; i++) {
        heir[i] = -1;
        int32_t parent = lineage->parent[i];
        if (parent < 0 || (order && order[parent] != order[i]))
            continue;
        if (heir[parent] < 0 || radius[i] > radius[heir[parent]])
            heir[parent] = (int32_t)i;
    }
}

Status field_tree(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    uint32_t *component = NULL;
    size_t n;
    TRY(tree_components(tree, &component, &n, err));
    for (size_t i = 0; i < tree->n; i++)
        value[i] = component[i] + 1.0;
    free(component);
    return STATUS_OK;
}

Status field_branch(const Tree *tree, const TreeMeta *overrides, double *value, Err *err)
{
    (void)overrides;
    int32_t *thickest = NULL;
    TRY(mem_calloc(&thickest, tree->n, sizeof *thickest, "thickest daughters", err));
    lineage_main_daughters(&(Lineage){tree->parent, tree->radius_mm, tree->n}, NULL, thickest);
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
