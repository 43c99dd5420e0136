/* One descent from at most eight cubes about everything: each cube filters its parent's list of
 * terms by their bound in it, and is dropped when the bounds do not add up to the level; so empty
 * space costs nothing and a segment is looked at only where it may matter. A cube of side 4 r_max *
 * 2^j lies on the lattice of multiples of its side, so that neighbours share their faces to the
 * last bit.
 *
 * The bound of the gradient. In units of s, the axial factor A of a term is the probability that a
 * normal variable is within the segment, and |A'| = |E[g; inside]| <= A sqrt(-2 ln A), because a
 * law whose mean is m has an entropy of at least m^2 / 2 relative to the normal law, and that of
 * the normal law confined to a set of probability A is -ln A. With the radial factor
 *   s |grad phi| <= phi sqrt(-2 ln phi).
 * For the sum, with L^2 = -2 ln Phi, p_i = phi_i / Phi and q_i = (s_min / s_i)^2 <= 1, by
 * Cauchy-Schwarz, q_i <= 1, and Gibbs' variational principle
 *   (s_min |grad Phi| / Phi)^2 <= sum p_i q_i (L^2 - 2 ln p_i)
 *                              <= 2 (sum p_i q_i L^2 / 2 - sum p_i ln p_i)
 *                              <= 2 ln sum exp(q_i L^2 / 2),
 * and grad (log form) = -grad Phi / (Phi L): s_min |grad| <= sqrt(2 ln(sum exp(q_i L^2 / 2))) / L,
 * which grows with Phi. Equality for one term, and for n that coincide. */
#include "surface/potential.h"

#include <float.h>
#include <stdlib.h>

/* There is no surface where the potential is below or above these. The hundredth of the level
 * covers a thousand dropped terms, and an erf approximated to 2.8e-4 in four terms. */
static const double empty_below = 0.99 * FIELD_LEVEL;
static const double full_above = 1.01 * FIELD_LEVEL;

/* A term matters for the size of a cell when its bound is above this. */
static const double significant = 1e-2;

/* accuracy = radius / radii_per_accuracy */
static const double radii_per_accuracy = 300;

/* With erf approximated by tanh, s |A'| is at most this times A sqrt(-2 ln A) down to A =
 * LOG_FORM_FLOOR / 10, and within the bound of the exact form from A = 1e-3 up (tabulated). */
static const double tanh_steepness = 1.18;

static const size_t max_cells = 1000000;

/* A term's bound is peak exp(-decay dist^2), above the cut-off up to dist^2 = reach2. */
typedef struct Support {
    double peak, decay, reach2;
} Support;

typedef struct Builder {
    const FieldSegment *segments;
    Support *supports; /* one a segment */
    double beta;
    double root_side;
    uint32_t *stack; /* the lists of the cubes from the first down to the current one */
    size_t depth, stack_capacity;
    CellTree tree;
    size_t cell_capacity, term_capacity;
} Builder;

/* Part of the stack, and what its terms have in common. */
typedef struct TermList {
    size_t first, count;
    double bound_sum;
    double smallest_radius, largest_radius;
    double local_radius; /* smallest of the significant terms, of all when none is */
} TermList;

/* A cube of the octree: the multiples of `side` from at[] on. */
typedef struct Cube {
    double side;
    int64_t at[3];
} Cube;

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

/* Pushes those terms of `from` whose bound in the box is above TERM_CUTOFF. */
static Status filter_terms(Builder *builder, const TermList *from, Box box, TermList *out, Err *err)
{
    TRY(mem_reserve(&builder->stack, &builder->stack_capacity, builder->depth + from->count,
                    sizeof *builder->stack, "terms", err));
    TermList list = {builder->depth, 0, 0, HUGE_VAL, 0, HUGE_VAL};
    for (size_t i = from->first; i < from->first + from->count; i++) {
        uint32_t number = builder->stack[i];
        const FieldSegment *segment = &builder->segments[number];
        const Support *support = &builder->supports[number];
        double distance2 = segment_box_distance2(segment, &box);
        if (!(distance2 < support->reach2))
            continue;
        builder->stack[list.first + list.count++] = number;
        double bound = support->peak * exp(-support->decay * distance2);
        list.bound_sum += bound;
        list.smallest_radius = fmin(list.smallest_radius, segment->radius_mm);
        list.largest_radius = fmax(list.largest_radius, segment->radius_mm);
        if (bound > significant)
            list.local_radius = fmin(list.local_radius, segment->radius_mm);
    }
    if (isinf(list.local_radius))
        list.local_radius = list.smallest_radius;
    builder->depth += list.count;
    *out = list;
    return STATUS_OK;
}

/* The bound of s_min |grad (log form)| for potentials up to `phi`. */
static double gradient_bound(const Builder *builder, const TermList *terms, double phi)
{
    double half_l2 = -log(phi), sum = 0;
    for (size_t i = terms->first; i < terms->first + terms->count; i++) {
        double ratio = terms->smallest_radius / builder->segments[builder->stack[i]].radius_mm;
        sum += exp(ratio * ratio * half_l2);
    }
    return sqrt(log(sum) / half_l2);
}

/* Whether the potential at the centre proves that the level is not met in the cube widened by
 * `margin`: it is too small to reach the level by the bound of the log form's gradient, or so large
 * that it stays above, each term losing at most the largest phi sqrt(-2 ln phi) / s, exp(-1/2) / s,
 * a mm. */
static bool misses_surface(const Builder *builder, const TermList *terms, const Cube *cube,
                           double margin)
{
    Vec3 center = box_center(cube_box(cube, 0));
    double half_diagonal = sqrt(3) * (cube->side / 2 + margin);
    double phi = 0, at_least = 0;
    for (size_t i = terms->first; i < terms->first + terms->count; i++) {
        const FieldSegment *segment = &builder->segments[builder->stack[i]];
        double term = potential_term(segment, center);
        phi += term;
        at_least += fmax(0, term - half_diagonal * exp(-0.5) * 2 / segment->radius_mm);
    }
    if (phi >= empty_below)
        return at_least > full_above;
    double rise = sqrt(-2 * log(fmax(phi, DBL_MIN))) - sqrt(-2 * log(empty_below));
    return rise * terms->smallest_radius / 2 >
           gradient_bound(builder, terms, empty_below) * half_diagonal;
}

static Status add_cell(Builder *builder, const TermList *candidates, const Cube *cube, Err *err)
{
    double accuracy = candidates->local_radius / radii_per_accuracy;
    double margin = CELL_OVERLAP * accuracy;
    TermList terms;
    TRY(filter_terms(builder, candidates, cube_box(cube, margin), &terms, err));
    if (terms.bound_sum < empty_below || misses_surface(builder, &terms, cube, margin))
        return STATUS_OK;

    CellTree *tree = &builder->tree;
    if (tree->n_cells == max_cells || tree->n_terms + terms.count > UINT32_MAX)
        return err_set(err, STATUS_INFEASIBLE,
                       "the isosurface needs more than %zu cells of up to %g mm; leave out thin "
                       "vessels or choose another model",
                       max_cells, builder->root_side);
    TRY(mem_reserve(&tree->cells, &builder->cell_capacity, tree->n_cells + 1, sizeof *tree->cells,
                    "cells", err));
    TRY(mem_reserve(&tree->terms, &builder->term_capacity, tree->n_terms + terms.count,
                    sizeof *tree->terms, "terms of cells", err));
    double near = gradient_bound(builder, &terms, LOG_FORM_CEILING);
    double far = tanh_steepness * gradient_bound(builder, &terms, LOG_FORM_FLOOR);
    tree->cells[tree->n_cells++] = (Cell){.low = cube_low(cube),
                                          .side = cube->side,
                                          .first = (uint32_t)tree->n_terms,
                                          .count = (uint32_t)terms.count,
                                          .scale = terms.smallest_radius / 2,
                                          .max_gradient = fmax(near, far),
                                          .accuracy = accuracy};
    for (size_t i = 0; i < terms.count; i++)
        tree->terms[tree->n_terms++] = builder->stack[terms.first + i];
    return STATUS_OK;
}

/* Adds the cells of a cube, whose parent has the terms `parent`. Terms are kept where they matter
 * in the cube widened by the overlap of any cell that it may hold. */
static Status descend(Builder *builder, const TermList *parent, const Cube *cube, Err *err)
{
    size_t depth = builder->depth;
    double margin = CELL_OVERLAP * parent->largest_radius / radii_per_accuracy;
    TermList terms;
    TRY(filter_terms(builder, parent, cube_box(cube, margin), &terms, err));
    if (terms.bound_sum >= empty_below && !misses_surface(builder, &terms, cube, margin)) {
        bool split =
            cube->side > builder->root_side || cube->side > builder->beta * terms.local_radius;
        if (!split)
            TRY(add_cell(builder, &terms, cube, err));
        for (int child = 0; split && child < 8; child++) {
            Cube part = {cube->side / 2, {0}};
            for (int axis = 0; axis < 3; axis++)
                part.at[axis] = 2 * cube->at[axis] + (child >> axis & 1);
            TRY(descend(builder, &terms, &part, err));
        }
    }
    builder->depth = depth;
    return STATUS_OK;
}

/* Descends from the cubes of the lattice, two along each axis at most, that hold the box; `all` is
 * the list of all terms. */
static Status descend_from_top(Builder *builder, const TermList *all, Box box, Err *err)
{
    Vec3 extent = vec3_sub(box.high, box.low);
    double widest = fmax(extent.x, fmax(extent.y, extent.z));
    double side = builder->root_side;
    while (side < widest)
        side *= 2;
    const double low[3] = {box.low.x, box.low.y, box.low.z};
    const double high[3] = {box.high.x, box.high.y, box.high.z};
    int64_t first[3], last[3];
    for (int axis = 0; axis < 3; axis++) {
        first[axis] = (int64_t)floor(low[axis] / side);
        last[axis] = (int64_t)floor(high[axis] / side);
    }
    for (int64_t z = first[2]; z <= last[2]; z++) {
        for (int64_t y = first[1]; y <= last[1]; y++) {
            for (int64_t x = first[0]; x <= last[0]; x++)
                TRY(descend(builder, all, &(Cube){side, {x, y, z}}, err));
        }
    }
    return STATUS_OK;
}

static Support support_of(const FieldSegment *segment)
{
    double peak = potential_term_peak(segment);
    double decay = 2 / (segment->radius_mm * segment->radius_mm);
    return (Support){peak, decay, log(peak / TERM_CUTOFF) / decay};
}

static Status build(Builder *builder, size_t n_segments, Err *err)
{
    TRY(mem_reserve(&builder->stack, &builder->stack_capacity, n_segments, sizeof *builder->stack,
                    "terms", err));
    TRY(mem_calloc(&builder->supports, n_segments, sizeof *builder->supports, "supports", err));
    TermList all = {.count = n_segments};
    Box box = box_empty();
    for (size_t i = 0; i < n_segments; i++) {
        const FieldSegment *segment = &builder->segments[i];
        builder->supports[i] = support_of(segment);
        builder->stack[i] = (uint32_t)i;
        double reach = sqrt(fmax(builder->supports[i].reach2, 0));
        box = box_with_ball(box, segment->a, reach);
        box = box_with_ball(box, segment->b, reach);
        all.largest_radius = fmax(all.largest_radius, segment->radius_mm);
    }
    builder->depth = n_segments;
    builder->root_side = 4 * all.largest_radius;
    return n_segments ? descend_from_top(builder, &all, box, err) : STATUS_OK;
}

Status celltree_build(const Scene *scene, double beta, CellTree *cells, Err *err)
{
    Builder builder = {.segments = scene->segments, .beta = beta};
    Status status = build(&builder, scene->n_segments, err);
    free(builder.supports);
    free(builder.stack);
    if (status == STATUS_OK)
        *cells = builder.tree;
    else
        celltree_release(&builder.tree);
    return status;
}

void celltree_release(CellTree *cells)
{
    free(cells->cells);
    free(cells->terms);
    *cells = (CellTree){0};
}
