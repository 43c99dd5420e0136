/* An octree about the surface of a junction region.
 *
 * Its cells are small where vessels are thin, where the surface bends, and where vessels that do
 * not blend pass each other. Only active cells, which the surface may pass, store the terms of the
 * potential that matter in them. The octree is graded, so that the lattice between its cells is
 * made of tetrahedra [lattice.h]. Private to the module mesh. */
#ifndef CORCAST_MESH_LATTICE_OCTREE_H
#define CORCAST_MESH_LATTICE_OCTREE_H

#include "mesh/regions/junctions.h"

typedef enum CellState {
    CELL_OUTSIDE,     /* all of the cell is outside the surface */
    CELL_INSIDE,      /* all of the cell is inside the surface */
    CELL_ACTIVE,      /* the surface may pass the cell */
    CELL_BEYOND_PLANE /* beyond the plane of a stub, where no surface is made */
} CellState;

/* A cell: the cube from `at` to `at` + 1, in units of octree_side of its level, counted from
 * Octree.corner. */
typedef struct OctreeCell {
    uint32_t children; /* index of the first of eight, x fastest; 0: a leaf */
    int32_t at[3];
    uint8_t level;
    uint8_t state; /* CellState */
    /* Of an active leaf: the terms that matter within about a cell's side of it, in
     * Octree.leaf_fields. */
    LocalField local;
} OctreeCell;

/* The greatest level; the root has level 0. Positions in cells of this level fit into the 21 bits
 * per axis that keys of lattice points have. */
enum { OCTREE_LEVELS = 20 };

/* Zero it before first use; release it with octree_release. */
typedef struct Octree {
    OctreeCell *cells; /* owned; the first is the root */
    size_t n_cells, capacity;
    Vec3 corner;                /* the root's corner with the lowest coordinates, mm */
    double side;                /* side of the root, mm */
    LocalFieldPool leaf_fields; /* the local fields of all active leaves */
    LocalFieldPool stack;       /* scratch of the descent; empty between calls */
} Octree;

/* How small the cells are. */
typedef struct CellSize {
    double ratio;     /* maximum side of a cell, in local radii */
    double bending;   /* maximum of the side times the turn of the normal across the cell, in local
                       * radii. The turn is the length of the difference of two unit normals. */
    size_t max_cells; /* maximum number of cells */
} CellSize;

/* Builds the octree of a region. A tree that was built before is replaced, and its memory is used
 * again. Cells with a common face or edge differ by at most one level.
 *
 * Errors   STATUS_INFEASIBLE if more than size->max_cells cells are needed, or if too many segments
 *          come together at one point [localfield_refuse]; STATUS_MEMORY. */
MUST_CHECK Status octree_build(Octree *tree, const JunctionPlan *plan, const CellSize *size,
                               Err *err);
void octree_release(Octree *tree);

/* Returns the leaf that holds x, or NULL if x is outside the tree. O(levels). */
const OctreeCell *octree_leaf(const Octree *tree, Vec3 x);

/* Returns the side of the cells of a level, mm. The division by a power of 2 is exact. */
static inline double octree_side(const Octree *tree, int level)
{
    return tree->side / (double)(1u << level);
}

/* Returns the centre of a cell, mm. */
static inline Vec3 octree_center(const Octree *tree, const OctreeCell *cell)
{
    double side = octree_side(tree, cell->level);
    return vec3(tree->corner.x + side * (cell->at[0] + 0.5),
                tree->corner.y + side * (cell->at[1] + 0.5),
                tree->corner.z + side * (cell->at[2] + 0.5));
}

#endif
