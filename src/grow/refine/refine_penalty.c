/* Computes the penalties for broken rules of clearance while refinement anneals: per mm that a
 * segment is shorter than wide, and per mm that two segments overlap.
 *
 * This is an exterior penalty in the l1 norm. At a rate that is high enough but finite, the best
 * tree keeps the rules exactly: wherever breaking a rule by 1 mm gains less than the rate. The
 * tree's topology is free, too, so one rising rate for all segments would freeze it before the
 * rules hold. Each segment therefore has a rate of its own. It is higher where a mm of the segment
 * costs more, and rises fastest while the segment breaks a rule (the breakout method, [M] in
 * docs/METHODS.md). Rates stay low where the rules hold, so that vessels there can give way to
 * those that break a rule. */
#include "grow/refine/refine_penalty.h"

#include <stdlib.h>

/* Factors by which rates rise after a round: of segments that keep the rules, and of segments that
 * break a rule. The ratio of 2 between them lets a broken rule outweigh its neighbours in a few
 * rounds. Faster rises end the search sooner, in worse trees. */
static const double rise = 1.1, steep_rise = 2.2;

Status penalties_init(Penalties *penalties, size_t segments, Err *err)
{
    TRY(mem_calloc(&penalties->rate, segments, sizeof *penalties->rate, "penalty rates", err));
    TRY(mem_calloc(&penalties->broken, segments, sizeof *penalties->broken, "segments", err));
    return mem_calloc(&penalties->seen, segments, sizeof *penalties->seen, "segments", err);
}

void penalties_release(Penalties *penalties)
{
    free(penalties->rate);
    free(penalties->broken);
    free(penalties->seen);
    *penalties = (Penalties){0};
}

void penalties_begin(Penalties *penalties, const Arbor *arbor, double relative_rate)
{
    double length = 0;
    for (size_t i = arbor->inlets; i < arbor->n; i++)
        length += arbor->branch[i].length;
    double mean = arbor_cost(arbor) / length;
    for (size_t i = arbor->inlets; i < arbor->n; i++) {
        double rho = arbor_stored_radius(arbor, (int32_t)i) / arbor->radius_unit;
        penalties->rate[i] =
            relative_rate * sqrt(mean * fmax(mean, law_lambda_power(&arbor->law, rho)));
    }
    penalties->active = true;
}

void penalties_raise(Penalties *penalties, const Clearance *clearance, const Arbor *arbor)
{
    penalties->n_broken = 0;
    for (size_t i = arbor->inlets; i < arbor->n; i++) {
        bool clear = clearance_is_kept(clearance, arbor, (int32_t)i);
        penalties->rate[i] *= clear ? rise : steep_rise;
        if (!clear)
            penalties->broken[penalties->n_broken++] = (int32_t)i;
    }
}

/* Returns the penalty that segments i and j pay for their overlap. */
static inline double penalty_between(const Penalties *penalties, const Clearance *clearance,
                                     const Arbor *arbor, int32_t i, int32_t j)
{
    const Shape *a = &arbor->shape[i], *b = &arbor->shape[j];
    double reach =
        a->reserved_radius + b->reserved_radius + clearance_between(clearance, arbor, i, j);
    double distance2 = segment_distance2(a->from, a->to, b->from, b->to);
    if (distance2 >= reach * reach || arbor_are_joined(arbor, i, j) || !arbor_contains(arbor, j))
        return 0;
    return (reach - sqrt(distance2)) * fmin(penalties->rate[i], penalties->rate[j]);
}

/* Returns the penalty of segment i: for its length, and for its overlaps with all segments that the
 * present count has not seen yet. */
static double penalty_of_segment(Penalties *penalties, const Clearance *clearance,
                                 const Arbor *arbor, int32_t i)
{
    const Shape *shape = &arbor->shape[i];
    double sum = fmax(0, 2 * shape->reserved_radius - arbor->branch[i].length) * penalties->rate[i];
    Capsule capsule = {shape->from, shape->to,
                       shape->reserved_radius + clearance->gap + clearance->tree_gap};
    GridItem item = grid_item(&clearance->grid, capsule, 0);
    GridBoxQuery probe = grid_box_query(&item, capsule.radius, 1);
    int32_t other;
    for (GridVisit visit = grid_visit(&clearance->grid, &item);
         grid_visit_near(&visit, &probe, &other);) {
        if (penalties->seen[other] == penalties->count || arbor->shape[other].saved == arbor->move)
            continue;
        penalties->seen[other] = penalties->count;
        sum += penalty_between(penalties, clearance, arbor, i, other);
    }
    for (int k = 0; k < arbor->n_saved_shapes; k++) { /* the grid has them as they were */
        other = arbor->saved_shape[k].i;
        if (penalties->seen[other] != penalties->count)
            sum += penalty_between(penalties, clearance, arbor, i, other);
    }
    return sum;
}

double penalty_of_segments(Penalties *penalties, const Clearance *clearance, const Arbor *arbor,
                           const int32_t *segment, int count)
{
    double sum = 0;
    for (int k = 0; k < count && penalties->active; k++) {
        penalties->count++;
        for (int j = 0; j <= k; j++)
            penalties->seen[segment[j]] = penalties->count;
        sum += penalty_of_segment(penalties, clearance, arbor, segment[k]);
    }
    return sum;
}

double penalty_at_bifurcation(Penalties *penalties, const Clearance *clearance, Arbor *arbor,
                              int32_t i)
{
    const int32_t *child = arbor->branch[i].child;
    Reduced mother = arbor_reduce(arbor, i);
    double unit =
        SUSPENDED_RESERVE * clearance->level * arbor->radius_unit * arbor_marginal(arbor, i).gauge;
    arbor_reserve(arbor, i, unit * mother.rho, 0);
    for (int side = 0; side < 2; side++)
        arbor_reserve(arbor, child[side],
                      unit * mother.widening * arbor_reduce(arbor, child[side]).rho, 0);
    const int32_t moved[] = {i, child[0], child[1]};
    return penalty_of_segments(penalties, clearance, arbor, moved, 3);
}
