/* A trunk: segments that keep their radii. What flows through them drops pressure by Poiseuille's
 * law, and a subtree that leaves the trunk has what is left of the drop, so its gauge [law.h] is
 * (share of the drop that is left)^(-1/4). A trunk begins at an inlet and is connected. */
#ifndef CORCAST_GROW_TRUNK_H
#define CORCAST_GROW_TRUNK_H

#include "grow/network.h"

/* The greatest share of the drop of pressure that may be spent along a trunk. */
#define TRUNK_MOST_SPENT 0.999

/* The share of the whole drop of pressure that is spent along the first `part`, in [0, 1], of the
 * kept segment i if it carries the flow of that many terminals. Needs its length. */
static inline double trunk_spent(const Network *net, int32_t i, int32_t terminals, double part)
{
    double unit = net->radius_unit / net->trunk->radius[i], unit2 = unit * unit;
    return unit2 * unit2 * network_burden(net, i, terminals) * net->segment[i].length * part;
}

/* The gauge of what begins where a share `spent` of the drop was spent on a segment of this gauge;
 * while a tree grows, what is spent counts as TRUNK_MOST_SPENT at most. */
double trunk_gauge(double gauge, double spent);

/* Computes gauge, radius and sensitivity of segment i, which sums up to `reduced`, from those of
 * the kept segment `parent`. */
void trunk_set_daughter(Network *net, int32_t i, const Reduced *reduced, int32_t parent);

/* Brings gauges and stakes of all kept segments up to date; part of network_refresh. Needs right
 * sums. O(kept segments). */
void trunk_refresh(Network *net);

/* The largest share of the drop that is spent on the way to the end of a kept segment, which is
 * *where. `spent` has room for one number for each node. Nodes are in depth-first order. */
double trunk_most_spent(const Network *net, double *spent, size_t *where);

#endif
