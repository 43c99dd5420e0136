/* The parameters of a mesh, and the measurements of a finished mesh.
 *
 * vesselmesh_build takes MeshParams and fills a MeshReport. meshreport_check converts the report to
 * a Status, so that no caller writes an invalid mesh. A junction region, in the following, is the
 * part of the surface around one or several nodes of the tree; a tube is the part of a segment
 * between two regions [regions/junctions.h]. Exported by the public header of the module mesh. */
#ifndef CORCAST_MESH_MESHREPORT_H
#define CORCAST_MESH_MESHREPORT_H

#include "base/base.h"
#include "scene/scene.h"

/* Parameters of vesselmesh_build. */
typedef struct MeshParams {
    double tolerance; /* target for the distance of the triangles from the surface, in local radii,
                       * in [0.001, 0.2]; a few triangles may exceed it [MeshReport.deviation] */
    double lod; /* level of detail, in (0, 1]: the mesh gets about this fraction of the triangles
                 * that the tolerance would need, but at least about 8 triangles per length of one
                 * radius. 0 is taken as 1. */
    double tube_edge; /* maximum length of a tube's triangles along it, in radii; 0: no limit */
    int threads;      /* number of threads; 0: one per processor */
    double max_coordinate_mm; /* largest coordinate, in magnitude, of another mesh that this mesh
                               * will be joined with; both meshes then use the same grid of
                               * coordinates [precision.h]. 0: none */
    /* Returns false to stop. NULL: none. `context` is passed to it. */
    bool (*progress)(double fraction, void *context);
    void *context;
} MeshParams;

/* Two segments that are near each other without being connected: they are in different parts of a
 * tree, or in different trees. */
typedef struct NearPair {
    uint32_t segments[2]; /* indices, ascending */
    double gap_mm;        /* distance between their surfaces; below 0: they overlap */
} NearPair;

/* The largest distance of a triangle from the exact surface. The two maxima may be at different
 * points. */
typedef struct MeshDeviation {
    double mm;
    double ratio; /* in local radii */
} MeshDeviation;

/* Raises both maxima of *deviation to a distance of `mm` that was measured where the local radius
 * is radius_mm. */
static inline void meshdeviation_add(MeshDeviation *deviation, double mm, double radius_mm)
{
    deviation->mm = mm > deviation->mm ? mm : deviation->mm;
    deviation->ratio = mm / radius_mm > deviation->ratio ? mm / radius_mm : deviation->ratio;
}

/* The measurements of a mesh, on its final points. All arrays are owned. */
typedef struct MeshReport {
    size_t trees;               /* number of trees of the input */
    size_t components;          /* number of connected components of the mesh */
    size_t genus;               /* sum over all components */
    size_t expected_components; /* value of `components` in a valid mesh: the number of trees, or
                                 * the number that a solid for printing sets */
    size_t expected_genus; /* value of `genus` in a valid mesh: the number of independent loops, or
                            * the number that a solid for printing sets */
    long long euler;       /* Euler number: points - edges + triangles */
    size_t open_edges;     /* number of edges that do not have exactly two triangles, one in each
                            * direction */
    size_t crossings; /* number of pairs of triangles with a common point that is not on a corner or
                       * edge of both */
    size_t bridges;   /* number of triangles whose segment is in another tree than the rest of their
                       * component */
    size_t n_missing; /* number of segments whose surface should be in the mesh, but that have no
                       * triangle */
    size_t n_enclosed; /* number of segments without a surface, because they are inside other
                        * vessels */
    size_t n_slivers;  /* number of segments whose surface is so narrow that no triangle belongs to
                        * it */
    size_t n_round_ends; /* number of ends that could not be cut off flat, because other vessels are
                          * too close */
    /* The segments that n_missing, n_enclosed, n_slivers and n_round_ends count. */
    uint32_t *missing, *enclosed, *slivers, *round_ends;
    NearPair *near;       /* pairs with a gap below NEAR_GAP that share no junction region, by
                           * ascending gap */
    size_t n_near;        /* number of pairs in `near` */
    size_t n_overlapping; /* number of pairs in `near` with a gap below 0 */
    double volume_mm3;
    double tolerance;        /* the tolerance that the triangles were made for. It is larger than
                              * MeshParams.tolerance if `lod` is below 1. */
    MeshDeviation deviation; /* in junction regions, measured at the middle of each triangle and of
                              * its longest edge; for tubes, computed */
    size_t junctions;        /* number of junction regions */
    size_t refined;          /* number of junction regions that needed finer cells */
} MeshReport;

/* Two vessels are near each other if their gap is smaller than this, in units of the smaller
 * radius. Reason of the value not recorded. */
#define NEAR_GAP 0.4

/* Frees the arrays and zeroes *report. */
void meshreport_release(MeshReport *report);

/* Returns true if the mesh is valid: closed, without crossings or bridges, with the expected
 * components and genus, and with a surface for every segment. */
bool meshreport_is_valid(const MeshReport *report);

/* Returns STATUS_OK for a valid mesh.
 *
 * Errors   STATUS_INPUT if triangles cross because the tree is too far from the origin;
 *          STATUS_DIFFERS for any other defect, with a sentence that names it. */
MUST_CHECK Status meshreport_check(const MeshReport *report, const VesselTree *tree, Err *err);

#endif
