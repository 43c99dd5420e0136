/* A network's segments in the grid that answers what is near [grid.h]. */
#ifndef CORCAST_GROW_NETWORK_GRID_H
#define CORCAST_GROW_NETWORK_GRID_H

#include "grow/cco/grid.h"
#include "grow/network.h"

/* What segments must keep to while a tree grows. */
typedef struct Rules {
    double thickness;    /* vessels count at their radii times this, in [0, 1] */
    double least_length; /* mm; segments are at least this long, and as long as wide */
    double gap;          /* mm; the least distance of vessels without a common node */
    double apart;        /* mm; the least distance of the walls of vessels of different trees */
    double pair;         /* mm; the distance of the ends of paired terminals; 0: there are none */
    double widest;       /* mm; vessels count as no thicker than this */
} Rules;

/* How far apart, mm, the centrelines of two vessels have to be that should be `clear`; those of a
 * pair of terminals no farther than their ends are, whatever their widths: they are thick while a
 * tree has few, and thin in the end. */
static inline double clear_of_mate(const Rules *rules, double clear)
{
    const double most = 0.99 * rules->pair;
    return clear < most ? clear : most;
}

/* The radius, mm, of the capsule that stands in the grid for a vessel of `radius` mm: 1.4 times as
 * wide, so that the vessel may widen for a while before it has to be entered anew. */
static inline double entry_reach(const Rules *rules, double radius)
{
    const double reserve = 1.4;
    double reach = reserve * rules->thickness * radius;
    return (reach < rules->widest ? reach : rules->widest) + rules->gap + rules->apart;
}

/* Enters a segment, by its radius as of the last refresh, in every cell that its capsule meets. One
 * without length is in no cell: others begin and end there. Not while threads use the grid.
 * STATUS_MEMORY. */
MUST_CHECK Status entry_add(Grid *grid, const Rules *rules, const Network *net, int32_t segment,
                            Err *err);
/* Takes the segment out and enters it anew, after its ends moved or it widened. */
MUST_CHECK Status entry_renew(Grid *grid, const Rules *rules, const Network *net, int32_t segment,
                              Err *err);
/* To be called after network_refresh: copies all radii into the grid, and enters anew the segments
 * that outgrew their capsules. O(n). */
MUST_CHECK Status entries_widen(Grid *grid, const Rules *rules, const Network *net, Err *err);

#endif
