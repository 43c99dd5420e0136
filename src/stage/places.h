/* Which segments of a tree are drawn, and which of its nodes are one place. */
#ifndef CORCAST_STAGE_PLACES_H
#define CORCAST_STAGE_PLACES_H

#include "base/base.h"
#include "tree/tree.h"

/* POV-Ray refuses cylinders shorter than this [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

typedef struct Places {
    int32_t
        *cover; /* one a node: the sister within whose segment its own lies, or TREE_NO_PARENT */
    int32_t *place; /* one a node: the node that stands for all at its place */
} Places;

/* Whether segment i has a radius and a length that POV-Ray takes; false for a root. */
bool segment_can_be_drawn(const Tree *tree, size_t i);

/* Finds them in *places (owned; places_release). */
MUST_CHECK Status places_find(const Tree *tree, Places *places, Err *err);
void places_release(Places *places);

/* Whether segment i can be drawn and does not lie within a sister. */
static inline bool places_draw(const Places *places, const Tree *tree, size_t i)
{
    return segment_can_be_drawn(tree, i) && places->cover[i] < 0;
}

#endif
