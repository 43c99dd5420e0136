/* Assigns a voxel to each label, so that no label is missing in a volume.
 *
 * A voxel normally gets the label of the segment that fills most of it. A thin segment may then
 * have no voxel. Claims list one voxel per label, which gets this label in any case. Private to the
 * module voxel. */
#ifndef CORCAST_VOXEL_CLAIMS_H
#define CORCAST_VOXEL_CLAIMS_H

#include "voxel/rows.h"

/* A voxel and the label that it gets. */
typedef struct Claim {
    int64_t voxel; /* index of the voxel in the grid, x fastest */
    uint32_t label;
} Claim;

/* One claim per label, by rising voxel. */
typedef struct Claims {
    Claim *claim; /* owned */
    size_t n;
    size_t n_taken; /* number of labels whose segments are not the largest part of any voxel on or
                     * next to their axes; they got a voxel of another label */
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

/* Returns the index of the first claim on this voxel or a later one, or claims->n if there is none.
 * O(log n). */
size_t claims_from(const Claims *claims, int64_t voxel);

#endif
