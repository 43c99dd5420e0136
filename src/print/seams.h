/* The topology of a solid, derived from the surfaces that it was put together from, and the proof
 * that the solid has it. */
#ifndef CORCAST_PRINT_SEAMS_H
#define CORCAST_PRINT_SEAMS_H

#include "mesh/mesh.h"

/* A graph of closed surfaces without holes, and of the rings of triangles that join them. A surface
 * is the outer side or the lumen of a tree, or the casing. All arrays are owned. */
typedef struct Seams {
    uint32_t *trees; /* per segment: its tree, an index below n_nodes */
    size_t n_segments;
    uint32_t n_nodes;
    uint32_t *root;  /* per surface: sets of joined surfaces [base/sets.h] */
    uint32_t *rings; /* per surface that represents a set: the number of rings in the set */
    size_t n_rings;
    bool *is_used; /* per surface: it is part of the solid */
} Seams;

/* Makes a graph without surfaces. Release it with seams_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status seams_make(const VesselTree *tree, Seams *out, Err *err);
void seams_release(Seams *seams);

/* Returns the surface of a triangle with this label. */
uint32_t seams_surface(const Seams *seams, uint32_t label);
/* Makes the surface of this label part of the solid. The label of a segment stands for its tree. */
void seams_add(Seams *seams, uint32_t label);
/* Joins the surfaces of two labels by a ring. */
void seams_ring(Seams *seams, uint32_t label, uint32_t other);

/* Returns the number of trees with a surface that no ring joins. `kind` is MESH_LUMEN, or 0 for the
 * outer side. */
size_t seams_count_unjoined(const Seams *seams, uint32_t kind);

/* Fills the fields of the report that meshcheck_topology and meshcheck_crossings fill, and the
 * expected numbers. Errors: STATUS_DIFFERS if a part of the solid is not connected, or does not
 * have the Euler number 2 (surfaces - rings) of its part of the graph; STATUS_MEMORY. */
MUST_CHECK Status seams_prove(const Seams *seams, const VesselMesh *mesh, double grid_mm,
                              int threads, MeshReport *report, Err *err);

#endif
