/* A Site holds the data of growth: the network (the growing tree), the domain, a grid that finds
 * the segments near a point or segment, and the rules that segments keep. Growth, connections and
 * repairs work on one Site.
 *
 * The caller updates the grid: by site_enter after adding a segment to the network, by site_renew
 * after moving an end of a segment, and by site_update_radii after network_refresh, which changes
 * radii. */
#ifndef CORCAST_GROW_SITE_H
#define CORCAST_GROW_SITE_H

#include "domain/domain.h"
#include "grow/cco/grid.h"
#include "grow/network.h"

/* Rules that segments keep while a tree grows. */
typedef struct Rules {
    double thickness;  /* factor in [0, 1] by which the rules multiply each radius. Growth lowers it
                        * in a full domain, which then can take more terminals */
    double min_length; /* minimum length of a segment, mm; a segment is also at least as long as its
                        * diameter times `thickness` */
    double gap;        /* mm; added to the minimum distance of vessels without a common node */
    double tree_gap;   /* mm; minimum distance of the walls of vessels of different trees */
    double pair_mm;    /* distance of the ends of paired terminals, mm: each terminal of the first
                        * tree has a partner in the second [mates.h]; 0: no pairs */
    double max_radius; /* mm; upper limit of the capsule's radius in the grid, before the gaps are
                        * added [site_reach]: the size of the domain, in which a wider capsule would
                        * meet no more cells */
} Rules;

/* A site. The caller releases its network and its grid. */
typedef struct Site {
    Network net;
    Grid grid;            /* the segments of `net`; zeroed before the first segment is added */
    const Domain *domain; /* borrowed */
    Rules rules;
} Site;

/* Returns the minimum distance, mm, of the axes of two vessels whose terminals are a pair:
 * `unpaired`, but at most 0.99 rules->pair_mm. `unpaired` is the minimum distance, mm, of two other
 * vessels with these radii. rules->pair_mm must be above 0.
 *
 * While a tree has few terminals, its vessels are so thick that `unpaired` exceeds pair_mm. Without
 * the limit, no pair could grow. The limit is below pair_mm, so that two terminals pair_mm apart
 * are not rejected. Vessels get thinner as the tree grows, and `unpaired` then falls below the
 * limit. */
static inline double pair_axis_distance(const Rules *rules, double unpaired)
{
    const double most = 0.99 * rules->pair_mm;
    return unpaired < most ? unpaired : most;
}

/* Returns the radius, mm, of the capsule of a vessel in the grid: 1.4 times `thickness` times its
 * radius, but at most rules->max_radius, plus both gaps of the rules.
 *
 * With the factor 1.4, a vessel can widen for a while before site_update_radii must enter it again.
 * A larger factor enters vessels in more cells. Because the gaps are added, the capsules of two
 * vessels meet whenever the vessels could break a rule. */
static inline double site_reach(const Rules *rules, double radius)
{
    const double reserve = 1.4;
    double reach = reserve * rules->thickness * radius;
    return (reach < rules->max_radius ? reach : rules->max_radius) + rules->gap + rules->tree_gap;
}

/* Enters a segment, with its radius of the last refresh, in every cell that its capsule meets. A
 * segment of length 0, which only a continued tree may have, is entered in no cell, because
 * neighbouring segments cover its position.
 *
 * This function and the next two change the grid. No other thread may use the grid meanwhile. After
 * an error the grid is incomplete, and growth must end. Errors: STATUS_MEMORY. */
MUST_CHECK Status site_enter(Site *site, int32_t segment, Err *err);

/* Removes a segment from the grid and enters it again, with its present ends and radius. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status site_renew(Site *site, int32_t segment, Err *err);

/* Copies all radii of the last network_refresh into the grid. A segment that is now wider than its
 * capsule is entered again. Errors: STATUS_MEMORY. Cost: O(n). */
MUST_CHECK Status site_update_radii(Site *site, Err *err);

#endif
