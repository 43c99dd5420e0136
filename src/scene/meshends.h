/* Divides a mesh of vessels into named parts: its walls, and the flat ends at which blood enters
 * and leaves. Every triangle belongs to one part. Exports for simulation use the names as names of
 * boundary patches. meshends_find finds the parts, meshends_part_name names them. */
#ifndef CORCAST_SCENE_MESHENDS_H
#define CORCAST_SCENE_MESHENDS_H

#include "scene/triangles.h"
#include "scene/vesseltree.h"

/* A flat end: a disc that closes a vessel, or the ring at the end of a vessel's hollow wall. */
typedef struct MeshEnd {
    char name[32];    /* unique: "inlet", or "inlet_002" if there are several inlets; "outlet_017";
                       * "inlet_ring" for a ring. The number is the SWC id of the segment */
    uint32_t segment; /* index in VesselTree.segments */
    bool is_inlet;    /* true: the end is at the segment's start; false: at its end */
    bool is_ring;     /* true: the end of a hollow wall; false: a disc */
    Vec3 center;      /* mm, on the segment's axis */
    Vec3 normal;      /* unit, points out of the vessel */
    double radius_mm;
    double area_mm2; /* sum of the areas of the triangles, which approximate a circle or ring */
} MeshEnd;

/* The parts of a mesh. Part k is walls[k] if k < n_walls, else ends[k - n_walls]. All arrays are
 * owned. */
typedef struct MeshEnds {
    const char *walls[3]; /* "wall"; or "outer" and "lumen" of a hollow wall; and "frame", if the
                           * mesh has a block or plate */
    size_t n_walls;
    MeshEnd *ends;   /* discs, then rings; among each of these inlets, then outlets, by ascending
                      * id */
    size_t n;        /* number of ends */
    uint32_t *parts; /* per triangle: index of its part */
} MeshEnds;

/* Finds the parts of a mesh of `tree`. The triangles of a round end belong to the wall. Release
 * *out with meshends_release. Errors: STATUS_MEMORY. O(triangles + segments). */
MUST_CHECK Status meshends_find(const VesselMesh *mesh, const VesselTree *tree, MeshEnds *out,
                                Err *err);
/* Frees the arrays and zeroes *ends. */
void meshends_release(MeshEnds *ends);

/* Returns the number of parts. */
static inline size_t meshends_parts(const MeshEnds *ends)
{
    return ends->n_walls + ends->n;
}
/* Returns the name of part `part`, which must be below meshends_parts. The name is borrowed. */
static inline const char *meshends_part_name(const MeshEnds *ends, size_t part)
{
    return part < ends->n_walls ? ends->walls[part] : ends->ends[part - ends->n_walls].name;
}

#endif
