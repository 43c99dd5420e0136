/* The weighted Fermat point: where the weighted sum of three distances is least. */
#ifndef CORCAST_GROW_CCO_FERMAT_H
#define CORCAST_GROW_CCO_FERMAT_H

#include "geom/geom.h"

/* The result of fermat_point. */
typedef struct Fermat {
    Vec3 place;  /* the point with the least sum */
    int corner;  /* 0 to 2: the corner that the point coincides with; -1: none */
    Vec3 inward; /* if `corner` is not -1: the direction, of any length, in which the sum rises
                  * least when the point leaves the corner */
} Fermat;

/* Finds the point x that minimises sum_i weight[i] |x - corner[i]|, which lies in the triangle of
 * the corners. The corners must differ, and the weights must be above 0. Positions and results have
 * the same unit of length. Cost: O(1), in closed form. */
Fermat fermat_point(const Vec3 corner[3], const double weight[3]);

/* Returns the point that minimises the same sum on the straight line from corner[0] to corner[1],
 * at least margin[0] from corner[0] and margin[1] from corner[1]. If the line is shorter than both
 * margins together, returns the point half way between the two ends of the margins. */
Vec3 fermat_point_between(const Vec3 corner[3], const double weight[3], const double margin[2]);

#endif
