/* A block about vessels, which are hollow in it. */
#ifndef CORCAST_PRINT_BLOCK_H
#define CORCAST_PRINT_BLOCK_H

#include "print/ports.h"
#include "print/seams.h"

/* The block about a tree, before its corners are rounded to a grid. STATUS_INPUT, with both sizes,
 * when it is to be smaller than the tree and its margin. O(n). */
MUST_CHECK Status block_casing(const VesselTree *tree, const PrintBlock *block, Casing *out,
                               Err *err);

/* Adds to an empty solid what is left of the block without the vessels, whose surface `mesh` is;
 * the ends that become ports are opened. *n_ports counts them. STATUS_INFEASIBLE when ports are
 * asked for and no end can have one. */
MUST_CHECK Status block_add(Solid *solid, const VesselTree *tree, const VesselMesh *mesh,
                            CutEnds *ends, const PrintBlock *block, const Casing *casing,
                            Seams *seams, size_t *n_ports, Err *err);

#endif
