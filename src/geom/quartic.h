/* Finds the real roots of polynomials of degree 4. The number of sign changes of the Bernstein
 * coefficients isolates each root, so that no simple root is missed. */
#ifndef CORCAST_GEOM_QUARTIC_H
#define CORCAST_GEOM_QUARTIC_H

/* Finds the roots of a quartic in [low, high). Returns their number, at most 4.
 *
 * b        the Bernstein coefficients of the quartic on [low, high].
 * roots    receives the roots in rising order. Two roots closer than 2^-32 of the interval's length
 *          are left out: the quartic only touches zero there. */
int quartic_roots(const double b[5], double low, double high, double roots[4]);

#endif
