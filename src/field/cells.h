/* The implicit surface as POV-Ray's isosurface objects represent it.
 *
 * The surface is covered by boxes, called cells. Each cell has the few terms of the potential that
 * matter in it, and a function of them that POV-Ray evaluates in the box. The same function can be
 * evaluated here, bit by bit, so that a picture of this program can be compared with one of
 * POV-Ray. Exported by the public header of the module field.
 *
 *     CellParams params = {.erf = ERF_FAST};
 *     TRY(celltree_build(&geometry, &params, &cells, err));
 *     double f = cell_function(&cells, &cells.cells[0], x);
 *     celltree_release(&cells); */
#ifndef CORCAST_FIELD_CELLS_H
#define CORCAST_FIELD_CELLS_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* POV-Ray's functions have no erf. It is replaced by tanh of an odd polynomial, of degree 3 (fast)
 * or 9 (exact). */
typedef enum ErfForm { ERF_FAST, ERF_EXACT } ErfForm;

/* Per form: the coefficients k of u, u^3, ... of -2 times the polynomial, so that (1 + erf u) / 2
 * is 1 / (1 + exp(k[0] u + k[1] u^3 + ...)). Unused coefficients are 0. */
enum { ERF_TERMS = 5 };
extern const double erf_forms[][ERF_TERMS];

/* Returns the largest absolute error of erf in a form. An error eps moves the surface of a long
 * vessel of radius r by at most eps r / 8: it changes the axial factor by at most eps / 2 of a term
 * that is FIELD_LEVEL on the surface, where |grad Phi| = 4 FIELD_LEVEL / r. */
double erf_form_error(ErfForm form);

/* The function k[0] x + k[1] y + k[2] z + k[3]. */
typedef struct Linear {
    double k[4];
} Linear;

/* A term of the potential, in units of sqrt2 s = radius / sqrt2. v and w are the distances from two
 * planes through the axis that are perpendicular to each other; start and end are the distances
 * from the two ends, positive inwards. */
typedef struct TermForm {
    Linear v, w, start, end;
} TermForm;

/* Returns the term of a segment in this form. The segment's ends must differ. */
TermForm term_form(const FieldSegment *segment);

/* The ends of a segment that matter in a cell. An end does not matter if all of the cell is at
 * least END_REACH units inside it. */
typedef enum TermPart { TERM_BOTH_ENDS, TERM_START, TERM_END, TERM_MIDDLE } TermPart;
#define END_REACH 3.5

/* Returns the term at x. The order of operations is that of POV-Ray. */
double term_form_value(const TermForm *term, TermPart part, ErfForm form, Vec3 x);

/* A term of a cell. */
typedef struct CellTerm {
    uint32_t segment; /* index into geometry->segments */
    uint32_t part;    /* TermPart */
} CellTerm;

/* A box and its function: `scale` times the log form of the sum of the terms, or of the largest of
 * the sums of its groups. The function is below 0 inside the vessel. Boxes of neighbours overlap,
 * so that no ray passes between them. */
typedef struct Cell {
    Vec3 low, high;
    uint32_t first, count; /* its terms are terms[first .. first + count), by rising segment */
    uint32_t first_group, n_groups; /* its groups; n_groups is 0 if all terms blend */
    double scale;        /* a power of 2, at most a quarter of the smallest s of its terms, mm */
    double max_gradient; /* proven bound of the function's gradient in the box */
    double accuracy;     /* mm; cell_accuracy */
    uint32_t largest; /* the segment whose term is the largest wherever the surface is in the box;
                       * CELL_MIXED if that is not certain for any segment */
} Cell;

/* In Cell.largest: no segment is certain. */
#define CELL_MIXED UINT32_MAX

/* The cells of a geometry. All arrays are owned. Release it with celltree_release. */
typedef struct CellTree {
    Cell *cells;
    size_t n_cells;
    CellTerm *terms;
    size_t n_terms;
    uint32_t *members; /* of all groups: positions of terms in their cell, rising */
    size_t n_members;
    size_t *group_ends; /* per group: index in `members` just past its last member, where the
                         * members of the next group begin */
    size_t n_groups;
    TermForm *forms; /* per segment */
    ErfForm erf;
} CellTree;

/* The default of CellParams.beta. Smaller cells are traced faster, but POV-Ray takes longer to read
 * them. How the number was chosen is not recorded. */
#define CELL_BETA 6

typedef struct CellParams {
    double beta; /* cubes are split while they are longer than this times the smallest radius that
                  * matters in them; 0: CELL_BETA */
    ErfForm erf;
} CellParams;

/* Returns the accuracy of a cell, mm: how far from the surface POV-Ray may find a hit along a ray.
 * It is 1/300 of radius_mm, but at least SHADOW_ACCURACY_MM, unless that is above 1/60 of the
 * radius. It rises with the radius.
 *
 * radius_mm   the smallest radius that matters in the cell. */
double cell_accuracy(double radius_mm);

/* Returns how far the approximations of cells move the surface of a vessel, mm. With the error eps
 * of erf [erf_form_error] and the radius r, the form of erf moves it by up to 1.2 eps r at a free
 * end, and by up to 2.8 eps r, as measured, where many segments shorter than their radius meet.
 * Ends and terms that are left out move it, too. */
double cell_displacement(double radius_mm, ErfForm form);

/* Finds the cells in which the surface can be. They are leaves of an octree, in Morton order. Its
 * root cubes have the side 4 r_max, and are on the lattice of multiples of their side. A term
 * matters for the size of a cell if it exceeds 1e-2 there.
 *
 * geometry  is read during the call alone. It may have no segments; then there are no cells.
 * cells     receives the cells; release it with celltree_release.
 * Errors    STATUS_INFEASIBLE if there are more than a million cells, or if it takes too long to
 *           find them; STATUS_MEMORY. */
MUST_CHECK Status celltree_build(const Geometry *geometry, const CellParams *params,
                                 CellTree *cells, Err *err);
void celltree_release(CellTree *cells);

/* Minimum accuracy of a cell, mm, where the radius allows. POV-Ray counts hits of a shadow ray from
 * 1e-3 mm on, but from 1e-4 mm on in the cell that cast the last shadow. Which cell that is depends
 * on the order of POV-Ray's work. No hit is between 1e-4 and 1e-3 mm if a cell's accuracy is 1e-3
 * or more, because rays that start on its surface are moved on by five accuracies. */
#define SHADOW_ACCURACY_MM 1.01e-3

/* Returns true if the cell has one term, and no end of this term matters. The cell's function is
 * then scale (TUBE_SLOPE sqrt(v^2 + w^2) - 2), which needs no exponential and no clamp. */
static inline bool cell_is_tube(const CellTree *cells, const Cell *cell)
{
    return cell->count == 1 && cells->terms[cell->first].part == TERM_MIDDLE;
}
#define TUBE_SLOPE 1.4142135623730951 /* sqrt 2 */

/* Returns the members of the cell's group `group`, which is below cell->n_groups: *n indices into
 * the cell's terms, rising. Borrowed from `cells`. */
const uint32_t *cell_group(const CellTree *cells, const Cell *cell, uint32_t group, uint32_t *n);

/* Returns the function of the cell at x, mm. Every bit is the same as in POV-Ray. */
double cell_function(const CellTree *cells, const Cell *cell, Vec3 x);
/* Returns the index in geometry->segments of the segment with the largest term at x, in the group
 * with the largest sum. On a tie, returns the first. */
uint32_t cell_largest_term(const CellTree *cells, const Cell *cell, Vec3 x);
/* Returns the weighted mean of values at x that termmean_at defines, from the cell's terms, as
 * POV-Ray evaluates it. Returns NAN where termmean_at does.
 *
 * segments  geometry->segments.
 * values    value of segment i: values[segments[i].segment]. */
double cell_mean(const CellTree *cells, const Cell *cell, const FieldSegment *segments,
                 const double *values, Vec3 x);

#endif
