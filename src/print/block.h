/* A block about vessels, in which they are hollow. */
#ifndef CORCAST_PRINT_BLOCK_H
#define CORCAST_PRINT_BLOCK_H

#include "print/ports.h"
#include "print/seams.h"

/* Finds the block about a tree. Its corners are not on a grid yet. Errors: STATUS_INPUT, with both
 * sizes, if the wanted block is smaller than the tree and its margin. O(n). */
MUST_CHECK Status block_casing(const VesselTree *tree, const PrintBlock *block, Casing *out,
                               Err *err);

/* What a block is made of. All pointers are borrowed. */
typedef struct BlockInput {
    const VesselTree *tree;
    const VesselMesh *mesh; /* the vessels' surface */
    CutEnds *ends;          /* of the mesh; those that get a port are opened */
    const PrintBlock *block;
    const Casing *casing;
} BlockInput;

/* Adds the block without the vessels to an empty solid.
 *
 * n_ports  receives the number of ports.
 * Errors   STATUS_INFEASIBLE if ports are wanted and no end can have one, STATUS_MEMORY. */
MUST_CHECK Status block_add(Solid *solid, const BlockInput *input, Seams *seams, size_t *n_ports,
                            Err *err);

#endif
