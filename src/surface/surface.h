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
#include "surface/blob.h"      // IWYU pragma: export
#include "surface/blobroots.h" // IWYU pragma: export
#include "surface/cells.h"     // IWYU pragma: export

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
 * potential is below the floor the terms that were dropped begin to weigh as much as those that
 * were kept; above the ceiling nothing is seen, and the form would only grow steep. */
#define LOG_FORM_FLOOR 1e-5
#define LOG_FORM_CEILING 0.2
double potential_log_form(double phi);

#endif
