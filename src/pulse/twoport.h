/* Computes the two-port of a vessel for two harmonics at a time. Private to the module pulse.
 * Pressures are in Pa, flows in mm^3/s, and admittances in mm^3/s/Pa.
 *
 * A PairR holds one real number for each of the two harmonics. It is a vector of two doubles, for
 * which every x86-64 processor has registers; the compiler emulates it elsewhere. All processors
 * therefore give the same bits. */
#ifndef CORCAST_PULSE_TWOPORT_H
#define CORCAST_PULSE_TWOPORT_H

#include "pulse/pulse.h"

enum { PAIR = PULSE_LANES };

typedef double PairR __attribute__((vector_size(8 * PAIR)));

/* A complex number per harmonic. */
typedef struct PairC {
    PairR re, im;
} PairC;

/* Constants of two harmonics that are the same for all vessels. */
typedef struct PairFrequency {
    PairR omega;     /* angular frequency, 1/s */
    PairC compliant; /* j omega / (1 + j omega t_w), t_w the relaxation time of the wall */
} PairFrequency;

/* The two-port of a vessel. It relates the proximal end (in) to the distal end (out): p_in = (a
 * p_out + b q_out) / scale, q_in = (c p_out + a q_out) / scale. The scale is 1, except where cosh
 * would overflow. */
typedef struct PairPort {
    PairC a, b, c;
    PairR scale;
} PairPort;

/* Returns the same complex number for both harmonics. */
static inline PairC pairc(double re, double im)
{
    return (PairC){(PairR){0} + re, (PairR){0} + im};
}

static inline PairC pairc_add(PairC x, PairC y)
{
    return (PairC){x.re + y.re, x.im + y.im};
}

static inline PairC pairc_mul(PairC x, PairC y)
{
    return (PairC){x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re};
}

static inline PairC pairc_scale(PairC x, PairR k)
{
    return (PairC){x.re * k, x.im * k};
}

static inline PairC pairc_inverse(PairC x)
{
    PairR k = 1 / (x.re * x.re + x.im * x.im);
    return (PairC){x.re * k, -x.im * k};
}

/* Returns the constants of the harmonics `first` and first + 1. `first` is at least 1. */
PairFrequency pairfrequency(int first, double period_s, double wall_time_s);

/* Returns the complex friction factor [pulse_friction]. `u` is the squared Womersley number, with
 * the radius, of each harmonic [PulseVessel.womersley_s]. */
PairC pair_friction(PairR u);

/* Returns the two-port of a vessel at the two frequencies `at`. */
PairPort pair_port(const PulseVessel *vessel, const PairFrequency *at);

/* Returns the admittance at the proximal end of a vessel. `load` is the admittance at its distal
 * end. The result does not depend on port->scale. *inverse receives 1 / (a + b load); p_out = scale
 * * *inverse * p_in. */
static inline PairC pairport_load(const PairPort *port, PairC load, PairC *inverse)
{
    *inverse = pairc_inverse(pairc_add(port->a, pairc_mul(port->b, load)));
    return pairc_mul(pairc_add(port->c, pairc_mul(port->a, load)), *inverse);
}

#endif
