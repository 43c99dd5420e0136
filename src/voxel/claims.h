/* Reserves one voxel for each label, so that no label is missing in a volume.
 *
 * A voxel normally has the label of the segment that fills the largest part of it. A thin segment
 * may then have no voxel. Therefore claims_make reserves one voxel per label (a claim); the writer
 * gives this voxel the label of the claim. Private to the module voxel. */
#ifndef CORCAST_VOXEL_CLAIMS_H
#define CORCAST_VOXEL_CLAIMS_H

#include "voxel/rows.h"

/* A reserved voxel and its label. */
typedef struct Claim {
    int64_t voxel; /* index of the voxel in the grid, x fastest */
    uint32_t label;
} Claim;

/* One claim per label, by ascending voxel index. */
typedef struct Claims {
    Claim *claim; /* owned */
    size_t n;
    size_t n_taken; /* number of claims that take a voxel from another label. A label needs such a
                     * claim if its segments fill the largest part of no voxel on or next to their
                     * axes */
} Claims;

/* Finds a voxel for each label, among the voxels that the label's segments touch. No two labels get
 * the same voxel.
 *
 * source    its labels must not be NULL.
 * geometry  for the ids of segments in errors.
 * out       receives the claims; release it with claims_release.
 * Errors    STATUS_INFEASIBLE if there are not enough voxels, naming the id of a segment without
 *           one; STATUS_MEMORY. */
MUST_CHECK Status claims_make(const RowSource *source, const Geometry *geometry, Claims *out,
                              Err *err);
void claims_release(Claims *claims);

/* Returns the index of the first claim on this voxel or on a later voxel; claims->n if there is
 * none. O(log n). */
size_t claims_first_at(const Claims *claims, int64_t voxel);

#endif
