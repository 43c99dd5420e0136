/* Finds which nodes and segments of a tree coincide. Two vessel surfaces at the same position would
 * make pictures undefined, so one of them is left out.
 *
 * A junction is a set of nodes at the same position that the tree connects: by links, by segments
 * without length, or because segments between the same two points end there. One node of the set
 * represents the junction. Nodes of unconnected vessels that happen to be at the same position
 * belong to different junctions. Of the segments between the same two junctions, the thickest is
 * drawn, and of equally thick ones the first. The drawn segment is the twin of each of the others.
 * The others lie within it and are left out of the geometry; StageReport counts them in `drawn` and
 * in `covered`. Private to the module stage.
 *
 *     Coincidence found;
 *     TRY(coincidence_find(&tree, &found, err));
 *     if (coincidence_draws(&found, i))
 *         ... draw segment i from junction[parent[i]] to junction[i]
 *     coincidence_release(&found); */
#ifndef CORCAST_STAGE_COINCIDENCE_H
#define CORCAST_STAGE_COINCIDENCE_H

#include "base/base.h"
#include "stage/stage.h"
#include "tree/tree.h"

/* POV-Ray rejects cylinders shorter than this, mm [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

/* Values of Coincidence.twin that are not the index of a segment. */
enum { NO_TWIN = -1, CANNOT_DRAW = -2, BACKWARD_TWIN = -3 };

typedef struct Coincidence {
    /* Per node: the twin of the segment that ends at the node. Owned.
     *     0 or more       index of the twin, which starts at the same junction
     *     BACKWARD_TWIN   the twin runs in the opposite direction, or was found by its junctions in
     *                     a network with links; its index is not stored
     *     NO_TWIN         the segment has no twin, and is drawn
     *     CANNOT_DRAW     no segment ends here, or it has no length or no radius */
    int32_t *twin;
    int32_t *junction; /* per node: the node that represents its junction; owned */
} Coincidence;

/* Finds the twins and junctions of a tree. Release *coincidence with coincidence_release; there is
 * nothing to release after an error. Errors: STATUS_MEMORY. Cost: O(n) for n nodes, and more if
 * many nodes lie close together. */
MUST_CHECK Status coincidence_find(const Tree *tree, Coincidence *coincidence, Err *err);
/* Frees the arrays and zeroes *coincidence. */
void coincidence_release(Coincidence *coincidence);
/* Returns the twins and junctions of the pieces of a smooth tree, borrowed from it. */
static inline Coincidence coincidence_of_smooth(const SmoothTree *smooth)
{
    return (Coincidence){.twin = smooth->twin, .junction = smooth->junction};
}
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
