/* A tree of boxes: which of many are met by a box or by a segment; private to the room domain. */
#ifndef CORCAST_DOMAIN_BOXTREE_H
#define CORCAST_DOMAIN_BOXTREE_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct BoxTree BoxTree;

/* Of `n` boxes, 1 <= n < 2^31, which are copied; the numbers 0 to n - 1 stand for them. Boxes are
 * widened by a rounding error or two, so that what touches is met. */
MUST_CHECK Status boxtree_build(const Box *boxes, size_t n, BoxTree **out, Err *err);
void boxtree_free(BoxTree *tree);

/* A walk over the boxes that are met, and few others:
 *     for (BoxWalk walk = boxwalk_segment(tree, a, b); boxwalk_next(&walk, &i);)
 * Each comes once; the order is the tree's own. */
enum { BOXWALK_DEPTH = 40 };
typedef struct BoxWalk {
    const BoxTree *tree;
    Box around;           /* all that is looked for */
    Vec3 origin, inverse; /* of the segment, see hit_box */
    bool is_segment;
    int depth;
    uint32_t item, end; /* of the leaf reached */
    uint32_t stack[BOXWALK_DEPTH];
} BoxWalk;

BoxWalk boxwalk_box(const BoxTree *tree, Box box);
BoxWalk boxwalk_segment(const BoxTree *tree, Vec3 a, Vec3 b);
bool boxwalk_next(BoxWalk *walk, uint32_t *box);

#endif
