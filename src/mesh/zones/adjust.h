/* Changes of a tree that has no sound mesh, or no flat ends. Exported by the door of the room mesh.
 */
#ifndef CORCAST_MESH_ZONES_ADJUST_H
#define CORCAST_MESH_ZONES_ADJUST_H

#include "mesh/meshreport.h"

/* Thins vessels that do not belong together and overlap, and what blends with them, until they are
 * apart; *thinned (owned) lists their indices, rising. STATUS_INPUT when that would leave less than
 * a twentieth of a radius. */
MUST_CHECK Status vesseltree_part(VesselTree *tree, const MeshParams *params, uint32_t **thinned,
                                  size_t *n, Err *err);

/* Lengthens ends that could not be cut off flat because of what meets nearby, along their axes by
 * at most LENGTHENED_MOST of their radii and not into other vessels, until they can; *lengthened
 * (owned) lists the indices of their segments, rising. */
#define LENGTHENED_MOST 3
MUST_CHECK Status vesseltree_free_ends(VesselTree *tree, const MeshParams *params,
                                       uint32_t **lengthened, size_t *n, Err *err);

#endif
