/* Where a tree is cut: into junction regions and straight tubes between them.
 *
 * A junction region holds one or several nodes, and the parts of the segments about them. The
 * surface of a region comes from a lattice. A tube is the part of a segment between two regions;
 * its surface is a cylinder. A branch stub is the part of such a segment that belongs to a region:
 * it ends at a plane across the segment, where the tube begins. */
#ifndef CORCAST_MESH_REGIONS_JUNCTIONS_H
#define CORCAST_MESH_REGIONS_JUNCTIONS_H

#include "mesh/meshreport.h"
#include "mesh/regions/junctionfield.h"

#define NO_JUNCTION UINT32_MAX

/* All arrays are owned. */
typedef struct Junctions {
    IndexLists incident; /* per node: the segments with an end there */
    IndexLists blending; /* per node: the segments that blend there */
    uint32_t *of_node;   /* per node: its region, or NO_JUNCTION if the vessel is cut off flat */
    uint32_t n_junctions;
    IndexLists nodes;   /* per region: its nodes */
    double (*plane)[2]; /* per segment that is a tube: distance of its two planes from its ends, mm;
                         * 0 at a flat end */
    bool *is_tube;      /* per segment: it is cut into stubs and a tube; else all of it belongs to
                         * one region */
    bool *is_close;     /* per segment: its planes are so near its ends that the rims there are not
                         * circles */
    double max_shift;   /* maximum distance by which other vessels move a tube's surface, in units
                         * of its radius */
    NearPair *unconnected; /* near pairs that share no region, by rising gap */
    size_t n_unconnected;
    size_t n_overlapping; /* number of pairs in `unconnected` with a gap below 0 */
} Junctions;

/* Cuts the tree. The result does not depend on the number of threads.
 *
 * out      receives the regions; release them with junctions_release.
 * Errors   STATUS_INPUT if the tree is too far from the origin [precision.h], STATUS_MEMORY. */
MUST_CHECK Status junctions_find(const VesselTree *tree, const MeshParams *params, Junctions *out,
                                 Err *err);
void junctions_release(Junctions *junctions);

/* Finds the two segments with the smallest gap between their surfaces, among the pairs that share
 * no node and no region.
 *
 * found    receives false if there is no such pair.
 * Errors   as junctions_find.
 * Cost     O(n log n) expected, if the vessels fill a volume evenly. */
MUST_CHECK Status vesseltree_closest_pair(const VesselTree *tree, const MeshParams *params,
                                          NearPair *pair, bool *found, Err *err);

/* A branch stub: the surface is cut at the plane through `at` across `outward`. */
typedef struct BranchStub {
    uint32_t segment;
    int end;          /* the end of the segment, 0 or 1, that is in the region */
    Vec3 at, outward; /* on the axis; unit vector along the axis, out of the region */
    double radius_mm;
    bool is_close; /* the rim is not a circle [Junctions] */
} BranchStub;

/* One region as the lattice needs it. */
typedef struct JunctionPlan {
    JunctionField field; /* a stub continues STUB_TAIL radii beyond its plane */
    BranchStub *stubs;   /* owned */
    size_t n_stubs;
} JunctionPlan;

/* In units of the radius: how far a stub continues beyond its plane, so that its end does not
 * change the field at the plane; how far a plane may be shifted; and how far if it is_close. */
#define STUB_TAIL 1.6
#define PLANE_MOVE 0.125
#define CLOSE_MOVE 0.06

/* Makes the plan of the region with this index. Errors: STATUS_MEMORY. */
MUST_CHECK Status junctionplan_make(const VesselTree *tree, const Junctions *junctions,
                                    uint32_t index, JunctionPlan *out, Err *err);
void junctionplan_release(JunctionPlan *plan);

#endif
