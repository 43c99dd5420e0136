/* The segments of a tree that are drawn, and its nodes that are at the same place. Private to the
 * module stage. */
#ifndef CORCAST_STAGE_PLACES_H
#define CORCAST_STAGE_PLACES_H

#include "base/base.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* POV-Ray refuses cylinders shorter than this [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

/* Values of Places.cover that are not the index of a sister. */
enum { PLACES_UNCOVERED = -1, PLACES_CANNOT_DRAW = -2, PLACES_COVERED_BACKWARDS = -3 };

typedef struct Places {
    /* Per node, about the segment that ends there. A twin of a segment lies between the same two
     * points and is at least as thick. A segment with a twin is not drawn.
     *   0 or more                  the index of its twin, a sister that starts at the same node
     *   PLACES_COVERED_BACKWARDS   it has a twin that runs in the opposite direction
     *   PLACES_UNCOVERED           it has no twin, and is drawn
     *   PLACES_CANNOT_DRAW         no segment that can be drawn ends here
     * Owned. */
    int32_t *cover;
    int32_t *place; /* per node: the node that represents all nodes at the same place; owned */
} Places;

/* Finds the twins and places of a tree. Release *places with places_release. Errors: STATUS_MEMORY.
 * Cost: O(n) for n nodes, and more if many nodes lie close together. */
MUST_CHECK Status places_find(const Tree *tree, Places *places, Err *err);
void places_release(Places *places);
/* Returns a report in which only `drawn`, `dropped` and `covered` are set. */
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
