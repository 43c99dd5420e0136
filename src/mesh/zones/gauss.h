/* The two functions that terms of the potential are made of, as exact as a wall in single precision
 * needs: a fifth of what the C library's take. */
#ifndef CORCAST_MESH_ZONES_GAUSS_H
#define CORCAST_MESH_ZONES_GAUSS_H

#include <stdint.h>

/* From here on 1 - erf(x) is below 2e-9. */
#define GAUSS_SATURATED 4.25

/* Two numbers that go the same way, in one register. */
typedef double Pair __attribute__((vector_size(16)));
typedef uint64_t PairBits __attribute__((vector_size(16)));

/* Of each number a where the mask is set, else b. */
static inline Pair pair_select(PairBits mask, Pair a, Pair b)
{
    return (Pair)((mask & (PairBits)a) | (~mask & (PairBits)b));
}

static const PairBits pair_sign = {0x8000000000000000u, 0x8000000000000000u};

static inline Pair pair_abs(Pair x)
{
    return (Pair)((PairBits)x & ~pair_sign);
}

/* exp(-x) of x >= 0 to 1e-8 of itself, where that is above 1e-300: 2^n e^f, |f| <= ln 2 / 2, and
 * e^f by its series. The sum with 1.5 2^52 rounds to whole numbers, and has n in its lowest bits.
 */
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

static inline double exp_minus(double x)
{
    return exp_minus_pair((Pair){x, x})[0];
}

/* erf(x) to 3e-7 [M. Abramowitz, I. Stegun: Handbook of Mathematical Functions, 7.1.28]; 1 where it
 * lacks less than 2e-9 of that. */
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
    Pair size = pair_select((PairBits)(a > GAUSS_SATURATED), one, 1 - 1 / (p * p));
    return (Pair)(((PairBits)x & pair_sign) | (PairBits)size);
}

#endif
