/* Solids for printing, made of the surfaces of vessels. Exported by the door of the room surface.
 *
 * A solid is put together from closed surfaces without holes, each of them proved by
 * vesselmesh_build, that are opened at flat ends and joined there by rings of triangles: so it has
 * as many parts as the surfaces and rings have, as a graph, and its genus is rings - surfaces +
 * parts. */
#ifndef CORCAST_SURFACE_PRINT_H
#define CORCAST_SURFACE_PRINT_H

#include "surface/mesh/vesselmesh.h"

typedef struct PrintParams {
    MeshParams mesh;
    bool part_overlaps; /* as vesseltree_part: walls and vessels that overlap are thinned */
    double wall_mm;     /* thickness of a wall about the vessels, which become its lumen ... */
    double wall_ratio;  /* ... and what it is thicker by, over the radius; both 0: solid vessels */
    bool lids;          /* of a wall: discs close the openings of the lumen, of the same points, so
                         * that wall and lumen are two solids that share it */
} PrintParams;

typedef struct PrintReport {
    size_t rings;      /* by which surfaces are joined */
    size_t openings;   /* of lumens, ends of vessels */
    size_t cavities;   /* closed ones */
    uint32_t *closed;  /* segments with an end that is not open; owned, as all of it */
    uint32_t *longer;  /* those that are lengthened, so that they can be cut off flat */
    uint32_t *thinned; /* those that are thinned, by part_overlaps */
    size_t n_closed, n_longer, n_thinned;
    double lumen_mm3, outer_mm3; /* of a wall: what its two sides enclose */
} PrintReport;

void printreport_release(PrintReport *report);

/* Whether vessels become walls. */
static inline bool print_has_wall(const PrintParams *params)
{
    return params->wall_mm > 0 || params->wall_ratio > 0;
}

/* Whether several surfaces are joined at flat ends. */
static inline bool print_is_joined(const PrintParams *params)
{
    return print_has_wall(params);
}

/* Makes the solid of a tree, whose body must be BODY_POTENTIAL if surfaces are joined, and proves
 * it: *report is that of the solid. Ends of the tree are lengthened, and its vessels thinned, as
 * the report says; labels are indices of its segments, with MESH_LUMEN inside a wall, and MESH_CAP
 * where an end is cut off flat; lids have both. What is proved is true of the solid without lids.
 * Errors as vesselmesh_build; STATUS_INPUT naming a pair of ids when
 * walls meet, or a segment that would have a lid but is not open, STATUS_DIFFERS when a surface is
 * not sound. The same bytes for any number of threads.
 */
MUST_CHECK Status print_build(VesselTree *tree, const PrintParams *params, VesselMesh *mesh,
                              MeshReport *report, PrintReport *print, Err *err);

#endif
