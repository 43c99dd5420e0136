/* Cuts the surface of a junction region at the end planes of its branch stubs. Until it is cut, a
 * stub's surface continues STUB_TAIL radii beyond its plane. The cut leaves one boundary loop per
 * stub, its rim. Private to the module mesh. */
#ifndef CORCAST_MESH_LATTICE_PLANECUT_H
#define CORCAST_MESH_LATTICE_PLANECUT_H

#include "mesh/lattice/patch.h"

/* The position of a point relative to the end plane of its stub. */
typedef struct PlaneOffset {
    uint16_t stub;
    double offset_mm; /* distance beyond the plane along the stub's axis; below 0: inside */
} PlaneOffset;

/* Workspace of one thread. Zero it before first use; release it with planecutter_release. */
typedef struct PlaneCutter {
    KeyMap rim_points;           /* edge -> index of the point where the edge crosses a plane */
    ARRAY(uint16_t) stub_beyond; /* per point: the stub whose plane it is beyond, or NO_STUB */
    ARRAY(PlaneOffset) offsets;
    ARRAY(BranchStub) stubs; /* copies of the plan's stubs, with shifted planes */
} PlaneCutter;

void planecutter_release(PlaneCutter *cutter);

/* Cuts the patch at the end plane of each stub and removes the triangles beyond it.
 *
 * First each plane is shifted along its axis into the widest gap between nearby points, so that the
 * cut leaves no slivers. The shift is at most `ratio` / 4 radii, and at most PLANE_MOVE radii
 * (CLOSE_MOVE if the stub is_close). A new rim point is on the circle about the axis, or on the
 * surface if the stub is_close. Its PatchPoint.rim_stub is the index of the stub.
 *
 * ratio    size of the cells over the local radius.
 * valid    receives true, or false if one triangle has points beyond two different planes. The
 *          patch is then of no use.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status planecut_apply(PlaneCutter *cutter, const JunctionSurface *surface, double ratio,
                                 bool *valid, Err *err);

#endif
