/* Cuts a tree into junction regions and straight tubes between them.
 *
 * A junction region holds one or several nodes, and the parts of the segments around them. The
 * surface of a region comes from a lattice. A tube is the part of a segment between two regions;
 * its surface is a cylinder. A branch stub is the part of such a segment that belongs to a region:
 * it ends at a plane across the segment, where the tube begins. A segment that is too short for a
 * tube belongs to one region as a whole.
 *
 * junctions_find cuts the tree once. junctionplan_make then gives the potential field and the
 * stubs of one region, from which junctionmesh_make builds the surface. */
#ifndef CORCAST_MESH_REGIONS_JUNCTIONS_H
#define CORCAST_MESH_REGIONS_JUNCTIONS_H

#include "mesh/meshreport.h"
#include "mesh/regions/junctionfield.h"

/* Value of Junctions.of_node if the node belongs to no region: it is a free end, which is cut flat
 * and needs none. */
#define NO_JUNCTION UINT32_MAX

/* The junction regions and tubes of a tree. All arrays are owned. */
typedef struct Junctions {
    IndexLists incident; /* per node: the segments with an end there */
    IndexLists blending; /* per node: the segments that blend there */
    uint32_t *of_node;   /* per node: the index of its region, or NO_JUNCTION */
    uint32_t n_junctions;
    IndexLists nodes;      /* per region: its nodes */
    double (*plane)[2];    /* per segment with is_tube: distance of each of its two planes from the
                            * end of the segment, mm; 0 at a flat end */
    bool *is_tube;         /* per segment: true if it is cut into two stubs and a tube; false if it
                            * belongs to one region entirely. The two stubs may belong to the same
                            * region, namely if the segment is part of a loop */
    bool *is_close;        /* per segment: true if its two planes are close together. The surface is
                            * then only nearly a cylinder at the planes, and the rims are not
                            * circles */
    double max_shift;      /* maximum distance between a tube's cylinder and the surface of the
                            * potential, to which other vessels add, in units of its radius */
    NearPair *unconnected; /* pairs with a gap below NEAR_GAP that share no region, by ascending
                            * gap */
    size_t n_unconnected;
    size_t n_overlapping; /* number of pairs in `unconnected` with a gap below 0 */
} Junctions;

/* Cuts a tree. The result does not depend on the number of threads.
 *
 * params   only tolerance, threads and max_coordinate_mm are used.
 * out      receives the regions; release them with junctions_release. Unchanged on error.
 * Errors   STATUS_INPUT if the tree is too far from the origin [precision.h], STATUS_MEMORY. */
MUST_CHECK Status junctions_find(const VesselTree *tree, const MeshParams *params, Junctions *out,
                                 Err *err);
/* Frees the arrays and zeroes *junctions. */
void junctions_release(Junctions *junctions);

/* Finds the two segments with the smallest gap between their surfaces, among the pairs that share
 * no node and no region. The regions are those of junctions_find.
 *
 * pair     receives the pair; its gap is below 0 if the vessels overlap.
 * found    receives false if there is no such pair.
 * Errors   STATUS_INPUT if the tree is too far from the origin [precision.h], STATUS_MEMORY.
 * Cost     O(n log n) expected, if the vessels fill a volume evenly. */
MUST_CHECK Status vesseltree_closest_pair(const VesselTree *tree, const MeshParams *params,
                                          NearPair *pair, bool *found, Err *err);

/* A branch stub. The surface is cut at the plane through `at` that is perpendicular to `outward`.
 */
typedef struct BranchStub {
    uint32_t segment;
    int end;      /* the end of the segment, 0 or 1, that is in the region */
    Vec3 at;      /* the point of the axis in the plane, mm */
    Vec3 outward; /* unit vector along the axis, out of the region */
    double radius_mm;
    bool is_close; /* the rim is not a circle [Junctions] */
} BranchStub;

/* One region as the lattice needs it. Release it with junctionplan_release. */
typedef struct JunctionPlan {
    JunctionField field; /* owned; a stub's term continues STUB_TAIL radii beyond its plane */
    BranchStub *stubs;   /* owned */
    size_t n_stubs;
    size_t n_loops; /* number of independent loops of the segments that are wholly in the region */
} JunctionPlan;

/* Length by which a stub's term continues beyond its plane, in units of the radius. It is long
 * enough that the term's end does not change the field at the plane, and short enough not to reach
 * other vessels. */
#define STUB_TAIL 1.6
/* Maximum shift of a plane along its axis to avoid slivers, in units of the radius: PLANE_MOVE, or
 * CLOSE_MOVE if the stub is_close. junctions_find leaves this much space beside each plane. Reasons
 * of the values not recorded. */
#define PLANE_MOVE 0.125
#define CLOSE_MOVE 0.06

/* Makes the plan of the region with this index, which is below n_junctions. Release *out with
 * junctionplan_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status junctionplan_make(const VesselTree *tree, const Junctions *junctions,
                                    uint32_t index, JunctionPlan *out, Err *err);
void junctionplan_release(JunctionPlan *plan);

#endif
