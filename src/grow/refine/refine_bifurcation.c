/* With all else as it is, S_root depends on the bifurcation through three lengths only. Where it is
 * least, the derivatives with respect to them pull evenly: the point is the weighted Fermat point
 * for these derivatives as weights [fermat.h], and weights at one point and the Fermat point for
 * them in turn converge in a few rounds. A point that collapses onto an end is pushed off it to the
 * least length, in the direction that costs least. */
#include "grow/refine/refine_bifurcation.h"

#include "grow/cco/fermat.h"

/* Lengths over the least after a push: radii move a little too, and vessels are given more room
 * than they need [refine_clearance.c]. */
static const double pushed = 1.06;

bool bifurcation_at(const Bifurcation *fork, Vec3 place, BifurcationState *out)
{
    const Law *law = fork->law;
    const Daughter *left = &fork->burden[0], *right = &fork->burden[1];
    Adjoint top = fork->marginal.adjoint;
    BifurcationState state = {.place = place};
    for (int i = 0; i < BIFURCATION_ENDS; i++)
        state.length[i] = vec3_distance(fork->end[i], place);

    double carries[BIFURCATION_ENDS] = {(left->flow + right->flow) * fork->viscosity,
                                        left->flow * left->viscosity,
                                        right->flow * right->viscosity};
    Reduced l = law_reduce(law, carries[BIFURCATION_LEFT], state.length[BIFURCATION_LEFT],
                           left->rho_gamma_below, left->cost_below);
    Reduced r = law_reduce(law, carries[BIFURCATION_RIGHT], state.length[BIFURCATION_RIGHT],
                           right->rho_gamma_below, right->cost_below);
    Reduced p = law_reduce(law, carries[BIFURCATION_PROXIMAL], state.length[BIFURCATION_PROXIMAL],
                           l.rho_gamma + r.rho_gamma, l.cost + r.cost);
    state.cost = top.load * p.load + top.cost * p.cost;
    state.weight[BIFURCATION_PROXIMAL] =
        law_length_weight(law, &p, top, carries[BIFURCATION_PROXIMAL]);
    state.weight[BIFURCATION_LEFT] =
        law_length_weight(law, &l, law_descend(law, &p, top, &l), carries[BIFURCATION_LEFT]);
    state.weight[BIFURCATION_RIGHT] =
        law_length_weight(law, &r, law_descend(law, &p, top, &r), carries[BIFURCATION_RIGHT]);

    double unit = fork->radius_unit * fork->marginal.gauge;
    state.radius[BIFURCATION_PROXIMAL] = unit * p.rho;
    state.radius[BIFURCATION_LEFT] = unit * p.widening * l.rho;
    state.radius[BIFURCATION_RIGHT] = unit * p.widening * r.rho;

    double greatest = fmax(state.weight[0], fmax(state.weight[1], state.weight[2]));
    if (!isfinite(state.cost) || !isfinite(greatest) || !(greatest > 0))
        return false;
    for (int i = 0; i < BIFURCATION_ENDS;
         i++) /* none pushes: Fermat's point wants weights above 0 */
        state.weight[i] = fmax(state.weight[i] / greatest, 1e-9);
    *out = state;
    return true;
}

static Vec3 push_off(const Bifurcation *fork, const BifurcationState *state, const Fermat *fermat)
{
    Vec3 place = fermat->place;
    for (int i = 0; i < BIFURCATION_ENDS; i++) {
        double least = pushed * fmax(fork->least_length, 2 * fork->least_widths * state->radius[i]);
        Vec3 away = vec3_sub(place, fork->end[i]);
        if (vec3_length(away) >= least)
            continue;
        Vec3 direction = fermat->corner == i ? fermat->inward : away;
        double length = vec3_length(direction);
        if (length > 0)
            place = vec3_add_scaled(fork->end[i], direction, least / length);
    }
    return place;
}

bool bifurcation_optimise(const Bifurcation *fork, int rounds, BifurcationState *state)
{
    for (int i = 0; i < rounds; i++) {
        Fermat fermat = fermat_point(fork->end, state->weight);
        if (!bifurcation_at(fork, push_off(fork, state, &fermat), state))
            return false;
    }
    return true;
}
