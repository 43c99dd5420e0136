/* A proved lower bound of the target of all trees of one topology, and a geometry that comes near
 * it.
 *
 * Outlets are the nodes at which blood leaves the tree. Fixed are: which outlets are below which
 * segment, the positions and flows of outlets, the positions of inlets, and for each outlet the
 * drop of pressure from its inlet, which follows from the tree's own radii by Poiseuille's law with
 * one viscosity. Free are the radii, and the positions and pressures of bifurcations. The bound is
 * below the target of any such tree, for any Murray exponent and any rules of length and clearance,
 * and also if less pressure drops on the path to an outlet. */
#ifndef CORCAST_GROW_BOUND_BOUND_H
#define CORCAST_GROW_BOUND_BOUND_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/tree.h"

/* The exponents of the target that a bound is computed for. */
#define BOUND_LAMBDA_RANGE ((Range){0.5, 4})

/* The least cost of the flow through an outlet: the multipliers of its position and of its pressure
 * drop [METHODS 1.5]. */
typedef struct Outlet {
    int32_t node;  /* node of the tree */
    double flow;   /* flow share */
    Vec3 pull;     /* mm^lambda */
    double charge; /* mm^(1 + lambda) for each unit of drop: 8 mu / pi times one unit of share, over
                      mm^3 */
} Outlet;

typedef struct Bound {
    double lambda;
    double target; /* sum of l r^lambda over the segments that blood flows through, mm^(1+lambda) */
    double best;   /* target of the best geometry found, with free radii */
    double murray; /* target of that geometry with radii by Murray's law; NAN if the tree states no
                    * Murray exponent, or its outlets have different pressures */
    double bound;  /* proved lower bound of the target */
    int steps;     /* of Newton's method */
    Outlet *outlet; /* owned; in the order of the nodes */
    size_t outlets;
} Bound;

/* Computes a lower bound of the target with the exponent `lambda`. The same tree gives the same
 * bits.
 *
 * out      receives the bound; release it with bound_release.
 * Errors   STATUS_USAGE if `lambda` is out of BOUND_LAMBDA_RANGE. STATUS_INPUT if no blood flows,
 *          if blood flows through a segment of radius 0, or if no pressure drops on the path to an
 *          outlet. STATUS_MEMORY.
 * Cost     O(n) for each of 15 to 30 steps: 20 s for 10^6 outlets, and 300 bytes per node. */
MUST_CHECK Status bound_tree(const Tree *tree, double lambda, Bound *out, Err *err);
void bound_release(Bound *bound);

/* Appends the proof of bound->bound as text [FORMATS, Certificates]. It refers to nodes by their
 * ids in the tree's SWC. */
void bound_put_certificate(const Bound *bound, const Tree *tree, Text *text);

#endif
