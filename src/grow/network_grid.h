/* The segments of a network in the grid of segments, with room to widen. */
#ifndef CORCAST_GROW_NETWORK_GRID_H
#define CORCAST_GROW_NETWORK_GRID_H

#include "grow/cco/grid.h"
#include "grow/network.h"

/* What a new connection must keep to. */
typedef struct Rules {
    double thickness;    /* how much of their radii vessels are taken to have, in [0, 1] */
    double least_length; /* mm; segments are at least this long and `thickness` diameters */
    double gap;          /* mm; vessels without a common node are further apart than this */
    double widest;       /* mm; vessels count as no thicker than this */
} Rules;

/* The radius of the capsule that stands in the grid for a vessel of `radius`: with room to widen
 * until the grid is made anew. */
static inline double entry_reach(const Rules *rules, double radius)
{
    const double reserve = 1.4;
    double reach = reserve * rules->thickness * radius;
    return (reach < rules->widest ? reach : rules->widest) + rules->gap;
}

/* Enters a segment of the tree, unless it has no length: others begin and end there. */
MUST_CHECK Status entry_add(Grid *grid, const Rules *rules, const Network *net, int32_t segment,
                            Err *err);
/* Enters it anew, after it moved or widened. */
MUST_CHECK Status entry_renew(Grid *grid, const Rules *rules, const Network *net, int32_t segment,
                              Err *err);
/* Brings all radii in the grid up to date with the network's. */
MUST_CHECK Status entries_widen(Grid *grid, const Rules *rules, const Network *net, Err *err);

#endif
