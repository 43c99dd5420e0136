/* The surface of the potential [field.h] as isosurface objects of POV-Ray. celltree_build covers
 * the surface with boxes, called cells. cell_function evaluates the function of a cell.
 *
 * A cell has the few terms of the potential that matter in its box, and a function of these terms.
 * POV-Ray evaluates the function to find the surface in the box. cell_function returns the same
 * bits as POV-Ray, so that an image by this program can be compared with an image by POV-Ray.
 * Exported by the public header of the module field.
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

/* The approximation of erf, which POV-Ray's functions lack: tanh of an odd polynomial. Its degree
 * is 3 (fast) or 9 (exact). */
typedef enum ErfForm { ERF_FAST, ERF_EXACT } ErfForm;

/* Per ErfForm: coefficients k of u, u^3, u^5, ... with (1 + erf u) / 2 = 1 / (1 + exp(k[0] u + k[1]
 * u^3 + ...)). They are -2 times the coefficients of the polynomial. Unused coefficients are 0. */
enum { ERF_TERMS = 5 };
extern const double erf_forms[][ERF_TERMS];

/* Returns the maximum absolute error of erf in a form. cell_displacement tells how far it moves the
 * surface. */
double erf_form_error(ErfForm form);

/* The function k[0] x + k[1] y + k[2] z + k[3]. */
typedef struct Linear {
    double k[4];
} Linear;

/* A term of the potential as functions of the position. The unit of length is radius / sqrt2, which
 * is sqrt2 times the width s of the potential, half of the radius. v and w are the signed distances
 * from two perpendicular planes that contain the axis. start and end are the distances from the two
 * ends along the axis, positive towards the segment. */
typedef struct TermForm {
    Linear v, w, start, end;
} TermForm;

/* Returns the term of a segment in this form. The segment's ends must differ. */
TermForm term_form(const FieldSegment *segment);

/* The ends of a segment that matter in a cell. An end does not matter if TermForm.start or
 * TermForm.end is at least END_REACH in the whole cell: erf is then 1 to 1e-6. */
typedef enum TermPart { TERM_BOTH_ENDS, TERM_START, TERM_END, TERM_MIDDLE } TermPart;
#define END_REACH 3.5

/* Returns the term at x, mm. The order of operations is that of POV-Ray. */
double term_form_value(const TermForm *term, TermPart part, ErfForm form, Vec3 x);

/* A term of a cell. */
typedef struct CellTerm {
    uint32_t segment; /* index into geometry->segments */
    uint32_t part;    /* TermPart */
} CellTerm;

/* A box and its function: `scale` times the log form of the sum of the terms, sqrt(-2 ln sum) - 2
 * with the sum clamped [potential_log_form]. If segments blend in groups, the sum is that of the
 * group with the largest sum. The function is below 0 inside the vessel. Neighbouring boxes
 * overlap, so that no ray passes between them. */
typedef struct Cell {
    Vec3 low, high;        /* corners of the box, mm */
    uint32_t first, count; /* its terms are CellTree.terms[first .. first + count), by ascending
                            * index of the segment */
    uint32_t first_group, n_groups; /* its groups in CellTree; n_groups is 0 if all terms blend */
    double scale;        /* a power of 2, at most a quarter of the smallest s of its terms, mm */
    double max_gradient; /* proved upper bound of the function's gradient in the box */
    double accuracy;     /* mm; cell_accuracy */
    uint32_t largest; /* the segment whose term is the largest at every point of the surface in the
                       * box; CELL_MIXED: there is no such segment, or the proof failed */
} Cell;

/* Value of Cell.largest for no segment. */
#define CELL_MIXED UINT32_MAX

/* The cells of a geometry. All arrays are owned. Release it with celltree_release. */
typedef struct CellTree {
    Cell *cells;
    size_t n_cells;
    CellTerm *terms;
    size_t n_terms;
    uint32_t *members; /* members of all groups, group after group. A member is the index of a term
                        * among the terms of its cell; members of a group are ascending */
    size_t n_members;
    size_t *group_ends; /* per group: 1 + index in `members` of its last member */
    size_t n_groups;
    TermForm *forms; /* per segment */
    ErfForm erf;
} CellTree;

/* The default of CellParams.beta. Smaller cells are traced faster, but POV-Ray takes longer to read
 * them. How the number was chosen is not recorded. */
#define CELL_BETA 6

typedef struct CellParams {
    double beta; /* cubes are split while they are longer than this times the smallest radius of the
                  * segments that are significant in them; 0: CELL_BETA */
    ErfForm erf;
} CellParams;

/* Returns the accuracy of a cell, mm: the maximum distance, along a ray, of POV-Ray's hit from the
 * surface. It is 1/300 of the radius, which is invisible at usual sizes, but at least
 * SHADOW_ACCURACY_MM, and at most 1/60 of the radius, which keeps thin vessels round.
 *
 * radius_mm  the smallest radius of the segments that are significant in the cell
 *            [celltree_build]. */
double cell_accuracy(double radius_mm);

/* Returns an upper bound, mm, of the distance by which the approximations in cells move the surface
 * of a vessel: 3 eps r for the form of erf, and 2e-5 r for ends and terms that are left out. Here
 * eps is erf_form_error, and r the radius. Beside a long vessel the form of erf moves the surface
 * by eps r / 8: on the surface the term is FIELD_LEVEL, eps changes its axial factor by eps / 2,
 * and |grad Phi| is 4 FIELD_LEVEL / r. At a free end the displacement is up to 1.2 eps r. Where
 * many segments meet that are shorter than their radius, 2.8 eps r was measured. */
double cell_displacement(double radius_mm, ErfForm form);

/* Finds the cells in which the surface may be. They are the leaves of an octree, in Morton order.
 * Its root cubes have the side 4 r_max, r_max the largest radius, and their corners are multiples
 * of this side. A segment is significant in a cell, and so limits its size, if its term exceeds
 * 1e-2 there: such a term can move the surface by 2 % of its radius.
 *
 * geometry  is read only during the call. Without segments there are no cells.
 * cells     receives the cells; release it with celltree_release.
 * Errors    STATUS_INFEASIBLE if there are more than a million cells, or if the search for
 *           them takes more than some seconds: 30 million tests of a term in a cube, and 150 more
 *           per cell that was found; STATUS_MEMORY. */
MUST_CHECK Status celltree_build(const Geometry *geometry, const CellParams *params,
                                 CellTree *cells, Err *err);
void celltree_release(CellTree *cells);

/* Minimum accuracy of a cell, mm, except for thin vessels [cell_accuracy]. POV-Ray ignores hits of
 * a shadow ray before 1e-3 mm, or before 1e-4 mm in the cell that cast the last shadow. The last
 * cell depends on the order of POV-Ray's work, so hits between 1e-4 and 1e-3 mm would make pictures
 * differ. With an accuracy of 1e-3 mm or more there are no such hits, because POV-Ray moves the
 * start of a ray on the surface by five accuracies. */
#define SHADOW_ACCURACY_MM 1.01e-3

/* Returns true if the cell has one term, and no end of this term matters. The cell's function is
 * then scale (TUBE_SLOPE sqrt(v^2 + w^2) - 2), which needs no exponential and no clamp. */
static inline bool cell_is_tube(const CellTree *cells, const Cell *cell)
{
    return cell->count == 1 && cells->terms[cell->first].part == TERM_MIDDLE;
}
#define TUBE_SLOPE 1.4142135623730951 /* sqrt 2 */

/* Returns the members of a group of a cell, and sets *n to their number. A member is the index of a
 * term among the terms of the cell; members are ascending. `group` is below cell->n_groups. The
 * array is borrowed from `cells`. */
const uint32_t *cell_group(const CellTree *cells, const Cell *cell, uint32_t group, uint32_t *n);

/* Returns the function of the cell at x, mm. Every bit is the same as in POV-Ray. */
double cell_function(const CellTree *cells, const Cell *cell, Vec3 x);
/* Returns the index in geometry->segments of the segment with the largest term at x, in the group
 * with the largest sum. On a tie, returns the first. */
uint32_t cell_largest_term(const CellTree *cells, const Cell *cell, Vec3 x);
/* Returns the weighted mean of values at x, as termmean_at [termmean.h] does, but from the terms of
 * the cell alone and with the operations of POV-Ray. Returns NAN in the cases of termmean_at.
 *
 * segments  geometry->segments.
 * values    value of segment i: values[segments[i].segment]. */
double cell_mean(const CellTree *cells, const Cell *cell, const FieldSegment *segments,
                 const double *values, Vec3 x);

#endif
