/* The program's own random generator, so that one seed gives one stream on every machine:
 * xoshiro256** 1.0 (Blackman & Vigna, ACM TOMS 47 (2021), 36), seeded through splitmix64. */
#ifndef CORCAST_BASE_RANDOM_H
#define CORCAST_BASE_RANDOM_H

#include <stdint.h>

typedef struct Random {
    uint64_t state[4];
} Random;

/* Sets the state; any seed will do, 0 as well. */
void random_seed(Random *random, uint64_t seed);
/* 64 random bits. */
uint64_t random_bits(Random *random);
/* Uniform in [0, 1), a multiple of 2^-53. */
double random_uniform(Random *random);

#endif
