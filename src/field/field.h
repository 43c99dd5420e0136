/* The public header of the module field: the implicit potential of a scene.
 *
 * Each segment has a term of the potential: a Gaussian across the segment's axis, cut off smoothly
 * at both ends. The surface of the vessels is a level set of the sum of the terms. This header has
 * the terms and the constants. Other headers of the module prepare them for rays [fieldindex.h],
 * for POV-Ray's isosurface [cells.h] and blob [blob.h], restrict blend groups to few segments
 * [localgroups.h], and mix values of segments [termmean.h].
 *
 * Phi(x) = sum_i exp(-d_i^2 / (2 s_i^2)) (erf((l_i - t_i) / (sqrt2 s_i)) + erf(t_i / (sqrt2 s_i)))
 * / 2, with s_i = radius / 2, the segment's length l_i, the distance d_i of x from its axis line,
 * and the distance t_i of x from its first end along the axis [Neumann et al. eq. 4-6;
 * docs/METHODS.md section 2]. The surface is Phi = FIELD_LEVEL. */
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

/* Returns k = 1 / (sqrt2 s), 1/mm. With lengths in units of 1 / k a term is exp(-E^2) (erf u + erf
 * v) / 2. E is the distance from the axis line; u and v are the distances from the two ends,
 * positive inwards. */
static inline double potential_k(double radius_mm)
{
    return sqrt(2) / radius_mm;
}

/* Returns the term of a segment at x, in [0, 1]. The error is a few units in the last place of the
 * term's larger factor, also far from the segment. The segment's ends must differ. */
double potential_term(const FieldSegment *segment, Vec3 x);
/* Returns the term of a segment at x, and sets *gradient to the term's gradient, 1/mm. */
double potential_term_gradient(const FieldSegment *segment, Vec3 x, Vec3 *gradient);

/* Returns the maximum of the term over all points: erf(l / (2 sqrt2 s)), half way along the
 * segment. */
double potential_term_peak(const FieldSegment *segment);
/* Returns an upper bound of the term in a box: peak exp(-dist^2 / (2 s^2)), with the distance of
 * the box from the segment. */
double potential_term_bound(const FieldSegment *segment, Box box);
/* Returns the squared distance between the segment's axis and the box, mm^2. */
double segment_box_distance2(const FieldSegment *segment, const Box *box);

/* Terms below these values are left out. If n terms below eps are left out, the surface of a lone
 * vessel moves by at most n eps r / (4 FIELD_LEVEL).
 *
 * A cell of POV-Ray's scene leaves out a segment if the segment's term is below CELL_TERM_CUTOFF
 * everywhere in the cell. A tile or packet leaves out a segment if its term is below
 * TILE_TERM_CUTOFF, in single precision, on all rays. A ray in double precision uses
 * RAY_TERM_CUTOFF; the surface that it finds is called exact. */
#define CELL_TERM_CUTOFF 1e-6
#define TILE_TERM_CUTOFF 1e-6
#define RAY_TERM_CUTOFF 1e-9

/* Range of the potential in the log form. Below the floor, the terms that were left out matter as
 * much as those that were not. Above the ceiling nothing is visible, and the form would only become
 * steep. */
#define LOG_FORM_FLOOR 1e-5
#define LOG_FORM_CEILING 0.2
/* Returns the log form of the potential, which POV-Ray traces: sqrt(-2 ln phi) - 2, with phi
 * clamped to the range above. It is 0 on the surface, and (distance - 2 s) / s about a lone vessel.
 */
double potential_log_form(double phi);

/* Sets *count to the number of segments that have no surface about them: half way along the segment
 * the sum of all terms, or of the terms of each of its groups, is below FIELD_LEVEL. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status surface_count_hidden(const Geometry *geometry, size_t *count, Err *err);

/* Depths, normals and ids of a picture of the surface, rows from the top. All arrays are
 * borrowed. */
typedef struct SurfacePlanes {
    const float *depth;  /* per pixel: mm along the ray; INFINITY where nothing is hit */
    const float *normal; /* per pixel: three components of the unit normal */
    const uint32_t *ids; /* per pixel: SWC id of the segment; not read where nothing is hit */
} SurfacePlanes;

/* Computes how far apart the depths of two pictures of one surface may be: a picture by POV-Ray's
 * root finder, and a picture of the exact surface.
 *
 * erf      the form of erf in POV-Ray's cells.
 * seen     the hits of POV-Ray's root finder.
 * exact    the hits on the exact surface.
 * allowed  receives, per pixel, the maximum difference along the ray, mm: 0 where neither picture
 *          has a hit, HUGE_VAL where the ray grazes a surface. The caller owns the array.
 * Errors   STATUS_MEMORY. */
MUST_CHECK Status surface_tolerance(const Geometry *geometry, const Camera *camera, ErfForm erf,
                                    const SurfacePlanes *seen, const SurfacePlanes *exact,
                                    float *allowed, Err *err);

#endif
