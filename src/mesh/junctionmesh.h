/* Builds the surface of one junction region.
 *
 * A region contains one or several nodes of the tree [regions/junctions.h]. Its surface is built in
 * steps: it is extracted from a lattice of tetrahedra in an octree, cut at the end planes of the
 * branch stubs, simplified, and split where it is too far from the exact surface. Then it is proved
 * to be a sphere with one hole per stub, and one handle per loop of the region's segments. The
 * boundary loop of a hole is called a rim; a tube begins there. Private to the module mesh.
 *
 *     JunctionWorkspace workspace = {0};
 *     JunctionInput input = {&tree, &plan, &fineness};
 *     TRY(junctionmesh_make(&workspace, &input, &mesh, statuses, err));
 *     junctionworkspace_release(&workspace); */
#ifndef CORCAST_MESH_JUNCTIONMESH_H
#define CORCAST_MESH_JUNCTIONMESH_H

#include "mesh/lattice/latticerepair.h"

/* The rim of a branch stub. Its points are JunctionMesh.rim_points[first .. first + n), by
 * ascending angle about the axis. The axis leads from the segment's first end to its second end. */
typedef struct Rim {
    uint32_t segment; /* index of the stub's segment in the tree */
    int end;          /* the segment's end, 0 or 1, that is in the region */
    uint32_t first, n;
} Rim;

/* A point of a finished surface, in single precision. */
typedef struct JunctionPoint {
    float x[3];       /* mm; multiples of MeshFineness.grid_mm */
    float normal[3];  /* unit, outward */
    uint32_t segment; /* the segment with the largest term at x in the potential, whose level set
                       * the surface is [regions/junctionfield.h] */
} JunctionPoint;

/* The finished surface. All arrays are owned. Release it with junctionmesh_release. */
typedef struct JunctionMesh {
    JunctionPoint *points;
    PatchTriangle *triangles;
    size_t n_points, n_triangles;
    Rim *rims; /* per stub of the plan */
    size_t n_rims;
    uint32_t *rim_points;    /* indices of points: the rims, one after another */
    int retries;             /* number of attempts with finer cells; 0: the first one succeeded */
    bool has_lost_handles;   /* during construction: the last attempt has fewer handles than the
                              * region has loops, so it failed; false in a finished surface */
    MeshDeviation deviation; /* largest distance from the exact surface, measured at the middles of
                              * triangles and of their longest edges */
} JunctionMesh;

/* Frees the arrays and zeroes *mesh. */
void junctionmesh_release(JunctionMesh *mesh);

/* Whether a segment's surface is in the mesh. */
typedef enum SegmentStatus {
    SEGMENT_MISSING,  /* the segment has a surface, but the mesh lacks it: an error */
    SEGMENT_PRESENT,  /* its surface is in the mesh */
    SEGMENT_ENCLOSED, /* it has no surface, because it is inside other vessels */
    SEGMENT_SLIVER    /* its surface is so narrow that no triangle belongs to it */
} SegmentStatus;

/* Limits that decide how fine a mesh is. All members except grid_mm are in units of the local
 * radius. */
typedef struct MeshFineness {
    CellSize cells;
    double sagitta;          /* maximum distance of a new edge from the surface when points are
                              * removed */
    double split_distance;   /* maximum distance of a triangle from the surface; triangles farther
                              * away are split */
    double max_repair;       /* maximum distance from the surface of a lattice point that is moved
                              * inside to close a tunnel or cavity [latticerepair.h] */
    double rebuild_distance; /* a region with a triangle farther from the surface is built again
                              * with finer cells */
    double grid_mm;          /* coordinates are rounded to integer multiples of it [mesh_grid] */
} MeshFineness;

/* Workspace of one thread: the largest arrays of a region, reused for the next region. Zero it
 * before first use; release it with junctionworkspace_release. */
typedef struct JunctionWorkspace {
    Octree tree;
    Lattice lattice;
    Patch patch;
} JunctionWorkspace;

void junctionworkspace_release(JunctionWorkspace *workspace);

/* The input of junctionmesh_make. All pointers are borrowed. */
typedef struct JunctionInput {
    const VesselTree *tree;
    const JunctionPlan *plan;
    const MeshFineness *fineness; /* limits of the first attempt */
} JunctionInput;

/* Builds the surface of a region, and proves that it is a sphere with one hole per stub and one
 * handle per loop. Tries again with finer cells if the proof fails.
 *
 * mesh      receives the surface; release it with junctionmesh_release.
 * statuses  per segment of the tree. The SegmentStatus of each segment that is wholly in the region
 *           is set, also on failure. The statuses of other segments stay.
 * Errors    STATUS_INFEASIBLE, naming the id of a segment, if finer cells do not help;
 *           STATUS_INPUT if the tree is too far from the origin [precision.h]; STATUS_MEMORY.
 * Threads   Several threads may build different regions, each with its own workspace. */
MUST_CHECK Status junctionmesh_make(JunctionWorkspace *workspace, const JunctionInput *input,
                                    JunctionMesh *mesh, uint8_t *statuses, Err *err);

#endif
