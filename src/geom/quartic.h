/* Real roots of polynomials of degree 4. Each root is isolated by counting sign changes, so that no
 * simple root is missed. */
#ifndef CORCAST_GEOM_QUARTIC_H
#define CORCAST_GEOM_QUARTIC_H

/* Finds the roots of a quartic in [low, high), by rising value. Returns their number, at most 4.
 *
 * b        Bernstein coefficients of the quartic on the interval.
 * roots    receives the roots. Two roots closer than 2^-32 of the interval's length, where the
 *          graph only touches zero, are left out. */
int quartic_roots(const double b[5], double low, double high, double roots[4]);

#endif
