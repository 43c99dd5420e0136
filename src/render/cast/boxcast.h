/* Searches a bounding volume hierarchy for the items that a ray hits. Primitives, triangles and
 * cells share this code. The functions are inline, so that the compiler can inline the callback
 * that computes the crossings. */
#ifndef CORCAST_RENDER_BOXCAST_H
#define CORCAST_RENDER_BOXCAST_H

#include "render/cast/raysearch.h"

enum { ITEM_CROSSINGS = 4 }; /* maximum number of crossings of one item */

/* Finds the crossings of a ray with item `item` in any order and returns their number. Sets only
 * those parts of hits[] that the caller needs. *rank decides between items that are hit at equal t:
 * the lower rank wins, then the lower index. */
typedef int ItemCrossings(const void *items, uint32_t item, Ray ray, Hit hits[ITEM_CROSSINGS],
                          double *rank);

/* Finds the nearest crossing with t_min <= t < t_max, and its item. Returns false if there is none.
 * Leaves out boxes that the ray does not meet at t = `boxes_from` or later. */
static inline bool boxcast_first(const BoxTree *tree, const RayPart *part, double boxes_from,
                                 ItemCrossings *crossings, const void *items, Hit *hit,
                                 uint32_t *index)
{
    BoxWalk walk;
    double lowest = 0;
    bool found = false;
    hit->t = part->t_max;
    boxwalk_start(&walk, tree, part->ray.origin, part->ray.direction, boxes_from, true);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, hit->t));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            Hit hits[ITEM_CROSSINGS];
            double rank = 0;
            const uint32_t item = tree->items[i];
            const int n = crossings(items, item, part->ray, hits, &rank);
            for (int k = 0; k < n; k++) {
                const double t = hits[k].t;
                if (!(t >= part->t_min) ||
                    !(t < hit->t || (found && t == hit->t &&
                                     (rank < lowest || (rank == lowest && item < *index)))))
                    continue;
                found = true;
                *hit = hits[k];
                *index = item;
                lowest = rank;
            }
        }
    return found;
}

/* Returns true if any item has a crossing with t_min < t < t_max. */
static inline bool boxcast_any(const BoxTree *tree, const RayPart *part, double boxes_from,
                               ItemCrossings *crossings, const void *items)
{
    BoxWalk walk;
    boxwalk_start(&walk, tree, part->ray.origin, part->ray.direction, boxes_from, false);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, part->t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            Hit hits[ITEM_CROSSINGS];
            double rank;
            const int n = crossings(items, tree->items[i], part->ray, hits, &rank);
            for (int k = 0; k < n; k++)
                if (hits[k].t > part->t_min && hits[k].t < part->t_max)
                    return true;
        }
    return false;
}

#endif
