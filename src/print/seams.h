/* The expected topology of a solid, and the proof that its triangles have it.
 *
 * A solid is put together from closed surfaces, which are joined by rings of triangles. The surface
 * of a tree has one handle per independent loop of the tree. A Seams is the graph of them: surfaces
 * are nodes, rings are edges. The caller adds every surface and every ring to the graph while it
 * adds them to the solid. seams_prove then compares the triangles with the graph. Private to the
 * module print. */
#ifndef CORCAST_PRINT_SEAMS_H
#define CORCAST_PRINT_SEAMS_H

#include "mesh/mesh.h"

/* The graph. A surface is the outer side of a tree, the lumen of a tree, or the casing. The outer
 * side of tree t has the index t, its lumen n_trees + t, and the casing 2 n_trees. All arrays are
 * owned. */
typedef struct Seams {
    uint32_t *trees; /* per segment: the index of its tree [meshcheck_trees] */
    uint32_t *loops; /* per tree: the number of its independent loops [meshcheck_loops] */
    uint32_t n_trees;
    uint32_t *root;  /* per surface: disjoint sets of joined surfaces [base/sets.h] */
    uint32_t *rings; /* per surface that is the root of a set: the number of rings in the set */
    size_t n_rings;  /* number of all rings */
    bool *is_used;   /* per surface: it is part of the solid */
} Seams;

/* Makes a graph of no surfaces and no rings, for the trees of `tree`. Release *out with
 * seams_release. Errors: STATUS_MEMORY. */
MUST_CHECK Status seams_make(const VesselTree *tree, Seams *out, Err *err);
void seams_release(Seams *seams);

/* Returns the index of the surface that a triangle with this label belongs to. */
uint32_t seams_surface(const Seams *seams, uint32_t label);
/* Adds the surface of this label to the graph. The label of any segment of a tree will do. */
void seams_add(Seams *seams, uint32_t label);
/* Adds a ring between the surfaces of two labels. */
void seams_ring(Seams *seams, uint32_t label, uint32_t other);

/* Returns the number of trees whose surface is part of the solid, but has no ring. `kind` selects
 * the surface: MESH_LUMEN the lumen, 0 the outer side. */
size_t seams_count_unjoined(const Seams *seams, uint32_t kind);

/* Checks the triangles of the solid against the graph.
 *
 * report   receives what meshcheck_topology and meshcheck_crossings find, and the expected numbers
 *          of components and genus. Other fields stay.
 * grid_mm  all coordinates are integer multiples of it.
 * threads  number of threads; 0: one per processor.
 * Errors   STATUS_DIFFERS if a component of the graph does not have the Euler number
 *          2 (surfaces - rings - loops of its surfaces) in the mesh; STATUS_MEMORY.
 *
 * Call meshreport_check for the other errors that the report can hold. */
MUST_CHECK Status seams_prove(const Seams *seams, const VesselMesh *mesh, double grid_mm,
                              int threads, MeshReport *report, Err *err);

#endif
