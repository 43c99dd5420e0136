/* Continues the growth of an existing tree (`from`): checks it, copies it into the network, and
 * restores its ids, types and columns at the end.
 *
 * The nodes of the tree become nodes of the network one by one, in order. Each remembers its index
 * in the tree (origin), because network_reorder renumbers the nodes.
 *
 * A vessel that consists of several segments is recognised by its nodes with one child. Its
 * pieces may be much shorter than wide, as in measured trees, so growth does not apply its own
 * rules to them. */
#include "grow/continue_tree.h"

#include <stdlib.h>
#include <string.h>

size_t continue_count_roots(const Tree *from)
{
    size_t count = 0;
    for (size_t i = 0; i < from->n; i++)
        count += !tree_is_segment(from, i);
    return count;
}

/* Checks node i, which has `children` children. */
static Status check_node(const Tree *from, size_t i, int32_t children, const Domain *domain,
                         bool keep_radii, Err *err)
{
    int32_t id = from->id[i];
    if (children > 2)
        return err_set(err, STATUS_INPUT,
                       "`from`: node %d has %d children; growth can continue only a tree in which "
                       "no node has more than 2",
                       id, children);
    if (!tree_is_segment(from, i) && children == 0)
        return err_set(err, STATUS_INPUT, "`from`: node %d is an inlet without a vessel", id);
    if (tree_is_segment(from, i) && children == 0 && !(tree_segment_length(from, i) > 0))
        return err_set(err, STATUS_INPUT,
                       "`from`: node %d, a terminal, has the position of its parent; its segment "
                       "must be longer than 0",
                       id);
    if (keep_radii && tree_is_segment(from, i) && !(from->radius_mm[i] > 0))
        return err_set(err, STATUS_INPUT,
                       "`from`: node %d has radius 0; `keep_radii` needs radii above 0", id);
    if (domain->dimension == 2 && from->position[i].z != 0)
        return err_set(err, STATUS_INPUT,
                       "`from`: node %d is at z = %g; the `domain` has two dimensions, so all "
                       "nodes must be at z = 0",
                       id, from->position[i].z);
    return STATUS_OK;
}

/* Returns the distance, mm, of a point from the box, along the axis along which it is farthest; 0
 * or less inside. */
static double beyond(Box box, Vec3 point)
{
    Vec3 below = vec3_sub(box.low, point), above = vec3_sub(point, box.high);
    return fmax(fmax(fmax(below.x, above.x), fmax(below.y, above.y)), fmax(below.z, above.z));
}

size_t continue_count_outside(const Tree *from, const Domain *domain, size_t *farthest, double *mm)
{
    size_t count = 0;
    double most = -INFINITY;
    for (size_t i = 0; i < from->n; i++) {
        Vec3 at = from->position[i];
        if (domain_inside(domain, at, domain->slack_mm))
            continue;
        count++;
        if (beyond(domain->bounds, at) <= most)
            continue;
        most = beyond(domain->bounds, at);
        *farthest = i;
    }
    double size = vec3_distance(domain->bounds.low, domain->bounds.high);
    *mm = count ? domain_distance(domain, from->position[*farthest], 2 * fmax(most, 0) + size) : 0;
    return count;
}

/* Checks that at least a part of the tree is in the domain. */
static Status check_place(const Tree *from, const Domain *domain, Err *err)
{
    size_t farthest = 0;
    double mm;
    if (continue_count_outside(from, domain, &farthest, &mm) < from->n)
        return STATUS_OK;
    Box tree = tree_bounds(from), box = domain->bounds;
    return err_set(
        err, STATUS_INPUT,
        "`from`: the whole tree is outside the domain: the tree extends from x %.4g to %.4g, "
        "y %.4g to %.4g, z %.4g to %.4g mm, the domain from x %.4g to %.4g, y %.4g to %.4g, "
        "z %.4g to %.4g mm; node %d is %.3g mm outside. Move the domain with @X,Y,Z, or use "
        "hull:MM, a hull around the tree",
        tree.low.x, tree.high.x, tree.low.y, tree.high.y, tree.low.z, tree.high.z, box.low.x,
        box.high.x, box.low.y, box.high.y, box.low.z, box.high.z, from->id[farthest], mm);
}

Status continue_check(const GrowParams *params, const Domain *domain, Err *err)
{
    const Tree *from = params->from;
    size_t inlets = continue_count_roots(from), terminals = 0;
    if (params->inlets > 0)
        return err_set(err, STATUS_USAGE,
                       "`inlet` cannot be combined with `from`, whose tree has its own inlets");
    if (inlets > GROW_MAX_INLETS)
        return err_set(err, STATUS_INPUT, "`from`: the tree has %zu roots; at most %d can grow",
                       inlets, GROW_MAX_INLETS);
    int32_t *children = NULL;
    TRY(tree_child_counts(from, &children, err));
    Status status = STATUS_OK;
    for (size_t i = 0; i < from->n; i++) {
        TRY_GOTO(check_node(from, i, children[i], domain, params->keep_radii, err));
        terminals += children[i] == 0;
    }
    TRY_GOTO(check_place(from, domain, err));
    if (params->terminals <= terminals)
        status =
            err_set(err, STATUS_USAGE,
                    "`terminals` is %zu; it must be above %zu, the number in the tree of `from`",
                    params->terminals, terminals);
done:
    free(children);
    return status;
}

/* Returns true if the vessel that the segment i is part of has other segments. */
static bool is_piece(const Network *net, int32_t i)
{
    const Segment *segment = &net->segment[i], *above = &net->segment[segment->parent];
    bool goes_on = segment->child[0] >= 0 && segment->child[1] < 0;
    return goes_on || (above->parent >= 0 && above->child[1] < 0);
}

void continue_copy(const Tree *from, Network *net)
{
    for (size_t i = 0; i < from->n; i++) {
        int32_t node = network_append(net, from->parent[i], from->position[i]);
        net->trait[node].origin = (int32_t)i;
        net->trait[node].given = tree_is_segment(from, i);
    }
    for (size_t i = 0; i < net->n; i++)
        net->trait[i].piece = net->trait[i].given && is_piece(net, (int32_t)i);
    for (size_t i = 0; net->trunk && i < net->n; i++)
        net->trunk->radius[i] = net->trait[i].given ? from->radius_mm[i] : 0;
    network_resum(net);
}

/* Gives the nodes of `from` their ids, types and, with keep_radii, radii. New nodes get the lowest
 * unused ids. */
static Status restore_nodes(const Tree *from, const Network *net, Tree *out, Err *err)
{
    bool *taken = NULL; /* by id */
    int32_t last = tree_max_id(from), id = 1;
    TRY(mem_calloc(&taken, (size_t)last + 1, sizeof *taken, "seen ids", err));
    for (size_t i = 0; i < from->n; i++)
        taken[from->id[i]] = true;
    for (size_t i = 0; i < out->n; i++) {
        int32_t origin = net->trait[i].origin;
        if (origin >= 0) {
            out->id[i] = from->id[origin];
            out->type[i] = from->type[origin];
            if (net->trunk && from->radius_mm[origin] > 0)
                out->radius_mm[i] = from->radius_mm[origin];
            continue;
        }
        while (id <= last && taken[id])
            id++;
        out->id[i] = id++;
    }
    free(taken);
    return STATUS_OK;
}

/* Adds the columns of `from`. New nodes have NAN there. */
static Status restore_columns(const Tree *from, const Network *net, Tree *out, Err *err)
{
    for (size_t k = 0; k < from->n_columns; k++) {
        const TreeColumn *column = &from->column[k];
        double *value;
        TRY(tree_add_column(out, column->name, column->unit, &value, err));
        for (size_t i = 0; i < out->n; i++)
            if (net->trait[i].origin >= 0)
                value[i] = column->value[net->trait[i].origin];
    }
    return STATUS_OK;
}

Status continue_restore(const Tree *from, const Network *net, Tree *out, Err *err)
{
    TRY(restore_nodes(from, net, out, err));
    TRY(restore_columns(from, net, out, err));
    for (size_t i = 0; i < from->meta.n_lines; i++)
        if (from->meta.line[i].text)
            TRY(meta_add_text(&out->meta, from->meta.line[i].key, from->meta.line[i].text, err));
    return STATUS_OK;
}

Status continue_radius_changes(const Tree *from, const Tree *out, GrowReport *report, Err *err)
{
    int32_t *node = NULL; /* of `from`, by id, plus 1 */
    double *change = NULL;
    size_t n = 0;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&node, (size_t)tree_max_id(out) + 1, sizeof *node, "ids", err));
    TRY_GOTO(mem_calloc(&change, from->n, sizeof *change, "radii", err));
    for (size_t i = 0; i < from->n; i++)
        if (tree_is_segment(from, i) && from->radius_mm[i] > 0)
            node[from->id[i]] = (int32_t)i + 1;
    for (size_t i = 0; i < out->n; i++)
        if (node[out->id[i]] > 0)
            change[n++] = out->radius_mm[i] / from->radius_mm[node[out->id[i]] - 1];
    sort_numbers(change, n);
    if (n > 0) {
        report->median_change = (change[(n - 1) / 2] + change[n / 2]) / 2;
        report->min_change = change[0];
        report->max_change = change[n - 1];
    }
done:
    free(node);
    free(change);
    return status;
}
