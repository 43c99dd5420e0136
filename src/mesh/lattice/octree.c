/* Builds the octree of a junction region.
 *
 * A cell is split while its side is larger than the usual side: CellSize.ratio times the radius of
 * the thinnest vessel that may matter in the cell. An active cell is also split while the normal
 * turns too much across it, as in the crotch of a bifurcation. Where vessels that do not blend pass
 * each other, cells are six times smaller, because the gap between the vessels must contain cells.
 * Cells beyond the plane of a stub make no surface, because the surface there is cut off.
 *
 * The root's side is a power of two times a base side. Eight base sides are compared:
 * CellSize.ratio times the largest radius, and seven smaller ones, each by the factor 2^(-1/8). The
 * one with the fewest cells along the segments is used. */
#include "mesh/lattice/octree.h"

#include <stdlib.h>
#include <string.h>

/* In units of a cube's side: sqrt(3) / 2, the radius of the ball about the cube. */
static const double half_diagonal = 0.8660254037844387;
/* In units of a leaf's side: radius of the ball about the leaf's centre in which an active leaf
 * knows all terms. The ball contains the centres of neighbours of twice the side, which are up to
 * sqrt(1.5^2 + 0.5^2 + 0.5^2) = 1.66 sides away. */
static const double known_reach = 1.75;
/* In units of the usual side: maximum side of the cells near vessels that do not blend, and minimum
 * side of the cells that a turning normal splits. Smaller cells resolve narrower gaps and sharper
 * crotches. Their number grows with the inverse square of the side. */
static const double unblended_cell_ratio = 1.0 / 6, smallest_cell_ratio = 1.0 / 8;
/* In units of CellSize.bending: the limit at a crease. It is below 1, because a triangle across a
 * crease is farther from the surface than a triangle along an arc whose normal turns as much. A
 * smaller value makes more cells along creases. */
static const double crease_bending_ratio = 0.22;
/* In units of the usual side: cells beyond a plane make a surface up to this distance. The plane
 * may be shifted by up to a quarter of the usual side [planecut.c], and must still cut whole
 * triangles there. */
static const double margin_behind = 0.75;
/* In units of FIELD_LEVEL: the bounds of the field must be this far from the level to prove that a
 * cell is inside or outside. The errors of gauss.h are far smaller. */
static const double bound_margin = 1e-3;
/* In units of FIELD_LEVEL: where all other vessels add less to the field, the surface counts as one
 * tube, whose bend the usual cells resolve. 0.03 moves the surface by less than 0.01 radii. A
 * smaller value splits more cells. */
static const double single_tube_margin = 0.03;

typedef struct OctreeBuilder {
    Octree *tree;
    const JunctionPlan *plan;
    const CellSize *size;
} OctreeBuilder;

void octree_release(Octree *tree)
{
    free(tree->cells);
    localfieldpool_release(&tree->leaf_fields);
    localfieldpool_release(&tree->stack);
    *tree = (Octree){0};
}

/* Returns true if the ball is beyond the plane of a stub, and no surface except the stub's can pass
 * through the ball: all other terms together are at most a tenth of the level. */
static bool is_behind(const OctreeBuilder *builder, const FieldBounds *bounds, Vec3 center,
                      double ball)
{
    const JunctionPlan *plan = builder->plan;
    if (bounds->sum_upper - bounds->largest_upper > 0.1 * FIELD_LEVEL)
        return false;
    uint16_t number = plan->field.terms[bounds->largest_term].stub;
    if (number == NO_STUB)
        return false;
    const BranchStub *stub = &plan->stubs[number];
    double behind = vec3_dot(vec3_sub(center, stub->at), stub->outward);
    return behind - ball > margin_behind * builder->size->ratio * stub->radius_mm;
}

/* Returns the unit normal of the field at x. */
static Vec3 normal_at(const OctreeBuilder *builder, const LocalField *part, Vec3 x)
{
    Vec3 gradient;
    localfield_gradient(&builder->plan->field, &builder->tree->stack, part, x, &gradient);
    double steepness = vec3_length(gradient);
    return vec3_scale(gradient, steepness > 0 ? -1 / steepness : 0);
}

/* Returns the difference of the normals at the two ends of the vector 2 `by` about x. */
static Vec3 turn_along(const OctreeBuilder *builder, const LocalField *part, Vec3 x, Vec3 by)
{
    return vec3_sub(normal_at(builder, part, vec3_add(x, by)),
                    normal_at(builder, part, vec3_sub(x, by)));
}

/* Returns how much the normal turns across a cell: the maximum, over all directions, of the length
 * of the difference of two unit normals. Returns 0 if the surface is more than 1.5 sides away. The
 * maximum is the larger singular value of the turns along two directions in the tangent plane, at
 * the point of the surface nearest to the centre. */
static double turn_across(const OctreeBuilder *builder, const LocalField *part, Vec3 center,
                          double side)
{
    Vec3 gradient, u, v, x = center;
    FieldValue value =
        localfield_gradient(&builder->plan->field, &builder->tree->stack, part, x, &gradient);
    double steepness = vec3_length(gradient);
    double off = (FIELD_LEVEL - value.phi) / fmax(steepness, 1e-300);
    if (fabs(off) > 1.5 * side)
        return 0;
    x = vec3_add_scaled(x, gradient, off / fmax(steepness, 1e-300));
    vec3_perpendiculars(vec3_scale(gradient, 1 / fmax(steepness, 1e-300)), &u, &v);
    Vec3 along_u = turn_along(builder, part, x, vec3_scale(u, side / 2));
    Vec3 along_v = turn_along(builder, part, x, vec3_scale(v, side / 2));
    double uu = vec3_dot(along_u, along_u), vv = vec3_dot(along_v, along_v);
    double uv = vec3_dot(along_u, along_v), half = 0.5 * (uu - vv);
    return sqrt(0.5 * (uu + vv) + sqrt(half * half + uv * uv));
}

/* Returns true if an active cell is larger than the rules at the top of this file permit. */
static bool must_split(const OctreeBuilder *builder, const LocalField *part,
                       const FieldBounds *bounds, Vec3 center, double side)
{
    double usual = builder->size->ratio * bounds->min_radius_mm;
    if (side > usual)
        return true;
    if (bounds->has_unblended_terms)
        return side > unblended_cell_ratio * usual;
    if (side * bounds->max_normal_difference >
        crease_bending_ratio * builder->size->bending * bounds->min_radius_mm)
        return true;
    if (side < 2 * smallest_cell_ratio * usual ||
        bounds->sum_upper - bounds->largest_upper < single_tube_margin * FIELD_LEVEL)
        return false;
    return side * turn_across(builder, part, center, side) >
           builder->size->bending * bounds->min_radius_mm;
}

static Status split(OctreeBuilder *builder, uint32_t cell, const LocalField *part, Err *err);

/* Finds the state of a cell, and splits the cell if it is too large. `part` holds all terms that
 * may matter in the cell. */
static Status classify_cell(OctreeBuilder *builder, uint32_t number, const LocalField *part,
                            Err *err)
{
    Octree *tree = builder->tree;
    LocalFieldPool *stack = &tree->stack;
    size_t n_terms = stack->n_terms, n_groups = stack->n_groups;
    const OctreeCell cell = tree->cells[number];
    double side = octree_side(tree, cell.level), ball = half_diagonal * side;
    Vec3 center = octree_center(tree, &cell);
    const FieldBalls balls = {center, known_reach * side, ball};
    NarrowField own;
    TRY(localfield_narrow(&builder->plan->field, stack, part, &balls, &own, err));
    const FieldBounds *bounds = &own.bounds;
    CellState state = CELL_ACTIVE;
    if (bounds->upper < (1 - bound_margin) * FIELD_LEVEL)
        state = CELL_OUTSIDE;
    else if (bounds->lower > (1 + bound_margin) * FIELD_LEVEL)
        state = CELL_INSIDE;
    else if (is_behind(builder, bounds, center, ball))
        state = CELL_BEYOND_PLANE;
    tree->cells[number].state = (uint8_t)state;
    if (state == CELL_ACTIVE && side <= builder->size->ratio * bounds->min_radius_mm &&
        own.local.n_terms > MAX_LOCAL_TERMS)
        return localfield_too_many_terms(err);
    if (state == CELL_ACTIVE && cell.level < OCTREE_LEVELS &&
        must_split(builder, &own.local, bounds, center, side))
        TRY(split(builder, number, &own.local, err));
    else if (state == CELL_ACTIVE)
        TRY(localfield_copy(stack, &own.local, &tree->leaf_fields, &tree->cells[number].local,
                            err));
    stack->n_terms = n_terms;
    stack->n_groups = n_groups;
    return STATUS_OK;
}

/* Sets the error that the region needs more than CellSize.max_cells cells. */
static Status refuse(const OctreeBuilder *builder, Err *err)
{
    return err_set(err, STATUS_INFEASIBLE,
                   "%u segments are too close together to be divided into smaller regions; "
                   "their surface needs more than %zu cells, 4 GB of memory; a larger `tolerance` "
                   "needs fewer",
                   builder->plan->field.n_terms, builder->size->max_cells);
}

/* Gives a cell children. The children of an active cell are settled. Other children have the state
 * of the cell. */
static Status split(OctreeBuilder *builder, uint32_t number, const LocalField *part, Err *err)
{
    Octree *tree = builder->tree;
    if (tree->n_cells + 8 > builder->size->max_cells)
        return refuse(builder, err);
    TRY(mem_reserve(&tree->cells, &tree->capacity, tree->n_cells + 8, sizeof *tree->cells,
                    "cells of a junction", err));
    uint32_t first = (uint32_t)tree->n_cells;
    tree->n_cells += 8;
    tree->cells[number].children = first;
    const OctreeCell parent = tree->cells[number];
    for (uint32_t i = 0; i < 8; i++) {
        OctreeCell child = {.level = (uint8_t)(parent.level + 1), .state = parent.state};
        for (int axis = 0; axis < 3; axis++)
            child.at[axis] = 2 * parent.at[axis] + (int32_t)(i >> axis & 1);
        tree->cells[first + i] = child;
    }
    for (uint32_t i = 0; i < 8 && parent.state == CELL_ACTIVE; i++)
        TRY(classify_cell(builder, first + i, part, err));
    return STATUS_OK;
}

/* Returns the leaf of this level or a lower one that holds a cell of the level; UINT32_MAX outside
 * the tree. */
static uint32_t leaf_at(const Octree *tree, const int64_t at[3], int level)
{
    for (int axis = 0; axis < 3; axis++)
        if (at[axis] < 0 || at[axis] >> level)
            return UINT32_MAX;
    uint32_t cell = 0;
    for (int down = level - 1; down >= 0 && tree->cells[cell].children; down--) {
        uint32_t octant =
            (uint32_t)((at[0] >> down & 1) | (at[1] >> down & 1) << 1 | (at[2] >> down & 1) << 2);
        cell = tree->cells[cell].children + octant;
    }
    return cell;
}

const OctreeCell *octree_leaf(const Octree *tree, Vec3 x)
{
    double unit = octree_side(tree, OCTREE_LEVELS);
    Vec3 from = vec3_scale(vec3_sub(x, tree->corner), 1 / unit);
    const int64_t at[3] = {(int64_t)floor(from.x), (int64_t)floor(from.y), (int64_t)floor(from.z)};
    uint32_t leaf = leaf_at(tree, at, OCTREE_LEVELS);
    return leaf != UINT32_MAX ? &tree->cells[leaf] : NULL;
}

/* Splits a leaf that is larger than grading permits. */
static Status split_leaf(OctreeBuilder *builder, uint32_t number, Err *err)
{
    Octree *tree = builder->tree;
    LocalField part = {0};
    if (tree->cells[number].state == CELL_ACTIVE) {
        const LocalField kept = tree->cells[number].local;
        TRY(localfield_copy(&tree->leaf_fields, &kept, &tree->stack, &part, err));
    }
    TRY(split(builder, number, &part, err));
    tree->stack.n_terms = tree->stack.n_groups = 0;
    return STATUS_OK;
}

/* Returns true if the cell at this offset from another has the same parent. */
static bool is_sibling(const OctreeCell *cell, const int by[3])
{
    bool same = true;
    for (int axis = 0; axis < 3; axis++)
        same = same && (cell->at[axis] + by[axis]) >> 1 == cell->at[axis] >> 1;
    return same;
}

/* Splits the leaves that share a face or an edge with a cell that has children, if they are larger
 * than the cell. */
static Status grade_about(OctreeBuilder *builder, uint32_t number, Err *err)
{
    Octree *tree = builder->tree;
    const OctreeCell cell = tree->cells[number];
    for (int i = 0; i < 27; i++) {
        const int by[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        if (abs(by[0]) + abs(by[1]) + abs(by[2]) > 2 || is_sibling(&cell, by))
            continue;
        const int64_t at[3] = {cell.at[0] + by[0], cell.at[1] + by[1], cell.at[2] + by[2]};
        uint32_t other = leaf_at(tree, at, cell.level);
        while (other != UINT32_MAX && tree->cells[other].level < cell.level) {
            TRY(split_leaf(builder, other, err));
            TRY(grade_about(builder, other, err));
            other = leaf_at(tree, at, cell.level);
        }
    }
    return STATUS_OK;
}

/* Grades all cells. Cells that grading adds are at the end of the array, so the loop reaches them,
 * too. */
static Status grade(OctreeBuilder *builder, Err *err)
{
    Octree *tree = builder->tree;
    for (uint32_t i = 0; i < tree->n_cells; i++)
        if (tree->cells[i].children)
            TRY(grade_about(builder, i, err));
    return STATUS_OK;
}

/* Returns the side that gives the fewest cells along the segments. A segment's cells have this
 * side, halved until it is at most `ratio` radii of the segment. `cost` is the cells' number
 * relative to cells of exactly `ratio` radii. */
static double best_side(const JunctionPlan *plan, double ratio)
{
    double best = 0, least = HUGE_VAL, widest = 0;
    for (uint32_t i = 0; i < plan->field.n_terms; i++)
        widest = fmax(widest, plan->field.terms[i].radius_mm);
    for (int i = 0; i < 8; i++) {
        double side = ratio * widest * elementary_exp2(-i / 8.0), cost = 0;
        for (uint32_t j = 0; j < plan->field.n_terms; j++) {
            double suits = ratio * plan->field.terms[j].radius_mm;
            double halvings = fmax(0, ceil(elementary_log2(side / suits)));
            double over = suits / ldexp(side, -(int)halvings);
            cost += over * over;
        }
        if (cost < least) {
            least = cost;
            best = side;
        }
    }
    return best;
}

/* Makes the root a cube about all terms, whose side is best_side times a power of two. */
static void place_root(Octree *tree, const JunctionPlan *plan, double ratio)
{
    Box box = box_empty();
    for (uint32_t i = 0; i < plan->field.n_terms; i++) {
        const PotentialTerm *term = &plan->field.terms[i];
        Vec3 b = vec3_add_scaled(term->a, term->axis, term->length_k / term->k);
        box =
            box_with_ball(box_with_ball(box, term->a, 2 * term->radius_mm), b, 2 * term->radius_mm);
    }
    int axis = box_longest_axis(box);
    double extent = vec3_component(vec3_sub(box.high, box.low), axis);
    double side = best_side(plan, ratio);
    tree->side = ldexp(side, (int)fmax(0, ceil(elementary_log2(extent / side))));
    Vec3 center = box_center(box);
    tree->corner = vec3_sub(center, vec3(tree->side / 2, tree->side / 2, tree->side / 2));
}

Status octree_build(Octree *tree, const JunctionPlan *plan, const CellSize *size, Err *err)
{
    OctreeBuilder builder = {tree, plan, size};
    tree->n_cells = 0;
    tree->leaf_fields.n_terms = tree->leaf_fields.n_groups = tree->stack.n_terms =
        tree->stack.n_groups = 0;
    place_root(tree, plan, size->ratio);
    TRY(mem_reserve(&tree->cells, &tree->capacity, 1, sizeof *tree->cells, "cells of a junction",
                    err));
    tree->cells[tree->n_cells++] = (OctreeCell){0};
    LocalField all;
    TRY(localfield_from_field(&plan->field, &tree->stack, &all, err));
    TRY(classify_cell(&builder, 0, &all, err));
    tree->stack.n_terms = tree->stack.n_groups = 0;
    return grade(&builder, err);
}
