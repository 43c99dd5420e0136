/* Finds the position of a bifurcation at which the target S_root [law.h] is least.
 *
 * With the rest of the tree held fixed, S_root depends on the position only through three lengths.
 * At its minimum, the derivatives with respect to the lengths are in equilibrium: the position is
 * the weighted Fermat point with these derivatives as weights [fermat.h]. The derivatives vary
 * slowly. Computing the weights at a position (bifurcation_at) and the Fermat point for the weights
 * (bifurcation_next) in turn therefore converges in a few rounds.
 *
 * If the Fermat point coincides with an end, the bifurcation is moved off the end to the
 * minimum length, in the direction that costs least. Such bifurcations are among the best there
 * are, so they must not be lost. A segment that must stay straight is split at the best
 * position along it. */
#include "grow/cco/bifurcation.h"

#include "grow/cco/fermat.h"

void bifurcation_at(const Law *law, const Bifurcation *problem, Vec3 place, BifurcationState *out)
{
    const double *burden = problem->burden;
    out->place = place;
    for (int i = 0; i < ENDS; i++)
        out->length[i] = vec3_distance(problem->end[i], place);
    Reduced left = law_add_segment(law, burden[LEFT], out->length[LEFT], &problem->below[0]);
    Reduced right = law_add_segment(law, burden[RIGHT], out->length[RIGHT], &problem->below[1]);
    Subtree fork = law_add_daughters(law, left.rho_gamma + right.rho_gamma, left.cost + right.cost);
    Reduced proximal = law_add_segment(law, burden[PROXIMAL], out->length[PROXIMAL], &fork);

    Adjoint top = problem->adjoint;
    Adjoint left_adjoint = law_daughter_adjoint(law, &proximal, top, &left);
    Adjoint right_adjoint = law_daughter_adjoint(law, &proximal, top, &right);
    out->price = top.load * (proximal.load - problem->load_before) +
                 top.cost * (proximal.cost - problem->cost_before) + problem->extra;
    out->weight[PROXIMAL] = law_length_weight(law, &proximal, top, burden[PROXIMAL]);
    out->weight[LEFT] = law_length_weight(law, &left, left_adjoint, burden[LEFT]);
    out->weight[RIGHT] = law_length_weight(law, &right, right_adjoint, burden[RIGHT]);

    double unit = problem->radius_unit;
    out->radius[PROXIMAL] = unit * proximal.rho;
    out->radius[LEFT] = unit * proximal.widening * left.rho;
    out->radius[RIGHT] = unit * proximal.widening * right.rho;
}

/* Returns the minimum length of segment i, mm. */
static double shortest(const Bifurcation *problem, int i, double radius)
{
    double least = box_max(2 * problem->min_diameters * radius, problem->min_length);
    return i == RIGHT || least < problem->min_part_length ? least : problem->min_part_length;
}

bool bifurcation_is_long_enough(const Bifurcation *problem, const BifurcationState *state)
{
    for (int i = 0; i < ENDS; i++)
        if (!(state->length[i] >= shortest(problem, i, state->radius[i])))
            return false;
    return true;
}

/* Returns the Fermat point, moved away from the three ends to the minimum lengths. */
static Vec3 push_off(const Bifurcation *problem, const BifurcationState *state,
                     const Fermat *fermat)
{
    Vec3 place = fermat->place;
    for (int i = 0; i < ENDS; i++) {
        double least = problem->margin * shortest(problem, i, state->radius[i]);
        Vec3 away = vec3_sub(place, problem->end[i]);
        if (vec3_dot(away, away) >= least * least)
            continue;
        Vec3 direction = fermat->corner == i ? fermat->inward : away;
        double length = vec3_length(direction);
        if (length > 0)
            place = vec3_add_scaled(problem->end[i], direction, least / length);
    }
    return place;
}

/* Returns the largest weight; 0 if the price or a weight is not finite. */
static double scale_of(const BifurcationState *state)
{
    const double *weight = state->weight;
    double greatest = box_max(weight[0], box_max(weight[1], weight[2]));
    return isfinite(state->price) && isfinite(greatest) && greatest > 0 ? greatest : 0;
}

bool bifurcation_next(const Bifurcation *problem, const BifurcationState *state, Vec3 *place)
{
    double weight[ENDS], scale = scale_of(state);
    if (scale == 0)
        return false;
    for (int i = 0; i < ENDS; i++) /* fermat_point needs weights above 0 */
        weight[i] = box_max(state->weight[i] / scale, 1e-9);
    if (problem->straight) {
        double margin[2];
        for (int i = 0; i < 2; i++)
            margin[i] = problem->margin * shortest(problem, i, state->radius[i]);
        *place = fermat_point_between(problem->end, weight, margin);
        return true;
    }
    Fermat fermat = fermat_point(problem->end, weight);
    *place = push_off(problem, state, &fermat);
    return true;
}

bool bifurcation_optimise(const Law *law, const Bifurcation *problem, int rounds,
                          BifurcationState *state)
{
    Vec3 place;
    for (int i = 0; i < rounds; i++) {
        if (!bifurcation_next(problem, state, &place))
            return false;
        bifurcation_at(law, problem, place, state);
    }
    return scale_of(state) > 0;
}
