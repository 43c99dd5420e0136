/* Computes radii and target of a tree from its topology, lengths and flows, in one sweep from the
 * terminals to the root. law_add_daughters sums the daughters of a segment, and law_add_segment
 * adds the segment itself. law_daughter_adjoint goes back from the root and gives derivatives.
 *
 * The target is the sum of l r^lambda over all segments of length l and radius r. Murray's law,
 * r_parent^gamma = sum of r_daughter^gamma, and Poiseuille's law with equal pressures at all
 * terminals fix the radii [docs/METHODS.md section 1.1]. A segment has these values:
 *
 * - N: its flow, divided by the mean flow of a terminal.
 * - m: its viscosity, divided by the reference viscosity mu. N m is called the burden.
 * - W, the load: N times the resistance of the segment and its subtree, in units of 8 mu / pi, with
 *   radii in units of the segment's own radius.
 * - rho = W^(1/4): the radius without the factors q and g below.
 * - X = rho^gamma (rho_gamma): Murray's law sums X over daughters.
 * - G: the sum of X over the daughters of the segment. P = G^(1/gamma).
 * - S (cost): the target of the segment and its subtree, without the factor (q g)^lambda.
 * - g, the gauge: 1 at a root segment. A daughter's gauge is the gauge of its parent times the
 *   parent's widening, rho / P.
 *
 * W = N m l + P^4, and S = rho^lambda l + (rho / P)^lambda times the sum of the daughters' S.
 *
 * The radius of a segment is r = q g rho. The radius unit q = (8 mu / pi Q_term / (p_perf -
 * p_term))^(1/4) is the same in the whole tree; Q_term is the mean flow of a terminal. The target
 * of the tree is q^lambda S_root, where S_root is the cost of the root segment. For a fixed number
 * of terminals, the least S_root therefore gives the least target.
 *
 * If gamma depends on the radius of the parent, each bifurcation has its own gamma, and so its own
 * Law. G and P of a segment use the law at its distal end; X uses the law at its proximal end. */
#ifndef CORCAST_GROW_CCO_LAW_H
#define CORCAST_GROW_CCO_LAW_H

#include "base/base.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The exponents at a bifurcation. */
typedef struct Law {
    double gamma;  /* Murray's exponent, in (0, 10] */
    double lambda; /* exponent of the radius in the target, >= 0 */
} Law;

/* The daughters of a segment with their subtrees, added up. All members are 0 at a terminal. Loads
 * are in mm, and rho is in mm^(1/4). */
typedef struct Subtree {
    double rho_gamma, cost; /* G, and the sum of S */
    double inverse;         /* 1 / P */
    double load;            /* P^4, which the subtree adds to the load of the segment, mm */
} Subtree;

/* The values of a segment, which include its subtree. */
typedef struct Reduced {
    double load;            /* W, mm */
    double rho_gamma;       /* X */
    double cost;            /* S */
    double rho;             /* W^(1/4) */
    double rho_lambda;      /* rho^lambda */
    double widening;        /* rho / P; 0 at a terminal */
    double widening_lambda; /* (rho / P)^lambda; 0 at a terminal */
    Subtree below;
} Reduced;

/* Derivatives of S_root with respect to the values of one segment. The adjoint of the root segment
 * is {0, 1}. */
typedef struct Adjoint {
    double load; /* partial derivative dS_root / d load, with the cost of the segment held fixed */
    double cost; /* dS_root / d cost */
} Adjoint;

/* Returns x^(-1/3) for a normal double x > 0, accurate to about one unit in the last place. The
 * first guess divides the bits of x by -3 in integer arithmetic, and adds a constant that makes its
 * error at most 3.4 %. Two steps use the first two terms of the series of (1 - e)^(-1/3), and a
 * third step uses the first term. No library function is called, and the build forbids fused
 * multiply-adds. Every machine therefore gives the same bits. */
static inline double inverse_cube_root(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = 0x553ef0ff289dd796u - bits / 3;
    double y;
    memcpy(&y, &bits, sizeof y);
    for (int i = 0; i < 2; i++) {
        double error = 1 - x * y * y * y;
        y += y * error * (1.0 / 3 + 2.0 / 9 * error);
    }
    double error = 1 - x * y * y * y;
    return y + y * error * (1.0 / 3);
}

/* Returns the radius unit q, mm^(3/4). If `flow` is instead the total flow of k terminals, the
 * result is q k^(1/4).
 *
 * viscosity  the reference viscosity, Pa s.
 * flow       flow through each terminal, mm^3/s.
 * drop       pressure at the inlet minus pressure at the terminals, Pa, above 0. */
static inline double law_radius_unit(double viscosity, double flow, double drop)
{
    return sqrt(sqrt(8 * viscosity / PI * flow / drop));
}

/* Returns x^lambda. A lambda of 0, 1 or 2 needs no call of elementary_pow. */
static inline double law_lambda_power(const Law *law, double x)
{
    if (law->lambda == 2)
        return x * x;
    if (law->lambda == 1)
        return x;
    if (law->lambda == 0)
        return 1;
    return elementary_pow(x, law->lambda);
}

/* Returns the subtree below a segment. `rho_gamma` and `cost` are sums over the daughters; both are
 * 0 at a terminal. `law` is the law at the segment's distal end. */
static inline Subtree law_add_daughters(const Law *law, double rho_gamma, double cost)
{
    Subtree out = {.rho_gamma = rho_gamma, .cost = cost};
    if (rho_gamma > 0 && law->gamma == 3) {
        out.inverse = inverse_cube_root(rho_gamma);
        double p2 = rho_gamma * out.inverse;
        out.load = p2 * p2;
    } else if (rho_gamma > 0) {
        double p = elementary_pow(rho_gamma, 1 / law->gamma), p2 = p * p;
        out.inverse = 1 / p;
        out.load = p2 * p2;
    }
    return out;
}

/* Returns the values of a segment with the length `length`, mm, the burden `burden` and the subtree
 * `below` at its distal end. `law` is the law at the segment's proximal end. Length and burden of a
 * terminal segment must be above 0, so that its load is above 0. */
static inline Reduced law_add_segment(const Law *law, double burden, double length,
                                      const Subtree *below)
{
    Reduced out = {.below = *below};
    out.load = burden * length + below->load;
    out.rho = sqrt(sqrt(out.load));
    if (law->gamma == 3) {
        out.rho_lambda = law_lambda_power(law, out.rho);
        out.rho_gamma = out.rho * out.rho * out.rho;
    } else if (law->lambda == 2 || law->lambda == 1 || law->lambda == 0) {
        out.rho_lambda = law_lambda_power(law, out.rho);
        out.rho_gamma = elementary_pow(out.rho, law->gamma);
    } else {
        Powers powers = elementary_powers(out.rho, law->lambda, law->gamma);
        out.rho_lambda = powers.a;
        out.rho_gamma = powers.b;
    }
    out.cost = out.rho_lambda * length;
    if (below->rho_gamma > 0) {
        out.widening = out.rho * below->inverse;
        out.widening_lambda = law_lambda_power(law, out.widening);
        out.cost += out.widening_lambda * below->cost;
    }
    return out;
}

/* Returns the total derivative dS_root / d load of the segment `at`, whose cost S changes with its
 * load W: S is W^(lambda/4) times a factor that does not depend on W, so dS / dW = lambda / 4 S /
 * W. */
static inline double law_load_derivative(const Law *law, const Reduced *at, Adjoint adjoint)
{
    return adjoint.load + adjoint.cost * law->lambda / 4 * at->cost / at->load;
}

/* Returns the adjoint of `daughter`. `adjoint` is the adjoint of its parent segment, and `law` is
 * the law at the bifurcation between the two segments. Uses the chain rule: the daughter changes G
 * by X = load^(gamma/4), and G changes P^4 = G^(4/gamma) and rho / P of the parent. */
static inline Adjoint law_daughter_adjoint(const Law *law, const Reduced *parent, Adjoint adjoint,
                                           const Reduced *daughter)
{
    double cost = adjoint.cost * parent->widening_lambda;
    double below = parent->below.load * law_load_derivative(law, parent, adjoint) -
                   law->lambda / 4 * cost * parent->below.cost;
    return (Adjoint){below * (daughter->rho_gamma / parent->below.rho_gamma) / daughter->load,
                     cost};
}

/* Returns dS_root / d length of the segment `at`, which has this burden. */
static inline double law_length_weight(const Law *law, const Reduced *at, Adjoint adjoint,
                                       double burden)
{
    return burden * law_load_derivative(law, at, adjoint) + adjoint.cost * at->rho_lambda;
}

#endif
