/* Gives a voxel to each label, so that no label is missing in a volume. Private to the module
 * voxel. */
#ifndef CORCAST_VOXEL_CLAIMS_H
#define CORCAST_VOXEL_CLAIMS_H

#include "voxel/rows.h"

typedef struct Claim {
    int64_t voxel; /* its index, x fastest */
    uint32_t label;
} Claim;

/* One claim per label, sorted by voxel. */
typedef struct Claims {
    Claim *claim; /* owned */
    size_t n;
    size_t n_taken; /* number of claims on voxels of which another label fills more */
} Claims;

/* Finds a voxel for each label, among those that its segments meet. Release *out with
 * claims_release. Errors: STATUS_INFEASIBLE if there are not enough voxels, naming the id of a
 * segment without one; STATUS_MEMORY. */
MUST_CHECK Status claims_make(const RowSource *source, const Geometry *geometry, Claims *out,
                              Err *err);
void claims_release(Claims *claims);

/* Returns the index of the first claim on this voxel or a later one. O(log n). */
size_t claims_from(const Claims *claims, int64_t voxel);

#endif
