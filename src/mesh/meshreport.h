/* The parameters of a mesh, and the facts about a finished one. Exported by the public header of
 * the module mesh. */
#ifndef CORCAST_MESH_MESHREPORT_H
#define CORCAST_MESH_MESHREPORT_H

#include "base/base.h"
#include "scene/scene.h"

typedef struct MeshParams {
    double tolerance; /* maximum distance of nearly all triangles from the surface, in local radii,
                       * in [0.001, 0.2] */
    double lod; /* in (0, 1]: the fraction of the triangles of this tolerance that are made, but at
                 * least about 9 per radius of length; 0 is taken as 1 */
    double tube_edge; /* maximum length of a tube's triangles along it, in radii; 0: no limit */
    int threads;      /* 0: all processors */
    double max_coordinate_mm; /* 0, or a coordinate of another object that the mesh is to be joined
                               * with, so that both are on one grid */
    bool (*progress)(double fraction, void *context); /* false: stop; NULL: none */
    void *context;
} MeshParams;

/* Two segments of different parts of a tree, or of different trees, that are near each other. */
typedef struct NearPair {
    uint32_t segments[2]; /* rising indices */
    double gap_mm;        /* between their surfaces; below 0: they overlap */
} NearPair;

/* The largest distance of a triangle from the surface. The two maxima may be at different places.
 */
typedef struct MeshDeviation {
    double mm;
    double ratio; /* in local radii */
} MeshDeviation;

/* Raises *deviation to a distance found where the local radius is radius_mm. */
static inline void meshdeviation_add(MeshDeviation *deviation, double mm, double radius_mm)
{
    deviation->mm = mm > deviation->mm ? mm : deviation->mm;
    deviation->ratio = mm / radius_mm > deviation->ratio ? mm / radius_mm : deviation->ratio;
}

/* The facts about a mesh, found on its final points. All arrays are owned. */
typedef struct MeshReport {
    size_t trees;                               /* number of trees of the input */
    size_t components;                          /* number of connected parts of the mesh */
    size_t genus;                               /* sum over all components */
    size_t expected_components, expected_genus; /* of a valid mesh: the number of trees, and 0;
                                                 * another number for a solid for printing */
    long long euler;                            /* points - edges + triangles */
    size_t open_edges; /* edges that do not have two triangles, one in each direction */
    size_t
        crossings;  /* pairs of triangles that meet elsewhere than in a corner or edge they share */
    size_t bridges; /* triangles of a segment of another tree than the rest of their component */
    size_t n_missing;  /* segments with a surface that has no triangle */
    size_t n_enclosed; /* segments that are inside others, so that they have no surface */
    size_t n_slivers;  /* segments whose surface is so narrow that no triangle belongs to it */
    size_t n_round; /* ends that could not be cut off flat, because other vessels are in the way */
    uint32_t *missing, *enclosed, *slivers, *round; /* the segments of these four counts */
    NearPair *near; /* pairs with a gap below NEAR_GAP, by rising gap */
    size_t n_near, n_overlapping;
    double volume_mm3;
    double tolerance; /* the triangles were made for this tolerance: larger than
                       * MeshParams.tolerance if `lod` is below 1 */
    MeshDeviation
        deviation; /* at the middle of each triangle of a junction region and of its longest edge */
    size_t junctions; /* number of junction regions */
    size_t repeated;  /* junction regions that needed finer cells */
} MeshReport;

/* In units of the smaller radius: vessels with a smaller gap are near each other. */
#define NEAR_GAP 0.4

void meshreport_release(MeshReport *report);

/* Returns true if the mesh is valid: closed, without crossings, with the expected topology, and
 * with a surface for every segment. */
bool meshreport_is_valid(const MeshReport *report);
/* Returns STATUS_OK for a valid mesh, else STATUS_DIFFERS with a sentence that says what is wrong,
 * or STATUS_INPUT if the tree is too far from the origin. */
MUST_CHECK Status meshreport_check(const MeshReport *report, const VesselTree *tree, Err *err);

#endif
