/* Builds a block in which the vessels are cavities.
 *
 * The block's solid has three kinds of surfaces: the faces of the casing (the block without
 * cavities), the surface of the vessels with its normals reversed, and the walls of ports that
 * connect the two [ports.h]. First block_casing computes the casing, then block_add adds all
 * surfaces to a solid. Private to the module print. */
#ifndef CORCAST_PRINT_BLOCK_H
#define CORCAST_PRINT_BLOCK_H

#include "print/ports.h"
#include "print/seams.h"

/* Computes the casing of a block about a tree, centred on the box of the tree's vessels. A size of
 * 0 in block->size_mm is replaced by the size of the vessels plus their margin. If the block is
 * round, its axis is the coordinate axis that is most nearly parallel to the first segment;
 * size_mm[0] is then the diameter and size_mm[1] the length.
 *
 * tree     must have at least one segment.
 * out      receives the casing. The caller moves its corners to points of the grid of the solid.
 * Errors   STATUS_INPUT if the specified block is smaller than the vessels with their margin; the
 *          sentence states both sizes.
 * Cost     O(n) for n segments. */
MUST_CHECK Status block_casing(const VesselTree *tree, const PrintBlock *block, Casing *out,
                               Err *err);

/* The input of block_add. All pointers are borrowed. */
typedef struct BlockInput {
    const VesselTree *tree;
    const VesselMesh *mesh; /* the vessels' surface */
    CutEnds *ends;          /* the flat ends of the mesh; block_add sets `opened` of each end that
                             * gets a port */
    const PrintBlock *block;
    const Casing *casing; /* from block_casing, rounded to the grid of the solid */
} BlockInput;

/* Adds the block, with the vessels as cavities, to an empty solid.
 *
 * seams    receives, in addition to its content, the surface of the block and the rings of the
 *          ports.
 * n_ports  receives the number of ports.
 * Errors   STATUS_INFEASIBLE if ports are wanted and no end can have one, or if ports touch each
 *          other at a face; STATUS_MEMORY. After an error, `solid` and `seams` are incomplete. */
MUST_CHECK Status block_add(Solid *solid, const BlockInput *input, SeamGraph *seams,
                            size_t *n_ports, Err *err);

#endif
