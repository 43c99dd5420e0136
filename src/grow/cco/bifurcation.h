/* Finds the position of a bifurcation that minimises the target of the tree, the sum of length *
 * radius^lambda [law.h]. The bifurcation is new, or it is moved.
 *
 * Three segments meet at the bifurcation. Their far ends and the rest of the tree are fixed.
 * bifurcation_at computes the price of a position: the change of S_root, which is the target
 * divided by a constant. It also computes the derivatives of the price with respect to the three
 * lengths. bifurcation_next then finds the Fermat point whose weights are these derivatives.
 * bifurcation_optimise calls both in turn; two rounds usually converge. */
#ifndef CORCAST_GROW_CCO_BIFURCATION_H
#define CORCAST_GROW_CCO_BIFURCATION_H

#include "geom/geom.h"
#include "grow/cco/law.h"
#include <stdbool.h>

/* The segment that leads to the bifurcation, and the two that leave it. For a new connection, LEFT
 * is the distal part of the split segment, and RIGHT is the new segment. */
enum { PROXIMAL, LEFT, RIGHT, ENDS };

/* The problem: the values that stay the same while the bifurcation moves. */
typedef struct Bifurcation {
    Vec3 end[ENDS];      /* mm; the far ends of the three segments, which differ */
    double burden[ENDS]; /* per segment: flow times viscosity [law.h] */
    Subtree below[2];    /* the subtrees below LEFT and RIGHT */
    Adjoint adjoint;     /* of the proximal segment */
    double radius_unit;  /* mm^(3/4); the proximal segment's radius is radius_unit * load^(1/4) [q g
                          * in law.h] */
    /* price = adjoint.load * (load - load_before) + adjoint.cost * (cost - cost_before) + extra.
     * Load and cost are those of the proximal segment; load_before and cost_before are those of the
     * segment that the bifurcation replaces. `extra` is the change of S_root that does not depend
     * on the position. If all three are 0, the price is S_root plus a constant. */
    double load_before, cost_before, extra;
    double min_length;      /* minimum length of a segment, mm */
    double min_diameters;   /* minimum length of a segment, as a multiple of its diameter */
    double min_part_length; /* mm; upper limit of the minimum length of PROXIMAL and LEFT, the two
                             * parts of a split segment; INFINITY: no limit */
    double margin; /* >= 1; bifurcation_next places the bifurcation at least this many minimum
                    * lengths from each end */
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
