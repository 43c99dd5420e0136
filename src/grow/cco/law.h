/* The law of a tree: how a segment and the subtree below it add up by Murray's law, Poiseuille's
 * law and the target. Reduced quantities make one step up the tree a few multiplications.
 *
 * A segment has the length l, the flow N relative to a terminal's mean flow, and the viscosity m
 * relative to a reference mu. N m is its burden. R* (in units of 8 mu / pi) and V* are the reduced
 * resistance and target of METHODS 1.1; the target is the sum of length times radius^lambda. The
 * reduced quantities of a segment are:
 *
 * - Load W = N R*, and rho = W^(1/4), which is the radius without the factors q and g below.
 *
 * - X = rho^gamma, the member rho_gamma, which Murray's law adds up. For the subtrees on the distal
 * end of a segment, G is the sum of X over the daughters, and P = G^(1/gamma).
 *
 * - S = rho^lambda V*, the member cost, which is the target without the factor q^lambda
 *   g^lambda.
 *
 * W = N m l + P^4, and S = rho^lambda l + (rho / P)^lambda times the sum of the daughters' S.
 *
 * If gamma depends on the radius of the parent, each fork has its own gamma. G and P of a segment
 * use the gamma of the fork at its distal end, X uses the gamma of the fork at its proximal end.
 * Each function states which of the two laws it receives. Only law_gather, and rho_gamma of
 * law_extend, depend on gamma.
 *
 * The radius is r = q g rho. q = (8 mu / pi Q_term / (p_perf - p_term))^(1/4) is the radius unit of
 * the tree. g is the gauge of the segment: 1 at the root, and from a segment to its daughters
 * multiplied by the segment's widening, rho / P. The target is T = q^lambda S_root, so for a fixed
 * number of terminals the least S_root gives the least T. */
#ifndef CORCAST_GROW_CCO_LAW_H
#define CORCAST_GROW_CCO_LAW_H

#include "base/base.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct Law {
    double gamma;  /* in (0, 10] */
    double lambda; /* >= 0 */
} Law;

/* The subtree at the distal end of a segment: all daughters together. All members are 0 at a
 * terminal. Lengths are in mm, so loads are in mm, rho in mm^(1/4). */
typedef struct Below {
    double rho_gamma, cost; /* G, and the sum of S */
    double inverse;         /* 1 / P */
    double load;            /* P^4, the part of the segment's load that the subtree adds, mm */
} Below;

/* A segment together with the subtree below it. */
typedef struct Reduced {
    double load;            /* W, mm */
    double rho_gamma;       /* X */
    double cost;            /* S */
    double rho;             /* W^(1/4) */
    double rho_lambda;      /* rho^lambda */
    double widening;        /* rho / P; 0 at a terminal */
    double widening_lambda; /* (rho / P)^lambda; 0 at a terminal */
    Below below;
} Reduced;

/* Derivatives of S_root, the cost of the root segment. The root's own adjoint is {0, 1}. */
typedef struct Adjoint {
    double load; /* with respect to a segment's load, while its cost is held fixed */
    double cost; /* with respect to its cost */
} Adjoint;

/* Returns x^(-1/3) for a normal double x > 0, accurate to about one unit in the last place.
 * Dividing the exponent by -3 in integer arithmetic gives a first guess, at most 3.4 % off. Two
 * steps with the first two terms of the series of (1 - e)^(-1/3), and one with the first term,
 * follow. No library function is used, and the build forbids fused multiply-adds, so that every
 * machine gives the same bits. */
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

/* Returns the radius unit q, mm^(3/4), of a tree whose terminals carry `flow` mm^3/s each at a
 * pressure `drop` Pa, above 0, below the inlet's, for blood of `viscosity` Pa s. If `flow` is the
 * total flow of N terminals, the result is q N^(1/4). */
static inline double law_radius_unit(double viscosity, double flow, double drop)
{
    return sqrt(sqrt(8 * viscosity / PI * flow / drop));
}

/* Returns x^lambda. The exponents 0, 1 and 2 need no function call. */
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

/* Returns the subtree below a segment, from the sums of the daughters' rho_gamma and cost; both
 * sums are 0 at a terminal. `law` is the law at the segment's distal end. */
static inline Below law_gather(const Law *law, double rho_gamma, double cost)
{
    Below out = {.rho_gamma = rho_gamma, .cost = cost};
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

/* Returns the segment of `length` mm with this `burden`, together with the subtree `below` it.
 * `law` is the law at the segment's proximal end. The load must be above 0: a terminal's segment
 * has length and burden above 0. */
static inline Reduced law_extend(const Law *law, double burden, double length, const Below *below)
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

/* Returns dS_root / d load of the segment `at`, including the change of its cost with the load:
 * S = W^(lambda/4) V*, so dS / dW = lambda / 4 S / W. */
static inline double law_total(const Law *law, const Reduced *at, Adjoint adjoint)
{
    return adjoint.load + adjoint.cost * law->lambda / 4 * at->cost / at->load;
}

/* Returns the adjoint of `daughter`, a daughter of `parent`, whose adjoint is `adjoint`. `law` is
 * the law at the fork between them. By the chain rule through the parent's P^4 = G^(4/gamma) and
 * rho / P, where X of the daughter is load^(gamma/4). */
static inline Adjoint law_descend(const Law *law, const Reduced *parent, Adjoint adjoint,
                                  const Reduced *daughter)
{
    double cost = adjoint.cost * parent->widening_lambda;
    double below = parent->below.load * law_total(law, parent, adjoint) -
                   law->lambda / 4 * cost * parent->below.cost;
    return (Adjoint){below * (daughter->rho_gamma / parent->below.rho_gamma) / daughter->load,
                     cost};
}

/* Returns dS_root / d length of the segment `at`, which carries `burden`. */
static inline double law_length_weight(const Law *law, const Reduced *at, Adjoint adjoint,
                                       double burden)
{
    return burden * law_total(law, at, adjoint) + adjoint.cost * at->rho_lambda;
}

#endif
