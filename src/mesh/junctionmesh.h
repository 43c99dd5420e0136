/* The finished wall of one junction. */
#ifndef CORCAST_MESH_JUNCTIONMESH_H
#define CORCAST_MESH_JUNCTIONMESH_H

#include "mesh/lattice/collapse.h"
#include "mesh/lattice/facerefine.h"
#include "mesh/lattice/planecut.h"
#include "mesh/lattice/repair.h"

/* The points on the rim of an stub: rim_points[first .. first + n), by rising angle about the axis
 * of the segment, from its first to its second end. */
typedef struct Rim {
    uint32_t segment;
    int end;
    uint32_t first, n;
} Rim;

/* A point of a finished wall, in as few bytes as it takes. */
typedef struct JunctionPoint {
    float x[3], normal[3]; /* on the grid of the mesh; unit */
    uint32_t segment;      /* whose term is largest there */
} JunctionPoint;

typedef struct JunctionMesh {
    JunctionPoint *points; /* owned, as all of it */
    Triangle *triangles;
    size_t n_points, n_triangles;
    Rim *rims;
    size_t n_rims;
    uint32_t *rim_points;
    int repeats; /* with finer cells */
    MeshOff off; /* of the triangles' middles and longest edges */
} JunctionMesh;

void junctionmesh_release(JunctionMesh *piece);

/* What has become of a segment. */
typedef enum SegmentStatus {
    SEGMENT_MISSING, /* it has a wall, which is not in the mesh */
    SEGMENT_PRESENT,
    SEGMENT_ENCLOSED, /* it lies within others */
    SEGMENT_SLIVER    /* it has a wall, but so narrow a one that no triangle is its own */
} SegmentStatus;

typedef struct MeshFineness {
    CellSize cells;
    double sagitta;  /* of the local radius, for edges */
    double split;    /* likewise, triangles that are farther off the wall are split */
    double farthest; /* likewise, of points that close a gap, off the wall */
    double worst;    /* likewise; junctions with triangles farther off get finer cells */
    double grid_mm;  /* coordinates are rounded to its multiples */
} MeshFineness;

/* A triangle and where it stands among others that are near in space. */
typedef struct PlacedTriangle {
    uint32_t code, number;
} PlacedTriangle;

/* Workspace of a thread; zeroed before the first use. */
typedef struct JunctionWorkspace {
    Octree tree;
    Lattice lattice;
    Repairer repairer;
    PlaneCutter cutter;
    Collapser collapser;
    Refiner refiner;
    KeyMap edges;
    Patch patch;
    uint32_t *next;
    PlacedTriangle *order;
    size_t next_capacity, order_capacity;
} JunctionWorkspace;

void junctionworkspace_release(JunctionWorkspace *worker);

/* Makes the wall of a junction; of the segments that lie wholly in it, segment_status[segment] is
 * set. Repeats with finer cells what is not a sphere with one hole for each stub.
 * STATUS_INFEASIBLE, naming the id of a segment, when that does not help. */
MUST_CHECK Status junctionmesh_make(JunctionWorkspace *worker, const VesselTree *tree,
                                    JunctionPlan *plan, const MeshFineness *fineness,
                                    JunctionMesh *piece, uint8_t *segment_status, Err *err);

#endif
