/* A random generator that gives the same numbers for the same seed on every machine.
 *
 *     Random random;
 *     random_seed(&random, 1);
 *     double x = random_uniform(&random);
 *
 * The generator is xoshiro256** 1.0 (Blackman & Vigna, ACM TOMS 47 (2021), 36); splitmix64 spreads
 * the seed over its state. Each thread needs a Random of its own. */
#ifndef CORCAST_BASE_RANDOM_H
#define CORCAST_BASE_RANDOM_H

#include <stdint.h>

typedef struct Random {
    uint64_t state[4];
} Random;

/* Sets the state from a seed, which may be any number, also 0. */
void random_seed(Random *random, uint64_t seed);
/* Returns 64 random bits. */
uint64_t random_bits(Random *random);
/* Returns a uniformly distributed number in [0, 1), a multiple of 2^-53. */
double random_uniform(Random *random);

#endif
