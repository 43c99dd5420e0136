/* Changes to a tree that has no valid mesh, or that has vessel ends that are not flat. Exported by
 * the public header of the module mesh. */
#ifndef CORCAST_MESH_REGIONS_ADJUST_H
#define CORCAST_MESH_REGIONS_ADJUST_H

#include "mesh/meshreport.h"

/* Makes vessels thinner that overlap although they do not belong together, and the vessels that
 * blend with them, until no vessels overlap.
 *
 * thinned  receives the indices of the thinned segments, rising (owned by the caller).
 * Errors   STATUS_INPUT if a segment would keep less than a twentieth of its radius; as
 *          vesselmesh_build. */
MUST_CHECK Status vesseltree_thin_overlaps(VesselTree *tree, const MeshParams *params,
                                           uint32_t **thinned, size_t *n, Err *err);

/* In units of the radius: maximum length added by vesseltree_lengthen_ends. */
#define MAX_LENGTHENING 3
/* Makes ends longer that could not be cut off flat because of other vessels nearby. An end moves
 * along its axis, not into other vessels. An end that does not become flat stays where it was.
 *
 * lengthened  receives the indices of the changed segments, rising (owned by the caller).
 * Errors      as vesselmesh_build. */
MUST_CHECK Status vesseltree_lengthen_ends(VesselTree *tree, const MeshParams *params,
                                           uint32_t **lengthened, size_t *n, Err *err);

#endif
