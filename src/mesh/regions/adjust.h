/* Changes a tree so that it can be meshed: thins vessels that overlap, and lengthens ends that
 * cannot be cut flat. Both functions are called before vesselmesh_build. Exported by the public
 * header of the module mesh.
 *
 * vesselmesh_build refuses a tree in which two vessels overlap without being connected. It leaves
 * an end round if other vessels are too close for a flat cut. The functions here prevent the
 * refusal and the round ends where they can, and list the segments that they changed. After an
 * error the tree may be changed, and the lists are not set. */
#ifndef CORCAST_MESH_REGIONS_ADJUST_H
#define CORCAST_MESH_REGIONS_ADJUST_H

#include "mesh/meshreport.h"

/* Thins unconnected vessels that overlap, until they no longer overlap. Vessels that are
 * connected with a thinned vessel in a junction, and are at most 1.3 times as thick, are thinned by
 * the same factor, so that one vessel of many segments gets no steps; 1.3 includes the parent of a
 * symmetric bifurcation. Stops after 12 rounds; vesselmesh_build refuses overlaps that remain.
 *
 * tree     its radii are changed.
 * thinned  receives the indices of the thinned segments, ascending; free it with free(). May be
 *          NULL if there are none.
 * n        receives the number of thinned segments.
 * Errors   STATUS_INPUT if a segment would keep less than a twentieth of its radius, or if the tree
 *          is too far from the origin [precision.h]; STATUS_MEMORY. */
MUST_CHECK Status vesseltree_thin_overlaps(VesselTree *tree, const MeshParams *params,
                                           uint32_t **thinned, size_t *n, Err *err);

/* Maximum length that vesseltree_lengthen_ends adds to an end, in units of the vessel's radius.
 * With a larger value more ends become flat, but the mesh differs more from the tree; reason of the
 * value not recorded. */
#define MAX_LENGTHENING 3

/* Lengthens ends that cannot be cut flat because other vessels are too close. An end moves outwards
 * along its axis, but not into other vessels. An end that cannot be cut flat within MAX_LENGTHENING
 * radii returns to its original position.
 *
 * tree        its ends are moved.
 * lengthened  receives the indices of the changed segments, ascending; free it with free().
 * n           receives the number of changed segments.
 * Errors      STATUS_INPUT if the tree is too far from the origin [precision.h]; STATUS_MEMORY. */
MUST_CHECK Status vesseltree_lengthen_ends(VesselTree *tree, const MeshParams *params,
                                           uint32_t **lengthened, size_t *n, Err *err);

#endif
