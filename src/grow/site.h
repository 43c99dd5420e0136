/* The site of growth: the network, a grid that finds the segments near a point or segment, the
 * domain, and the rules that segments keep. Growth, connections and repairs all work on one site.
 *
 * The grid must be kept up to date: site_enter after a segment was added, site_renew after its ends
 * moved, and site_widen after network_refresh has changed the radii. */
#ifndef CORCAST_GROW_SITE_H
#define CORCAST_GROW_SITE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/network.h"

/* Rules that segments keep while a tree grows. */
typedef struct Rules {
    double thickness;    /* vessels count at this multiple of their radii, in [0, 1] */
    double least_length; /* mm; minimum length of a segment, which is also at least its diameter */
    double gap;          /* mm; minimum distance of two vessels without a common node */
    double apart;        /* mm; minimum distance of the walls of vessels of different trees */
    double pair;   /* mm; distance of the ends of paired terminals; 0: no terminals are paired */
    double widest; /* mm; vessels count as no thicker than this */
} Rules;

typedef struct Site {
    Network net;
    Grid grid;            /* the segments of `net`; zeroed before the first segment is added */
    const Domain *domain; /* borrowed */
    Rules rules;
} Site;

/* Returns the distance, mm, that the centrelines of the vessels of two paired terminals must keep,
 * if vessels without a pair would have to keep `clear` mm. It is at most the distance of the
 * terminals' ends: vessels are thick while a tree has few terminals, and thin in the end. */
static inline double clear_of_mate(const Rules *rules, double clear)
{
    const double most = 0.99 * rules->pair;
    return clear < most ? clear : most;
}

/* Returns the radius, mm, of the capsule that represents a vessel of `radius` mm in the grid. The
 * capsule is 1.4 times as wide as the vessel, so that the vessel may widen for a while before it
 * has to be entered again. */
static inline double site_reach(const Rules *rules, double radius)
{
    const double reserve = 1.4;
    double reach = reserve * rules->thickness * radius;
    return (reach < rules->widest ? reach : rules->widest) + rules->gap + rules->apart;
}

/* Enters a segment, with its radius of the last refresh, in every cell that its capsule meets. A
 * segment without length is entered in no cell: other segments begin and end there. No thread may
 * use the grid meanwhile. Errors: STATUS_MEMORY. */
MUST_CHECK Status site_enter(Site *site, int32_t segment, Err *err);

/* Removes a segment from the grid and enters it again, after its ends moved or it widened.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status site_renew(Site *site, int32_t segment, Err *err);

/* Copies all radii of the last network_refresh into the grid, and enters the segments again that
 * have outgrown their capsules. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status site_widen(Site *site, Err *err);

#endif
