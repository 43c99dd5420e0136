/* Finds the position of a bifurcation that minimises the target, for a new connection or for a
 * bifurcation that is moved.
 *
 * Three segments meet at the bifurcation. Their far ends and the rest of the tree are fixed. The
 * price of a position is the change of S_root [law.h], which is proportional to the change of the
 * target. bifurcation_at computes the price and its derivatives with respect to the three lengths.
 * bifurcation_optimise moves the bifurcation to the Fermat point whose weights are these
 * derivatives, and repeats both steps; a few rounds converge. */
#ifndef CORCAST_GROW_CCO_BIFURCATION_H
#define CORCAST_GROW_CCO_BIFURCATION_H

#include "geom/geom.h"
#include "grow/cco/law.h"
#include <stdbool.h>

/* The segment that leads to the bifurcation, and the two segments that leave it. */
enum { PROXIMAL, LEFT, RIGHT, ENDS };

/* The problem: the values that stay the same while the bifurcation moves. */
typedef struct Bifurcation {
    Vec3 end[ENDS];      /* mm; the far ends of the three segments, which differ */
    double burden[ENDS]; /* per segment: flow times viscosity [law.h] */
    Subtree below[2];    /* the subtrees below LEFT and RIGHT */
    Adjoint adjoint;     /* of the proximal segment */
    double radius_unit;  /* mm^(3/4); q times the proximal segment's gauge [law.h] */
    /* The bifurcation replaces a segment that had the load load_before and the cost cost_before.
     * The price is the change of S_root, to first order, plus `extra`. If all three are 0, the
     * price is S_root plus a constant. */
    double load_before, cost_before, extra;
    double min_length;      /* minimum length of a segment, mm */
    double min_diameters;   /* minimum length of a segment, as a multiple of its diameter */
    double min_part_length; /* mm; if lower, it replaces both minima for PROXIMAL and LEFT;
                             * INFINITY: it replaces neither */
    double margin; /* >= 1; bifurcation_next keeps this many minimum lengths from the ends */
    bool straight; /* the bifurcation stays on the line between the far ends of PROXIMAL and LEFT */
} Bifurcation;

/* The bifurcation at one position. */
typedef struct BifurcationState {
    Vec3 place;          /* mm */
    double price;        /* change of S_root [Bifurcation] */
    double length[ENDS]; /* mm */
    double radius[ENDS]; /* mm */
    double weight[ENDS]; /* d price / d length */
} BifurcationState;

/* Computes the state of the bifurcation at `place`, mm. `law` has the exponents at the bifurcation.
 * A value that exceeds the range of a double is not finite. Cost: O(1). */
void bifurcation_at(const Law *law, const Bifurcation *problem, Vec3 place, BifurcationState *out);

/* Returns true if all three segments have their minimum lengths. */
bool bifurcation_is_long_enough(const Bifurcation *problem, const BifurcationState *state);

/* Sets *place to the Fermat point [fermat.h] for state->weight. If the point is nearer to an end
 * than `margin` times the minimum length, it is moved away from the end. Returns false, and leaves
 * *place unchanged, if the price or a weight is not finite. */
bool bifurcation_next(const Bifurcation *problem, const BifurcationState *state, Vec3 *place);

/* Improves *state, which bifurcation_at has computed, by `rounds` rounds of bifurcation_next and
 * bifurcation_at. Does not check that segments are long enough. Returns false if a price or weight
 * is not finite; *state is then undefined. */
bool bifurcation_optimise(const Law *law, const Bifurcation *problem, int rounds,
                          BifurcationState *state);

#endif
