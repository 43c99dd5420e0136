/* That a solid has the topology of the surfaces that it was put together from. */
#ifndef CORCAST_PRINT_SEAMS_H
#define CORCAST_PRINT_SEAMS_H

#include "mesh/mesh.h"

/* Closed surfaces without holes, and the rings that join them, as a graph. A surface is the outer
 * side or the lumen of a tree, or the one casing. */
typedef struct Seams {
    uint32_t *trees; /* of each segment: its tree; owned, as all of it */
    size_t n_segments;
    uint32_t n_nodes;       /* trees are below it */
    uint32_t *root, *rings; /* of each surface: union-find, and rings in the part it is the root of
                             */
    size_t n_rings;
    bool *is_there; /* likewise: whether the solid has it */
} Seams;

MUST_CHECK Status seams_make(const VesselTree *tree, Seams *out, Err *err);
void seams_release(Seams *seams);

/* The surface that a triangle with this label is of. */
uint32_t seams_surface(const Seams *seams, uint32_t label);
/* Has the solid the surface with this label; where the label is of a segment, that of its tree. */
void seams_add(Seams *seams, uint32_t label);
/* Joins the surfaces of two labels by a ring. */
void seams_ring(Seams *seams, uint32_t label, uint32_t other);

/* How many trees have a surface of this kind, MESH_LUMEN or 0, that nothing is joined to. */
size_t seams_lone(const Seams *seams, uint32_t kind);

/* Fills what meshcheck_topology and meshcheck_crossings fill, and what is expected. STATUS_DIFFERS
 * when a part of the solid does not have the Euler number 2 (surfaces - rings) of its part of the
 * graph, or is not one. */
MUST_CHECK Status seams_prove(const Seams *seams, const VesselMesh *mesh, double grid_mm,
                              int threads, MeshReport *report, Err *err);

#endif
