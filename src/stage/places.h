/* Which segments of a tree are drawn, and which of its nodes are one place. */
#ifndef CORCAST_STAGE_PLACES_H
#define CORCAST_STAGE_PLACES_H

#include "base/base.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* POV-Ray refuses cylinders shorter than this [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

/* What a segment has instead of a sister that covers it. */
enum { PLACES_UNCOVERED = -1, PLACES_CANNOT_DRAW = -2, PLACES_COVERED_BACKWARDS = -3 };

typedef struct Places {
    /* For each node: the twin that the node's segment lies within, so that the segment is not
     * drawn. A twin is a segment between the same two points that is at least as thick. The twin is
     * a sister, which begins at the same node; or PLACES_COVERED_BACKWARDS for a twin that runs the
     * other way. PLACES_UNCOVERED if there is none; PLACES_CANNOT_DRAW where there is no segment
     * that can be drawn. All arrays are owned. */
    int32_t *cover;
    int32_t *place; /* for each node: the node that stands for all nodes at the same place */
} Places;

/* Fills *places (owned; places_release). O(n) of n nodes, unless many lie close to
 * each other. STATUS_MEMORY. */
MUST_CHECK Status places_find(const Tree *tree, Places *places, Err *err);
void places_release(Places *places);
/* Returns the counts `drawn`, `dropped` and `covered` of the tree's segments, and nothing else. */
StageReport places_count(const Tree *tree, const Places *places);

/* segment_can_be_drawn, found before. */
static inline bool places_can_draw(const Places *places, size_t i)
{
    return places->cover[i] != PLACES_CANNOT_DRAW;
}

/* Whether segment i can be drawn and does not lie within a twin. */
static inline bool places_draw(const Places *places, size_t i)
{
    return places->cover[i] == PLACES_UNCOVERED;
}

#endif
