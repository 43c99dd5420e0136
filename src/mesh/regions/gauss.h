/* Fast exp(-x) and erf(x), for the terms of the potential. Their precision suffices for a surface
 * in single precision; they take a fifth of the time of the C library's functions. Each computes
 * two values at once, in a vector register. All numbers are dimensionless. Private to the module
 * mesh. */
#ifndef CORCAST_MESH_REGIONS_GAUSS_H
#define CORCAST_MESH_REGIONS_GAUSS_H

#include <stdint.h>

/* For x above this, 1 - erf(x) is below 2e-9. */
#define GAUSS_SATURATED 4.25

/* Two numbers in one vector register. */
typedef double Pair __attribute__((vector_size(16)));
/* The bits of a Pair, and a mask: all bits of a number set, or none. */
typedef uint64_t PairBits __attribute__((vector_size(16)));

/* Returns, per number, a where the mask is set, else b. */
static inline Pair pair_select(PairBits mask, Pair a, Pair b)
{
    return (Pair)((mask & (PairBits)a) | (~mask & (PairBits)b));
}

/* The sign bits. */
static const PairBits pair_sign = {0x8000000000000000u, 0x8000000000000000u};

/* Returns |x| of both numbers. */
static inline Pair pair_abs(Pair x)
{
    return (Pair)((PairBits)x & ~pair_sign);
}

/* Returns exp(-x) of both numbers, which must be >= 0. The relative error is below 1e-8 where the
 * result is above 1e-300. For x above 690, where exp(-x) is below 1e-300, the result is exp(-690).
 *
 * The result is 2^n e^f with |f| <= ln 2 / 2; e^f is computed by its power series. Adding 1.5 *
 * 2^52 rounds a number to an integer: n is then in the lowest bits of the sum. */
static inline Pair exp_minus_pair(Pair x)
{
    x = pair_select((PairBits)(x < 690), x, (Pair){690, 690});
    Pair shifted = x * -1.4426950408889634 + 0x1.8p52, n = shifted - 0x1.8p52;
    Pair f = -x - n * 0.69314718055994531;
    Pair f2 = f * f;
    Pair even = 1 + f2 * (1.0 / 2 + f2 * (1.0 / 24 + f2 * (1.0 / 720)));
    Pair odd = 1 + f2 * (1.0 / 6 + f2 * (1.0 / 120 + f2 * (1.0 / 5040)));
    return (Pair)((PairBits)(even + f * odd) + ((PairBits)shifted << 52));
}

/* Returns exp(-x) of one number x >= 0, as exp_minus_pair. */
static inline double exp_minus(double x)
{
    return exp_minus_pair((Pair){x, x})[0];
}

/* Returns erf(x) of both numbers with an absolute error below 3e-7 [M. Abramowitz, I. Stegun:
 * Handbook of Mathematical Functions, 7.1.28]. The result is exactly 1 for x above GAUSS_SATURATED,
 * and exactly -1 for x below -GAUSS_SATURATED. */
static inline Pair erf_pair(Pair x)
{
    const Pair one = {1, 1};
    Pair a = pair_abs(x);
    Pair p =
        1 +
        a * (0.0705230784 +
             a * (0.0422820123 +
                  a * (0.0092705272 + a * (0.0001520143 + a * (0.0002765672 + a * 0.0000430638)))));
    p *= p;
    p *= p;
    p *= p;
    Pair magnitude = pair_select((PairBits)(a > GAUSS_SATURATED), one, 1 - 1 / (p * p));
    return (Pair)(((PairBits)x & pair_sign) | (PairBits)magnitude);
}

#endif
