/* Which voxel shows a label when it would otherwise be in none; private to the room voxel. */
#ifndef CORCAST_VOXEL_CLAIMS_H
#define CORCAST_VOXEL_CLAIMS_H

#include "voxel/rows.h"

typedef struct Claim {
    int64_t voxel; /* its number, x fastest */
    uint32_t label;
} Claim;

/* One for each label, by rising voxel. */
typedef struct Claims {
    Claim *claim; /* owned */
    size_t n;
    size_t taken; /* of these, voxels that others fill the most of */
} Claims;

/* STATUS_INFEASIBLE when labels cannot have a voxel each, of those that their segments meet, naming
 * one by the id of its segment; STATUS_MEMORY. */
MUST_CHECK Status claims_make(const RowSource *source, const Geometry *geometry, Claims *out,
                              Err *err);
void claims_release(Claims *claims);

/* The number of the first claim on this voxel or a later one. O(log n). */
size_t claims_from(const Claims *claims, int64_t voxel);

#endif
