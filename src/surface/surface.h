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

/* One term of the potential at x, in [0, 1). */
double potential_term(const FieldSegment *segment, Vec3 x);
/* The same term, and its gradient (1/mm) in *gradient. */
double potential_term_gradient(const FieldSegment *segment, Vec3 x, Vec3 *gradient);

/* An upper bound of the term anywhere in a box: exp(-dist^2 / (2 s^2)), dist from the box to the
 * segment. */
double potential_term_bound(const FieldSegment *segment, Box box);

/* Terms below this are dropped: a cell or a ray leaves out segments whose term is below it all
 * over, and n of them move the surface of a lone vessel by at most n TERM_CUTOFF r / (4
 * FIELD_LEVEL). */
#define TERM_CUTOFF 1e-6

/* Cubes that cover the surface, each with the few terms that matter in it, for POV-Ray's isosurface
 * object [docs/POVRAY.md]. */
typedef struct Cell {
    Vec3 low;
    double side;
    uint32_t first, count; /* its terms: term[first .. first + count) */
    double scale;        /* smallest s of its terms, mm; the cell's function is scale * log form */
    double max_gradient; /* bound of that function's gradient in the cell, proven or sampled */
    double accuracy;     /* mm: smallest radius in the cell / 300 */
} Cell;

typedef struct CellTree {
    Cell *cells;
    size_t n_cells;
    uint32_t *terms; /* indices into scene->segments */
    size_t n_terms;
} CellTree;

/* The octree of cells in which the surface can lie: root cells of 4 r_max, split while the side is
 * above beta times the smallest radius that matters in it. */
MUST_CHECK Status celltree_build(const Scene *scene, double beta, CellTree *cells, Err *err);
void celltree_release(CellTree *cells);

/* The log form of the potential that POV-Ray traces: sqrt(-2 ln clamp(phi, 1e-12, 0.6)) - 2, zero
 * on the surface, close to (distance - 2 s) / s about a lone vessel. */
double potential_log_form(double phi);

#endif
