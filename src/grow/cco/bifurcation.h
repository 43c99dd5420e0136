/* The best position of a bifurcation: an optimisation problem on its own, for a new connection and
 * for a bifurcation that is moved.
 *
 * Three segments meet at the bifurcation. Their far ends are fixed, and so is the rest of the tree.
 * The price of a position is the change of the target (as S_root [law.h]). bifurcation_at computes
 * the price and its derivatives; bifurcation_optimise repeats that and a move to the Fermat point
 * of these derivatives, which converges in a few rounds. */
#ifndef CORCAST_GROW_CCO_BIFURCATION_H
#define CORCAST_GROW_CCO_BIFURCATION_H

#include "geom/geom.h"
#include "grow/cco/law.h"
#include <stdbool.h>

/* The segment that leads to the bifurcation, and the two that leave it. */
enum { PROXIMAL, LEFT, RIGHT, ENDS };

/* The problem: all that stays the same while the bifurcation moves. */
typedef struct Bifurcation {
    Vec3 end[ENDS];      /* mm; the far ends of the three segments, which differ */
    double burden[ENDS]; /* per segment: flow times viscosity [law.h] */
    Below below[2];      /* the subtrees below LEFT and RIGHT */
    Adjoint adjoint;     /* of the proximal segment */
    double radius_unit;  /* mm^(3/4); q times the proximal segment's gauge [law.h] */
    /* The price is the change of S_root, to first order, when the bifurcation replaces a segment
     * with the load load_before and the cost cost_before, plus `extra`. If all three are 0, the
     * price is S_root plus a constant. */
    double load_before, cost_before, extra;
    double least_length; /* mm; segments are no shorter than this */
    double least_widths; /* and no shorter than this many diameters */
    double least_part;   /* mm; PROXIMAL and LEFT may be this short in spite of these two rules;
                          * INFINITY: no exception */
    double margin; /* bifurcation_next keeps the bifurcation this many times the least length from
                    * the ends; >= 1 */
    bool straight; /* the bifurcation stays on the line from the end of PROXIMAL to that of LEFT */
} Bifurcation;

/* The bifurcation at one position. */
typedef struct BifurcationState {
    Vec3 place;          /* mm */
    double price;        /* change of S_root [Bifurcation] */
    double length[ENDS]; /* mm */
    double radius[ENDS]; /* mm */
    double weight[ENDS]; /* d price / d length */
} BifurcationState;

/* Computes the state of the bifurcation at `place`, mm. `law` is the law at the bifurcation. A
 * number of the state that a double cannot hold is not finite. Cost: O(1). */
void bifurcation_at(const Law *law, const Bifurcation *problem, Vec3 place, BifurcationState *out);

/* Returns true if all three segments have the length that least_length, least_widths and least_part
 * require. */
bool bifurcation_is_long_enough(const Bifurcation *problem, const BifurcationState *state);

/* Sets *place to the Fermat point [fermat.h] for the state's weights, moved away from the ends by
 * at least `margin` times the required lengths. Returns false, and leaves *place, if the state's
 * price or weights are not finite. */
bool bifurcation_next(const Bifurcation *problem, const BifurcationState *state, Vec3 *place);

/* Moves *state, which bifurcation_at computed, `rounds` times to its bifurcation_next. Does not
 * check that segments are long enough. Returns false if a state is not finite. */
bool bifurcation_optimise(const Law *law, const Bifurcation *problem, int rounds,
                          BifurcationState *state);

#endif
