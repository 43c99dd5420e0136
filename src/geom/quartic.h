/* Roots of quartics, found by proof. */
#ifndef CORCAST_GEOM_QUARTIC_H
#define CORCAST_GEOM_QUARTIC_H

/* The roots in [low, high), rising, of the quartic whose Bernstein coefficients on that interval
 * are b: how many, at most 4. Two that lie within 2^-32 of its length, where the graph only touches
 * zero, are none. */
int quartic_roots(const double b[5], double low, double high, double roots[4]);

#endif
