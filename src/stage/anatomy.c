/* Orders and the main branch are fields of `derive`. A network with loops has no orders. */
#include "derive/derive.h"
#include "stage/stage.h"

#include <stdlib.h>

static Status set_orders(const Tree *tree, int *order, Err *err)
{
    Field strahler = {0};
    if (tree->link)
        return STATUS_OK;
    TRY(derive_computed_field(tree, &(TreeMeta){0}, "strahler", &strahler, err));
    for (size_t i = 0; i < tree->n; i++)
        order[i] = tree_is_segment(tree, i) ? (int)strahler.value[i] : 0;
    field_release(&strahler);
    return STATUS_OK;
}

/* Trees that links connect are one tree, whose root is the first of their roots. */
static Status set_trees(const Tree *tree, Vec3 origin, Anatomy *anatomy, Err *err)
{
    TRY(tree_components(tree, &anatomy->component, &anatomy->n_trees, err));
    for (size_t i = tree->n; i-- > 0;)
        if (!tree_is_segment(tree, i))
            anatomy->root[anatomy->component[i]] = vec3_sub(tree->position[i], origin);
    return STATUS_OK;
}

static void add_to_path(Anatomy *anatomy, Vec3 point)
{
    size_t n = anatomy->n_main_branch;
    if (n == 0 || vec3_length(vec3_sub(point, anatomy->main_branch[n - 1])) > 0)
        anatomy->main_branch[anatomy->n_main_branch++] = point;
}

/* Returns the thickest segment that starts at the first root, node 0; 0 if there is none. */
static size_t first_of_path(const Tree *tree)
{
    size_t thickest = 0;
    for (size_t i = 1; i < tree->n; i++)
        if (tree->parent[i] == 0 &&
            (thickest == 0 || tree->radius_mm[i] > tree->radius_mm[thickest]))
            thickest = i;
    return thickest;
}

/* Follows the main branch along the segments of the tree, or along the pieces of `smooth`. */
static Status set_path(const Tree *tree, const SmoothTree *smooth, Vec3 origin, Anatomy *anatomy,
                       Err *err)
{
    const Tree *points = smooth ? &smooth->tree : tree;
    Field branch = {0};
    TRY(derive_computed_field(tree, &(TreeMeta){0}, "branch", &branch, err));
    size_t first = first_of_path(tree);
    add_to_path(anatomy, anatomy->root[0]);
    for (size_t i = 1; first > 0 && i < points->n; i++) {
        size_t segment = smooth ? smooth->segment[i] : i;
        if (segment >= first && branch.value[segment] == branch.value[first])
            add_to_path(anatomy, vec3_sub(points->position[i], origin));
    }
    field_release(&branch);
    return STATUS_OK;
}

Status stage_anatomy(const Tree *tree, const SmoothTree *smooth, Vec3 origin, Anatomy *anatomy,
                     Err *err)
{
    const Tree *drawn = smooth ? &smooth->tree : tree; /* the pieces have the orders of segments */
    Anatomy made = {0};
    Status status;
    TRY_GOTO(mem_calloc(&made.order, drawn->n, sizeof *made.order, "orders", err));
    TRY_GOTO(mem_calloc(&made.root, drawn->n, sizeof *made.root, "roots", err));
    TRY_GOTO(mem_calloc(&made.main_branch, drawn->n, sizeof *made.main_branch, "main branch", err));
    TRY_GOTO(set_orders(drawn, made.order, err));
    TRY_GOTO(set_trees(drawn, origin, &made, err));
    TRY_GOTO(set_path(tree, smooth, origin, &made, err));
    *anatomy = made;
    made = (Anatomy){0};
done:
    anatomy_release(&made);
    return status;
}
