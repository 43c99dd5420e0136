/* Computes the fraction of a voxel that a union of bodies covers.
 *
 * A voxel inside one body is full. A voxel that meets one body has the exact fraction of
 * body_fraction [body.h]. A voxel that meets several bodies is divided in eight, repeatedly, and
 * the smallest parts are sampled by lines. Private to the module voxel. */
#ifndef CORCAST_VOXEL_COVER_H
#define CORCAST_VOXEL_COVER_H

#include "base/base.h"
#include "voxel/body.h"

/* Workspace of cover_fraction, for one thread. Zero it before first use; release it with
 * cover_release. */
typedef struct CoverWorkspace {
    uint32_t *lists;          /* lists of bodies, one per level of the split */
    double (*chords)[2];      /* of one line: the intervals inside the bodies */
    size_t n_lists, n_chords; /* capacities */
} CoverWorkspace;

/* Makes the workspace large enough for `n_bodies` bodies. Errors: STATUS_MEMORY. */
MUST_CHECK Status cover_reserve(CoverWorkspace *workspace, size_t n_bodies, Err *err);
void cover_release(CoverWorkspace *workspace);

/* Returns the fraction of a voxel, `cell`, in [0, 1], that the union of the n bodies of `list`
 * covers.
 *
 * bodies     the array that the indices in `list` refer to.
 * list       n different indices. Their order does not matter.
 * workspace  must be reserved for n bodies.
 *
 * If at most one body meets the cell, the error is that of body_fraction. Otherwise the error is at
 * most 0.01, with a root mean square of 0.0014. */
double cover_fraction(const Body *bodies, const uint32_t *list, size_t n, const VoxelCell *cell,
                      CoverWorkspace *workspace);

#endif
