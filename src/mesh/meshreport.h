/* What a mesh is made for, and what is true of it. Exported by the door of the room mesh. */
#ifndef CORCAST_MESH_MESHREPORT_H
#define CORCAST_MESH_MESHREPORT_H

#include "base/base.h"
#include "scene/scene.h"

typedef struct MeshParams {
    double tolerance; /* of the local radius, in [0.001, 0.2]: what few places exceed */
    double lod; /* in (0, 1]: about this part of the triangles that the tolerance takes, and no
                 * fewer than about 9 for each radius of length; 0: as 1 */
    double tube_edge; /* how long triangles of straight tubes are along them, in radii; 0: any */
    int threads;      /* 0: all processors */
    double reach_mm;  /* 0, or a coordinate of what it is to be joined with: both lie on one grid */
    void (*progress)(double fraction, void *context); /* NULL: none */
    void *context;
} MeshParams;

/* Two segments of different parts of a tree, or of different trees, that come near. */
typedef struct NearPair {
    uint32_t segments[2]; /* by rising index */
    double gap_mm;        /* between their walls; below 0: they overlap */
} NearPair;

/* How far triangles are off the surface at most. */
typedef struct MeshOff {
    double mm, ratio; /* ratio: over the local radius, not at the same place */
} MeshOff;

static inline void meshoff_add(MeshOff *off, double mm, double radius_mm)
{
    off->mm = mm > off->mm ? mm : off->mm;
    off->ratio = mm / radius_mm > off->ratio ? mm / radius_mm : off->ratio;
}

/* What is true of a mesh, established on its final points. */
typedef struct MeshReport {
    size_t trees;                               /* of the input */
    size_t components;                          /* of the mesh */
    size_t genus;                               /* all components together */
    size_t expected_components, expected_genus; /* of a sound mesh: one for each tree, and 0, unless
                                                 * it was made into a solid for printing */
    long long euler;                            /* points - edges + triangles, of all */
    size_t open_edges; /* that not two triangles share, one each way; 0: closed and oriented */
    size_t crossings;  /* pairs of triangles that meet elsewhere than in what they share */
    size_t bridges;    /* components that hold segments of several trees */
    size_t n_missing;  /* segments with a wall that has no triangle */
    size_t n_enclosed; /* segments that lie within others, so that they have no wall */
    size_t n_slivers;  /* segments whose wall is so narrow that no triangle is their own */
    size_t n_round;    /* ends that could not be cut flat, because other vessels are in the way */
    uint32_t *missing, *enclosed, *slivers, *round; /* their segments; owned */
    NearPair *near; /* owned; gaps below NEAR_GAP of the thinner radius, overlaps first */
    size_t n_near, n_overlapping;
    double volume_mm3;
    double tolerance; /* that the triangles were made for: above what was asked where `lod` is below
                         1 */
    MeshOff off;      /* of junctions at the middle of each triangle and of its longest edge */
    size_t junctions, repeated; /* junction junctions, and those that needed finer cells */
} MeshReport;

#define NEAR_GAP 0.4

void meshreport_release(MeshReport *report);

/* Whether the report is that of a mesh to be handed out. */
bool meshreport_is_sound(const MeshReport *report);
/* STATUS_DIFFERS, saying what is wrong, unless it is. */
MUST_CHECK Status meshreport_check(const MeshReport *report, const VesselTree *tree, Err *err);

#endif
