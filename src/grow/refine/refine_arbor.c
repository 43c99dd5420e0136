/* Every segment holds rho_gamma, cost and utilisation of itself with all that hangs on it, so a
 * change at one place is carried to the root by recomputing the segments on the way and nothing
 * else: O(depth) and exact, because nothing is added to or taken from a running sum. What a move
 * overwrites is saved first, each segment once, so undoing it restores the very bits. */
#include "grow/refine/refine_arbor.h"

#include <stdlib.h>

/* A relative change of a viscosity that counts as none, and the most rounds until there is no
 * greater one. */
static const double settled = 1e-13;
enum { MOST_ROUNDS = 100 };

Reduced arbor_reduce(const Arbor *arbor, int32_t i)
{
    const Branch *branch = &arbor->branch[i];
    const int32_t *child = branch->child;
    double flow =
        child[0] < 0 ? branch->flow : arbor->branch[child[0]].flow + arbor->branch[child[1]].flow;
    Below below = arbor_below(arbor, i);
    return law_extend(&arbor->law, flow * arbor_viscosity(arbor, i), branch->length, &below);
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

Status arbor_init(Arbor *arbor, const Tree *tree, Err *err)
{
    const double *number = tree->meta.number;
    double drop = pa_from_mmhg(number[META_P_PERF]) - pa_from_mmhg(number[META_P_TERM]);
    bool pries = meta_number(&tree->meta, META_VISCOSITY_LAW) == VISCOSITY_PRIES;
    double reference_cp = number[pries ? META_PLASMA_VISCOSITY : META_VISCOSITY];
    double flow = mm3_s_from_ml_min(number[META_Q_PERF]) / (double)(tree->n / 2);
    Arbor made = {.law = {number[META_GAMMA], number[META_LAMBDA]},
                  .n = tree->n,
                  .hematocrit = number[META_HEMATOCRIT],
                  .radius_unit = law_radius_unit(pa_s_from_cp(reference_cp), flow, drop)};
    double *share = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&made.branch, made.n, sizeof *made.branch, "segments", err));
    TRY_GOTO(mem_calloc(&made.shape, made.n, sizeof *made.shape, "segments", err));
    TRY_GOTO(mem_calloc(&made.marginal, made.n, sizeof *made.marginal, "segments", err));
    TRY_GOTO(mem_calloc(&made.saved_branch, made.n, sizeof *made.saved_branch, "segments", err));
    if (pries) {
        TRY_GOTO(mem_calloc(&made.viscosity, made.n, sizeof *made.viscosity, "segments", err));
        for (size_t i = 1; i < made.n; i++)
            made.viscosity[i] = viscosity_pries_pa_s(tree->radius_mm[i], made.hematocrit, 1);
    }
    TRY_GOTO(tree_flow_shares(tree, &share, err));
    double total = 0;
    for (size_t i = 0; i < tree->n; i++)
        total += share[i];
    for (size_t i = 0; i < tree->n; i++)
        made.branch[i].flow = share[i] / total * (double)(tree->n / 2);
    arbor_arrange(&made, tree->parent, tree->position);
    TRY_GOTO(arbor_update_viscosity(&made, err));
    *arbor = made;
done:
    free(share);
    if (status != STATUS_OK)
        arbor_release(&made);
    return status;
}

void arbor_release(Arbor *arbor)
{
    free(arbor->branch);
    free(arbor->shape);
    free(arbor->marginal);
    free(arbor->viscosity);
    free(arbor->saved_branch);
    *arbor = (Arbor){0};
}

/* The segment after `i` in the order in which daughters come before their mother; 0 at last. */
static int32_t next_upward(const Arbor *arbor, int32_t i)
{
    const Branch *parent = &arbor->branch[arbor->branch[i].parent];
    if (arbor->branch[i].parent == 0)
        return 0;
    if (parent->child[1] == i)
        return arbor->branch[i].parent;
    for (i = parent->child[1]; arbor->branch[i].child[0] >= 0;)
        i = arbor->branch[i].child[0];
    return i;
}

void arbor_sum(Arbor *arbor)
{
    int32_t i = arbor_root(arbor);
    while (arbor->branch[i].child[0] >= 0)
        i = arbor->branch[i].child[0];
    for (; i != 0; i = next_upward(arbor, i)) {
        arbor->branch[i].length = vec3_distance(arbor->shape[i].from, arbor->shape[i].to);
        sum(arbor, i);
    }
}

void arbor_arrange(Arbor *arbor, const int32_t *parent, const Vec3 *place)
{
    for (size_t i = 0; i < arbor->n; i++) {
        arbor->branch[i].parent = parent[i];
        arbor->branch[i].child[0] = arbor->branch[i].child[1] = -1;
    }
    for (size_t i = 1; i < arbor->n; i++) {
        int32_t *child = arbor->branch[parent[i]].child;
        child[child[0] >= 0] = (int32_t)i;
        arbor->shape[i].from = place[parent[i]];
        arbor->shape[i].to = place[i];
    }
    arbor_sum(arbor);
}

Marginal arbor_marginal(const Arbor *arbor, int32_t i)
{
    int32_t parent = arbor->branch[i].parent;
    if (parent == 0)
        return (Marginal){{0, 1}, 1, 0};
    const Marginal *above = &arbor->marginal[parent];
    Reduced mother = arbor_reduce(arbor, parent), daughter = arbor_reduce(arbor, i);
    return (Marginal){law_descend(&arbor->law, &mother, above->adjoint, &daughter),
                      above->gauge * mother.widening,
                      above->extra + law_total(&arbor->law, &mother, above->adjoint) *
                                         arbor->branch[parent].length *
                                         arbor_viscosity(arbor, parent)};
}

int32_t arbor_next(const Arbor *arbor, int32_t i)
{
    if (arbor->branch[i].child[0] >= 0)
        return arbor->branch[i].child[0];
    for (int32_t parent; (parent = arbor->branch[i].parent) != 0; i = parent)
        if (arbor->branch[parent].child[0] == i)
            return arbor->branch[parent].child[1];
    return 0;
}

double arbor_radius_seen(const Arbor *arbor, int32_t i)
{
    return arbor->radius_unit * arbor->marginal[i].gauge * arbor_reduce(arbor, i).rho;
}

static Status too_thin(Err *err)
{
    return err_set(err, STATUS_INFEASIBLE,
                   "vessels are too thin for the viscosity law pries: radii and viscosities do not "
                   "settle");
}

Status arbor_update_viscosity(Arbor *arbor, Err *err)
{
    double change = arbor->viscosity ? INFINITY : 0;
    for (int round = 0; round < MOST_ROUNDS && change > settled; round++) {
        change = 0;
        arbor_refresh(arbor);
        for (size_t i = 1; i < arbor->n; i++) {
            double radius = arbor_radius_seen(arbor, (int32_t)i);
            double viscosity = viscosity_pries_pa_s(radius, arbor->hematocrit, 1);
            if (!isfinite(viscosity))
                return too_thin(err);
            change = fmax(change, fabs(viscosity / arbor->viscosity[i] - 1));
            arbor->viscosity[i] = viscosity;
        }
        arbor_sum(arbor);
    }
    return change <= settled ? STATUS_OK : too_thin(err);
}

double arbor_radius(const Arbor *arbor, int32_t i)
{
    double radius = arbor->radius_unit * arbor_reduce(arbor, i).rho;
    while ((i = arbor->branch[i].parent) != 0)
        radius *= arbor_reduce(arbor, i).widening;
    return radius;
}

int32_t arbor_find_overuse(const Arbor *arbor, double *radius)
{
    int32_t i = arbor_root(arbor);
    double scale = arbor->radius_unit;
    if (!(scale * arbor->branch[i].utilisation > 1))
        return 0;
    for (;;) {
        Reduced reduced = arbor_reduce(arbor, i);
        *radius = scale * reduced.rho;
        const int32_t *child = arbor->branch[i].child;
        if (*radius * arbor->branch[i].inverse_limit > 1 || child[0] < 0)
            return i;
        scale *= reduced.widening;
        i = child[arbor->branch[child[1]].utilisation > arbor->branch[child[0]].utilisation];
    }
}

void arbor_refresh(Arbor *arbor)
{
    for (int32_t i = arbor_root(arbor); i != 0; i = arbor_next(arbor, i))
        arbor->marginal[i] = arbor_marginal(arbor, i);
}

bool arbor_is_below(const Arbor *arbor, int32_t i, int32_t top)
{
    /* Flow only grows towards the root. */
    while (i != top && i != 0 && arbor->branch[i].flow <= arbor->branch[top].flow)
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
    if (++arbor->move == 0) { /* the count has come round: forget what older moves saved */
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
        arbor->viscosity[arbor->grafted] = arbor->saved_viscosity;
    arbor->grafted = 0;
    arbor->pruned = 0;
}

/* The segment, now saved. */
static Branch *branch_of(Arbor *arbor, int32_t i)
{
    Branch *branch = &arbor->branch[i];
    if (branch->saved != arbor->move) {
        arbor->saved_branch[arbor->n_saved_branches++] = (struct SavedBranch){*branch, i};
        branch->saved = arbor->move;
    }
    return branch;
}

static Shape *shape_of(Arbor *arbor, int32_t i)
{
    Shape *shape = &arbor->shape[i];
    if (shape->saved != arbor->move) {
        arbor->saved_shape[arbor->n_saved_shapes++] = (struct SavedShape){*shape, i};
        shape->saved = arbor->move;
    }
    return shape;
}

static void put(Arbor *arbor, int32_t i, Vec3 from, Vec3 to)
{
    Shape *shape = shape_of(arbor, i);
    shape->from = from;
    shape->to = to;
    branch_of(arbor, i)->length = vec3_distance(from, to);
}

void arbor_sum_from(Arbor *arbor, int32_t i)
{
    for (; i != 0; i = arbor->branch[i].parent) {
        branch_of(arbor, i);
        sum(arbor, i);
    }
}

/* Puts the bifurcation at the end of segment i to `place` and sums up anew. */
static void pivot(Arbor *arbor, int32_t i, Vec3 from, Vec3 place)
{
    for (int side = 0; side < 2; side++) {
        int32_t child = arbor->branch[i].child[side];
        put(arbor, child, place, arbor->shape[child].to);
        sum(arbor, child);
    }
    put(arbor, i, from, place);
    arbor_sum_from(arbor, i);
}

void arbor_shift(Arbor *arbor, int32_t i, Vec3 place)
{
    pivot(arbor, i, arbor->shape[i].from, place);
}

/* Puts `with` where segment i begins. */
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
    arbor_sum_from(arbor, sibling);
    arbor->pruned = i;
}

void arbor_graft(Arbor *arbor, int32_t i, int32_t host, Vec3 place)
{
    int32_t fork = arbor->branch[i].parent;
    replace(arbor, host, fork);
    int32_t *child = branch_of(arbor, fork)->child;
    child[child[0] == i] = host;
    branch_of(arbor, host)->parent = fork;
    if (arbor->viscosity) { /* the fork's segment was the first part of the host */
        arbor->grafted = fork;
        arbor->saved_viscosity = arbor->viscosity[fork];
        arbor->viscosity[fork] = arbor->viscosity[host];
    }
    pivot(arbor, fork, arbor->shape[host].from, place);
    arbor->pruned = 0;
}

void arbor_reserve(Arbor *arbor, int32_t i, double reserved_radius, double inverse_limit)
{
    shape_of(arbor, i)->reserved_radius = reserved_radius;
    branch_of(arbor, i)->inverse_limit = inverse_limit;
}
