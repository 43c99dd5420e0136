/* A block in which the vessels are cavities.
 *
 * The solid is bounded by the faces of the casing (the block without cavities), by the surface of
 * the vessels with its normals reversed, and by the walls of the ports that connect the two
 * [ports.h]. First block_casing finds the faces, then block_add adds everything to a solid. Private
 * to the module print. */
#ifndef CORCAST_PRINT_BLOCK_H
#define CORCAST_PRINT_BLOCK_H

#include "print/ports.h"
#include "print/seams.h"

/* Finds the faces of the block about a tree, centred on the box of its vessels. A size of 0 in
 * block->size_mm fits the block to the vessels and their margin. The axis of a round block is the
 * coordinate axis most nearly parallel to the first segment; size_mm[0] is its diameter, size_mm[1]
 * its length.
 *
 * tree     must have at least one segment.
 * out      receives the block; its corners are not rounded to the grid of the solid yet.
 * Errors   STATUS_INPUT, with both sizes, if the specified block is smaller than the vessels with
 *          their margin.
 * Cost     O(n) for n segments. */
MUST_CHECK Status block_casing(const VesselTree *tree, const PrintBlock *block, Casing *out,
                               Err *err);

/* What block_add needs. All pointers are borrowed. */
typedef struct BlockInput {
    const VesselTree *tree;
    const VesselMesh *mesh; /* the vessels' surface */
    CutEnds *ends; /* the flat ends of the mesh; an end that gets a port is set to opened */
    const PrintBlock *block;
    const Casing *casing; /* from block_casing, rounded to the grid of the solid */
} BlockInput;

/* Adds the block, with the vessels as cavities, to an empty solid.
 *
 * seams    is extended by the surface of the block and the rings of the ports.
 * n_ports  receives the number of ports.
 * Errors   STATUS_INFEASIBLE if ports are wanted and no end can have one, or if ports touch at a
 *          face; STATUS_MEMORY. `solid` and `seams` are then incomplete. */
MUST_CHECK Status block_add(Solid *solid, const BlockInput *input, Seams *seams, size_t *n_ports,
                            Err *err);

#endif
