/* The blob that stands for the potential in POV-Ray's `blob`, whose fields are quartics. Exported
 * by the module's public header.
 *
 * A component of radius R and strength S adds S (1 - d^2 / R^2)^2 at a point whose distance d from
 * the component's segment, or from a sphere's centre, is below R. The surface is where the sum is 1
 * [shape/blob.cpp of POV-Ray 3.7.0.10; docs/POVRAY.md section 9].
 *
 * A vessel segment consists of a few components [docs/METHODS.md section 2.6]: tubes along it; at
 * each end, for each tube, a sphere of minus half its strength; and pairs of beads on the axis, one
 * inside the end and one equally far beyond it, of opposite strengths. In a chain of one radius,
 * the components at the end of one segment are cancelled by those of the next, for any numbers. */
#ifndef CORCAST_FIELD_BLOB_H
#define CORCAST_FIELD_BLOB_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

enum {
    BLOB_TUBES = 2,
    BLOB_BEADS = 2,
    BLOB_COMPONENTS = 3 * BLOB_TUBES + 4 * BLOB_BEADS,
    /* POV-Ray counts a tube as three: its body and two hemispheres. */
    BLOB_POVRAY_COMPONENTS = BLOB_COMPONENTS + 2 * BLOB_TUBES,
    BLOB_POVRAY_LIMIT = 1000000 /* one blob of POV-Ray has fewer components than this */
};

/* Lengths are in units of the vessel's radius. */
typedef struct BlobTube {
    double radius, strength;
} BlobTube;

typedef struct BlobBead {
    double offset; /* of the bead inside the segment from the end; the opposite bead is as far
                      outside */
    double radius, strength;
} BlobBead;

typedef struct BlobShape {
    BlobTube tube[BLOB_TUBES];
    BlobBead bead[BLOB_BEADS];
} BlobShape;

/* Fitted to the Gaussian line potential over e^-2 by tests/fit/fit_blob.c. */
#define BLOB_SHAPE                                                                                 \
    {                                                                                              \
        .tube = {{1.1909, 2.8305643108357454}, {1.6382, 1.9152}},                                  \
        .bead = {{0.0641, 1.0036, 2.2312}, {0.2403, 1.4344, 0.6311}},                              \
    }
extern const BlobShape blob_shape;

/* Returns the strength of tube[0] for which the surface of a long vessel has the vessel's radius.
 */
double blob_first_strength(const BlobShape *shape);

/* Returns the distance from a segment, in radii, beyond which its field is 0. */
double blob_reach(const BlobShape *shape);
/* Returns a ball that holds the field of a segment with the shape blob_shape. */
Ball blob_ball(const FieldSegment *segment);

typedef struct BlobComponent {
    Vec3 a, b;        /* ends of a tube's axis; a sphere has its centre in both */
    double radius_mm; /* > 0 */
    double strength;  /* not 0 */
} BlobComponent;

/* Returns true if component `index` of blob_components is a tube. */
static inline bool blob_component_is_tube(int index)
{
    return index < BLOB_TUBES;
}

/* Fills the components of a segment, the tubes first. */
void blob_components(const BlobShape *shape, const FieldSegment *segment,
                     BlobComponent components[BLOB_COMPONENTS]);

/* Returns the sum of the components at x, and sets *gradient to its gradient, 1/mm. */
double blob_components_at(const BlobComponent components[BLOB_COMPONENTS], Vec3 x, Vec3 *gradient);

/* Returns the field at x of a segment with the shape blob_shape. */
double blob_term(const FieldSegment *segment, Vec3 x);

enum { BLOB_ROOTS = 16 };

typedef struct BlobRoots {
    int n;
    double t[BLOB_ROOTS]; /* rising; the error is 10^-12 of the smallest radius near the ray, plus
                           * the rounding of the double */
    bool sure; /* there is certainly no other root in the interval, or before the last of BLOB_ROOTS
                */
} BlobRoots;

/* Finds the first places in (t_min, t_max) where the field of the segments' blob crosses 1 along
 * the ray, in either direction. This is the reference when the root finders of two renderers
 * disagree: it halves intervals in long double, and uses no acceleration. Errors: STATUS_MEMORY.
 * O(n). */
MUST_CHECK Status blob_roots(const FieldSegment *segments, size_t n, Ray ray, double t_min,
                             double t_max, BlobRoots *roots, Err *err);

#endif
