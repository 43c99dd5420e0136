/* An approximation of the potential by POV-Ray's `blob`, whose fields are quartic polynomials.
 * Exported by the public header of the module field.
 *
 * A component of radius R and strength S adds S (1 - d^2 / R^2)^2 at a point whose distance d from
 * the component's segment, or from a sphere's centre, is below R. The surface is where the sum is 1
 * [shape/blob.cpp of POV-Ray 3.7.0.10; docs/POVRAY.md section 9].
 *
 * A vessel segment consists of BLOB_COMPONENTS components [docs/METHODS.md section 2.6]. Tubes run
 * along it. At each end, each tube has a sphere of minus half the tube's strength. Pairs of small
 * spheres, called beads, are on the axis: one inside the end, one equally far beyond it, of
 * opposite strengths. In a chain of segments of one radius, the spheres and beads at the end of one
 * segment are cancelled by those of the next, for any numbers. */
#ifndef CORCAST_FIELD_BLOB_H
#define CORCAST_FIELD_BLOB_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

enum {
    BLOB_TUBES = 2,
    BLOB_BEADS = 2,
    BLOB_COMPONENTS = 3 * BLOB_TUBES + 4 * BLOB_BEADS,
    /* POV-Ray counts a tube as three components: its body and two hemispheres. */
    BLOB_POVRAY_COMPONENTS = BLOB_COMPONENTS + 2 * BLOB_TUBES,
    BLOB_POVRAY_LIMIT = 1000000 /* one blob of POV-Ray has fewer components than this */
};

/* One tube of a segment. Its radius is in units of the vessel's radius. */
typedef struct BlobTube {
    double radius, strength;
} BlobTube;

/* A pair of beads at each end of a segment. Lengths are in units of the vessel's radius. */
typedef struct BlobBead {
    double offset; /* distance of the inner bead from the end, inwards; the opposite bead is equally
                    * far beyond the end */
    double radius, strength;
} BlobBead;

/* The shape of a segment: which tubes and beads it has. */
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
/* Returns a ball, in mm, outside which the field of a segment with the shape blob_shape is 0. */
Ball blob_ball(const FieldSegment *segment);

/* A tube or a sphere of a segment. */
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

/* Fills the components of a segment: BLOB_TUBES tubes, then spheres. The segment's ends must
 * differ. */
void blob_components(const BlobShape *shape, const FieldSegment *segment,
                     BlobComponent components[BLOB_COMPONENTS]);

/* Returns the sum of the components of one segment at x, and sets *gradient to its gradient,
 * 1/mm. */
double blob_components_at(const BlobComponent components[BLOB_COMPONENTS], Vec3 x, Vec3 *gradient);

/* Returns the field at x of one segment with the shape blob_shape. */
double blob_term(const FieldSegment *segment, Vec3 x);

/* Maximum number of roots that blob_roots finds. */
enum { BLOB_ROOTS = 16 };

/* The first roots along a ray. */
typedef struct BlobRoots {
    int n;                /* number of roots in t */
    double t[BLOB_ROOTS]; /* parameters along the ray, mm, rising. The error is 1e-12 of the
                           * smallest radius near the ray, plus the rounding of the double. */
    bool sure;            /* no root is missing in the interval; if n is BLOB_ROOTS, none before the
                           * last */
} BlobRoots;

/* Finds the first roots in (t_min, t_max): points where the field of the blob of all segments
 * crosses 1 along the ray, in either direction. This is the reference when the root finders of two
 * renderers disagree: it halves intervals in long double, and uses no acceleration.
 *
 * ray      its direction must be a unit vector.
 * roots    receives the roots; owns nothing.
 * Errors   STATUS_MEMORY.
 * Cost     O(n) for n segments. */
MUST_CHECK Status blob_roots(const FieldSegment *segments, size_t n, Ray ray, double t_min,
                             double t_max, BlobRoots *roots, Err *err);

#endif
