/* Proves a lower bound of the target of all trees with one topology, and finds a geometry whose
 * target is near the bound. Call bound_tree, then bound_put_certificate for the proof as text.
 *
 * The target is the sum of l r^lambda over the segments of length l and radius r. Outlets are the
 * nodes at which blood leaves the tree. These properties of the tree are fixed:
 *
 * - the topology, that is, which outlets are below which segment;
 * - the positions of inlets and outlets, and the flows of the outlets;
 * - the pressure drop from the inlet to each outlet, which follows from the radii of the given tree
 *   by Poiseuille's law with one viscosity.
 *
 * All radii, and the positions and pressures of the bifurcations, are free. No tree with the same
 * fixed properties has a target below the bound. The bound holds for any Murray exponent, and
 * whatever minimum length of segments or minimum distance of vessels is required. It also holds for
 * trees with smaller pressure drops.
 *
 *     TRY(bound_tree(&tree, 2, &bound, err));
 *     bound_put_certificate(&bound, &tree, &text);    (then bound_release) */
#ifndef CORCAST_GROW_BOUND_BOUND_H
#define CORCAST_GROW_BOUND_BOUND_H

#include "base/base.h"
#include "geom/geom.h"
#include "tree/tree.h"

/* The exponents lambda that bound_tree accepts, both ends included. Reason for the ends not
 * recorded. */
#define BOUND_LAMBDA_RANGE ((Range){0.5, 4})

/* An outlet, and the Lagrange multipliers of its position and of its pressure drop. These dual
 * variables prove the bound [docs/METHODS.md section 1.5]. */
typedef struct Outlet {
    int32_t node;  /* index of the node in the tree */
    double flow;   /* flow share, above 0 */
    Vec3 pull;     /* multiplier of the position, mm^lambda */
    double charge; /* multiplier of the pressure drop, mm^(1 + lambda) per unit of pressure, >= 0.
                    * The unit of pressure is 8 mu Q / (pi mm^3), where Q is the flow of the flow
                    * share 1 */
} Outlet;

typedef struct Bound {
    double lambda;
    /* Targets, mm^(1 + lambda): */
    double target;  /* of the given tree, without segments that carry no flow */
    double best;    /* of the best geometry found, with free radii; at most `target` */
    double murray;  /* of the best geometry with radii by Murray's law; NAN if the tree states no
                     * Murray exponent, or its outlets have different pressures */
    double bound;   /* the proved lower bound; 0 if no bound above 0 was proved */
    int steps;      /* number of steps of Newton's method */
    Outlet *outlet; /* owned; in the order of the nodes */
    size_t outlets;
} Bound;

/* Computes a lower bound of the target with the exponent `lambda`. Does not change the tree. The
 * result is reproducible bit for bit.
 *
 * out      receives the bound; release it with bound_release.
 * Errors   STATUS_USAGE if `lambda` is out of BOUND_LAMBDA_RANGE. STATUS_INPUT if no blood flows,
 *          if blood flows through a segment of radius 0, or if no pressure drops on the path to an
 *          outlet. STATUS_MEMORY.
 * Cost     15 to 30 steps of O(n), in all about 20 s for 10^6 outlets. Memory: 300 bytes per
 *          node. */
MUST_CHECK Status bound_tree(const Tree *tree, double lambda, Bound *out, Err *err);
/* Frees the outlets and zeroes *bound, which may be zeroed before. */
void bound_release(Bound *bound);

/* Appends the proof of bound->bound as text [docs/FORMATS.md, Certificates]. The text refers to
 * nodes by their ids in the tree's SWC file. `tree` must be the tree that was passed to bound_tree.
 * If memory runs out, text_check [base/text.h] reports it. */
void bound_put_certificate(const Bound *bound, const Tree *tree, Text *text);

#endif
