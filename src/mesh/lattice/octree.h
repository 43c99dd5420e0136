/* An octree about the wall of a junction junction. */
#ifndef CORCAST_MESH_LATTICE_OCTREE_H
#define CORCAST_MESH_LATTICE_OCTREE_H

#include "mesh/zones/junctions.h"

typedef enum CellState {
    CELL_OUTSIDE, /* wholly */
    CELL_INSIDE,
    CELL_ACTIVE, /* the wall may pass */
    CELL_BEHIND  /* behind the plane of an stub, where no wall is made */
} CellState;

/* The cube [at, at + 1] times the side of its level from the corner of the tree on. */
typedef struct OctreeCell {
    uint32_t children; /* the first of eight, x fastest; 0: a leaf */
    int32_t at[3];
    uint8_t level;
    uint8_t state;   /* CellState */
    LocalField part; /* of an active leaf: what matters within a cell's width of it; in kept */
} OctreeCell;

enum { OCTREE_LEVELS = 20 };

typedef struct Octree {
    OctreeCell *cells; /* owned; the first is the root */
    size_t n_cells, capacity;
    Vec3 corner;
    double side; /* of the root, mm */
    LocalFieldPool kept, stack;
} Octree;

/* How fine cells are. */
typedef struct CellSize {
    double ratio;   /* the side of a cell over the local radius */
    double bending; /* side times turn of the normal across it over the local radius: not more */
    size_t most;    /* how many there may be */
} CellSize;

/* Makes the tree anew, graded so that cells with a common face or edge differ by one level at most.
 * STATUS_INFEASIBLE when that takes more cells than there may be.
 * Zeroed before the first use; keeps its room. Release with octree_release. */
MUST_CHECK Status octree_build(Octree *tree, const JunctionPlan *plan, const CellSize *size,
                               Err *err);
void octree_release(Octree *tree);

/* The leaf that holds x; NULL outside the tree. O(levels). */
const OctreeCell *octree_leaf(const Octree *tree, Vec3 x);

static inline double octree_side(const Octree *tree, int level)
{
    return tree->side / (double)(1u << level); /* exact */
}

static inline Vec3 octree_center(const Octree *tree, const OctreeCell *cell)
{
    double side = octree_side(tree, cell->level);
    return vec3(tree->corner.x + side * (cell->at[0] + 0.5),
                tree->corner.y + side * (cell->at[1] + 0.5),
                tree->corner.z + side * (cell->at[2] + 0.5));
}

#endif
