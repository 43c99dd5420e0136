/* Checks that a tree can be refined, before memory is allocated for it. Refinement requires more of
 * a tree than a file guarantees: one or two children at a root; two or none elsewhere, after
 * vessels of several segments are made straight; segments longer than 0; flow that leaves only at
 * terminals; all numbers of the law (gamma, lambda, pressures, flow, viscosity); and positions
 * inside the domain. */
#include "grow/refine/refine_arbor.h"

#include <stdlib.h>

static Status check_meta(const TreeMeta *meta, Err *err)
{
    Status status = meta_check_cco(meta, META_OF_FILE, err);
    if (status != STATUS_OK)
        err_prefix(err, "the tree cannot be refined: ");
    return status;
}

/* Returns the node at which the vessel that ends at node i begins: the nearest node above it that
 * is a root or has two children. */
static size_t proximal(const Tree *tree, const int32_t *children, size_t i)
{
    do
        i = (size_t)tree->parent[i];
    while (tree_is_segment(tree, i) && children[i] == 1);
    return i;
}

static Status check_node(const Tree *tree, const int32_t *counts, size_t i, Err *err)
{
    int32_t id = tree->id[i], children = counts[i];
    if (children > 2)
        return err_set(err, STATUS_INPUT,
                       "node %d has %d children; refinement needs a tree in which no node has more "
                       "than 2",
                       id, children);
    if (!tree_is_segment(tree, i) && children == 0)
        return err_set(err, STATUS_INPUT, "node %d is a root without a vessel", id);
    if (tree_is_segment(tree, i) && children != 1 &&
        !(vec3_distance(tree->position[i], tree->position[proximal(tree, counts, i)]) > 0))
        return err_set(err, STATUS_INPUT,
                       "node %d has the same position as the start of its vessel; refinement needs "
                       "vessels longer than 0",
                       id);
    if (tree->flow_share && (children == 0 ? !(tree->flow_share[i] > 0) : tree->flow_share[i] != 0))
        return err_set(err, STATUS_INPUT,
                       "the flow share of node %d is %g; refinement needs a share above 0 at each "
                       "terminal and 0 at all other nodes",
                       id, tree->flow_share[i]);
    return STATUS_OK;
}

static Status check_inside(const Tree *tree, const int32_t *counts, size_t i, const Domain *domain,
                           Err *err)
{
    if (tree_is_segment(tree, i) && counts[i] == 1)
        return STATUS_OK;
    Vec3 at = tree->position[i];
    if (!domain_inside(domain, at, domain->slack_mm))
        return err_set(err, STATUS_INPUT,
                       "node %d at (%.9g, %.9g, %.9g) is outside the domain; all nodes "
                       "must be inside",
                       tree->id[i], at.x, at.y, at.z);
    if (tree_is_segment(tree, i) && !domain_is_convex(domain) &&
        !domain_holds_segment(domain, tree->position[proximal(tree, counts, i)], at))
        return err_set(err, STATUS_INPUT,
                       "the vessel that ends in node %d leaves the domain when it is straight; "
                       "refinement needs the whole tree inside",
                       tree->id[i]);
    return STATUS_OK;
}

Status refine_check(const RefineParams *params, const Domain *domain, const Tree *tree, Err *err)
{
    char number[NUMBER_TEXT_SIZE];
    if (!(params->seconds >= 0) || !isfinite(params->seconds))
        return err_set(err, STATUS_USAGE, "`seconds` is %s; it must be a finite number, 0 or more",
                       number_text(params->seconds, number));
    TRY(check_meta(&tree->meta, err));
    int32_t *children = NULL;
    TRY(tree_child_counts(tree, &children, err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < tree->n && status == STATUS_OK; i++) {
        status = check_node(tree, children, i, err);
        if (status == STATUS_OK && domain)
            status = check_inside(tree, children, i, domain, err);
    }
    free(children);
    return status;
}
