/* A proved lower bound of the target of all trees of one topology, and the geometry that comes near
 * it.
 *
 * Outlets are the nodes that blood leaves the tree at. Given are: which outlets lie below which
 * segment, the places and flows of outlets, the places of inlets, and for each outlet the drop of
 * pressure from its inlet, which follows from the tree's own radii by Poiseuille's law with one
 * viscosity. Free are the radii, the places of bifurcations and the pressures there. The bound is
 * below the target of any such tree, whatever Murray exponent it has, whatever rules of length and
 * clearance it keeps, and also if less pressure drops on the way to an outlet. */
#ifndef CORCAST_GROW_BOUND_H
#define CORCAST_GROW_BOUND_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/tree.h"

/* The exponents of the target that a bound is computed for. */
#define BOUND_LAMBDA_RANGE ((Range){0.5, 4})

/* What the flow through an outlet costs at the least: the multipliers of its place and of its drop
 * [METHODS 1.5]. */
typedef struct Outlet {
    int32_t node;  /* of the tree */
    double flow;   /* its share */
    Vec3 pull;     /* mm^lambda */
    double charge; /* mm^(1 + lambda) for each unit of drop: 8 mu / pi times one unit of share, over
                      mm^3 */
} Outlet;

typedef struct Bound {
    double lambda;
    double target; /* sum of l r^lambda over the segments that blood flows through, mm^(1+lambda) */
    double best;   /* of the best geometry found, its radii free */
    double murray; /* of that geometry with the radii that Murray's law gives; NAN where the tree
                      says no Murray exponent, or its outlets have different pressures */
    double bound;  /* proved */
    int steps;     /* of Newton's method */
    Outlet *outlet; /* owned; in the order of the nodes */
    size_t outlets;
} Bound;

/* Bounds the target with this exponent, in *out (owned; bound_release). The same tree gives the
 * same bits. O(n) for each of 15 to 30 steps: 20 s for 10^6 outlets, and 300 bytes a node.
 * STATUS_USAGE for an exponent out of range, STATUS_INPUT when no blood flows, when flow passes a
 * segment of radius 0, or when nothing drops on the way to an outlet, STATUS_MEMORY. */
MUST_CHECK Status bound_tree(const Tree *tree, double lambda, Bound *out, Err *err);
void bound_release(Bound *bound);

/* Appends the proof of bound->bound as text [FORMATS, Certificates], to be read beside the tree's
 * SWC. */
void bound_put_certificate(const Bound *bound, const Tree *tree, Text *text);

#endif
