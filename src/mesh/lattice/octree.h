/* An octree around the surface of a junction region.
 *
 * Its cells are small where vessels are thin, where the surface bends, and where two vessels that
 * do not blend are near each other. Active cells are the cells that the surface may pass through;
 * only they store the terms of the potential that are significant in them. The octree is graded
 * (neighbouring cells differ by at most one level), so that the tetrahedra of the lattice, whose
 * corners are the corners and centres of the cells [lattice.h], fill space. Private to the module
 * mesh. */
#ifndef CORCAST_MESH_LATTICE_OCTREE_H
#define CORCAST_MESH_LATTICE_OCTREE_H

#include "mesh/regions/junctions.h"

typedef enum CellState {
    CELL_OUTSIDE,     /* all of the cell is outside the surface */
    CELL_INSIDE,      /* all of the cell is inside the surface */
    CELL_ACTIVE,      /* the surface may pass through the cell */
    CELL_BEYOND_PLANE /* the cell is beyond the plane at which a vessel of the region is cut [a
                       * stub, junctions.h], where no surface is extracted */
} CellState;

/* A cell: the cube from `at` to `at` + 1 along each axis. The unit is octree_side of its level, and
 * the origin is Octree.corner. */
typedef struct OctreeCell {
    uint32_t children; /* index of the first of eight, x fastest; 0: a leaf */
    int32_t at[3];
    uint8_t level;
    uint8_t state; /* CellState */
    /* Of an active leaf: the terms that are significant within about one cell side of the leaf;
     * stored in Octree.leaf_fields. */
    LocalField local;
} OctreeCell;

/* Maximum level; the root has level 0. Keys of lattice points have 21 bits per axis, which is
 * sufficient for positions in cells of this level. */
enum { OCTREE_LEVELS = 20 };

/* The octree of one region. Zero it before first use; release it with octree_release. */
typedef struct Octree {
    OctreeCell *cells; /* owned; the first is the root */
    size_t n_cells, capacity;
    Vec3 corner;                /* the root's corner with the lowest coordinates, mm */
    double side;                /* side of the root, mm */
    LocalFieldPool leaf_fields; /* the local fields of all active leaves */
    LocalFieldPool stack;       /* workspace of octree_build; empty between calls */
} Octree;

/* Limits of the size and number of cells. */
typedef struct CellSize {
    double ratio;   /* maximum side of a cell, in local radii */
    double bending; /* maximum of the product of a cell's side, in local radii, and |n1 - n2| of two
                     * unit normals n1 and n2 in the cell */
    size_t max_cells; /* maximum number of cells */
} CellSize;

/* Builds the octree of a region. A tree that was built before is replaced, and its memory is used
 * again. Cells with a common face or edge differ by at most one level.
 *
 * Errors   STATUS_INFEASIBLE if more than size->max_cells cells are needed, or if too many segments
 *          come together at one point [localfield_too_many_terms]; STATUS_MEMORY. */
MUST_CHECK Status octree_build(Octree *tree, const JunctionPlan *plan, const CellSize *size,
                               Err *err);
void octree_release(Octree *tree);

/* Returns the leaf that contains x, borrowed; NULL if x is outside the octree. O(levels). */
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
