/* Removes points of a patch where the surface is nearly flat, which it is mainly along vessels.
 * Each edge collapse merges a point into a neighbour. Private to the module mesh. */
#ifndef CORCAST_MESH_LATTICE_COLLAPSE_H
#define CORCAST_MESH_LATTICE_COLLAPSE_H

#include "mesh/lattice/patch.h"

/* Workspace of one thread. Zero it before first use; release it with collapser_release. */
typedef struct Collapser {
    ARRAY(uint32_t) next;  /* per corner of a triangle: the next corner at the same point */
    ARRAY(uint32_t) first; /* per point: its first corner */
    ARRAY(uint32_t) stamp; /* per point: marks neighbours while a collapse is tested */
    ARRAY(bool) settled;   /* per point: it was tested, must stay, and nothing near has changed */
} Collapser;

void collapser_release(Collapser *collapser);

/* Merges points into neighbours. A merge is made only if the surface stays within `sagitta` of the
 * new edges; `sagitta`, above 0, is in units of the local vessel radius. All points stay
 * on the surface, and rim points stay on their rim. The topology of the patch does not change. Then
 * compacts the patch [patch_compact], which renumbers its points. Errors: STATUS_MEMORY. */
MUST_CHECK Status collapse_apply(Collapser *collapser, Patch *patch, double sagitta, Err *err);

#endif
