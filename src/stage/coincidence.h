/* Finds nodes and segments of a tree that coincide. Two vessel surfaces at the same position would
 * make pictures undefined, so only one of them is drawn. Private to the module stage.
 *
 * A junction is a set of nodes at the same position that are connected in the tree: by a link,
 * which states that two nodes of a network are the same point [tree/tree.h], by a segment without
 * length, or because segments between the same two positions end at both nodes. One node of the set
 * represents the junction. Nodes of unconnected vessels that happen to be at the same position
 * belong to different junctions.
 *
 * Segments between the same two junctions coincide. The thickest of them is drawn; of equally thick
 * segments, the first is drawn. It is called the twin of each of the others, which are inside it
 * and are not drawn themselves. StageReport.drawn counts them all the same, because the twin's
 * surface is theirs, too; StageReport.covered counts them alone.
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

/* Minimum length of a drawn segment, mm. POV-Ray rejects cylinders that are shorter
 * [docs/POVRAY.md]. */
#define SHORTEST_MM 1e-9

/* Values of Coincidence.twin that are not the index of a segment. */
enum { NO_TWIN = -1, CANNOT_DRAW = -2, UNSTORED_TWIN = -3 };

/* The coincidences of a tree. */
typedef struct Coincidence {
    /* Per node: the twin of the segment that ends at the node. Owned.
     *     0 or more       index of the twin, which starts at the same junction
     *     UNSTORED_TWIN   the segment has a twin whose index is not stored, because the twin runs
     *                     in the opposite direction, or the tree is a network with links
     *     NO_TWIN         the segment has no twin, and is drawn
     *     CANNOT_DRAW     no segment ends at the node, or the segment has no length or no radius */
    int32_t *twin;
    int32_t *junction; /* per node: the node that represents its junction; owned */
} Coincidence;

/* Finds the twins and junctions of a tree. Release *coincidence with coincidence_release; there is
 * nothing to release after an error. Errors: STATUS_MEMORY. Cost: O(n) for n nodes, and more if
 * many nodes lie close together. */
MUST_CHECK Status coincidence_find(const Tree *tree, Coincidence *coincidence, Err *err);
/* Frees the arrays and zeroes *coincidence. */
void coincidence_release(Coincidence *coincidence);
/* Returns the twins and junctions of the pieces of a smooth tree, borrowed from it: do not release
 * the result. */
static inline Coincidence coincidence_of_smooth(const SmoothTree *smooth)
{
    return (Coincidence){.twin = smooth->twin, .junction = smooth->junction};
}
/* Counts the segments of a tree that are drawn, that have no length or radius, and that have a
 * twin. Returns a report in which only `drawn`, `dropped` and `covered` are set. */
StageReport coincidence_count(const Tree *tree, const Coincidence *coincidence);

/* Returns true if segment i has a length and a radius [segment_can_be_drawn]. */
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
