/* The weighted Fermat point: the point at which the weighted sum of its distances to three corners
 * is least. The best position of a bifurcation is such a point [bifurcation.h]. */
#ifndef CORCAST_GROW_CCO_FERMAT_H
#define CORCAST_GROW_CCO_FERMAT_H

#include "geom/geom.h"

/* The result of fermat_point. */
typedef struct Fermat {
    Vec3 place;  /* the Fermat point */
    int corner;  /* index of the corner that coincides with the point, 0 to 2; -1: none */
    Vec3 inward; /* if `corner` is not -1: the direction, away from the corner, in which the sum
                  * rises least; a vector of any length */
} Fermat;

/* Finds the point x that minimises sum_i weight[i] |x - corner[i]|, which lies in the triangle of
 * the corners. The corners must differ, and the weights must be above 0. Positions and results have
 * the same unit of length. Cost: O(1), in closed form. */
Fermat fermat_point(const Vec3 corner[3], const double weight[3]);

/* Returns the point on the straight line from corner[0] to corner[1] that minimises the sum of
 * fermat_point. The point is at least margin[0] from corner[0] and margin[1] from corner[1]. If the
 * line is shorter than margin[0] + margin[1], both distances fall short of their margins by the
 * same amount. */
Vec3 fermat_point_between(const Vec3 corner[3], const double weight[3], const double margin[2]);

#endif
