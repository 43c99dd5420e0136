/* The expected topology of a solid, and the proof that its triangles have this topology.
 *
 * A solid is assembled from closed surfaces, which are joined by rings of triangles. A SeamGraph
 * describes the assembly: its nodes are surfaces, its edges are rings. The surface of a tree has
 * one handle per independent loop of the tree. The caller adds every surface and every ring to the
 * graph when it adds them to the solid. Finally seams_prove compares the triangles with the graph.
 * Private to the module print. */
#ifndef CORCAST_PRINT_SEAMS_H
#define CORCAST_PRINT_SEAMS_H

#include "mesh/mesh.h"

/* The graph. A surface is the outer side of a tree, the lumen of a tree, or the casing. Indices of
 * surfaces: the outer side of tree t has the index t, the lumen of tree t the index n_trees + t,
 * and the casing the index 2 n_trees. All arrays are owned. */
typedef struct SeamGraph {
    uint32_t *trees; /* per segment: the index of its tree [meshcheck_trees] */
    uint32_t *loops; /* per tree: the number of its independent loops [meshcheck_loops] */
    uint32_t n_trees;
    uint32_t *parent; /* per surface: its parent in the disjoint sets of joined surfaces
                       * [base/sets.h] */
    uint32_t *rings;  /* per surface that is the root of a set: the number of rings in the set */
    size_t n_rings;   /* number of all rings */
    bool *is_used;    /* per surface: true if it is part of the solid */
} SeamGraph;

/* Makes an empty graph for the trees of `tree`. Release *out with seams_release. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status seams_make(const VesselTree *tree, SeamGraph *out, Err *err);
void seams_release(SeamGraph *seams);

/* Returns the index of the surface that a triangle with this label belongs to. A label
 * [scene/triangles.h] is the index of a segment, with MESH_LUMEN added if the triangle is on the
 * inner side of a wall. */
uint32_t seams_surface(const SeamGraph *seams, uint32_t label);
/* Adds to the graph the surface that triangles with this label belong to. The label of any segment
 * of the tree identifies the surface. */
void seams_add_surface(SeamGraph *seams, uint32_t label);
/* Adds a ring between the surfaces that two labels belong to. */
void seams_add_ring(SeamGraph *seams, uint32_t label, uint32_t other);

/* Returns the number of trees whose surface is part of the solid but has no ring. `kind` selects
 * one of a tree's two surfaces: MESH_LUMEN the lumen, 0 the outer side. */
size_t seams_count_unjoined(const SeamGraph *seams, uint32_t kind);

/* Compares the triangles of the solid with the graph. Call meshreport_check afterwards for the
 * other defects that the report can contain.
 *
 * report   receives the results of meshcheck_topology and meshcheck_crossings, and the expected
 *          number of components and genus. Other members stay unchanged.
 * grid_mm  grid step: all coordinates are integer multiples of it.
 * threads  number of threads; 0: one per processor.
 * Errors   STATUS_DIFFERS if, in the mesh, the Euler number of a component of the graph is not
 *          2 (surfaces - rings - loops of its surfaces); STATUS_MEMORY. */
MUST_CHECK Status seams_prove(const SeamGraph *seams, const VesselMesh *mesh, double grid_mm,
                              int threads, MeshReport *report, Err *err);

#endif
