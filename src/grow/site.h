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
    double thickness;    /* in [0, 1]; rules take the radius of a vessel times this factor, so that
                          * a full domain can take more terminals */
    double least_length; /* mm; a segment is at least this long, and at least as long as wide */
    double gap;          /* mm; minimum distance of the axes of vessels without a common node */
    double apart;        /* mm; minimum distance of the walls of vessels of different trees */
    double pair;         /* mm; distance of the ends of paired terminals; 0: none are paired */
    double widest;       /* mm; the largest radius that the grid takes for a vessel */
} Rules;

/* A site. The caller releases its network and its grid. */
typedef struct Site {
    Network net;
    Grid grid;            /* the segments of `net`; zeroed before the first segment is added */
    const Domain *domain; /* borrowed */
    Rules rules;
} Site;

/* Returns the distance, mm, that the axes of two vessels with paired terminals must keep. `clear`
 * is the distance, mm, that two other vessels of these radii must keep; rules->pair must be above
 * 0.
 *
 * While a tree has few terminals its vessels are so thick that `clear` exceeds the distance of the
 * paired ends, and no pair could grow. The result is therefore at most 0.99 of that distance. The
 * vessels get thinner as the tree grows, and `clear` then decides. */
static inline double clear_of_mate(const Rules *rules, double clear)
{
    const double most = 0.99 * rules->pair;
    return clear < most ? clear : most;
}

/* Returns the radius, mm, of the capsule that represents a vessel of `radius` mm in the grid. The
 * vessel's own part is 1.4 times its counted radius, so that the vessel may widen for a while
 * before it has to be entered again, but at most rules->widest. Both distances of the rules are
 * added, so that the capsule reaches every segment that a rule may forbid. */
static inline double site_reach(const Rules *rules, double radius)
{
    const double reserve = 1.4;
    double reach = reserve * rules->thickness * radius;
    return (reach < rules->widest ? reach : rules->widest) + rules->gap + rules->apart;
}

/* Enters a segment, with its radius of the last refresh, in every cell that its capsule meets. A
 * segment of length 0 is entered in no cell: the segments that begin or end at its position stand
 * for it. This function and the next two change the grid: no other thread may use it meanwhile, and
 * after an error it is incomplete and growth must end. Errors: STATUS_MEMORY. */
MUST_CHECK Status site_enter(Site *site, int32_t segment, Err *err);

/* Removes a segment from the grid and enters it again, after its ends moved or it widened.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status site_renew(Site *site, int32_t segment, Err *err);

/* Copies all radii of the last network_refresh into the grid, and enters the segments again that
 * have outgrown their capsules. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status site_widen(Site *site, Err *err);

#endif
