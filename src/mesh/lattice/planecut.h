/* Cutting a junction's wall off at the planes of its stubs. */
#ifndef CORCAST_MESH_LATTICE_PLANECUT_H
#define CORCAST_MESH_LATTICE_PLANECUT_H

#include "base/keymap.h"
#include "mesh/lattice/octree.h"
#include "mesh/lattice/patch.h"

/* A point on an stub's tube: how far it lies beyond the plane, mm. */
typedef struct PlaneOffset {
    uint16_t stub;
    double along;
} PlaneOffset;

/* Workspace of a thread; zeroed before the first use. */
typedef struct PlaneCutter {
    KeyMap crossings; /* edge -> point on the rim */
    uint16_t *behind; /* one a point: the stub whose plane it lies behind, or NO_STUB */
    uint32_t *renamed;
    PlaneOffset *near;
    BranchStub *stubs; /* with their planes moved */
    size_t stub_capacity, behind_capacity, renamed_capacity, near_capacity;
} PlaneCutter;

void planecutter_release(PlaneCutter *cutter);

/* Moves the planes by at most a quarter of `ratio` radii, or so many as they may, to where few
 * points lie, and cuts the wall there; points on the rims lie on the circle about the axis, or of
 * close planes on the wall, and name the stub. *sound is false when a triangle reaches behind two
 * planes. */
MUST_CHECK Status planecut_apply(PlaneCutter *cutter, const JunctionPlan *plan, const Octree *tree,
                                 double ratio, Patch *patch, bool *sound, Err *err);

#endif
