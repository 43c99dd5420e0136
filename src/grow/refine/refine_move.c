/* The two moves of refinement: of a bifurcation, and of a subtree.
 *
 * A move is first made in the arbor, which costs O(depth) and gives the exact S_root (the target in
 * reduced units [cco/law.h]). Only a move that gains is tested for clearance (shift and connect,
 * which call surcharge). A move that is rejected is undone.
 *
 * move_bifurcation finds the best position of a bifurcation [bifurcation.h]. If that is next to an
 * end, it also searches from positions further up the parent (leave_end). It tries shorter and
 * shorter steps towards the best position; while rules may be broken, also random steps.
 *
 * move_subtree prunes the subtree, and computes the price of its connection to each of the nearest
 * segments in O(1) from their marginals (find_candidates, propose, price). It chooses a connection
 * (choose), and grafts the subtree there (connect). Marginals are slightly out of date. That makes
 * the choice between candidates less exact, but never the decision to accept a move. At a
 * temperature above 0, the connection is drawn from the Boltzmann distribution of the prices, so
 * that one draw replaces many proposals of which all but one would be rejected. Metropolis's rule
 * (tolerance) corrects for the error of the price.
 *
 * Penalties are computed exactly from reserved radii: what the changed segments paid before the
 * move, and what they pay after it. A subtree is moved in two steps. The penalty that it pays at a
 * position is the increase of all penalties when it is added there. */
#include "grow/refine/refine_move.h"

#include "grow/cco/bifurcation.h"

#include <float.h>

/* Maximum number of candidates for a connection, and number of nearest segments from which they are
 * chosen. Up to five candidates are neighbours in the tree, and some of the nearest segments belong
 * to the subtree itself; more candidates take time in proportion, and are farther away. */
enum { CANDIDATES = 12, NEIGHBOURS = 20 };
/* Rounds of the optimiser: for each candidate, whose price only ranks it, and for the chosen one.
 * The optimiser converges in a few rounds [bifurcation.c]. */
enum { ROUGH_ROUNDS = 1, ROUNDS = 2 };
/* A bifurcation whose best position breaks a rule tries STEPS shorter and shorter steps. If it pays
 * penalties, it then tries JOLTS random steps. A subtree that cannot be connected to the chosen
 * candidate tries others, up to ATTEMPTS. */
enum { STEPS = 3, JOLTS = 4, ATTEMPTS = 4 };
/* Bifurcations keep this many times the minimum length from the ends, because radii change slightly
 * with a move, and vessels reserve more room than they need [refine_clearance.c]. */
static const double margin = 1.06;
/* A bifurcation is next to an end if its shortest segment is at most near_end times its longest. It
 * is then also tried at PARTS_UP positions further up its parent: the first at the part farthest_up
 * of the way to the parent's beginning, each other half as far as the one before. */
static const double near_end = 0.05, farthest_up = 0.4;
enum { PARTS_UP = 4 };
/* Gains below this share of S_root are not worth a move: they are near the rounding of S_root. */
static const double least_gain = 1e-9;

/* Returns the optimisation problem of the bifurcation of segments `left` and `right` that ends
 * segment `proximal`. */
static Bifurcation bifurcation_of(const LocalSearch *search, int32_t proximal, int32_t left,
                                  int32_t right, const Marginal *marginal)
{
    const Arbor *arbor = &search->arbor;
    double left_flow = arbor->branch[left].flow, right_flow = arbor->branch[right].flow;
    return (Bifurcation){
        .end = {arbor->shape[proximal].from, arbor->shape[left].to, arbor->shape[right].to},
        .burden = {(left_flow + right_flow) * arbor_viscosity(arbor, proximal),
                   left_flow * arbor_viscosity(arbor, left),
                   right_flow * arbor_viscosity(arbor, right)},
        .below = {arbor_below(arbor, left), arbor_below(arbor, right)},
        .adjoint = marginal->adjoint,
        .radius_unit = arbor->radius_unit * marginal->gauge,
        .min_length = search->clearance.min_length,
        .min_diameters = search->clearance.level,
        .min_part_length = INFINITY,
        .margin = margin};
}

/* If the best position is next to an end, tries positions further up the parent segment. The
 * shorter a daughter, the thinner it is, and the faster the target rises as it becomes longer. Next
 * to an end the target therefore has a local minimum, which no short step leaves, and which is
 * often not the global minimum. */
static void leave_end(const Law *law, const Bifurcation *problem, BifurcationState *best)
{
    const double *length = best->length;
    double shortest = fmin(length[PROXIMAL], fmin(length[LEFT], length[RIGHT]));
    if (shortest > near_end * fmax(length[PROXIMAL], fmax(length[LEFT], length[RIGHT])))
        return;
    Vec3 place = best->place, up = vec3_sub(problem->end[PROXIMAL], place);
    double part = farthest_up;
    for (int k = 0; k < PARTS_UP; k++, part /= 2) {
        BifurcationState other;
        bifurcation_at(law, problem, vec3_add_scaled(place, up, part), &other);
        if (bifurcation_optimise(law, problem, ROUNDS, &other) && other.price < best->price)
            *best = other;
    }
}

/* Keeps the present move, which has placed the bifurcation at the end of segment i. */
static Status keep(LocalSearch *search, int32_t i, Err *err)
{
    Arbor *arbor = &search->arbor;
    search->kept++;
    const int32_t *child = arbor->branch[i].child;
    arbor->marginal[i] = arbor_marginal(arbor, i);
    arbor->marginal[child[0]] = arbor_marginal(arbor, child[0]);
    arbor->marginal[child[1]] = arbor_marginal(arbor, child[1]);
    return clearance_update_grid(&search->clearance, arbor, err);
}

/* Returns what the bifurcation at the end of segment i costs besides S_root at the position of the
 * present move: its penalties. While penalties are not active, returns 0 if the move keeps the
 * rules and INFINITY if not. */
static double surcharge(LocalSearch *search, int32_t i)
{
    Arbor *arbor = &search->arbor;
    if (!search->penalties.active)
        return clearance_allows(&search->clearance, arbor) ? 0 : INFINITY;
    if (!clearance_holds_move(&search->clearance, arbor))
        return INFINITY;
    return penalty_at_bifurcation(&search->penalties, &search->clearance, arbor, i);
}

/* Returns the penalties that the segments pay at present; 0 while penalties are not active. */
static double penalty(LocalSearch *search, const int32_t *segment, int count)
{
    return penalty_of_segments(&search->penalties, &search->clearance, &search->arbor, segment,
                               count);
}

/* Moves the bifurcation at the end of segment i to `place` if S_root plus penalties are then
 * below `cost`. */
static bool shift(LocalSearch *search, int32_t i, Vec3 place, double cost)
{
    Arbor *arbor = &search->arbor;
    arbor_begin(arbor);
    arbor_move_node(arbor, i, place);
    double now = arbor_cost(arbor);
    if (now < cost && now + surcharge(search, i) < cost)
        return true;
    arbor_undo(arbor);
    return false;
}

/* Returns a random step of about the size of the shortest segment at the bifurcation. */
static Vec3 jolt(LocalSearch *search, int32_t i)
{
    const Arbor *arbor = &search->arbor;
    const Branch *branch = &arbor->branch[i];
    const Box *box = &search->clearance.box;
    double size = fmin(branch->length, fmin(arbor->branch[branch->child[0]].length,
                                            arbor->branch[branch->child[1]].length));
    size = fmax(size, arbor->shape[i].reserved_radius);
    Vec3 step;
    step.x = random_uniform(&search->random) - 0.5;
    step.y = random_uniform(&search->random) - 0.5;
    step.z = box->high.z > box->low.z ? random_uniform(&search->random) - 0.5 : 0;
    return vec3_scale(step, 2 * size * random_uniform(&search->random));
}

Status move_bifurcation(LocalSearch *search, int32_t i, Err *err)
{
    Arbor *arbor = &search->arbor;
    const int32_t *child = arbor->branch[i].child;
    const int32_t moved[] = {i, child[0], child[1]};
    Vec3 place = arbor->shape[i].to;
    Marginal marginal = arbor_marginal(arbor, i);
    Bifurcation problem = bifurcation_of(search, i, child[0], child[1], &marginal);
    const Law law = arbor_law(arbor, i);
    BifurcationState now, best;
    search->tried++;
    bifurcation_at(&law, &problem, place, &now);
    best = now;
    if (!bifurcation_optimise(&law, &problem, ROUNDS, &best))
        return STATUS_OK;
    leave_end(&law, &problem, &best);
    arbor_begin(arbor);
    double due = penalty(search, moved, 3), cost = arbor_cost(arbor);
    if (!(best.price < now.price + due - least_gain * cost))
        return STATUS_OK;
    Vec3 step = vec3_sub(best.place, place);
    for (int k = 0; k < STEPS; k++, step = vec3_scale(step, 0.5))
        if (shift(search, i, vec3_add(place, step), cost + due))
            return keep(search, i, err);
    for (int k = 0; k < JOLTS && due > 0; k++)
        if (shift(search, i, vec3_add(place, jolt(search, i)), cost + due))
            return keep(search, i, err);
    return STATUS_OK;
}

/* A segment to which a subtree may be connected. */
typedef struct MoveCandidate {
    int32_t host; /* the segment, which the connection splits */
    double price; /* increase of S_root by the connection, estimated from the marginals */
    Bifurcation problem;
    BifurcationState state;
} MoveCandidate;

/* Returns the marginal of a segment: the stored one, unless the present move has changed the
 * segment or its parent. */
static Marginal marginal_of(const Arbor *arbor, int32_t i)
{
    const Branch *branch = &arbor->branch[i];
    bool is_near =
        branch->saved == arbor->move || arbor->branch[branch->parent].saved == arbor->move;
    return is_near ? arbor_marginal(arbor, i) : arbor->marginal[i];
}

/* Estimates the price of connecting `subtree`, which is pruned, to `host`. Returns false if a
 * number is not finite. */
static bool price(const LocalSearch *search, int32_t subtree, int32_t host, MoveCandidate *out)
{
    const Arbor *arbor = &search->arbor;
    const Shape *shape = &arbor->shape[host];
    Marginal marginal = marginal_of(arbor, host);
    Reduced before = arbor_reduce(arbor, host);
    out->host = host;
    out->problem = bifurcation_of(search, host, host, subtree, &marginal);
    Vec3 middle = vec3_scale(vec3_add(shape->from, shape->to), 0.5);
    Vec3 place = vec3_add_scaled(vec3_scale(middle, 0.75), arbor->shape[subtree].to, 0.25);
    const Law law = arbor_law(arbor, host);
    bifurcation_at(&law, &out->problem, place, &out->state);
    if (!bifurcation_optimise(&law, &out->problem, ROUGH_ROUNDS, &out->state))
        return false;
    out->price = out->state.price - marginal.adjoint.load * before.load -
                 marginal.adjoint.cost * before.cost + marginal.extra * arbor->branch[subtree].flow;
    return isfinite(out->price);
}

typedef struct Candidates {
    int count;
    MoveCandidate list[CANDIDATES]; /* the first is where the subtree came from */
} Candidates;

/* Adds a host to the candidates, unless it is one already or they are complete. */
static void propose(const LocalSearch *search, int32_t subtree, int32_t host, Candidates *out)
{
    for (int k = 0; k < out->count; k++)
        if (out->list[k].host == host)
            return;
    if (out->count < CANDIDATES)
        out->count += price(search, subtree, host, &out->list[out->count]);
}

/* Finds the candidates for `subtree`, which is pruned: the segment `origin` that it was cut off
 * from, the segments that share a node with `origin`, and the nearest segments. Finds none if the
 * first has no price. */
static void find_candidates(LocalSearch *search, int32_t subtree, int32_t origin, Candidates *out)
{
    const Arbor *arbor = &search->arbor;
    int32_t fork = arbor->branch[subtree].parent, above = arbor->branch[origin].parent;
    const int32_t *below = arbor->branch[origin].child;
    Near near[NEIGHBOURS];
    out->count = 0;
    propose(search, subtree, origin, out);
    if (out->count == 0)
        return;
    if (!arbor_is_inlet(arbor, above)) {
        propose(search, subtree, above, out);
        propose(search, subtree, arbor_sibling(arbor, origin), out);
    }
    for (int side = 0; side < 2 && below[0] >= 0; side++)
        propose(search, subtree, below[side], out);
    int found = grid_nearest_adaptive(&search->clearance.grid, arbor->shape[subtree].to, INFINITY,
                                      NEIGHBOURS, &search->reach, near);
    for (int k = 0; k < found; k++)
        if (near[k].segment != fork && arbor_is_same_tree(arbor, near[k].segment, subtree) &&
            !arbor_is_below(arbor, near[k].segment, subtree))
            propose(search, subtree, near[k].segment, out);
}

/* Chooses the cheapest candidate or, at a temperature above 0, draws one from the Boltzmann
 * distribution. */
static int choose(LocalSearch *search, const MoveCandidate *candidate, int count,
                  double temperature)
{
    int best = 0;
    for (int k = 1; k < count; k++)
        if (candidate[k].price < candidate[best].price)
            best = k;
    if (!(temperature > 0))
        return best;
    double weight[CANDIDATES], sum = 0;
    for (int k = 0; k < count; k++)
        sum += weight[k] =
            elementary_exp((candidate[best].price - candidate[k].price) / temperature);
    double left = random_uniform(&search->random) * sum;
    for (int k = 0; k < count; k++)
        if ((left -= weight[k]) < 0)
            return k;
    return best;
}

/* Returns by how much the cost of a move may exceed its estimate, by Metropolis's rule. */
static double tolerance(LocalSearch *search, double temperature)
{
    return -temperature * elementary_log(random_uniform(&search->random));
}

/* Connects `subtree`, which is pruned, to the candidate if S_root plus penalties are then below
 * `limit`. If not, the caller must undo the move. */
static bool connect(LocalSearch *search, int32_t subtree, MoveCandidate *to, double limit)
{
    Arbor *arbor = &search->arbor;
    const Law law = arbor_law(arbor, to->host);
    if (!bifurcation_optimise(&law, &to->problem, ROUNDS, &to->state))
        return false;
    limit += penalty(search, &to->host, 1);
    arbor_graft(arbor, subtree, to->host, to->state.place);
    double now = arbor_cost(arbor);
    return now < limit && now + surcharge(search, arbor->branch[subtree].parent) < limit;
}

Status move_subtree(LocalSearch *search, int32_t i, double temperature, Err *err)
{
    Arbor *arbor = &search->arbor;
    search->tried++;
    if (arbor_is_inlet(arbor, arbor->branch[i].parent))
        return STATUS_OK;
    int32_t fork = arbor->branch[i].parent, origin = arbor_sibling(arbor, i);
    const int32_t here[] = {i, fork, origin};
    double cost = arbor_cost(arbor);
    Candidates candidates;
    MoveCandidate *candidate = candidates.list;
    arbor_begin(arbor);
    double due = penalty(search, here, 3);
    arbor_prune(arbor, i);
    due -= penalty(search, &origin, 1);
    find_candidates(search, i, origin, &candidates);
    if (candidates.count > 0)
        candidate[0].price += due;
    for (int attempt = 0; attempt < ATTEMPTS && candidates.count > 1; attempt++) {
        int chosen = choose(search, candidate, candidates.count, temperature);
        if (chosen == 0)
            break;
        double limit = cost + due;
        if (temperature > 0)
            limit += candidate[chosen].price - candidate[0].price + tolerance(search, temperature);
        if (connect(search, i, &candidate[chosen], limit)) {
            TRY(keep(search, fork, err));
            arbor->marginal[origin] = arbor_marginal(arbor, origin);
            return STATUS_OK;
        }
        candidate[chosen] = candidate[--candidates.count];
        arbor_undo(arbor);
        arbor_begin(arbor);
        arbor_prune(arbor, i);
    }
    arbor_undo(arbor);
    return STATUS_OK;
}
