/* The public header of the module field: the potential of a scene, whose level set is a smooth
 * surface of the vessels.
 *
 * Each segment has a term of the potential: a Gaussian of the distance from the segment's axis, cut
 * off smoothly at both ends. The potential is the sum of the terms. This header has the terms and
 * the constants. The other headers of the module are for these purposes:
 *
 * - fieldindex.h finds the terms that a ray meets.
 * - cells.h represents the surface as POV-Ray's isosurface, and blob.h as POV-Ray's blob.
 * - localgroups.h restricts the sets of segments that blend to few segments.
 * - termmean.h computes means of values of segments, weighted by their terms.
 *
 * For segment i, let l be its length, s half of its radius, d the distance of x from its axis line,
 * and t the distance of x from its first end, along the axis. The potential is
 *
 *    Phi(x) = sum_i exp(-d^2 / (2 s^2)) (erf((l - t) / (sqrt2 s)) + erf(t / (sqrt2 s))) / 2
 *
 * [Neumann et al. eq. 4-6; docs/METHODS.md section 2]. The surface is Phi = FIELD_LEVEL. */
#ifndef CORCAST_FIELD_FIELD_H
#define CORCAST_FIELD_FIELD_H

#include "base/base.h"
#include "field/blob.h"        // IWYU pragma: export
#include "field/cells.h"       // IWYU pragma: export
#include "field/fieldindex.h"  // IWYU pragma: export
#include "field/localgroups.h" // IWYU pragma: export
#include "field/termmean.h"    // IWYU pragma: export
#include "geom/geom.h"
#include "scene/scene.h"

/* Returns k = 1 / (sqrt2 s), 1/mm, for a radius above 0. With lengths in units of 1 / k, a term is
 * exp(-E^2) (erf u + erf v) / 2. E is the distance from the axis line; u and v are the distances
 * from the two ends along the axis, positive towards the segment. */
static inline double potential_k(double radius_mm)
{
    return sqrt(2) / radius_mm;
}

/* Returns the term of a segment at x, mm; the term is in [0, 1]. The absolute error is a few units
 * in the last place of the larger one of the term's two factors, exp and half the sum of erf. The
 * segment's ends must differ. */
double potential_term(const FieldSegment *segment, Vec3 x);
/* Returns the term of a segment at x, and sets *gradient to the term's gradient, 1/mm. */
double potential_term_gradient(const FieldSegment *segment, Vec3 x, Vec3 *gradient);

/* Returns the maximum of the term over all points: erf(l / (2 sqrt2 s)), half way along the
 * segment. */
double potential_term_peak(const FieldSegment *segment);
/* Returns an upper bound of the term in a box: peak exp(-distance^2 / (2 s^2)), where the distance
 * is that between the box and the segment. */
double potential_term_bound(const FieldSegment *segment, Box box);
/* Returns the squared distance between the segment's axis and the box, mm^2. */
double segment_box_distance2(const FieldSegment *segment, const Box *box);

/* Terms below these values are left out. If n terms below eps are left out, the surface of a single
 * vessel of radius r moves by at most n eps r / (4 FIELD_LEVEL).
 *
 * CELL_TERM_CUTOFF  for a cell of POV-Ray's scene [cells.h]: a term is left out if it is below this
 *                   everywhere in the cell.
 * TILE_TERM_CUTOFF  for the rays of an image tile or packet, in single precision: a term is left
 *                   out if it is below this on all rays.
 * RAY_TERM_CUTOFF   for a ray in double precision; the surface that such rays find is called exact.
 */
#define CELL_TERM_CUTOFF 1e-6
#define TILE_TERM_CUTOFF 1e-6
#define RAY_TERM_CUTOFF 1e-9

/* Range to which the log form clamps the potential. Below the floor, the error by terms that were
 * left out is as large as the potential. Values above the ceiling, 1.5 times FIELD_LEVEL, are
 * inside the vessel, where nothing is visible; there the log form would only become steep. */
#define LOG_FORM_FLOOR 1e-5
#define LOG_FORM_CEILING 0.2
/* Returns the log form of the potential, which POV-Ray traces: sqrt(-2 ln phi) - 2, with phi
 * clamped to the range above. The log form is 0 on the surface. Around a single vessel it is
 * (distance from the axis - 2 s) / s. */
double potential_log_form(double phi);

/* Sets *count to the number of segments that the surface does not enclose, and that are therefore
 * missing in a picture. At the middle of such a segment, the potential is below FIELD_LEVEL; if
 * segments blend in groups [localgroups.h], the sum of every group that contains the segment is.
 * Errors: STATUS_MEMORY. */
MUST_CHECK Status surface_count_missing(const Geometry *geometry, size_t *count, Err *err);

/* Depths, normals and ids of an image of the surface. The first row is the top of the image. All
 * arrays are borrowed. */
typedef struct SurfacePlanes {
    const float *depth;  /* per pixel: mm along the ray; INFINITY where nothing is hit */
    const float *normal; /* per pixel: three components of the unit normal */
    const uint32_t *ids; /* per pixel: SWC id of the segment; not read where nothing is hit */
} SurfacePlanes;

/* Computes, per pixel, by how much the depths of two images of one surface may differ. One image is
 * by POV-Ray's root finder, which is inexact; the other is of the exact surface.
 *
 * erf      the form of erf in POV-Ray's cells.
 * povray   the hits of POV-Ray's root finder.
 * exact    the hits on the exact surface.
 * allowed  array of the caller, one entry per pixel. Receives the allowed difference along the ray,
 *          mm: 0 where neither image has a hit; HUGE_VAL where the angle between ray and surface is
 *          below 3 degrees, because such a ray may pass on either side of the surface.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status surface_tolerance(const Geometry *geometry, const Camera *camera, ErfForm erf,
                                    const SurfacePlanes *povray, const SurfacePlanes *exact,
                                    float *allowed, Err *err);

#endif
