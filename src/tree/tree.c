/* Creates, checks, prunes and measures trees of vessel segments.
 *
 * A tree is one array per quantity, indexed by node, with parents before their children. All
 * functions are loops over these arrays, and none is recursive, so a chain of a million segments
 * needs no deep stack. */
#include "tree/tree.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

Status tree_init(Tree *tree, size_t n, Err *err)
{
    assert(n >= 1);
    if (n > TREE_MAX_ID)
        return err_set(err, STATUS_INFEASIBLE, "a tree of %zu nodes is too large: at most %d", n,
                       TREE_MAX_ID);
    Tree made = {.n = n};
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.id, n, sizeof *made.id, "node ids", err));
    TRY_GOTO(mem_calloc(&made.type, n, sizeof *made.type, "node types", err));
    TRY_GOTO(mem_calloc(&made.parent, n, sizeof *made.parent, "node parents", err));
    TRY_GOTO(mem_calloc(&made.position, n, sizeof *made.position, "node positions", err));
    TRY_GOTO(mem_calloc(&made.radius_mm, n, sizeof *made.radius_mm, "node radii", err));
    for (size_t i = 0; i < n; i++)
        made.parent[i] = TREE_NO_PARENT;
    *tree = made;
done:
    if (status != STATUS_OK)
        tree_release(&made);
    return status;
}

static void release_column(TreeColumn *column)
{
    free(column->name);
    free(column->unit);
    free(column->value);
}

void tree_release(Tree *tree)
{
    free(tree->id);
    free(tree->type);
    free(tree->parent);
    free(tree->position);
    free(tree->radius_mm);
    free(tree->link);
    free(tree->flow_share);
    for (size_t k = 0; k < tree->n_columns; k++)
        release_column(&tree->column[k]);
    free(tree->column);
    meta_release(&tree->meta);
    *tree = (Tree){0};
}

void tree_hash(const Tree *tree, Hash *hash)
{
    const TreeMeta *meta = &tree->meta;
    size_t n = tree->n;
    hash_add(hash, &n, sizeof n);
    hash_add(hash, tree->id, n * sizeof *tree->id);
    hash_add(hash, tree->type, n * sizeof *tree->type);
    hash_add(hash, tree->parent, n * sizeof *tree->parent);
    hash_add(hash, tree->position, n * sizeof *tree->position);
    hash_add(hash, tree->radius_mm, n * sizeof *tree->radius_mm);
    hash_add(hash, tree->link, tree->link ? n * sizeof *tree->link : 0);
    hash_add(hash, tree->flow_share, tree->flow_share ? n * sizeof *tree->flow_share : 0);
    for (size_t k = 0; k < tree->n_columns; k++) {
        hash_add_text(hash, tree->column[k].name);
        hash_add_text(hash, tree->column[k].unit);
        hash_add(hash, tree->column[k].value, n * sizeof *tree->column[k].value);
    }
    hash_add(hash, meta->known, sizeof meta->known);
    for (MetaKey key = 0; key < META_KEYS; key++)
        if (meta->known[key])
            hash_add(hash, &meta->number[key], sizeof meta->number[key]);
}

bool tree_has_types(const Tree *tree)
{
    size_t i = 0;
    while (i < tree->n && tree->type[i] == TREE_VESSEL_TYPE)
        i++;
    return i < tree->n;
}

int32_t tree_max_id(const Tree *tree)
{
    int32_t last = 0;
    for (size_t i = 0; i < tree->n; i++)
        last = tree->id[i] > last ? tree->id[i] : last;
    return last;
}

double tree_root_radius(const Tree *tree)
{
    double radius = 0;
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i) || !tree_is_segment(tree, (size_t)tree->parent[i]))
            radius = fmax(radius, tree->radius_mm[i]);
    return radius;
}

Status tree_child_counts(const Tree *tree, int32_t **count, Err *err)
{
    int32_t *counted = NULL;
    TRY(mem_calloc(&counted, tree->n, sizeof *counted, "child counts", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            counted[tree->parent[i]]++;
    for (size_t i = 0; i < tree->n && tree->link; i++)
        if (tree_has_link(tree, i)) {
            counted[tree->link[i]]++;
            counted[i] = 1;
        }
    *count = counted;
    return STATUS_OK;
}

size_t tree_link_count(const Tree *tree)
{
    size_t links = 0;
    for (size_t i = 0; i < tree->n && tree->link; i++)
        links += tree_has_link(tree, i);
    return links;
}

Status tree_add_links(Tree *tree, Err *err)
{
    assert(!tree->link);
    TRY(mem_calloc(&tree->link, tree->n, sizeof *tree->link, "links", err));
    for (size_t i = 0; i < tree->n; i++)
        tree->link[i] = TREE_NO_LINK;
    return STATUS_OK;
}

Status tree_components(const Tree *tree, uint32_t **component, size_t *n, Err *err)
{
    uint32_t *set = NULL;
    TRY(mem_alloc(&set, tree->n, sizeof *set, "components", err));
    for (size_t i = 0; i < tree->n; i++)
        set[i] = tree_is_segment(tree, i) ? set[tree->parent[i]] : (uint32_t)i;
    for (size_t i = 0; i < tree->n && tree->link; i++)
        if (tree_has_link(tree, i))
            sets_join(set, (uint32_t)i, (uint32_t)tree->link[i]);
    *n = 0;
    for (size_t i = 0; i < tree->n; i++) /* set[i] <= i: earlier nodes have their number */
        set[i] = set[i] == i ? (uint32_t)(*n)++ : set[set[i]];
    *component = set;
    return STATUS_OK;
}

Status tree_loop_count(const Tree *tree, size_t *loops, Err *err)
{
    uint32_t *component;
    size_t components, roots = 0;
    TRY(tree_components(tree, &component, &components, err));
    free(component);
    for (size_t i = 0; i < tree->n; i++)
        roots += !tree_is_segment(tree, i);
    *loops = tree_link_count(tree) + components - roots;
    return STATUS_OK;
}

Status tree_add_flow_shares(Tree *tree, Err *err)
{
    assert(!tree->flow_share);
    return mem_calloc(&tree->flow_share, tree->n, sizeof *tree->flow_share, "flow shares", err);
}

const TreeColumn *tree_column(const Tree *tree, const char *name)
{
    for (size_t k = 0; k < tree->n_columns; k++)
        if (strcmp(tree->column[k].name, name) == 0)
            return &tree->column[k];
    return NULL;
}

Status tree_add_column(Tree *tree, const char *name, const char *unit, double **value, Err *err)
{
    assert(*name && !tree_column(tree, name));
    TreeColumn made = {0};
    Status status = STATUS_OK;
    size_t capacity = tree->n_columns;
    TRY_GOTO(mem_strdup(&made.name, name, err));
    TRY_GOTO(mem_strdup(&made.unit, unit, err));
    TRY_GOTO(mem_calloc(&made.value, tree->n, sizeof *made.value, "values of a column", err));
    TRY_GOTO(mem_reserve(&tree->column, &capacity, capacity + 1, sizeof made, "columns", err));
    for (size_t i = 0; i < tree->n; i++)
        made.value[i] = (double)NAN;
    tree->column[tree->n_columns++] = made;
    *value = made.value;
done:
    if (status != STATUS_OK)
        release_column(&made);
    return status;
}

Status tree_set_column(Tree *tree, const char *name, const char *unit, double **value, Err *err)
{
    const TreeColumn *there = tree_column(tree, name);
    if (!there)
        return tree_add_column(tree, name, unit, value, err);
    TreeColumn *column = &tree->column[there - tree->column];
    char *copy;
    TRY(mem_strdup(&copy, unit, err));
    free(column->unit);
    column->unit = copy;
    for (size_t i = 0; i < tree->n; i++)
        column->value[i] = (double)NAN;
    *value = column->value;
    return STATUS_OK;
}

Status tree_flow_shares(const Tree *tree, double **share, Err *err)
{
    double *made = NULL;
    int32_t *children = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made, tree->n, sizeof *made, "flow shares", err));
    if (tree->flow_share) {
        memcpy(made, tree->flow_share, tree->n * sizeof *made);
    } else {
        TRY_GOTO(tree_child_counts(tree, &children, err));
        for (size_t i = 0; i < tree->n; i++)
            made[i] = tree_is_segment(tree, i) && children[i] == 0;
    }
    *share = made;
done:
    if (status != STATUS_OK)
        free(made);
    free(children);
    return status;
}

/* Checks one node: id, parent, position, radius and share. */
static Status check_node(const Tree *tree, size_t i, Err *err)
{
    int32_t id = tree->id[i], parent = tree->parent[i];
    char number[NUMBER_TEXT_SIZE];
    if (id < 1 || id > TREE_MAX_ID)
        return err_set(err, STATUS_INPUT, "node %d: the id must be in 1 .. %d", id, TREE_MAX_ID);
    if (parent != TREE_NO_PARENT && (parent < 0 || (size_t)parent >= i))
        return err_set(err, STATUS_INPUT, "node %d: its parent does not come before it", id);
    if (!vec3_finite(tree->position[i]))
        return err_set(err, STATUS_INPUT, "node %d: the position is not finite", id);
    if (!isfinite(tree->radius_mm[i]) || tree->radius_mm[i] < 0)
        return err_set(err, STATUS_INPUT, "node %d: radius %s; it must be finite and not negative",
                       id, number_text(tree->radius_mm[i], number));
    if (tree->flow_share && !(isfinite(tree->flow_share[i]) && tree->flow_share[i] >= 0))
        return err_set(err, STATUS_INPUT,
                       "node %d: flow share %s; it must be finite and not negative", id,
                       number_text(tree->flow_share[i], number));
    return STATUS_OK;
}

/* Checks the link of node i. `others` has, per node, the count of tree_child_counts. */
static Status check_link(const Tree *tree, size_t i, const int32_t *others, Err *err)
{
    int32_t id = tree->id[i], to = tree->link[i];
    const char *fault = NULL;
    if (to < 0 || (size_t)to >= tree->n || (size_t)to == i)
        return err_set(err, STATUS_INPUT, "node %d: its link does not name another node", id);
    if (!tree_is_segment(tree, i))
        fault = "a root cannot have a link";
    else if (others[i] != 0)
        fault = "a node with a link cannot have children or be named by a link";
    else if (!tree_is_segment(tree, (size_t)to) && others[to] == 1)
        fault = "the link names a root that no other segment leaves";
    else if (memcmp(&tree->position[i], &tree->position[to], sizeof *tree->position) != 0)
        fault = "its position differs from that of the node that its link names";
    else if (tree->flow_share && tree->flow_share[i] > 0)
        fault = "a node with a link cannot have a flow share";
    return fault ? err_set(err, STATUS_INPUT, "node %d: %s", id, fault) : STATUS_OK;
}

Status tree_check_links(const Tree *tree, Err *err)
{
    int32_t *others = NULL;
    if (!tree->link)
        return STATUS_OK;
    Status status = STATUS_OK;
    TRY(mem_calloc(&others, tree->n, sizeof *others, "counts of segments", err));
    for (size_t i = 0; i < tree->n; i++) {
        if (tree_is_segment(tree, i))
            others[tree->parent[i]]++;
        if (tree_has_link(tree, i) && tree->link[i] >= 0 && (size_t)tree->link[i] < tree->n)
            others[tree->link[i]]++;
    }
    for (size_t i = 0; i < tree->n && status == STATUS_OK; i++)
        if (tree_has_link(tree, i))
            status = check_link(tree, i, others, err);
    free(others);
    return status;
}

Status tree_check(const Tree *tree, Err *err)
{
    if (tree->n == 0)
        return err_set(err, STATUS_INPUT, "the tree has no nodes; at least one is needed");
    for (size_t i = 0; i < tree->n; i++)
        TRY(check_node(tree, i, err));
    TRY(tree_check_links(tree, err));
    uint8_t *seen = NULL; /* one bit per id */
    TRY(mem_calloc(&seen, (size_t)tree_max_id(tree) / 8 + 1, 1, "bytes of seen ids", err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < tree->n; i++) {
        uint8_t *byte = &seen[tree->id[i] / 8];
        uint8_t bit = (uint8_t)(1u << tree->id[i] % 8);
        if (*byte & bit)
            TRY_GOTO(
                err_set(err, STATUS_INPUT, "node %d: another node has the same id", tree->id[i]));
        *byte |= bit;
    }
done:
    free(seen);
    return status;
}

enum { DROPPED = -1 };

/* Sets the flow shares of `out`. The shares of dropped nodes are added to the share of their
 * nearest kept ancestor. The loop runs backwards, so that a node has the shares of its whole
 * subtree before it passes them on. `place` has, per node of `tree`, its index in `out`. */
static Status prune_flow_shares(const Tree *tree, const int32_t *place, Tree *out, Err *err)
{
    if (out->n == tree->n && !tree->flow_share)
        return STATUS_OK;
    TRY(tree_add_flow_shares(out, err));
    double *share = NULL;
    TRY(tree_flow_shares(tree, &share, err));
    for (size_t i = tree->n; i-- > 0;) {
        if (place[i] == DROPPED)
            share[tree->parent[i]] += share[i];
        else
            out->flow_share[place[i]] = share[i];
    }
    free(share);
    if (!tree->flow_share)
        out->meta.known[META_TERMINAL_FLOW] = false;
    return STATUS_OK;
}

/* Copies the columns of the kept nodes. */
static Status prune_columns(const Tree *tree, const int32_t *place, Tree *out, Err *err)
{
    for (size_t k = 0; k < tree->n_columns; k++) {
        const TreeColumn *column = &tree->column[k];
        double *value;
        TRY(tree_add_column(out, column->name, column->unit, &value, err));
        for (size_t i = 0; i < tree->n; i++)
            if (place[i] != DROPPED)
                value[place[i]] = column->value[i];
    }
    return STATUS_OK;
}

/* Frees the array of links if no node has a link. */
static void drop_empty_links(Tree *tree)
{
    if (tree_link_count(tree) > 0)
        return;
    free(tree->link);
    tree->link = NULL;
}

/* Copies the links whose two nodes are kept. */
static Status prune_links(const Tree *tree, const int32_t *place, Tree *out, Err *err)
{
    if (!tree->link)
        return STATUS_OK;
    TRY(tree_add_links(out, err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_has_link(tree, i) && place[i] != DROPPED && place[tree->link[i]] != DROPPED)
            out->link[place[i]] = place[tree->link[i]];
    drop_empty_links(out);
    return STATUS_OK;
}

/* Makes a new tree of the nodes that have an index in `place`. */
static Status take_placed(const Tree *tree, const int32_t *place, size_t n, Tree *out, Err *err)
{
    Tree made = {0};
    Status status = STATUS_OK;
    TRY_GOTO(tree_init(&made, n, err));
    TRY_GOTO(meta_copy(&made.meta, &tree->meta, err));
    for (size_t i = 0; i < tree->n; i++) {
        int32_t at = place[i];
        if (at == DROPPED)
            continue;
        made.id[at] = tree->id[i];
        made.type[at] = tree->type[i];
        made.parent[at] = tree_is_segment(tree, i) ? place[tree->parent[i]] : TREE_NO_PARENT;
        made.position[at] = tree->position[i];
        made.radius_mm[at] = tree->radius_mm[i];
    }
    TRY_GOTO(prune_links(tree, place, &made, err));
    TRY_GOTO(prune_flow_shares(tree, place, &made, err));
    TRY_GOTO(prune_columns(tree, place, &made, err));
    *out = made;
done:
    if (status != STATUS_OK)
        tree_release(&made);
    return status;
}

Status tree_prune_copy(const Tree *tree, double radius_mm, Tree *out, Err *err)
{
    int32_t *place = NULL; /* per node: its index in the new tree, or DROPPED */
    TRY(mem_calloc(&place, tree->n, sizeof *place, "node places", err));
    int32_t n = 0;
    for (size_t i = 0; i < tree->n; i++) {
        bool kept = !tree_is_segment(tree, i) ||
                    (place[tree->parent[i]] != DROPPED && !(tree->radius_mm[i] < radius_mm));
        place[i] = kept ? n++ : DROPPED;
    }
    Status status = take_placed(tree, place, (size_t)n, out, err);
    free(place);
    return status;
}

/* Measures the path length from the root to each node, mm. Returns the longest one. */
static double measure_paths(const Tree *tree, double *path)
{
    double longest = 0;
    for (size_t i = 0; i < tree->n; i++) {
        path[i] =
            tree_is_segment(tree, i) ? path[tree->parent[i]] + tree_segment_length(tree, i) : 0;
        longest = fmax(longest, path[i]);
    }
    return longest;
}

/* Shortens the segments that lead beyond the path length `reach`. A shortened segment no longer
 * ends at the node that its link names, so the link is removed. */
static void cut_ends(const Tree *tree, const int32_t *place, const double *path, double reach,
                     Tree *part)
{
    for (size_t i = 0; i < tree->n; i++) {
        if (place[i] == DROPPED || !(path[i] > reach))
            continue;
        size_t parent = (size_t)tree->parent[i];
        double share = (reach - path[parent]) / (path[i] - path[parent]);
        Vec3 from = tree->position[parent], span = vec3_sub(tree->position[i], from);
        part->position[place[i]] = vec3_add_scaled(from, span, share);
        if (part->link)
            part->link[place[i]] = TREE_NO_LINK;
    }
    drop_empty_links(part);
}

Status tree_proximal_part(const Tree *tree, double part, Tree *out, Err *err)
{
    int32_t *place = NULL, n = 0;
    double *path = NULL;
    Status status;
    TRY_GOTO(mem_calloc(&place, tree->n, sizeof *place, "node places", err));
    TRY_GOTO(mem_calloc(&path, tree->n, sizeof *path, "path lengths", err));
    double longest = measure_paths(tree, path), reach = part < 1 ? part * longest : longest;
    for (size_t i = 0; i < tree->n; i++) {
        bool kept =
            !tree_is_segment(tree, i) || (place[tree->parent[i]] != DROPPED &&
                                          (path[tree->parent[i]] < reach || !(path[i] > reach)));
        place[i] = kept ? n++ : DROPPED;
    }
    TRY_GOTO(take_placed(tree, place, (size_t)n, out, err));
    cut_ends(tree, place, path, reach, out);
done:
    free(place);
    free(path);
    return status;
}

void tree_renumber(Tree *tree)
{
    for (size_t i = 0; i < tree->n; i++)
        tree->id[i] = (int32_t)i + 1;
}

Box tree_bounds(const Tree *tree)
{
    Box box = box_empty();
    for (size_t i = 0; i < tree->n; i++) {
        box = box_with_ball(box, tree->position[i], tree->radius_mm[i]);
        if (tree_is_segment(tree, i))
            box = box_with_ball(box, tree->position[tree->parent[i]], tree->radius_mm[i]);
    }
    return box;
}
