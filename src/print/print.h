/* The public header of the module print: builds solids for 3D printing from vessels.
 *
 * There are four kinds of prints: solid vessels; vessels with a wall around a lumen; a block with
 * the vessels as cavities; and solid or hollow vessels on a base plate. A free end of a vessel is
 * open if it is cut flat and no disc closes it, so that its lumen leads out of the print or into a
 * port. A print is assembled from
 * closed surfaces, each of which is valid by meshreport_check. The surfaces are opened at flat ends
 * and joined there by rings of triangles, so no boolean operation is needed.
 *
 * The topology follows from the assembly. The solid has as many connected components as the graph
 * whose nodes are surfaces and whose edges are rings. Its genus is rings - surfaces + components +
 * the sum of the genera of the surfaces. print_build proves that the triangles have this topology.
 *
 *     PrintParams params = {.mesh = {.tolerance = 0.02}, .wall_mm = 1};
 *     TRY(print_build(&tree, &params, &mesh, &report, &print, err));
 *
 * The caller then uses `mesh`, and releases all three with vesselmesh_release, meshreport_release
 * and printreport_release. */
#ifndef CORCAST_PRINT_PRINT_H
#define CORCAST_PRINT_PRINT_H

#include "mesh/mesh.h"

/* Which vessel ends get a port out of the block: none, only first ends of segments (inlets), or
 * all. */
typedef enum PrintPorts { PORTS_NONE, PORTS_INLET, PORTS_ALL } PrintPorts;

/* A block in which the vessels are cavities. */
typedef struct PrintBlock {
    bool is_wanted;
    bool is_round;     /* true: a cylinder, whose axis is the coordinate axis nearest to the
                        * direction of the first segment; vessels leave it through its two flat
                        * faces. false: a box. */
    double size_mm[3]; /* of a box: along x, y, z. Of a cylinder: diameter, height. 0: as large as
                        * the vessels and the margin need. */
    double margin_mm;  /* minimum distance of vessels from the block's faces */
    PrintPorts ports;
    double taper; /* increase of a port's diameter towards its face, mm per mm, in [0, 1] */
    bool is_luer; /* ports end in the female half of a Luer fitting */
} PrintBlock;

/* A base plate below the vessels, perpendicular to the z axis. Support pins connect it to the
 * vessels. */
typedef struct PrintBase {
    bool is_wanted;
    double thickness_mm;
    double min_pin_radius_mm; /* minimum radius of a pin */
} PrintBase;

/* Parameters of print_build. */
typedef struct PrintParams {
    MeshParams mesh;
    bool part_overlaps; /* true: thins unconnected vessels that overlap, including their walls
                         * [vesseltree_thin_overlaps] */
    /* Thickness of a wall around the vessels, which become its lumen: wall_mm + wall_ratio *
     * radius. Both 0: no wall. A wall cannot be combined with a block. */
    double wall_mm, wall_ratio;
    bool lids; /* with a wall: discs close the openings of the lumen. The discs use the points of
                * the lumen's rims, so that wall and lumen are two solids that share triangles. */
    PrintBlock block;
    PrintBase base; /* cannot be combined with a block */
} PrintParams;

/* The facts about a print. All arrays are owned. */
typedef struct PrintReport {
    size_t rings;         /* number of rings that join surfaces */
    size_t openings;      /* number of openings of lumens: open vessel ends, or ports of a block */
    size_t pins;          /* number of pins between vessels and the base plate */
    size_t unsupported;   /* number of nodes that need a pin, but where no pin is possible */
    size_t cavities;      /* number of closed cavities: lumens without an opening */
    NearPair closest;     /* the two unconnected vessels, with their walls, with the smallest gap */
    bool has_closest;     /* false: no two vessels are unconnected, and `closest` is not set */
    uint32_t *closed;     /* indices of segments with a free end that is not open; a segment with
                           * two closed ends occurs twice */
    uint32_t *lengthened; /* indices of segments that were lengthened, so that their ends can be cut
                           * flat */
    uint32_t *thinned;    /* indices of segments that were thinned because of part_overlaps */
    size_t n_closed, n_lengthened, n_thinned;
    double lumen_mm3; /* volume of the vessels */
    double outer_mm3; /* volume inside the outer surface of the walls; without walls, volume of the
                       * vessels */
} PrintReport;

/* Frees the arrays and zeroes *report. */
void printreport_release(PrintReport *report);

/* Returns true if the vessels get a wall. */
static inline bool print_has_wall(const PrintParams *params)
{
    return params->wall_mm > 0 || params->wall_ratio > 0;
}

/* Returns true if the print has lumens: in walls, or in a block. */
static inline bool print_is_hollow(const PrintParams *params)
{
    return print_has_wall(params) || params->block.is_wanted;
}

/* Returns true if the print is assembled from several surfaces, which are joined at flat ends. */
static inline bool print_is_joined(const PrintParams *params)
{
    return print_is_hollow(params) || params->base.is_wanted;
}

/* Builds the solid of a tree and proves its topology. The result does not depend on the number of
 * threads. On error, `mesh`, `report` and `print` stay unchanged.
 *
 * tree     its body must be BODY_POTENTIAL if print_is_joined. The function may lengthen ends and
 *          thin vessels, as the report states; the tree may be changed also on error.
 * mesh     receives the triangles; release it with vesselmesh_release. Labels are indices of
 *          segments of `tree`, with the flag MESH_LUMEN inside a wall, MESH_CAP where an end is cut
 *          flat, and MESH_FRAME on pins, plate and block. Lids have MESH_CAP and MESH_LUMEN.
 * report   receives the facts about the solid without lids; release it with meshreport_release.
 * print    receives the facts about the print; release it with printreport_release.
 * Errors   STATUS_INPUT if walls overlap (the sentence names the ids of one pair), if lids are
 *          wanted but an end is not open, if the block is too small, or if the tree is too far from
 *          the origin.
 *          STATUS_INFEASIBLE if no pin or no port is possible, or if a junction region has no valid
 *          surface. STATUS_DIFFERS if a surface or the solid is not valid. STATUS_CANCELLED if
 *          MeshParams.progress returned false. STATUS_MEMORY. */
MUST_CHECK Status print_build(VesselTree *tree, const PrintParams *params, VesselMesh *mesh,
                              MeshReport *report, PrintReport *print, Err *err);

#endif
