/* Where three segments meet best: the bifurcation as an optimisation problem of its own, for a new
 * connection and for one that refinement moves. */
#ifndef CORCAST_GROW_BIFURCATION_H
#define CORCAST_GROW_BIFURCATION_H

#include "geom/geom.h"
#include "grow/cco/law.h"
#include <stdbool.h>

/* The segment that leads to the bifurcation, and the two that leave it. */
enum { PROXIMAL, LEFT, RIGHT, ENDS };

/* The problem: everything that stays the same while the bifurcation moves. */
typedef struct Bifurcation {
    Vec3 end[ENDS];      /* mm; the far ends of the three segments, which differ */
    double burden[ENDS]; /* flow times viscosity of each segment [law.h] */
    Below below[2];      /* what hangs on the far ends of LEFT and RIGHT */
    Adjoint adjoint;     /* of the proximal segment */
    double radius_unit;  /* mm^(3/4); q times the proximal segment's gauge [law.h] */
    /* The price is the change of S_root to first order: from a segment of load_before and
     * cost_before in place of the bifurcation, plus `extra`. With all three 0 it is S_root but for
     * a constant. */
    double load_before, cost_before, extra;
    double least_length; /* mm; segments are no shorter than this */
    double least_widths; /* and no shorter than this many diameters */
    double least_part;   /* mm; PROXIMAL and LEFT may always be this short */
    double margin;       /* places are kept this many times the least length off the ends, >= 1 */
    bool straight;       /* whether PROXIMAL and LEFT must stay in line */
} Bifurcation;

/* The bifurcation at one place. */
typedef struct BifurcationState {
    Vec3 place; /* mm */
    double price;
    double length[ENDS]; /* mm */
    double radius[ENDS]; /* mm */
    double weight[ENDS]; /* d price / d length */
} BifurcationState;

/* Computes the state with the bifurcation at `place`, mm; not finite when a figure is beyond what a
 * double can hold. */
void bifurcation_at(const Law *law, const Bifurcation *problem, Vec3 place, BifurcationState *out);

/* Whether all three segments are as long as they have to be. */
bool bifurcation_is_long_enough(const Bifurcation *problem, const BifurcationState *state);

/* Finds in *place the point that is best for the state's weights, kept off the ends. False when the
 * state is not finite. */
bool bifurcation_next(const Bifurcation *problem, const BifurcationState *state, Vec3 *place);

/* Moves *state, which bifurcation_at filled, `rounds` times to the next place, whatever the lengths
 * there. False when a state is not finite. */
bool bifurcation_optimise(const Law *law, const Bifurcation *problem, int rounds,
                          BifurcationState *state);

#endif
