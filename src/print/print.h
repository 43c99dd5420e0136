/* Solids for printing, made of the surfaces of vessels. Exported by the door of the room surface.
 *
 * A solid is put together from closed surfaces without holes, each of them proved by
 * vesselmesh_build, that are opened at flat ends and joined there by rings of triangles: so it has
 * as many parts as the surfaces and rings have, as a graph, and its genus is rings - surfaces +
 * parts. */
#ifndef CORCAST_PRINT_PRINT_H
#define CORCAST_PRINT_PRINT_H

#include "mesh/mesh.h"

/* Which ends of vessels are led out of a block. */
typedef enum PrintPorts { PORTS_NONE, PORTS_INLET, PORTS_ALL } PrintPorts;

/* A block that vessels are hollow in. */
typedef struct PrintBlock {
    bool is_there;
    bool is_round;     /* a cylinder along the axis that the first vessel is nearest to, which
                        * vessels leave through its two flat faces; else a box */
    double size_mm[3]; /* of a cylinder, diameter and height; 0: as the margin has it */
    double margin_mm;  /* left about the vessels at the least */
    PrintPorts ports;
    double taper; /* of ports: by how much their diameter grows for each mm */
    bool is_luer; /* ports end in the female half of a Luer fitting */
} PrintBlock;

/* A plate under the vessels, across the z axis, that they stand on by pins. */
typedef struct PrintBase {
    bool is_there;
    double thickness_mm;
    double least_radius_mm; /* of pins */
} PrintBase;

typedef struct PrintParams {
    MeshParams mesh;
    bool part_overlaps; /* as vesseltree_part: walls and vessels that overlap are thinned */
    double wall_mm;     /* thickness of a wall about the vessels, which become its lumen ... */
    double wall_ratio;  /* ... and what it is thicker by, over the radius; both 0: solid vessels */
    bool lids;          /* of a wall: discs close the openings of the lumen, of the same points, so
                         * that wall and lumen are two solids that share it */
    PrintBlock block;
    PrintBase base;
} PrintParams;

typedef struct PrintReport {
    size_t rings;      /* by which surfaces are joined */
    size_t openings;   /* of lumens: ends of vessels, or ports of a block */
    size_t pins;       /* between vessels and the base */
    size_t hanging;    /* places that a printer begins in the air, and no pin could be led to */
    size_t cavities;   /* lumens of trees without an opening */
    NearPair closest;  /* of vessels that do not belong together, with their walls */
    bool has_closest;  /* there are such */
    uint32_t *closed;  /* segments with an end that is not open; owned, as all of it */
    uint32_t *longer;  /* those that are lengthened, so that they can be cut off flat */
    uint32_t *thinned; /* those that are thinned, by part_overlaps */
    size_t n_closed, n_longer, n_thinned;
    double lumen_mm3, outer_mm3; /* what vessels enclose, and with a wall or in a block what that
                                  * does */
} PrintReport;

void printreport_release(PrintReport *report);

/* Whether vessels become walls. */
static inline bool print_has_wall(const PrintParams *params)
{
    return params->wall_mm > 0 || params->wall_ratio > 0;
}

/* Whether the print has lumens. */
static inline bool print_is_hollow(const PrintParams *params)
{
    return print_has_wall(params) || params->block.is_there;
}

/* Whether several surfaces are joined at flat ends. */
static inline bool print_is_joined(const PrintParams *params)
{
    return print_is_hollow(params) || params->base.is_there;
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
