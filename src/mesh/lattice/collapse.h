/* Fewer triangles where a surface is nearly flat, along a vessel above all. */
#ifndef CORCAST_MESH_LATTICE_COLLAPSE_H
#define CORCAST_MESH_LATTICE_COLLAPSE_H

#include "mesh/lattice/patch.h"

/* Workspace of a thread; zeroed before the first use. */
typedef struct Collapser {
    uint32_t *next;  /* one a corner: the next corner of the same point */
    uint32_t *first; /* one a point: its first corner */
    uint32_t *stamp, *renamed;
    bool *settled; /* one a point: nothing about it has changed since it could not go */
    size_t next_capacity, first_capacity, stamp_capacity, renamed_capacity, settled_capacity;
} Collapser;

void collapser_release(Collapser *collapser);

/* Moves points into neighbours while no new edge is farther from the surface between its ends than
 * `sagitta` of the local radius. All points stay on the surface; a rim's points stay on the rim.
 * What the patch is topologically does not change. */
MUST_CHECK Status collapse_make(Collapser *collapser, Patch *patch, double sagitta, Err *err);

#endif
