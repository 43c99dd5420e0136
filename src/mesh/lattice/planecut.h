/* Cutting a zone's wall off at the planes of its arms. */
#ifndef CORCAST_MESH_LATTICE_PLANECUT_H
#define CORCAST_MESH_LATTICE_PLANECUT_H

#include "mesh/lattice/octree.h"
#include "mesh/lattice/pairtable.h"
#include "mesh/lattice/patch.h"

/* A point on an arm's tube: how far it lies beyond the plane, mm. */
typedef struct PlaneNear {
    uint16_t arm;
    double along;
} PlaneNear;

/* Workspace of a thread; zeroed before the first use. */
typedef struct PlaneCutter {
    PairTable crossings; /* edge -> point on the rim */
    uint16_t *behind;    /* one a point: the arm whose plane it lies behind, or NO_ARM */
    uint32_t *renamed;
    PlaneNear *near;
    Arm *arms; /* with their planes moved */
    size_t arm_capacity, behind_capacity, renamed_capacity, near_capacity;
} PlaneCutter;

void planecutter_release(PlaneCutter *cutter);

/* Moves the planes by at most a quarter of `ratio` radii, or so many as they may, to where few
 * points lie, and cuts the wall there; points on the rims lie on the circle about the axis, or of
 * close planes on the wall, and name the arm. *sound is false when a triangle reaches behind two
 * planes. */
MUST_CHECK Status planecut_make(PlaneCutter *cutter, const ZonePlan *plan, const ZoneTree *tree,
                                double ratio, Patch *patch, bool *sound, Err *err);

#endif
