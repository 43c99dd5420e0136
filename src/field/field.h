/* The door of the room surface: the implicit potential of a scene.
 *
 * Phi(x) = sum_i exp(-d_i^2 / (2 s_i^2)) (erf((l_i - t_i) / (sqrt2 s_i)) + erf(t_i / (sqrt2 s_i)))
 * / 2, s_i = radius / 2 [Neumann et al. eq. 4-6; docs/METHODS.md section 2]; the surface is Phi =
 * FIELD_LEVEL. */
#ifndef CORCAST_FIELD_FIELD_H
#define CORCAST_FIELD_FIELD_H

#include "base/base.h"
#include "field/blob.h"        // IWYU pragma: export
#include "field/blobroots.h"   // IWYU pragma: export
#include "field/cells.h"       // IWYU pragma: export
#include "field/fieldindex.h"  // IWYU pragma: export
#include "field/localgroups.h" // IWYU pragma: export
#include "field/termmean.h"    // IWYU pragma: export
#include "geom/geom.h"
#include "scene/scene.h"

/* 1 / (sqrt2 s), 1/mm: with lengths in units of 1 / k a term is exp(-E^2) (erf u + erf v) / 2, E
 * the distance from the axis line, u and v how far x is inside either end. */
static inline double potential_k(double radius_mm)
{
    return sqrt(2) / radius_mm;
}

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

/* Terms below these are left out: n of them, below eps each, move the surface of a lone vessel by
 * at most n eps r / (4 FIELD_LEVEL). CELL: of a cell of POV-Ray's scene, a segment whose term is
 * below it all over the cell. TILE: of a tile or packet of rays in single precision, a segment
 * whose term is below it on all of them. Which terms a cell drops and which a tile does is not the
 * same set. RAY: of a ray in double precision; the surface that is called exact. */
#define CELL_TERM_CUTOFF 1e-6
#define TILE_TERM_CUTOFF 1e-6
#define RAY_TERM_CUTOFF 1e-9

/* The log form of the potential that POV-Ray traces: sqrt(-2 ln clamp(phi, LOG_FORM_FLOOR,
 * LOG_FORM_CEILING)) - 2, zero on the surface, (distance - 2 s) / s about a lone vessel. Where the
 * potential is below the floor the terms that were dropped begin to weigh as much as those that
 * were kept; above the ceiling nothing is seen, and the form would only grow steep. */
#define LOG_FORM_FLOOR 1e-5
#define LOG_FORM_CEILING 0.2
double potential_log_form(double phi);

/* How many segments have no surface about them: half way along the segment the sum of all terms, or
 * of those of each of its groups, is below the level. STATUS_MEMORY. */
MUST_CHECK Status surface_count_hidden(const Geometry *geometry, size_t *count, Err *err);

/* What a picture knows of each pixel, rows from the top; borrowed. */
typedef struct SurfaceSight {
    const float *depth;  /* mm along the ray; INFINITY where nothing is seen */
    const float *normal; /* 3 a pixel, unit */
    const uint32_t *ids; /* of segments of the geometry, where something is seen */
} SurfaceSight;

/* Fills allowed[pixel], mm, with how far apart along the ray two sights through a camera may be:
 * `seen`, what POV-Ray's root finder sees of the geometry in cells with this form of erf, and
 * `exact`, where the surface is. 0 where neither sees anything, HUGE_VAL where the ray grazes what
 * either sees. STATUS_MEMORY. */
MUST_CHECK Status surface_tolerance(const Geometry *geometry, const Camera *camera, ErfForm erf,
                                    const SurfaceSight *seen, const SurfaceSight *exact,
                                    float *allowed, Err *err);

#endif
