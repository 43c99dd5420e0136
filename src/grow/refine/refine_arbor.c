/* The tree as refinement changes it (the arbor): connects, moves and removes segments, keeps their
 * reduced costs and radii up to date, and undoes moves.
 *
 * Every segment stores rho_gamma, cost and utilisation [refine_arbor.h] of itself together with its
 * subtree. A change at one segment is carried to the root by recomputing only the segments on the
 * path: O(depth), and exact, because no running sum is added to or subtracted from. Values that a
 * move overwrites are saved first, once per segment, so that undoing a move restores the same
 * bits. */
#include "grow/refine/refine_arbor.h"

#include <stdlib.h>

/* Exponents and viscosities agree with the radii once a round changes them by no more than this:
 * exponents absolutely, viscosities relatively. It is some hundred units in the last place, so that
 * the written radii obey the law to rounding. */
static const double settled = 1e-13;
/* Rounds after which arbor_iterate_local fails. A radius depends only on the fourth root of a
 * viscosity, so most trees need far fewer. */
enum { MOST_ROUNDS = 100 };
/* Number of ancestors whose sums arbor_prune updates. The cut subtree matters most to the prices
 * near it; the sums further up are updated only if the move is made. */
enum { PRUNED_LEVELS = 4 };

Reduced arbor_reduce(const Arbor *arbor, int32_t i)
{
    const Branch *branch = &arbor->branch[i];
    const int32_t *child = branch->child;
    double flow =
        child[0] < 0 ? branch->flow : arbor->branch[child[0]].flow + arbor->branch[child[1]].flow;
    Subtree below = arbor_below(arbor, i);
    const Law law = arbor_law(arbor, branch->parent);
    return law_add_segment(&law, flow * arbor_viscosity(arbor, i), branch->length, &below);
}

/* Sums up segment i from its daughters. */
static void sum(Arbor *arbor, int32_t i)
{
    Branch *branch = &arbor->branch[i];
    Reduced reduced = arbor_reduce(arbor, i);
    branch->rho_gamma = reduced.rho_gamma;
    branch->cost = reduced.cost;
    branch->utilisation = reduced.rho * branch->inverse_limit;
    if (branch->child[0] < 0)
        return;
    const Branch *left = &arbor->branch[branch->child[0]];
    const Branch *right = &arbor->branch[branch->child[1]];
    branch->flow = left->flow + right->flow;
    branch->utilisation =
        fmax(branch->utilisation, reduced.widening * fmax(left->utilisation, right->utilisation));
}

/* Lists the nodes that are part of the arbor in `node`, inlets first, and their parents there in
 * `parent`; `children` are the tree's counts. */
static Status list_nodes(Arbor *arbor, const Tree *tree, const int32_t *children, int32_t *parent,
                         Err *err)
{
    int32_t *index = NULL; /* per node of the tree: its node in the arbor, or the one above it */
    TRY(mem_calloc(&index, tree->n, sizeof *index, "nodes", err));
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            arbor->node[arbor->inlets++] = (int32_t)i;
    size_t inlets = 0;
    arbor->n = arbor->inlets;
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            parent[inlets] = TREE_NO_PARENT;
            index[i] = (int32_t)inlets++;
            continue;
        }
        int32_t above = index[tree->parent[i]];
        index[i] = children[i] == 1 ? above : (int32_t)arbor->n;
        arbor->terminals += children[i] == 0;
        if (children[i] == 1)
            continue;
        parent[arbor->n] = above;
        arbor->node[arbor->n++] = (int32_t)i;
    }
    free(index);
    return STATUS_OK;
}

/* Allocates the arrays with an entry per node. */
static Status allocate(Arbor *arbor, Err *err)
{
    TRY(mem_calloc(&arbor->branch, arbor->n, sizeof *arbor->branch, "segments", err));
    TRY(mem_calloc(&arbor->shape, arbor->n, sizeof *arbor->shape, "segments", err));
    TRY(mem_calloc(&arbor->marginal, arbor->n, sizeof *arbor->marginal, "segments", err));
    TRY(mem_calloc(&arbor->saved_branch, arbor->n, sizeof *arbor->saved_branch, "segments", err));
    if (arbor->pries || arbor->gamma.n > 1)
        TRY(mem_calloc(&arbor->local, arbor->n, sizeof *arbor->local, "segments", err));
    if (arbor->inlets > 1)
        TRY(mem_calloc(&arbor->tree, arbor->n, sizeof *arbor->tree, "segments", err));
    return STATUS_OK;
}

/* Returns the viscosity and the Murray exponent at a radius, mm. */
static Local local_at(const Arbor *arbor, double radius)
{
    return (Local){arbor->pries ? viscosity_pries_pa_s(radius, arbor->hematocrit, 1) : 1,
                   logcurve_at(&arbor->gamma, radius)};
}

/* Copies the data of each node from the tree, and sums up. */
static Status fill(Arbor *arbor, const Tree *tree, const int32_t *parent, Err *err)
{
    double *share = NULL, total = 0;
    Vec3 *place = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(tree_flow_shares(tree, &share, err));
    TRY_GOTO(mem_calloc(&place, arbor->n, sizeof *place, "places", err));
    for (size_t i = 0; i < tree->n; i++)
        total += share[i];
    for (size_t i = 0; i < arbor->n; i++) {
        size_t node = (size_t)arbor->node[i];
        place[i] = tree->position[node];
        arbor->branch[i].flow = share[node] / total * (double)arbor->terminals;
        if (arbor->local)
            arbor->local[i] = local_at(arbor, tree->radius_mm[node]);
        if (arbor->tree)
            arbor->tree[i] = i < arbor->inlets ? (int32_t)i : arbor->tree[parent[i]];
    }
    arbor_arrange(arbor, parent, place);
    status = arbor_iterate_local(arbor, err);
done:
    free(share);
    free(place);
    return status;
}

Status arbor_init(Arbor *arbor, const Tree *tree, Err *err)
{
    const double *number = tree->meta.number;
    double drop = pa_from_mmhg(number[META_P_PERF]) - pa_from_mmhg(number[META_P_TERM]);
    bool pries = meta_number(&tree->meta, META_VISCOSITY_LAW) == VISCOSITY_PRIES;
    double reference_cp = number[pries ? META_PLASMA_VISCOSITY : META_VISCOSITY];
    LogCurve gamma = meta_gamma(&tree->meta);
    Arbor made = {.law = {gamma.value[0], number[META_LAMBDA]},
                  .gamma = gamma,
                  .pries = pries,
                  .hematocrit = number[META_HEMATOCRIT]};
    int32_t *children = NULL, *parent = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(tree_child_counts(tree, &children, err));
    TRY_GOTO(mem_calloc(&parent, tree->n, sizeof *parent, "nodes", err));
    TRY_GOTO(mem_calloc(&made.node, tree->n, sizeof *made.node, "nodes", err));
    TRY_GOTO(list_nodes(&made, tree, children, parent, err));
    double flow = mm3_s_from_ml_min(number[META_Q_PERF]) / (double)made.terminals;
    made.radius_unit = law_radius_unit(pa_s_from_cp(reference_cp), flow, drop);
    TRY_GOTO(allocate(&made, err));
    TRY_GOTO(fill(&made, tree, parent, err));
    *arbor = made;
    made = (Arbor){0};
done:
    free(children);
    free(parent);
    arbor_release(&made);
    return status;
}

void arbor_release(Arbor *arbor)
{
    free(arbor->node);
    free(arbor->tree);
    free(arbor->branch);
    free(arbor->shape);
    free(arbor->marginal);
    free(arbor->local);
    free(arbor->saved_branch);
    *arbor = (Arbor){0};
}

/* Returns the first of segment i and all segments below it in post-order (daughters before their
 * mother). */
static int32_t first_upward(const Arbor *arbor, int32_t i)
{
    while (arbor->branch[i].child[0] >= 0)
        i = arbor->branch[i].child[0];
    return i;
}

/* Returns the first segment of the tree after the tree of `inlet`; 0 if there is none. */
static int32_t next_tree(const Arbor *arbor, int32_t inlet)
{
    return (size_t)inlet + 1 < arbor->inlets ? arbor->branch[inlet + 1].child[0] : 0;
}

/* Returns the segment after `i` in post-order, tree after tree; 0 after the last. */
static int32_t next_upward(const Arbor *arbor, int32_t i)
{
    int32_t above = arbor->branch[i].parent, next;
    const int32_t *child = arbor->branch[above].child;
    if (child[0] == i && child[1] >= 0)
        return first_upward(arbor, child[1]);
    if (!arbor_is_inlet(arbor, above))
        return above;
    next = next_tree(arbor, above);
    return next ? first_upward(arbor, next) : 0;
}

void arbor_sum(Arbor *arbor)
{
    for (int32_t i = first_upward(arbor, arbor_first(arbor)); i != 0; i = next_upward(arbor, i)) {
        arbor->branch[i].length = vec3_distance(arbor->shape[i].from, arbor->shape[i].to);
        sum(arbor, i);
    }
}

void arbor_arrange(Arbor *arbor, const int32_t *parent, const Vec3 *place)
{
    for (size_t i = 0; i < arbor->n; i++) {
        arbor->branch[i].parent = parent[i];
        arbor->branch[i].child[0] = arbor->branch[i].child[1] = -1;
        arbor->shape[i].from = arbor->shape[i].to = place[i];
    }
    for (size_t i = arbor->inlets; i < arbor->n; i++) {
        int32_t *child = arbor->branch[parent[i]].child;
        child[child[0] >= 0] = (int32_t)i;
        arbor->shape[i].from = place[parent[i]];
    }
    arbor_sum(arbor);
}

Marginal arbor_marginal(const Arbor *arbor, int32_t i)
{
    int32_t parent = arbor->branch[i].parent;
    if (arbor_is_inlet(arbor, parent))
        return (Marginal){{0, 1}, 1, 0};
    const Marginal *above = &arbor->marginal[parent];
    Reduced mother = arbor_reduce(arbor, parent), daughter = arbor_reduce(arbor, i);
    return (Marginal){law_daughter_adjoint(&arbor->law, &mother, above->adjoint, &daughter),
                      above->gauge * mother.widening,
                      above->extra + law_load_derivative(&arbor->law, &mother, above->adjoint) *
                                         arbor->branch[parent].length *
                                         arbor_viscosity(arbor, parent)};
}

int32_t arbor_next(const Arbor *arbor, int32_t i)
{
    if (arbor->branch[i].child[0] >= 0)
        return arbor->branch[i].child[0];
    for (;; i = arbor->branch[i].parent) {
        int32_t above = arbor->branch[i].parent;
        const int32_t *child = arbor->branch[above].child;
        if (child[0] == i && child[1] >= 0)
            return child[1];
        if (arbor_is_inlet(arbor, above))
            return next_tree(arbor, above);
    }
}

double arbor_stored_radius(const Arbor *arbor, int32_t i)
{
    return arbor->radius_unit * arbor->marginal[i].gauge * arbor_reduce(arbor, i).rho;
}

/* Sets the error of an iteration that does not converge. */
static Status disagree(const Arbor *arbor, Err *err)
{
    return err_set(err, STATUS_INFEASIBLE,
                   arbor->gamma.n > 1
                       ? "gamma changes too fast with the radius: the radii do not converge"
                       : "vessels are too thin for the viscosity law pries: radii and viscosities "
                         "do not converge");
}

Status arbor_iterate_local(Arbor *arbor, Err *err)
{
    double change = arbor->local ? INFINITY : 0;
    for (int round = 0; round < MOST_ROUNDS && change > settled; round++) {
        change = 0;
        arbor_refresh(arbor);
        for (size_t i = arbor->inlets; i < arbor->n; i++) {
            const Local was = arbor->local[i],
                        now = local_at(arbor, arbor_stored_radius(arbor, (int32_t)i));
            if (!isfinite(now.viscosity))
                return disagree(arbor, err);
            change = fmax(
                change, fmax(fabs(now.viscosity / was.viscosity - 1), fabs(now.gamma - was.gamma)));
            arbor->local[i] = now;
        }
        arbor_sum(arbor);
    }
    return change <= settled ? STATUS_OK : disagree(arbor, err);
}

double arbor_radius(const Arbor *arbor, int32_t i)
{
    double radius = arbor->radius_unit * arbor_reduce(arbor, i).rho;
    while (!arbor_is_inlet(arbor, i = arbor->branch[i].parent))
        radius *= arbor_reduce(arbor, i).widening;
    return radius;
}

/* Returns the root segment with the greatest utilisation. */
static int32_t fullest_root(const Arbor *arbor)
{
    int32_t fullest = arbor_first(arbor);
    for (size_t k = 0; k < arbor->inlets; k++)
        for (int slot = 0; slot < 2; slot++) {
            int32_t root = arbor->branch[k].child[slot];
            if (root >= 0 && arbor->branch[root].utilisation > arbor->branch[fullest].utilisation)
                fullest = root;
        }
    return fullest;
}

int32_t arbor_find_overuse(const Arbor *arbor, double *radius)
{
    int32_t i = fullest_root(arbor);
    double scale = arbor->radius_unit;
    if (!(scale * arbor->branch[i].utilisation > 1))
        return 0;
    for (;;) {
        Reduced reduced = arbor_reduce(arbor, i);
        *radius = scale * reduced.rho;
        const int32_t *child = arbor->branch[i].child;
        if (*radius * arbor->branch[i].inverse_limit > 1)
            return i;
        if (child[0] < 0) /* rounding alone made the utilisation of the root exceed 1 */
            return 0;
        scale *= reduced.widening;
        i = child[arbor->branch[child[1]].utilisation > arbor->branch[child[0]].utilisation];
    }
}

void arbor_refresh(Arbor *arbor)
{
    for (int32_t i = arbor_first(arbor); i != 0; i = arbor_next(arbor, i))
        arbor->marginal[i] = arbor_marginal(arbor, i);
}

bool arbor_is_below(const Arbor *arbor, int32_t i, int32_t top)
{
    /* Flow grows towards the root, so that the walk can end where the flow exceeds that of `top`.
     */
    while (i != top && !arbor_is_inlet(arbor, i) &&
           arbor->branch[i].flow <= arbor->branch[top].flow)
        i = arbor->branch[i].parent;
    return i == top;
}

bool arbor_are_joined(const Arbor *arbor, int32_t i, int32_t j)
{
    int32_t above_i = arbor->branch[i].parent, above_j = arbor->branch[j].parent;
    return above_i == above_j || above_i == j || above_j == i;
}

void arbor_begin(Arbor *arbor)
{
    if (++arbor->move == 0) { /* the number of the move has wrapped around */
        for (size_t i = 0; i < arbor->n; i++)
            arbor->branch[i].saved = arbor->shape[i].saved = 0;
        arbor->move = 1;
    }
    arbor->n_saved_branches = 0;
    arbor->n_saved_shapes = 0;
    arbor->grafted = 0;
}

void arbor_undo(Arbor *arbor)
{
    for (size_t k = 0; k < arbor->n_saved_branches; k++)
        arbor->branch[arbor->saved_branch[k].i] = arbor->saved_branch[k].was;
    for (int k = 0; k < arbor->n_saved_shapes; k++)
        arbor->shape[arbor->saved_shape[k].i] = arbor->saved_shape[k].was;
    if (arbor->grafted)
        arbor->local[arbor->grafted] = arbor->saved_local;
    arbor->grafted = 0;
    arbor->pruned = 0;
}

/* Saves the branch of segment i if the present move has not saved it yet, and returns it. */
static Branch *branch_of(Arbor *arbor, int32_t i)
{
    Branch *branch = &arbor->branch[i];
    if (branch->saved != arbor->move) {
        arbor->saved_branch[arbor->n_saved_branches++] = (struct SavedBranch){*branch, i};
        branch->saved = arbor->move;
    }
    return branch;
}

/* Saves the shape of segment i if the present move has not saved it yet, and returns it. */
static Shape *shape_of(Arbor *arbor, int32_t i)
{
    Shape *shape = &arbor->shape[i];
    if (shape->saved != arbor->move) {
        arbor->saved_shape[arbor->n_saved_shapes++] = (struct SavedShape){*shape, i};
        shape->saved = arbor->move;
    }
    return shape;
}

/* Sets the ends of segment i. */
static void put(Arbor *arbor, int32_t i, Vec3 from, Vec3 to)
{
    Shape *shape = shape_of(arbor, i);
    shape->from = from;
    shape->to = to;
    branch_of(arbor, i)->length = vec3_distance(from, to);
}

void arbor_sum_from(Arbor *arbor, int32_t i)
{
    for (; !arbor_is_inlet(arbor, i); i = arbor->branch[i].parent) {
        branch_of(arbor, i);
        sum(arbor, i);
    }
}

/* Updates the sums of segments i and j and of all segments above them, each once. Of the two paths,
 * advances the one whose segment has less flow, until they meet: flow grows towards the root, so if
 * one segment is below the other, it comes first. */
static void sum_from_both(Arbor *arbor, int32_t i, int32_t j)
{
    const Branch *branch = arbor->branch;
    while (i != j && !(arbor_is_inlet(arbor, i) && arbor_is_inlet(arbor, j))) {
        bool first = !arbor_is_inlet(arbor, i) &&
                     (arbor_is_inlet(arbor, j) || branch[i].flow < branch[j].flow);
        int32_t *next = first ? &i : &j, above = branch[*next].parent;
        branch_of(arbor, *next);
        sum(arbor, *next);
        *next = above;
    }
    arbor_sum_from(arbor, i);
}

/* Makes segment i lead from `from` to a bifurcation at `place`, and updates the sums from there and
 * from segment `also` up to the root. */
static void pivot(Arbor *arbor, int32_t i, Vec3 from, Vec3 place, int32_t also)
{
    for (int side = 0; side < 2; side++) {
        int32_t child = arbor->branch[i].child[side];
        put(arbor, child, place, arbor->shape[child].to);
        sum(arbor, child);
    }
    put(arbor, i, from, place);
    sum_from_both(arbor, i, also);
}

void arbor_move_node(Arbor *arbor, int32_t i, Vec3 place)
{
    pivot(arbor, i, arbor->shape[i].from, place, i);
}

/* Makes `with` a child of the node at which segment i begins, in the place of segment i. */
static void replace(Arbor *arbor, int32_t i, int32_t with)
{
    int32_t above = arbor->branch[i].parent;
    int32_t *child = branch_of(arbor, above)->child;
    child[child[0] != i] = with;
    branch_of(arbor, with)->parent = above;
}

void arbor_prune(Arbor *arbor, int32_t i)
{
    int32_t fork = arbor->branch[i].parent, sibling = arbor_sibling(arbor, i);
    replace(arbor, fork, sibling);
    put(arbor, sibling, arbor->shape[fork].from, arbor->shape[sibling].to);
    int32_t at = sibling;
    for (int k = 0; k < PRUNED_LEVELS && !arbor_is_inlet(arbor, at); k++) {
        branch_of(arbor, at);
        sum(arbor, at);
        at = arbor->branch[at].parent;
    }
    arbor->pruned = i;
    arbor->stale = at;
}

void arbor_graft(Arbor *arbor, int32_t i, int32_t host, Vec3 place)
{
    int32_t fork = arbor->branch[i].parent;
    replace(arbor, host, fork);
    int32_t *child = branch_of(arbor, fork)->child;
    child[child[0] == i] = host;
    branch_of(arbor, host)->parent = fork;
    if (arbor->local) { /* the fork's segment was the first part of the host */
        arbor->grafted = fork;
        arbor->saved_local = arbor->local[fork];
        arbor->local[fork] = arbor->local[host];
    }
    pivot(arbor, fork, arbor->shape[host].from, place, arbor->stale);
    arbor->pruned = 0;
}

void arbor_reserve(Arbor *arbor, int32_t i, double reserved_radius, double inverse_limit)
{
    shape_of(arbor, i)->reserved_radius = reserved_radius;
    branch_of(arbor, i)->inverse_limit = inverse_limit;
}
