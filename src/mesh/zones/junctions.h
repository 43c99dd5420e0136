/* Where a tree is cut: junction zones, whose walls a lattice makes, and the straight tubes between
 * them. */
#ifndef CORCAST_MESH_ZONES_JUNCTIONS_H
#define CORCAST_MESH_ZONES_JUNCTIONS_H

#include "mesh/meshreport.h"
#include "mesh/zones/junctionfield.h"

#define NO_ZONE UINT32_MAX

typedef struct Zones {
    uint32_t *zone; /* one a node; NO_ZONE: the vessel is cut off flat there */
    uint32_t n_zones;
    NumberLists nodes;   /* of each zone, in place of segments of nodes */
    double (*plane)[2];  /* one a segment: where its tube begins, from either end, mm; where the end
                          * is flat, 0 */
    bool *is_tube;       /* one a segment; else it lies in one zone, whole */
    bool *is_close;      /* one a segment: its planes are so near its ends that their rims are no
                          * circles */
    double moved;        /* how far others move the wall of a tube at most, in radii */
    NearPair *strangers; /* near pairs without a common zone; those that overlap first */
    size_t n_strangers, n_overlapping;
} Zones;

/* Cuts the tree. */
MUST_CHECK Status zones_find(const VesselTree *tree, const NumberLists *incident,
                             const NumberLists *blending, const MeshParams *params, Zones *out,
                             Err *err);
void zones_release(Zones *zones);

/* A tube that leaves a zone: to be cut across at `at`, where `outward` (unit) leads out of the zone
 * along the axis. */
typedef struct Arm {
    uint32_t segment;
    int end; /* of the segment, that lies in the zone */
    Vec3 at, outward;
    double radius_mm;
    bool is_close; /* the rim is no circle */
} Arm;

/* What a lattice needs to know of one zone. Arms run on behind their planes by ARM_TAIL radii. */
typedef struct ZonePlan {
    ZoneField field;
    Arm *arms; /* owned */
    size_t n_arms;
} ZonePlan;

#define ARM_TAIL 1.6
/* Of the radius: how far a plane may be moved, and one of those that are close. */
#define PLANE_MOVE 0.125
#define CLOSE_MOVE 0.06

MUST_CHECK Status zoneplan_make(const VesselTree *tree, const NumberLists *incident,
                                const NumberLists *blending, const Zones *zones, uint32_t zone,
                                ZonePlan *out, Err *err);
void zoneplan_release(ZonePlan *plan);

#endif
