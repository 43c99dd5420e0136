/* An octree about the surface of a junction region. Its cells are small where vessels are thin,
 * where the surface bends, and where vessels that do not blend pass each other. */
#ifndef CORCAST_MESH_LATTICE_OCTREE_H
#define CORCAST_MESH_LATTICE_OCTREE_H

#include "mesh/regions/junctions.h"

typedef enum CellState {
    CELL_OUTSIDE, /* all of the cell is outside */
    CELL_INSIDE,
    CELL_ACTIVE,      /* the surface may pass the cell */
    CELL_BEYOND_PLANE /* behind the plane of a stub, where no surface is made */
} CellState;

/* The cube from `at` to `at` + 1, in units of the side of its level, from the tree's corner. */
typedef struct OctreeCell {
    uint32_t children; /* index of the first of eight, x fastest; 0: a leaf */
    int32_t at[3];
    uint8_t level;
    uint8_t state; /* CellState */
    LocalField
        local; /* of an active leaf: what matters within a cell's width, in Octree.leaf_fields */
} OctreeCell;

/* The greatest level; the root has level 0. */
enum { OCTREE_LEVELS = 20 };

/* Zero it before first use; release it with octree_release. */
typedef struct Octree {
    OctreeCell *cells; /* owned; the first is the root */
    size_t n_cells, capacity;
    Vec3 corner;
    double side; /* of the root, mm */
    LocalFieldPool leaf_fields, stack;
} Octree;

typedef struct CellSize {
    double ratio;   /* maximum side of a cell, in local radii */
    double bending; /* maximum side times the turn of the normal across the cell, in local radii */
    size_t max_cells; /* maximum number of cells */
} CellSize;

/* Builds the tree of a region; a tree that was built before is replaced, and its memory is used
 * again. Cells with a common face or edge differ by at most one level. Errors: STATUS_INFEASIBLE if
 * more than size->max_cells cells are needed, or as localfield_refuse; STATUS_MEMORY. */
MUST_CHECK Status octree_build(Octree *tree, const JunctionPlan *plan, const CellSize *size,
                               Err *err);
void octree_release(Octree *tree);

/* Returns the leaf that holds x, or NULL if x is outside the tree. O(levels). */
const OctreeCell *octree_leaf(const Octree *tree, Vec3 x);

/* Returns the side of the cells of a level, mm; exact. */
static inline double octree_side(const Octree *tree, int level)
{
    return tree->side / (double)(1u << level);
}

static inline Vec3 octree_center(const Octree *tree, const OctreeCell *cell)
{
    double side = octree_side(tree, cell->level);
    return vec3(tree->corner.x + side * (cell->at[0] + 0.5),
                tree->corner.y + side * (cell->at[1] + 0.5),
                tree->corner.z + side * (cell->at[2] + 0.5));
}

#endif
