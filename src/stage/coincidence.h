/* The segments of a tree that are drawn, and its nodes that are at the same place. Private to the
 * module stage. */
#ifndef CORCAST_STAGE_COINCIDENCE_H
#define CORCAST_STAGE_COINCIDENCE_H

#include "base/base.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* POV-Ray refuses cylinders shorter than this [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

/* Values of Coincidence.cover that are not the index of a sister. */
enum { NO_TWIN = -1, CANNOT_DRAW = -2, BACKWARD_TWIN = -3 };

typedef struct Coincidence {
    /* Per node, about the segment that ends there. A twin of a segment lies between the same two
     * points and is at least as thick. A segment with a twin is not drawn.
     *   0 or more                  the index of its twin, a sister that starts at the same node
     *   BACKWARD_TWIN   it has a twin that runs in the opposite direction
     *   NO_TWIN           it has no twin, and is drawn
     *   CANNOT_DRAW         no segment that can be drawn ends here
     * Owned. */
    int32_t *twin;
    int32_t *junction; /* per node: the node that represents all nodes at the same place; owned */
} Coincidence;

/* Finds the twins and places of a tree. Release *places with coincidence_release. Errors:
 * STATUS_MEMORY. Cost: O(n) for n nodes, and more if many nodes lie close together. */
MUST_CHECK Status coincidence_find(const Tree *tree, Coincidence *coincidence, Err *err);
void coincidence_release(Coincidence *coincidence);
/* Returns a report in which only `drawn`, `dropped` and `covered` are set. */
StageReport coincidence_count(const Tree *tree, const Coincidence *coincidence);

/* Returns the stored result of segment_can_be_drawn. */
static inline bool coincidence_can_draw(const Coincidence *coincidence, size_t i)
{
    return coincidence->twin[i] != CANNOT_DRAW;
}

/* Returns true if segment i can be drawn and has no twin. */
static inline bool coincidence_draws(const Coincidence *coincidence, size_t i)
{
    return coincidence->twin[i] == NO_TWIN;
}

#endif
