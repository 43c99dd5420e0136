/* The public header of the module print: solids for printing, made from the surfaces of vessels.
 *
 * A solid is put together from closed surfaces without holes, each of them valid by
 * meshreport_check. They are opened at flat ends and joined there by rings of triangles. So the
 * solid has as many connected parts as the graph of surfaces and rings, and its genus is rings -
 * surfaces + parts. */
#ifndef CORCAST_PRINT_PRINT_H
#define CORCAST_PRINT_PRINT_H

#include "mesh/mesh.h"

/* The vessel ends that are led out of a block. */
typedef enum PrintPorts { PORTS_NONE, PORTS_INLET, PORTS_ALL } PrintPorts;

/* A block in which the vessels are hollow. */
typedef struct PrintBlock {
    bool is_wanted;
    bool is_round;     /* a cylinder along the coordinate axis that the first vessel is nearest to,
                        * which     vessels leave through its two flat faces; else a box */
    double size_mm[3]; /* of a box: along x, y, z; of a cylinder: diameter, height; 0: from the
                          margin */
    double margin_mm;  /* minimum distance of vessels from the block's faces */
    PrintPorts ports;
    double taper; /* increase of a port's diameter per mm */
    bool is_luer; /* ports end in the female half of a Luer fitting */
} PrintBlock;

/* A plate below the vessels, across the z axis, on which they stand by support pins. */
typedef struct PrintBase {
    bool is_wanted;
    double thickness_mm;
    double min_pin_radius_mm; /* minimum radius of a pin */
} PrintBase;

typedef struct PrintParams {
    MeshParams mesh;
    bool part_overlaps; /* thin walls and vessels that overlap [vesseltree_thin_overlaps] */
    /* Thickness of a wall about the vessels, which become its lumen: wall_mm + wall_ratio * radius.
     * Both 0: solid vessels. */
    double wall_mm, wall_ratio;
    bool lids; /* of a wall: discs close the openings of the lumen. They use its points, so that
                * wall and lumen are two solids that share them. */
    PrintBlock block;
    PrintBase base;
} PrintParams;

/* The facts about a print. All arrays are owned. */
typedef struct PrintReport {
    size_t rings;       /* number of rings that join surfaces */
    size_t openings;    /* of lumens: ends of vessels, or ports of a block */
    size_t pins;        /* number of pins between vessels and the base */
    size_t unsupported; /* number of places that need a pin, but where no pin is possible */
    size_t cavities;    /* number of lumens without an opening */
    NearPair closest;   /* the vessels nearest to each other that do not belong together, with their
                           walls */
    bool has_closest;   /* false: there are no such vessels */
    uint32_t *closed;   /* segments with an end that is not open */
    uint32_t *lengthened; /* segments that were made longer, so that their ends are flat */
    uint32_t *thinned;    /* segments that were made thinner, by part_overlaps */
    size_t n_closed, n_lengthened, n_thinned;
    double lumen_mm3; /* volume of the vessels */
    double outer_mm3; /* volume that the outer surface encloses; without a wall or block, that of
                       * the vessels */
} PrintReport;

void printreport_release(PrintReport *report);

/* Returns true if the vessels get a wall. */
static inline bool print_has_wall(const PrintParams *params)
{
    return params->wall_mm > 0 || params->wall_ratio > 0;
}

/* Returns true if the print has lumens. */
static inline bool print_is_hollow(const PrintParams *params)
{
    return print_has_wall(params) || params->block.is_wanted;
}

/* Returns true if several surfaces are joined at flat ends. */
static inline bool print_is_joined(const PrintParams *params)
{
    return print_is_hollow(params) || params->base.is_wanted;
}

/* Makes the solid of a tree and proves its topology. The result does not depend on the number of
 * threads.
 *
 * tree     its body must be BODY_POTENTIAL if surfaces are joined. Ends may become longer and
 * vessels thinner, as the report states. mesh     receives the triangles. Labels are indices of
 * segments, with MESH_LUMEN inside a wall, and with MESH_CAP where an end is cut off flat; lids
 * have both. report   receives the facts about the solid without lids. Errors   as
 * vesselmesh_build; STATUS_INPUT with a pair of ids if walls meet, or with a segment that would
 * need a lid but is not open; STATUS_INFEASIBLE if no pin or no port is possible; STATUS_DIFFERS if
 * a surface is not valid. */
MUST_CHECK Status print_build(VesselTree *tree, const PrintParams *params, VesselMesh *mesh,
                              MeshReport *report, PrintReport *print, Err *err);

#endif
