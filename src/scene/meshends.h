/* The flat ends of vessels in a mesh, by name: where blood enters and leaves. */
#ifndef CORCAST_SCENE_MESHENDS_H
#define CORCAST_SCENE_MESHENDS_H

#include "scene/triangles.h"
#include "scene/vesseltree.h"

/* A disc that closes a vessel. */
typedef struct MeshEnd {
    char name[24];    /* "inlet", of several "inlet_002"; "outlet_017": by the segment's SWC id */
    uint32_t segment; /* index */
    bool is_inlet;    /* it is where the segment begins; else where it ends */
    Vec3 center;      /* mm, on the segment's axis */
    Vec3 normal;      /* unit, out of the vessel */
    double radius_mm;
    double area_mm2; /* of the triangles, which lie in the circle of that radius */
} MeshEnd;

/* The parts of a mesh: part 0 is the wall, part k + 1 is ends[k]. */
typedef struct MeshEnds {
    MeshEnd *ends; /* inlets, then outlets, each by rising id; owned, as all of it */
    size_t n;
    uint32_t *parts; /* one a triangle */
} MeshEnds;

#define MESHENDS_WALL "wall"

/* Finds the ends that triangles of the mesh close. An end that is round belongs to the wall.
 * STATUS_MEMORY. O(triangles + segments). */
MUST_CHECK Status meshends_find(const VesselMesh *mesh, const VesselTree *tree, MeshEnds *out,
                                Err *err);
void meshends_release(MeshEnds *ends);

/* The name of a part. Borrowed. */
static inline const char *meshends_part_name(const MeshEnds *ends, size_t part)
{
    return part ? ends->ends[part - 1].name : MESHENDS_WALL;
}

#endif
