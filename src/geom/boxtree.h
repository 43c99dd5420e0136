/* A bounding volume hierarchy over boxes: which of many a ray, a segment or a box meets, and few
 * others. */
#ifndef CORCAST_GEOM_BOXTREE_H
#define CORCAST_GEOM_BOXTREE_H

#include "base/base.h"
#include "geom/hit.h"
#include <stddef.h>
#include <stdint.h>

/* Nodes stand in depth-first order, the first child next to its parent. */
typedef struct BoxNode {
    Box box;
    uint32_t first;   /* leaf: its part of `items`; inner: the second child */
    uint32_t n_items; /* 0 for an inner node */
} BoxNode;

/* The numbers of the boxes, leaf by leaf. Zeroed: a tree of nothing, for boxtree_release alone. */
typedef struct BoxTree {
    BoxNode *nodes;
    uint32_t *items;
} BoxTree;

/* Builds the tree of `n` boxes, 1 <= n < 2^31, which the numbers 0 to n - 1 stand for. Boxes are
 * widened by a rounding error or two, so that what touches is met. O(n log n). *out is owned by the
 * caller; on failure, STATUS_MEMORY, it is unchanged. */
MUST_CHECK Status boxtree_build(const Box *boxes, size_t n, BoxTree *out, Err *err);
void boxtree_release(BoxTree *tree);

/* A walk through the tree: the nodes still to be looked at are on a stack. */
enum { BOXTREE_DEPTH = 64 };
typedef struct BoxWalk {
    const BoxTree *tree;
    Vec3 origin, direction, inverse; /* of the ray; see hit_box */
    double t_min;
    bool near_first; /* the child whose centre is nearer comes before the other */
    bool is_box;
    Box around;         /* what is looked for, if it is a box */
    uint32_t item, end; /* of the leaf reached */
    int top;
    uint32_t stack[BOXTREE_DEPTH + 2];
} BoxWalk;

/* Walks over the leaves that a ray from `origin` on meets at t_min or more; `direction` may have
 * any length. */
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

/* The next leaf that the ray meets by t_max, which may fall from call to call; NULL: no more. */
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

/* Walks over the boxes in the leaves that a box, or the segment from a to b, meets:
 *     for (BoxWalk walk = boxwalk_segment(tree, a, b); boxwalk_next(&walk, &i);)
 * Each comes once; the order is the tree's own. */
BoxWalk boxwalk_box(const BoxTree *tree, Box box);
BoxWalk boxwalk_segment(const BoxTree *tree, Vec3 a, Vec3 b);
bool boxwalk_next(BoxWalk *walk, uint32_t *item);

#endif
