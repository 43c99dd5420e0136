/* Changes to a tree before it is meshed: thins vessels that overlap, and lengthens ends that cannot
 * be cut flat. Exported by the public header of the module mesh.
 *
 * vesselmesh_build refuses a tree whose vessels overlap although they do not blend. It leaves an
 * end round if other vessels are too close to cut it flat. The functions here
 * change the tree to avoid both, and list the changed segments. After an error the tree may be
 * changed, and the lists are not set. */
#ifndef CORCAST_MESH_REGIONS_ADJUST_H
#define CORCAST_MESH_REGIONS_ADJUST_H

#include "mesh/meshreport.h"

/* Thins unconnected vessels that overlap, until they no longer do. Vessels that blend with a
 * thinned vessel, and are not much thicker, are thinned by the same factor. At most 12 rounds are
 * tried; vesselmesh_build refuses overlaps that remain.
 *
 * tree     its radii are changed.
 * thinned  receives the indices of the thinned segments, rising; free it with free().
 * n        receives the number of thinned segments.
 * Errors   STATUS_INPUT if a segment would keep less than a twentieth of its radius, or if the tree
 *          is too far from the origin; STATUS_MEMORY. */
MUST_CHECK Status vesseltree_thin_overlaps(VesselTree *tree, const MeshParams *params,
                                           uint32_t **thinned, size_t *n, Err *err);

/* Maximum length that vesseltree_lengthen_ends adds to an end, in units of the vessel's radius. The
 * reason for the number is not recorded. */
#define MAX_LENGTHENING 3

/* Lengthens ends that could not be cut off flat because other vessels are too close. An end moves
 * outwards along its axis, but not into other vessels. An end that does not become flat within
 * MAX_LENGTHENING radii goes back to its first position.
 *
 * tree        its ends are moved.
 * lengthened  receives the indices of the changed segments, rising; free it with free().
 * n           receives the number of changed segments.
 * Errors      STATUS_INPUT if the tree is too far from the origin; STATUS_MEMORY. */
MUST_CHECK Status vesseltree_lengthen_ends(VesselTree *tree, const MeshParams *params,
                                           uint32_t **lengthened, size_t *n, Err *err);

#endif
