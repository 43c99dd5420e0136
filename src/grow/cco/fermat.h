/* The weighted Fermat point: where three weighted lengths that meet are shortest; in space, and on
 * a straight line. */
#ifndef CORCAST_GROW_FERMAT_H
#define CORCAST_GROW_FERMAT_H

#include "geom/geom.h"

/* The outcome of fermat_point. */
typedef struct Fermat {
    Vec3 place;  /* the minimiser */
    int corner;  /* the corner it coincides with, -1 when it lies off all three */
    Vec3 inward; /* at a corner: the direction (not unit) in which leaving it costs least */
} Fermat;

/* The point that minimises sum_i weight[i] |x - corner[i]|. The corners differ; weights are
 * positive. In space it lies in the plane of the corners, always in their triangle. */
Fermat fermat_point(const Vec3 corner[3], const double weight[3]);

/* The point between corner[0] and corner[1], margin[0] and margin[1] or more away from them, that
 * minimises the same sum; midway between the margins when these are wider than the distance. */
Vec3 fermat_point_between(const Vec3 corner[3], const double weight[3], const double margin[2]);

#endif
