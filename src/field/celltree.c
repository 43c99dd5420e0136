/* Divides the surface of the potential into the cells of an octree, each with the terms that matter
 * in it and a proven bound of the gradient.
 *
 * The octree is descended once, from at most eight cubes that hold all vessels. Each cube filters
 * its parent's list of terms by their bounds in the cube. A cube is dropped if the bounds do not
 * add up to the level. So empty space costs nothing, and a segment is tested only where it may
 * matter. A cube of side 4 r_max 2^j is on the lattice of multiples of its side, so that neighbours
 * share their faces to the last bit. The box of a cell is its cube with an overlap about it.
 *
 * The bound of the gradient. In units of s, the axial factor A of a term is the probability that a
 * normal variable is within the segment, and |A'| = |E[g; inside]| <= A sqrt(-2 ln A). The reason:
 * a distribution with mean m has a relative entropy of at least m^2 / 2 to the normal distribution,
 * and that of the normal distribution confined to a set of probability A is -ln A. With the radial
 * factor
 *   s |grad phi| <= phi sqrt(-2 ln phi).
 * For the sum, with L^2 = -2 ln Phi, p_i = phi_i / Phi and q_i = (s_min / s_i)^2 <= 1, by
 * Cauchy-Schwarz, q_i <= 1, and Gibbs' variational principle
 *   (s_min |grad Phi| / Phi)^2 <= sum p_i q_i (L^2 - 2 ln p_i)
 *                              <= 2 (sum p_i q_i L^2 / 2 - sum p_i ln p_i)
 *                              <= 2 ln sum exp(q_i L^2 / 2),
 * and grad (log form) = -grad Phi / (Phi L): s_min |grad| <= sqrt(2 ln(sum exp(q_i L^2 / 2))) / L,
 * which grows with Phi. Equality holds for one term, and for n terms that coincide. The bound holds
 * for each sum of some of the terms, so it holds for the largest of such sums. */
#include "field/field.h"

#include <float.h>
#include <stdlib.h>

/* A cube has no surface if the potential in it is everywhere below empty_below or above full_above.
 * The margin of a hundredth of the level, 1.35e-3, covers a thousand terms of up to
 * CELL_TERM_CUTOFF that are left out, or four terms with an erf approximated to 2.8e-4. */
static const double empty_below = 0.99 * FIELD_LEVEL;
static const double full_above = 1.01 * FIELD_LEVEL;

/* A term limits the size of a cell and its accuracy if its bound in the cell is above this, a 14th
 * of the level: such a term can move the surface by 2 % of its radius. A smaller value makes more
 * cells; with a larger one, a thin vessel's accuracy would be that of a thick neighbour. */
static const double significant_bound = 1e-2;

/* In units of the local radius: the accuracy of a cell (the error at which POV-Ray ends its
 * search), and the maximum to which SHADOW_ACCURACY_MM may raise it. 1 / 300 is invisible at usual
 * sizes. The maximum keeps thin vessels round. */
static const double accuracy_ratio = 1.0 / 300, largest_accuracy_ratio = 1.0 / 60;

/* A box reaches beyond its cube by this many accuracies, so that a hit that is an accuracy off
 * still is in the box of a neighbour, and by up to 2 SHIFTS spacings. Boxes are shifted against
 * each other by whole spacings [box_shifted]. Each of the 12 combinations of a level and two
 * parities [shift_index] has a shift of its own. SHIFTS is larger, and is odd, as the argument in
 * box_shifted requires. */
static const double overlap_accuracies = 5;
enum { SHIFTS = 13 };

/* To make a cell's box small, its cube is halved HALVINGS times along each axis, into 64 parts. The
 * box contains the parts that the surface may meet. Each further halving costs eight times as many
 * tests. With more than MAX_HALVED_TERMS terms, where the tests take longest, the box contains the
 * whole cube. */
enum { HALVINGS = 2, MAX_HALVED_TERMS = 16 };

/* With erf as a polynomial's tanh, s |A'| is at most this times A sqrt(-2 ln A) down to A =
 * LOG_FORM_FLOOR / 10, and within the bound of the exact form from A = 1e-3 up (tabulated in
 * tests/unit/cells_test.c). */
static const double tail_steepness[] = {[ERF_FAST] = 1.14, [ERF_EXACT] = 1.21};

/* A tree of more cells is refused. A tree of 20,000 segments has 191,000 cells; POV-Ray's
 * memory and time to read a scene grow with the number. */
static const size_t max_cells = 1000000;
/* The limits of the number of tests of a term in a cube, which bound the time to some seconds. The
 * number may grow with the number of cells found, because cubes without surface are the waste to
 * limit. A term that passes its test counts KEPT_TERM_COST tests more, for its exponential. Most
 * trees need 80 tests per cell, half of the limit. */
enum { KEPT_TERM_COST = 3 };
static const uint64_t max_tests = 30000000, max_tests_per_cell = 150;

/* A term's bound at the distance dist is peak exp(-decay dist^2). It is above CELL_TERM_CUTOFF up
 * to dist^2 = reach2. */
typedef struct Support {
    double peak, decay, reach2;
} Support;

typedef struct CellBuilder {
    const FieldSegment *segments;
    Support *supports; /* per segment */
    double beta;
    double root_side;
    /* mm, a power of 2. Single precision holds its multiples in all boxes, and their differences.
     * POV-Ray stores the lowest corner and the size of a box in single precision, and skips a box
     * that a ray misses by these. So the faces of boxes are at multiples of the spacing. */
    double spacing;
    uint32_t *stack; /* the lists of the cubes from the first down to the current one */
    size_t depth, stack_capacity;
    uint64_t tests;      /* number of terms tested so far, in all cubes */
    LocalGroups *groups; /* NULL if all segments blend */
    CellTree tree;
    size_t cell_capacity, term_capacity, member_capacity, group_capacity;
} CellBuilder;

/* A list of terms: a part of the stack, and properties of its terms. */
typedef struct TermList {
    size_t first, count;
    double bound_sum; /* sum of the bounds of the terms */
    double smallest_radius, largest_radius;
    double local_radius; /* smallest radius of the terms above significant_bound; of all terms if
                            none is */
    double steepness;    /* the bound of s_min |grad (log form)| below the level; 0 where there is
                          * no surface by bound_sum */
} TermList;

/* A cube of the octree, with its lowest corner at at[] times `side`. */
typedef struct Cube {
    double side;
    int64_t at[3];
} Cube;

static Cube octant_of(const Cube *cube, int octant)
{
    Cube part = {cube->side / 2, {0}};
    for (int axis = 0; axis < 3; axis++)
        part.at[axis] = 2 * cube->at[axis] + (octant >> axis & 1);
    return part;
}

static Vec3 cube_low(const Cube *cube)
{
    return vec3((double)cube->at[0] * cube->side, (double)cube->at[1] * cube->side,
                (double)cube->at[2] * cube->side);
}

static Box cube_box(const Cube *cube, double margin)
{
    Vec3 low = cube_low(cube);
    double side = cube->side + margin;
    return (Box){{low.x - margin, low.y - margin, low.z - margin},
                 {low.x + side, low.y + side, low.z + side}};
}

/* Returns the bound of s_min |grad (log form)| for potentials up to `phi`. */
static double gradient_bound(const CellBuilder *builder, const TermList *terms, double phi)
{
    double half_l2 = -elementary_log(phi), sum = 0;
    for (size_t i = terms->first; i < terms->first + terms->count; i++) {
        double ratio = terms->smallest_radius / builder->segments[builder->stack[i]].radius_mm;
        sum += elementary_exp(ratio * ratio * half_l2);
    }
    return sqrt(elementary_log(sum) / half_l2);
}

/* Pushes those terms of `from` whose bound in the box is above CELL_TERM_CUTOFF. */
static Status filter_terms(CellBuilder *builder, const TermList *from, Box box, TermList *out,
                           Err *err)
{
    TRY(mem_reserve(&builder->stack, &builder->stack_capacity, builder->depth + from->count,
                    sizeof *builder->stack, "terms", err));
    TermList list = {builder->depth, 0, 0, HUGE_VAL, 0, HUGE_VAL, 0};
    builder->tests += from->count;
    if (builder->tests > max_tests + max_tests_per_cell * builder->tree.n_cells)
        return err_set(err, STATUS_INFEASIBLE,
                       "the isosurface has too many vessels that overlap, or radii that differ too "
                       "much, to be divided into cells in a reasonable time; leave out vessels or "
                       "choose another model");
    for (size_t i = from->first; i < from->first + from->count; i++) {
        uint32_t number = builder->stack[i];
        const FieldSegment *segment = &builder->segments[number];
        const Support *support = &builder->supports[number];
        double distance2 = segment_box_distance2(segment, &box);
        if (!(distance2 < support->reach2))
            continue;
        builder->stack[list.first + list.count++] = number;
        double bound = support->peak * elementary_exp(-support->decay * distance2);
        list.bound_sum += bound;
        list.smallest_radius = fmin(list.smallest_radius, segment->radius_mm);
        list.largest_radius = fmax(list.largest_radius, segment->radius_mm);
        if (bound > significant_bound)
            list.local_radius = fmin(list.local_radius, segment->radius_mm);
    }
    if (isinf(list.local_radius))
        list.local_radius = list.smallest_radius;
    if (list.bound_sum >= empty_below)
        list.steepness = gradient_bound(builder, &list, empty_below);
    builder->tests += KEPT_TERM_COST * list.count;
    builder->depth += list.count;
    *out = list;
    return STATUS_OK;
}

/* A sum of terms at the centre of a cube, and its lower bound in the cube. Per mm, each term loses
 * at most the maximum of phi sqrt(-2 ln phi) / s, which is exp(-1/2) / s. */
typedef struct CubeSum {
    double phi, at_least;
} CubeSum;

/* Sums n terms of the list: those at these positions, or, if positions is NULL, the first n. */
static CubeSum sum_in(const CellBuilder *builder, const uint32_t *list, const uint32_t *positions,
                      size_t n, Vec3 center, double half_diagonal)
{
    CubeSum sum = {0};
    for (size_t i = 0; i < n; i++) {
        const FieldSegment *segment = &builder->segments[list[positions ? positions[i] : i]];
        double term = potential_term(segment, center);
        sum.phi += term;
        sum.at_least +=
            fmax(0, term - half_diagonal * elementary_exp(-0.5) * 2 / segment->radius_mm);
    }
    return sum;
}

/* Returns the largest of the sums of the groups. */
static CubeSum largest_sum(const CellBuilder *builder, const TermList *terms, Vec3 center,
                           double half_diagonal)
{
    const uint32_t *list = builder->stack + terms->first;
    if (!builder->groups)
        return sum_in(builder, list, NULL, terms->count, center, half_diagonal);
    CubeSum largest = {0};
    size_t n_groups = localgroups_find(builder->groups, list, terms->count);
    for (size_t group = 0; group < n_groups; group++) {
        size_t n;
        const uint32_t *positions = localgroups_members(builder->groups, group, &n);
        CubeSum sum = sum_in(builder, list, positions, n, center, half_diagonal);
        largest.phi = fmax(largest.phi, sum.phi);
        largest.at_least = fmax(largest.at_least, sum.at_least);
    }
    return largest;
}

/* Returns true if the potential at the centre proves that the cube, widened by `margin`, does not
 * meet the surface. By the bound of the log form's gradient, the potential is too small to reach
 * the level, or so large that it stays above. */
static bool misses_surface(const CellBuilder *builder, const TermList *terms, const Cube *cube,
                           double margin)
{
    Vec3 center = box_center(cube_box(cube, 0));
    double half_diagonal = sqrt(3) * (cube->side / 2 + margin);
    CubeSum sum = largest_sum(builder, terms, center, half_diagonal);
    if (sum.phi >= empty_below)
        return sum.at_least > full_above;
    double rise =
        sqrt(-2 * elementary_log(fmax(sum.phi, DBL_MIN))) - sqrt(-2 * elementary_log(empty_below));
    return rise * terms->smallest_radius / 2 > terms->steepness * half_diagonal;
}

/* Rounds x down (sign 1) or up (sign -1) to this number of decimals, which may be negative. */
static double round_down(double x, int decimals, double sign)
{
    double unit = elementary_pow(10, abs(decimals));
    return decimals < 0 ? sign * floor(sign * x / unit) * unit
                        : sign * floor(sign * x * unit) / unit;
}

/* Returns the number of decimals that keep `digits` significant digits of x > 0. */
static int decimals_of(double x, int digits)
{
    return digits - 1 - (int)floor(elementary_log10(x));
}

double cell_accuracy(double radius)
{
    double accuracy =
        fmax(accuracy_ratio * radius, fmin(SHADOW_ACCURACY_MM, largest_accuracy_ratio * radius));
    return round_down(accuracy, decimals_of(accuracy, 3), 1);
}

/* Returns which ends of the segment matter for the term in the box. */
static TermPart relevant_ends(const TermForm *form, Box box)
{
    Vec3 center = box_center(box), half = vec3_sub(box.high, center);
    bool felt[2];
    for (int end = 0; end < 2; end++) {
        const double *k = end ? form->end.k : form->start.k;
        double inside = k[0] * center.x + k[1] * center.y + k[2] * center.z + k[3];
        double swing = fabs(k[0]) * half.x + fabs(k[1]) * half.y + fabs(k[2]) * half.z;
        felt[end] = inside - swing < END_REACH;
    }
    return felt[0] ? (felt[1] ? TERM_BOTH_ENDS : TERM_START) : felt[1] ? TERM_END : TERM_MIDDLE;
}

/* Stores the terms of a list as the terms of a cell. */
static Status push_terms(CellBuilder *builder, const TermList *terms, Box box, Err *err)
{
    CellTree *tree = &builder->tree;
    TRY(mem_reserve(&tree->terms, &builder->term_capacity, tree->n_terms + terms->count,
                    sizeof *tree->terms, "terms of cells", err));
    for (size_t i = 0; i < terms->count; i++) {
        uint32_t segment = builder->stack[terms->first + i];
        tree->terms[tree->n_terms++] =
            (CellTerm){segment, relevant_ends(&tree->forms[segment], box)};
    }
    return STATUS_OK;
}

/* Adds the groups of the cell, unless all its terms are in one group. */
static Status push_groups(CellBuilder *builder, const TermList *terms, Cell *cell, Err *err)
{
    CellTree *tree = &builder->tree;
    size_t n_groups = 0;
    if (builder->groups)
        n_groups = localgroups_find(builder->groups, builder->stack + terms->first, terms->count);
    if (n_groups < 2)
        return STATUS_OK;
    cell->first_group = (uint32_t)tree->n_groups;
    cell->n_groups = (uint32_t)n_groups;
    TRY(mem_reserve(&tree->group_ends, &builder->group_capacity, tree->n_groups + n_groups,
                    sizeof *tree->group_ends, "groups of cells", err));
    for (size_t group = 0; group < n_groups; group++) {
        size_t n;
        const uint32_t *positions = localgroups_members(builder->groups, group, &n);
        TRY(mem_reserve(&tree->members, &builder->member_capacity, tree->n_members + n,
                        sizeof *tree->members, "groups of cells", err));
        for (size_t i = 0; i < n; i++)
            tree->members[tree->n_members++] = positions[i];
        tree->group_ends[tree->n_groups++] = tree->n_members;
    }
    return STATUS_OK;
}

/* Returns the segment whose term is above half of the level wherever the sum reaches the level,
 * because all other terms together stay below half of it. Returns CELL_MIXED if there is none. */
static uint32_t largest_in(const CellBuilder *builder, const TermList *terms, Box box)
{
    for (size_t i = 0; i < terms->count; i++) {
        uint32_t segment = builder->stack[terms->first + i];
        double bound = potential_term_bound(&builder->segments[segment], box);
        if (terms->bound_sum - bound < 0.48 * FIELD_LEVEL)
            return segment;
    }
    return CELL_MIXED;
}

/* Returns the bound of the gradient of the cell's function. cell->scale must be set. */
static double max_gradient(const CellBuilder *builder, const TermList *terms, const Cell *cell)
{
    double bound = 1;
    if (!cell_is_tube(&builder->tree, cell)) {
        double near = gradient_bound(builder, terms, LOG_FORM_CEILING);
        double far = gradient_bound(builder, terms, LOG_FORM_FLOOR);
        bound = fmax(near, tail_steepness[builder->tree.erf] * far);
    }
    double gradient = bound * (1 + 1e-9) * cell->scale * 2 / terms->smallest_radius;
    return round_down(gradient, decimals_of(gradient, 4), -1);
}

/* Returns the number of different shifts: SHIFTS, or 1, which means no shift, where single
 * precision is too coarse for shifts. */
static int shifts_at(const CellBuilder *builder, double accuracy)
{
    return 2 * SHIFTS * builder->spacing <= overlap_accuracies * accuracy ? SHIFTS : 1;
}

/* Returns how far the box of a cell reaches beyond its cube before the box is shifted, mm. */
static double overlap_of(const CellBuilder *builder, double accuracy)
{
    double step = shifts_at(builder, accuracy) * builder->spacing;
    return ceil(overlap_accuracies * accuracy / step) * step;
}

/* Returns the shift of a cell's box, in spacings, below SHIFTS - 1. Two cells that touch need
 * different shifts if their boxes, before the overlap is added, may begin and end in the same two
 * planes across an axis. The cubes of such cells are at most HALVINGS levels of the octree apart.
 * If they are of one level, they differ in one or two of their three coordinates. */
static int shift_index(const CellBuilder *builder, const Cube *cube)
{
    int level = ilogb(builder->root_side / cube->side) % (HALVINGS + 1);
    int64_t x = cube->at[0] & 1, y = cube->at[1] & 1, z = cube->at[2] & 1;
    return 4 * level + (int)((x ^ z) | (y ^ z) << 1);
}

/* Returns the box of a cell: `box`, rounded outwards to multiples of the spacing, and shifted.
 *
 * The shift makes the order of hits certain. POV-Ray halves the interval of a ray in a box again
 * and again, and so finds the surface at a fraction k / 2^i of the interval. Take a ray along an
 * axis that meets the boxes of two cells with different shifts s and s', and overlaps of 13 m and
 * 13 m' spacings. Equal fractions of the two intervals are different points: they would be one
 * point if 13 (m - m') (2 k - 2^i) were 2^i (s - s'), which 13 does not divide. Unequal fractions
 * may be one point. But the two boxes begin at different points, so it is known which box POV-Ray
 * searches first. */
static Box box_shifted(const CellBuilder *builder, Box box, const Cube *cube, double accuracy)
{
    double unit = builder->spacing;
    int shifts = shifts_at(builder, accuracy);
    double up = shift_index(builder, cube) % shifts, down = shifts - 1 - up;
    return (Box){{(floor(box.low.x / unit) - down) * unit, (floor(box.low.y / unit) - down) * unit,
                  (floor(box.low.z / unit) - down) * unit},
                 {(ceil(box.high.x / unit) + up) * unit, (ceil(box.high.y / unit) + up) * unit,
                  (ceil(box.high.z / unit) + up) * unit}};
}

static bool box_has_box(Box box, Box other)
{
    return box_contains(box, other.low, 0) && box_contains(box, other.high, 0);
}

/* Widens *box to hold the parts of the cube, halved `times` times, in which the surface can be.
 * Each part has `margin` about it. */
static Status widen_to_surface(CellBuilder *builder, const TermList *candidates, const Cube *cube,
                               double margin, int times, Box *box, Err *err)
{
    const Box own = cube_box(cube, margin);
    size_t depth = builder->depth;
    TermList terms;
    if (box_has_box(*box, own))
        return STATUS_OK;
    TRY(filter_terms(builder, candidates, own, &terms, err));
    if (terms.bound_sum >= empty_below && !misses_surface(builder, &terms, cube, margin)) {
        if (times == 0)
            *box = box_union(*box, own);
        for (int octant = 0; times > 0 && octant < 8; octant++) {
            const Cube part = octant_of(cube, octant);
            TRY(widen_to_surface(builder, &terms, &part, margin, times - 1, box, err));
        }
    }
    builder->depth = depth;
    return STATUS_OK;
}

/* Finds the box of the surface in a cube. Its tests of terms are not counted, because the number of
 * cells bounds them. */
static Status box_of_surface(CellBuilder *builder, const TermList *candidates, const Cube *cube,
                             double margin, Box *box, Err *err)
{
    int times = candidates->count > MAX_HALVED_TERMS ? 0 : HALVINGS;
    uint64_t tests = builder->tests;
    *box = box_empty();
    TRY(widen_to_surface(builder, candidates, cube, margin, times, box, err));
    builder->tests = tests;
    return STATUS_OK;
}

/* Adds the cell of a cube that is not split, unless the surface misses the cube. */
static Status add_cell(CellBuilder *builder, const TermList *candidates, const Cube *cube, Err *err)
{
    double accuracy = cell_accuracy(candidates->local_radius);
    Box box;
    TermList terms;
    TRY(box_of_surface(builder, candidates, cube, overlap_of(builder, accuracy), &box, err));
    if (box_is_empty(box))
        return STATUS_OK;
    box = box_shifted(builder, box, cube, accuracy);
    TRY(filter_terms(builder, candidates, box, &terms, err));

    CellTree *tree = &builder->tree;
    if (tree->n_cells == max_cells || tree->n_terms + terms.count > UINT32_MAX)
        return err_set(err, STATUS_INFEASIBLE,
                       "the isosurface needs more than %zu cells of up to %g mm; leave out thin "
                       "vessels or choose another model",
                       max_cells, builder->root_side);
    TRY(mem_reserve(&tree->cells, &builder->cell_capacity, tree->n_cells + 1, sizeof *tree->cells,
                    "cells", err));
    Cell cell = {.low = box.low,
                 .high = box.high,
                 .first = (uint32_t)tree->n_terms,
                 .count = (uint32_t)terms.count,
                 .scale = elementary_exp2(floor(elementary_log2(terms.smallest_radius / 8))),
                 .accuracy = accuracy,
                 .largest = largest_in(builder, &terms, box)};
    TRY(push_terms(builder, &terms, box, err));
    TRY(push_groups(builder, &terms, &cell, err));
    cell.max_gradient = max_gradient(builder, &terms, &cell);
    tree->cells[tree->n_cells++] = cell;
    return STATUS_OK;
}

/* Adds the cells of a cube, whose parent has the terms `parent`. A term is kept if it matters in
 * the cube widened by the overlap of any cell in it. */
static Status descend(CellBuilder *builder, const TermList *parent, const Cube *cube, Err *err)
{
    size_t depth = builder->depth;
    double accuracy = cell_accuracy(parent->largest_radius);
    double margin =
        overlap_accuracies * accuracy + 2 * shifts_at(builder, accuracy) * builder->spacing;
    TermList terms;
    TRY(filter_terms(builder, parent, cube_box(cube, margin), &terms, err));
    if (terms.bound_sum >= empty_below && !misses_surface(builder, &terms, cube, margin)) {
        bool split =
            cube->side > builder->root_side || cube->side > builder->beta * terms.local_radius;
        if (!split)
            TRY(add_cell(builder, &terms, cube, err));
        for (int octant = 0; split && octant < 8; octant++) {
            const Cube part = octant_of(cube, octant);
            TRY(descend(builder, &terms, &part, err));
        }
    }
    builder->depth = depth;
    return STATUS_OK;
}

/* Descends from the cubes of the lattice that hold the box, at most two along each axis. `all` is
 * the list of all terms. */
static Status descend_from_top(CellBuilder *builder, const TermList *all, Box box, Err *err)
{
    double widest = vec3_component(vec3_sub(box.high, box.low), box_longest_axis(box));
    double side = builder->root_side;
    while (side < widest)
        side *= 2;
    int64_t first[3], last[3];
    for (int axis = 0; axis < 3; axis++) {
        first[axis] = (int64_t)floor(vec3_component(box.low, axis) / side);
        last[axis] = (int64_t)floor(vec3_component(box.high, axis) / side);
    }
    for (int64_t z = first[2]; z <= last[2]; z++)
        for (int64_t y = first[1]; y <= last[1]; y++)
            for (int64_t x = first[0]; x <= last[0]; x++)
                TRY(descend(builder, all, &(Cube){side, {x, y, z}}, err));
    return STATUS_OK;
}

/* Returns the smallest power of 2 whose multiples, in a box and up to two root cubes beyond it, are
 * exact in single precision, as are their differences. */
static double spacing_within(Box box, double root_side)
{
    double farthest = fmax(fmax(fmax(-box.low.x, box.high.x), fmax(-box.low.y, box.high.y)),
                           fmax(-box.low.z, box.high.z));
    return elementary_exp2(ilogb(farthest + 2 * root_side) + 2 - FLT_MANT_DIG);
}

/* Returns the constants of the bound of a segment's term. */
static Support support_of(const FieldSegment *segment)
{
    double peak = potential_term_peak(segment);
    double decay = 2 / (segment->radius_mm * segment->radius_mm);
    return (Support){peak, decay, elementary_log(peak / CELL_TERM_CUTOFF) / decay};
}

/* Prepares the arrays of all terms, and descends. */
static Status build(CellBuilder *builder, size_t n_segments, Err *err)
{
    CellTree *tree = &builder->tree;
    TRY(mem_reserve(&builder->stack, &builder->stack_capacity, n_segments, sizeof *builder->stack,
                    "terms", err));
    TRY(mem_calloc(&builder->supports, n_segments, sizeof *builder->supports, "supports", err));
    TRY(mem_calloc(&tree->forms, n_segments, sizeof *tree->forms, "forms of terms", err));
    TermList all = {.count = n_segments};
    Box box = box_empty();
    for (size_t i = 0; i < n_segments; i++) {
        const FieldSegment *segment = &builder->segments[i];
        tree->forms[i] = term_form(segment);
        builder->supports[i] = support_of(segment);
        builder->stack[i] = (uint32_t)i;
        double reach = sqrt(fmax(builder->supports[i].reach2, 0));
        box = box_with_ball(box, segment->a, reach);
        box = box_with_ball(box, segment->b, reach);
        all.largest_radius = fmax(all.largest_radius, segment->radius_mm);
    }
    if (n_segments == 0)
        return STATUS_OK;
    builder->depth = n_segments;
    builder->root_side = 4 * all.largest_radius;
    builder->spacing = spacing_within(box, builder->root_side);
    return descend_from_top(builder, &all, box, err);
}

Status celltree_build(const Geometry *geometry, const CellParams *params, CellTree *cells, Err *err)
{
    CellBuilder builder = {.segments = geometry->segments,
                           .beta = params->beta > 0 ? params->beta : CELL_BETA,
                           .tree = {.erf = params->erf}};
    Status status;
    if (geometry->blend.n_groups)
        TRY_GOTO(localgroups_new(geometry, &builder.groups, err));
    TRY_GOTO(build(&builder, geometry->n_segments, err));
    *cells = builder.tree;
    builder.tree = (CellTree){0};
done:
    localgroups_free(builder.groups);
    free(builder.supports);
    free(builder.stack);
    celltree_release(&builder.tree);
    return status;
}

void celltree_release(CellTree *cells)
{
    free(cells->cells);
    free(cells->terms);
    free(cells->members);
    free(cells->group_ends);
    free(cells->forms);
    *cells = (CellTree){0};
}
