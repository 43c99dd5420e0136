/* The segments of a tree that are drawn, and its nodes that are at the same place. Private to the
 * module stage. */
#ifndef CORCAST_STAGE_PLACES_H
#define CORCAST_STAGE_PLACES_H

#include "base/base.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* POV-Ray refuses cylinders shorter than this [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

/* Values of Places.cover for a segment that no sister covers. */
enum { PLACES_UNCOVERED = -1, PLACES_CANNOT_DRAW = -2, PLACES_COVERED_BACKWARDS = -3 };

typedef struct Places {
    /* Per node: the twin of the segment that ends there, or a PLACES_... A segment with a twin is
     * not drawn. A twin is a segment between the same two points that is at least as thick: a
     * sister, which starts at the same node, or PLACES_COVERED_BACKWARDS, which runs the other way.
     * Without a twin: PLACES_UNCOVERED; without a segment that can be drawn: PLACES_CANNOT_DRAW.
     * Owned. */
    int32_t *cover;
    int32_t *place; /* per node: the node that represents all nodes at the same place; owned */
} Places;

/* Finds the twins and places of a tree. Release *places with places_release. Errors: STATUS_MEMORY.
 * O(n) for n nodes, unless many are close to each other. */
MUST_CHECK Status places_find(const Tree *tree, Places *places, Err *err);
void places_release(Places *places);
/* Returns the counts `drawn`, `dropped` and `covered` of the tree's segments, and nothing else. */
StageReport places_count(const Tree *tree, const Places *places);

/* Returns the stored result of segment_can_be_drawn. */
static inline bool places_can_draw(const Places *places, size_t i)
{
    return places->cover[i] != PLACES_CANNOT_DRAW;
}

/* Returns true if segment i can be drawn and has no twin. */
static inline bool places_draw(const Places *places, size_t i)
{
    return places->cover[i] == PLACES_UNCOVERED;
}

#endif
