/* Builds the finished surface of one junction region. */
#ifndef CORCAST_MESH_JUNCTIONMESH_H
#define CORCAST_MESH_JUNCTIONMESH_H

#include "mesh/lattice/collapse.h"
#include "mesh/lattice/facerefine.h"
#include "mesh/lattice/latticerepair.h"
#include "mesh/lattice/planecut.h"

/* The rim of a branch stub: the points rim_points[first .. first + n), by rising angle about the
 * axis that leads from the segment's first end to its second. */
typedef struct Rim {
    uint32_t segment;
    int end; /* the segment's end that is in the region */
    uint32_t first, n;
} Rim;

/* A point of a finished surface, in little memory. */
typedef struct JunctionPoint {
    float x[3], normal[3]; /* mm, on the grid of the mesh; unit, outward */
    uint32_t segment;      /* the vessel whose term is largest here */
} JunctionPoint;

/* All arrays are owned. Release it with junctionmesh_release. */
typedef struct JunctionMesh {
    JunctionPoint *points;
    PatchTriangle *triangles;
    size_t n_points, n_triangles;
    Rim *rims; /* per stub */
    size_t n_rims;
    uint32_t *rim_points;
    int repeats;             /* number of attempts with finer cells */
    MeshDeviation deviation; /* at the middles of triangles and of their longest edges */
} JunctionMesh;

void junctionmesh_release(JunctionMesh *mesh);

/* The surface of a segment in the mesh. */
typedef enum SegmentStatus {
    SEGMENT_MISSING,  /* it has a surface, which is not in the mesh */
    SEGMENT_PRESENT,  /* its surface is in the mesh */
    SEGMENT_ENCLOSED, /* it has no surface: it is inside other vessels */
    SEGMENT_SLIVER    /* its surface is so narrow that no triangle belongs to it */
} SegmentStatus;

/* How fine a mesh is. All but grid_mm are in units of the local radius. */
typedef struct MeshFineness {
    CellSize cells;
    double sagitta; /* maximum distance of an edge from the surface when points are removed */
    double split_distance;   /* triangles that are farther from the surface are split */
    double max_repair;       /* maximum distance from the surface of points that close a gap */
    double rebuild_distance; /* regions with a triangle farther from the surface are built with
                                finer cells */
    double grid_mm;          /* coordinates are rounded to integer multiples of it */
} MeshFineness;

/* A triangle and the Morton code of its first point. */
typedef struct PlacedTriangle {
    uint32_t code, index;
} PlacedTriangle;

/* Workspace of one thread. Zero it before first use; release it with junctionworkspace_release. */
typedef struct JunctionWorkspace {
    Octree tree;
    Lattice lattice;
    Repairer repairer;
    PlaneCutter cutter;
    Collapser collapser;
    Refiner refiner;
    KeyMap edges;
    Patch patch;
    ARRAY(uint32_t) next; /* per point: the next point along its rim */
    ARRAY(PlacedTriangle) order;
} JunctionWorkspace;

void junctionworkspace_release(JunctionWorkspace *workspace);

/* The region to be built. All pointers are borrowed. */
typedef struct JunctionInput {
    const VesselTree *tree;
    const JunctionPlan *plan;
    const MeshFineness *fineness;
} JunctionInput;

/* Builds the surface of a region, and proves that it is a sphere with one hole for each stub. Tries
 * again with finer cells if it is not.
 *
 * mesh      receives the surface; owned by the caller.
 * statuses  per segment of the tree: the SegmentStatus of the segments that are wholly in the
 * region is set, also on failure. Errors    STATUS_INFEASIBLE with the id of a segment if finer
 * cells do not help, STATUS_INPUT if the region is too far from the origin [precision.h],
 * STATUS_MEMORY. */
MUST_CHECK Status junctionmesh_make(JunctionWorkspace *workspace, const JunctionInput *input,
                                    JunctionMesh *mesh, uint8_t *statuses, Err *err);

#endif
