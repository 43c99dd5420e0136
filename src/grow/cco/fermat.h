/* The weighted Fermat point: where the weighted sum of three distances is least. */
#ifndef CORCAST_GROW_CCO_FERMAT_H
#define CORCAST_GROW_CCO_FERMAT_H

#include "geom/geom.h"

/* The result of fermat_point. */
typedef struct Fermat {
    Vec3 place;  /* the minimiser */
    int corner;  /* the corner that the minimiser coincides with; -1: none */
    Vec3 inward; /* at a corner: the direction, of any length, in which leaving it costs least */
} Fermat;

/* Finds the point that minimises sum_i weight[i] |x - corner[i]|. The corners differ, and the
 * weights are positive. The point lies in the triangle of the corners. */
Fermat fermat_point(const Vec3 corner[3], const double weight[3]);

/* Returns the point that minimises the same sum on the straight line from corner[0] to corner[1],
 * at least margin[0] and margin[1] away from them. If the margins do not fit, returns the middle
 * between them. */
Vec3 fermat_point_between(const Vec3 corner[3], const double weight[3], const double margin[2]);

#endif
