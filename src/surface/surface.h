/* The door of the room surface: the implicit potential of a scene.
 *
 * Phi(x) = sum_i exp(-d_i^2 / (2 s_i^2)) (erf((l_i - t_i) / (sqrt2 s_i)) + erf(t_i / (sqrt2 s_i)))
 * / 2, s_i = radius / 2 [Neumann et al. eq. 4-6; docs/METHODS.md section 2]; the surface is Phi =
 * FIELD_LEVEL. */
#ifndef CORCAST_SURFACE_SURFACE_H
#define CORCAST_SURFACE_SURFACE_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

/* One term of the potential at x, in [0, 1], to a few units of the last place of its largest
 * factor, tails included. */
double potential_term(const FieldSegment *segment, Vec3 x);
/* The same term, and its gradient (1/mm) in *gradient. */
double potential_term_gradient(const FieldSegment *segment, Vec3 x, Vec3 *gradient);

/* The largest value of the term anywhere, erf(l / (2 sqrt2 s)): half way along the segment. */
double potential_term_peak(const FieldSegment *segment);
/* An upper bound of the term anywhere in a box: peak exp(-dist^2 / (2 s^2)), dist from the box to
 * the segment. */
double potential_term_bound(const FieldSegment *segment, Box box);

/* Terms below this are dropped: a cell leaves out segments whose term is below it all over, and n
 * of them move the surface of a lone vessel by at most n TERM_CUTOFF r / (4 FIELD_LEVEL). */
#define TERM_CUTOFF 1e-6

/* The log form of the potential that POV-Ray traces: sqrt(-2 ln clamp(phi, LOG_FORM_FLOOR,
 * LOG_FORM_CEILING)) - 2, zero on the surface, (distance - 2 s) / s about a lone vessel. Where the
 * potential is below the floor the terms that were dropped weigh as much as those that were kept;
 * above the ceiling nothing is seen, and the form would only grow steep. */
#define LOG_FORM_FLOOR 1e-6
#define LOG_FORM_CEILING 0.2
double potential_log_form(double phi);

/* Cubes that cover the surface, each with the few terms that matter in it, for POV-Ray's isosurface
 * object [docs/POVRAY.md]. What is said of a cell holds up to CELL_OVERLAP * accuracy outside it
 * too, so that containers may overlap by that much and leave no seam. */
typedef struct Cell {
    Vec3 low;
    double side;
    uint32_t first, count; /* its terms: terms[first .. first + count), by rising index */
    double scale;        /* smallest s of its terms, mm; the cell's function is scale * log form */
    double max_gradient; /* proven bound of that function's gradient in the cell; covers the erf
                          * approximated by tanh(1.129663422 x + 0.09980966638 x^3) too */
    double accuracy;     /* mm: 1/300 of the smallest radius whose term exceeds 1e-2 in the cell */
} Cell;

#define CELL_OVERLAP 5

typedef struct CellTree {
    Cell *cells;
    size_t n_cells;
    uint32_t *terms; /* indices into scene->segments */
    size_t n_terms;
} CellTree;

/* The octree of cells in which the surface can lie: root cells of 4 r_max on the lattice of their
 * multiples, split while the side is above beta (> 0) times the smallest radius that matters in it,
 * in Morton order. Owned by the caller. STATUS_INFEASIBLE beyond a million cells. */
MUST_CHECK Status celltree_build(const Scene *scene, double beta, CellTree *cells, Err *err);
void celltree_release(CellTree *cells);

#endif
