/* The parts of a mesh by name: its walls, and the flat ends where blood enters and leaves. */
#ifndef CORCAST_SCENE_MESHENDS_H
#define CORCAST_SCENE_MESHENDS_H

#include "scene/triangles.h"
#include "scene/vesseltree.h"

/* A disc that closes a vessel, or the ring at the end of a vessel's wall. */
typedef struct MeshEnd {
    char name[32];    /* "inlet", of several "inlet_002"; "outlet_017": by the segment's SWC id; of
                       * a ring "inlet_ring", ... */
    uint32_t segment; /* index */
    bool is_inlet;    /* it is where the segment begins; else where it ends */
    bool is_ring;
    Vec3 center; /* mm, on the segment's axis */
    Vec3 normal; /* unit, out of the vessel */
    double radius_mm;
    double area_mm2; /* of the triangles, which lie in the circle of that radius, or about it */
} MeshEnd;

/* Part k is walls[k], or behind them ends[k - n_walls]. */
typedef struct MeshEnds {
    const char *walls[3]; /* "wall", or of a hollow wall "lumen" and "outer"; "frame" */
    size_t n_walls;
    MeshEnd
        *ends; /* discs, then rings; of each inlets, then outlets, by rising id; owned, as all */
    size_t n;
    uint32_t *parts; /* one a triangle */
} MeshEnds;

/* Finds the parts of a mesh of the tree. An end that is round belongs to the wall. STATUS_MEMORY.
 * O(triangles + segments). */
MUST_CHECK Status meshends_find(const VesselMesh *mesh, const VesselTree *tree, MeshEnds *out,
                                Err *err);
void meshends_release(MeshEnds *ends);

static inline size_t meshends_parts(const MeshEnds *ends)
{
    return ends->n_walls + ends->n;
}
/* The name of a part. Borrowed. */
static inline const char *meshends_part_name(const MeshEnds *ends, size_t part)
{
    return part < ends->n_walls ? ends->walls[part] : ends->ends[part - ends->n_walls].name;
}

#endif
