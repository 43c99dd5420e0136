/* A patch: the triangles of one junction region during its construction.
 *
 * The surface of a region is built in steps. lattice_make [lattice.h] extracts the surface from the
 * octree. planecut_apply cuts it at the end planes of the branch stubs. collapse_apply removes
 * points. facerefine_apply splits triangles. The steps append points and triangles to a patch, mark
 * triangles as PATCH_REMOVED, and compact the patch. Several threads may build different patches.
 * Private to the module mesh. */
#ifndef CORCAST_MESH_LATTICE_PATCH_H
#define CORCAST_MESH_LATTICE_PATCH_H

#include "base/base.h"
#include "geom/geom.h"
#include "mesh/lattice/octree.h"
#include "mesh/meshreport.h"
#include <stdint.h>

/* A point of a patch. */
typedef struct PatchPoint {
    Vec3 x;               /* mm */
    Vec3 normal;          /* unit, outward */
    double radius_mm;     /* the local radius: the radius of `segment` */
    uint32_t segment;     /* index of the segment with the largest term at x [JunctionField] */
    uint16_t vessel_stub; /* index of the branch stub of `segment`, or NO_STUB */
    uint16_t rim_stub;    /* index of the stub whose rim the point is on, or NO_STUB */
} PatchPoint;

/* A triangle: the indices of its three points, counterclockwise seen from outside. */
typedef struct PatchTriangle {
    uint32_t at[3];
} PatchTriangle;

/* A triangle with this value in at[0] is removed by patch_compact. */
#define PATCH_REMOVED UINT32_MAX

/* The points and triangles. All arrays are owned. Zero it before first use; release it with
 * patch_release. After STATUS_MEMORY from any function below, the patch may only be released. */
typedef struct Patch {
    PatchPoint *points;
    size_t n_points, point_capacity;
    PatchTriangle *triangles;
    size_t n_triangles, triangle_capacity;
    uint32_t *scratch; /* per point: for patch_compact and the functions on connected parts */
    size_t scratch_capacity;
} Patch;

void patch_release(Patch *patch);

/* The noun for the elements of a patch in error sentences of STATUS_MEMORY. */
extern const char patch_items[];

/* One region: its plan, its octree and its patch, as the steps that make the surface need them. All
 * pointers are borrowed. */
typedef struct JunctionSurface {
    const JunctionPlan *plan;
    Octree *tree;
    Patch *patch;
} JunctionSurface;

/* Returns the point of a patch at x. `value` and `gradient` are the field's value and gradient
 * there. `gradient` must not be 0. */
PatchPoint patch_surface_point(const JunctionField *field, Vec3 x, const FieldValue *value,
                               Vec3 gradient);

/* Appends a point, and sets *index to its index. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_add_point(Patch *patch, PatchPoint point, uint32_t *index, Err *err);
/* Appends a triangle. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_add_triangle(Patch *patch, PatchTriangle triangle, Err *err);

/* Removes the triangles whose at[0] is PATCH_REMOVED, and the points that no triangle uses. The
 * other triangles and points stay in order; points get new indices. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_compact(Patch *patch, Err *err);

/* Sets *parts to the number of connected parts of the patch. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_count_parts(Patch *patch, size_t *parts, Err *err);

/* Removes all connected parts except the one with most points. Errors: STATUS_MEMORY. */
MUST_CHECK Status patch_keep_largest(Patch *patch, Err *err);

/* Cuts the patch at the end plane of each stub, and removes the triangles beyond the planes. Before
 * the cut, a stub's surface continues STUB_TAIL (1.6) radii beyond its plane [regions/junctions.h].
 * The cut leaves one boundary loop per stub, called its rim. Compacts the patch.
 *
 * First shifts each plane along the stub's axis, so that the cut leaves no slivers. The points near
 * the plane are sorted by their position along the axis. The plane moves to the middle of the
 * widest gap between successive positions. In local radii, the shift is at most `ratio` / 4, which
 * is a quarter of a cell, and at most PLANE_MOVE (CLOSE_MOVE if BranchStub.is_close is true)
 * [regions/junctions.h].
 *
 * The new points of a rim are on the circle around the stub's axis. If is_close is true, the
 * surface is not exactly a cylinder at the plane, and the new points are on the surface instead.
 * The PatchPoint.rim_stub of a new point is the index of the stub.
 *
 * ratio    side of the cells of the octree, divided by the local radius.
 * valid    receives true; false if one triangle has points beyond two different planes. The patch
 *          is then unusable.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status planecut_apply(const JunctionSurface *surface, double ratio, bool *valid,
                                 Err *err);

/* Removes points where the surface is nearly flat, which is mainly the case along vessels. Each
 * edge collapse merges a point into a neighbour. The topology of the patch does not change. The
 * remaining points do not move. Rim points are merged only with rim points of the same rim.
 * Compacts the patch.
 *
 * sagitta  maximum distance between the old surface and the new edges, in local radii, above 0.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status collapse_apply(Patch *patch, double sagitta, Err *err);

/* Splits triangles that are too far from the exact surface. Most of them are between the daughters
 * of a bifurcation. The new points are on the surface, and have higher indices than the
 * other points. Edges on rims are not split. An edge is not split either if the split would turn a
 * triangle over. Some triangles may therefore remain too far from the surface. The topology of the
 * patch does not change.
 *
 * limit      maximum distance of a triangle from the surface, in local radii.
 * deviation  is raised to the largest distance of a final triangle from the surface, if that is
 *            larger. Distances are measured at the middle of each triangle and of its longest edge.
 * Errors     STATUS_MEMORY. */
MUST_CHECK Status facerefine_apply(const JunctionSurface *surface, double limit,
                                   MeshDeviation *deviation, Err *err);

#endif
