/* The named parts of a mesh: its walls, and the flat ends at which blood enters and leaves. Exports
 * for simulation name boundary patches by them. Every triangle belongs to one part. */
#ifndef CORCAST_SCENE_MESHENDS_H
#define CORCAST_SCENE_MESHENDS_H

#include "scene/triangles.h"
#include "scene/vesseltree.h"

/* A flat end: a disc that closes a vessel, or the ring at the end of a vessel's hollow wall. */
typedef struct MeshEnd {
    char name[32];    /* "inlet", or "inlet_002" if there are several; "outlet_017"; "inlet_ring"
                       * for a ring. The number is the SWC id of the segment. */
    uint32_t segment; /* index in VesselTree.segments */
    bool is_inlet;    /* true: at the segment's start; false: at its end */
    bool is_ring;
    Vec3 center; /* mm, on the segment's axis */
    Vec3 normal; /* unit, out of the vessel */
    double radius_mm;
    double area_mm2; /* sum of the triangles' areas; approximates that of the circle */
} MeshEnd;

/* Part k is walls[k], or ends[k - n_walls]. All arrays are owned. */
typedef struct MeshEnds {
    const char *walls[3]; /* "wall", or "outer" and "lumen" of a hollow wall; "frame" */
    size_t n_walls;
    MeshEnd *ends;   /* discs, then rings; in each inlets, then outlets, by rising id */
    size_t n;        /* number of ends */
    uint32_t *parts; /* per triangle: index of its part */
} MeshEnds;

/* Finds the parts of a mesh of `tree`. A round end belongs to the wall. Release *out with
 * meshends_release. Errors: STATUS_MEMORY. O(triangles + segments). */
MUST_CHECK Status meshends_find(const VesselMesh *mesh, const VesselTree *tree, MeshEnds *out,
                                Err *err);
/* Frees the arrays and zeroes *ends. */
void meshends_release(MeshEnds *ends);

/* Returns the number of parts. */
static inline size_t meshends_parts(const MeshEnds *ends)
{
    return ends->n_walls + ends->n;
}
/* Returns the name of a part. Borrowed. */
static inline const char *meshends_part_name(const MeshEnds *ends, size_t part)
{
    return part < ends->n_walls ? ends->walls[part] : ends->ends[part - ends->n_walls].name;
}

#endif
