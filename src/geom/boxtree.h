/* A bounding volume hierarchy over boxes. Among many boxes, it finds the few boxes that a ray, a
 * segment or another box may intersect.
 *
 *     BoxTree tree;
 *     TRY(boxtree_build(boxes, n, &tree, err));
 *     for (BoxWalk walk = boxwalk_box(&tree, around); boxwalk_next(&walk, &i);)
 *         test object i exactly;
 *     boxtree_release(&tree);
 *
 * A walk finds every box that is intersected. It may also find other boxes, because it returns all
 * boxes of each leaf that is intersected. Threads may walk through one tree at the same time. */
#ifndef CORCAST_GEOM_BOXTREE_H
#define CORCAST_GEOM_BOXTREE_H

#include "base/base.h"
#include "geom/hit.h"
#include <stddef.h>
#include <stdint.h>

/* A node of the tree. Nodes are in depth-first order: the first child is the next node. */
typedef struct BoxNode {
    Box box;          /* contains all boxes of the node */
    uint32_t first;   /* leaf: index of its first entry in `items`; inner node: index of its second
                       * child */
    uint32_t n_items; /* leaf: number of its entries in `items`; 0: an inner node */
} BoxNode;

/* The tree. Both arrays are owned. A zeroed tree may only be released. */
typedef struct BoxTree {
    BoxNode *nodes;
    uint32_t *items; /* the indices of the boxes, leaf by leaf */
} BoxTree;

/* Builds the tree of `n` boxes, 1 <= n < 2^31. Walks return the indices 0 to n - 1 of the boxes.
 *
 * boxes   borrowed during the call. The tree stores each box enlarged by 1e-12 of its distance from
 *         the origin, a few rounding errors, so that objects that only touch are found.
 * out     receives the tree; release it with boxtree_release.
 * Errors  STATUS_MEMORY.
 * Cost    O(n log n). */
MUST_CHECK Status boxtree_build(const Box *boxes, size_t n, BoxTree *out, Err *err);
void boxtree_release(BoxTree *tree);

/* Maximum depth of a tree, which limits the stack of a walk. From half of this depth on,
 * boxtree_build splits the boxes of a node into two halves of equal number; 2^31 boxes then need at
 * most 32 more levels. */
enum { BOXTREE_DEPTH = 64 };

/* A walk through the tree, for a ray or for a box. */
typedef struct BoxWalk {
    const BoxTree *tree;
    Vec3 origin, direction, inverse; /* the ray, and 1 / direction [hit_box] */
    double t_min;
    bool near_first; /* of two children, the child whose centre comes first along the ray is visited
                      * first */
    bool is_box;     /* the walk is for the box `around`, not for a ray */
    Box around;
    uint32_t item,
        end; /* the entries of `items` in the present leaf that are still to be returned */
    int top; /* number of nodes on the stack */
    uint32_t stack[BOXTREE_DEPTH + 2]; /* nodes that are still to be visited */
} BoxWalk;

/* Starts a walk over the leaves that the ray origin + t direction intersects at t >= t_min.
 * `direction` may have any length above 0. If `near_first` is true, nearer children are visited
 * first, so that a caller can lower t_max early. Continue with boxwalk_leaf. */
static inline void boxwalk_start(BoxWalk *walk, const BoxTree *tree, Vec3 origin, Vec3 direction,
                                 double t_min, bool near_first)
{
    walk->tree = tree;
    walk->origin = origin;
    walk->direction = direction;
    walk->inverse = vec3_inverse(direction);
    walk->t_min = t_min;
    walk->near_first = near_first;
    walk->is_box = false;
    walk->item = walk->end = 0;
    walk->stack[0] = 0;
    walk->top = 1;
}

/* Returns the next leaf that the ray intersects at t <= t_max; NULL after the last leaf. t_max may
 * fall from call to call. The leaf is borrowed from the tree. */
static inline const BoxNode *boxwalk_leaf(BoxWalk *walk, double t_max)
{
    const BoxNode *nodes = walk->tree->nodes;
    while (walk->top > 0) {
        uint32_t index = walk->stack[--walk->top];
        const BoxNode *node = &nodes[index];
        double t0 = walk->t_min, t1 = t_max;
        if (!hit_box(walk->origin, walk->inverse, &node->box, &t0, &t1))
            continue;
        if (node->n_items > 0)
            return node;
        uint32_t near = index + 1, far = node->first;
        Vec3 apart = vec3_sub(box_center(nodes[far].box), box_center(nodes[near].box));
        bool swap = walk->near_first && vec3_dot(apart, walk->direction) < 0;
        walk->stack[walk->top++] = swap ? near : far;
        walk->stack[walk->top++] = swap ? far : near;
    }
    return NULL;
}

/* Starts a walk over the boxes in the leaves that intersect `box`. Continue with boxwalk_next. */
BoxWalk boxwalk_box(const BoxTree *tree, Box box);
/* Starts a walk over the boxes in the leaves that the segment from a to b intersects. Continue with
 * boxwalk_next. */
BoxWalk boxwalk_segment(const BoxTree *tree, Vec3 a, Vec3 b);
/* Sets *item to the index of the next box. Returns false after the last box. Each box is returned
 * once, in the order of the tree. */
bool boxwalk_next(BoxWalk *walk, uint32_t *item);

#endif
