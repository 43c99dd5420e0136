/* Searches a bounding volume hierarchy (BVH) for the items that a ray hits. Items are primitives,
 * triangles or POV-Ray's cells. The search visits the leaves whose boxes the ray meets, and calls
 * an ItemCrossings function for each item of a leaf. The search functions are inline, so that the
 * compiler can inline this callback. They allocate nothing and cannot fail.
 *
 *     Hit hit;
 *     uint32_t triangle;
 *     if (boxcast_first(&boxes, &part, part.t_min, triangle_crossings, mesh, &hit, &triangle))
 *         ... hit.t is the distance to the nearest triangle, mm
 *
 * t is the distance along the ray, mm. Both functions search the interval t_min <= t < t_max of a
 * RayPart. */
#ifndef CORCAST_RENDER_CAST_BOXCAST_H
#define CORCAST_RENDER_CAST_BOXCAST_H

#include "render/cast/raysearch.h"

enum { ITEM_CROSSINGS = 4 }; /* maximum number of crossings of one item */

/* Computes the crossings of a ray with item `item`, in any order. Returns their number, at most
 * ITEM_CROSSINGS.
 *
 * items  the pointer that the caller passed to the search.
 * item   index of the item, an element of BoxTree.items.
 * ray    the whole ray; crossings outside [t_min, t_max) may be returned.
 * hits   receives the crossings. Only the fields that the caller of the search reads must be set.
 * rank   0 on entry; the function may set it. If several items are hit at equal t, the item with
 *        the lowest rank is returned; of equal ranks, the item with the lowest index. cell_search
 *        sets it to the order in which POV-Ray intersects its cells; other searches do not. */
typedef int ItemCrossings(const void *items, uint32_t item, Ray ray, Hit hits[ITEM_CROSSINGS],
                          double *rank);

/* Finds the nearest crossing of a ray with any item of the tree.
 *
 * boxes_from  mm, at most part->t_min: boxes that the ray leaves before t = boxes_from are skipped.
 *             Less than t_min if a crossing may be outside the box of its item by rounding.
 * items       passed to `crossings`.
 * hit, index  receive the crossing and the index of its item; undefined if there is none.
 * Returns     true if there is a crossing with t_min <= t < t_max. */
static inline bool boxcast_first(const BoxTree *tree, const RayPart *part, double boxes_from,
                                 ItemCrossings *crossings, const void *items, Hit *hit,
                                 uint32_t *index)
{
    BoxWalk walk;
    double lowest = 0;
    bool found = false;
    *index = 0;
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

/* Returns true if any item has a crossing with t_min <= t < t_max. The parameters are those of
 * boxcast_first. */
static inline bool boxcast_any(const BoxTree *tree, const RayPart *part, double boxes_from,
                               ItemCrossings *crossings, const void *items)
{
    BoxWalk walk;
    boxwalk_start(&walk, tree, part->ray.origin, part->ray.direction, boxes_from, false);
    for (const BoxNode *leaf; (leaf = boxwalk_leaf(&walk, part->t_max));)
        for (uint32_t i = leaf->first; i < leaf->first + leaf->n_items; i++) {
            Hit hits[ITEM_CROSSINGS];
            double rank = 0;
            const int n = crossings(items, tree->items[i], part->ray, hits, &rank);
            for (int k = 0; k < n; k++)
                if (hits[k].t >= part->t_min && hits[k].t < part->t_max)
                    return true;
        }
    return false;
}

#endif
