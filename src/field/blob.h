/* Approximates the potential [field.h] by POV-Ray's `blob`, whose field is a sum of quartic
 * polynomials. blob_components makes the components of a vessel segment, and blob_components_at
 * evaluates their field. Exported by the public header of the module field.
 *
 * A component is a tube with hemispherical ends, or a sphere. A component of radius R and strength
 * S adds S (1 - d^2 / R^2)^2 to the field at a point whose distance d, from the tube's axis or from
 * the sphere's centre, is below R. The surface is where the field is 1 [shape/blob.cpp of POV-Ray
 * 3.7.0.10; docs/POVRAY.md section 9].
 *
 * A vessel segment has BLOB_COMPONENTS components [docs/METHODS.md section 2.6]:
 *
 * - BLOB_TUBES tubes along the segment;
 * - per tube and end, a sphere at the end with the tube's radius and minus half its strength;
 * - per end, BLOB_BEAD_PAIRS pairs of small spheres on the axis, called beads. The bead inside the
 *   segment has a strength s, and the bead at the same distance beyond the end has -s.
 *
 * Where two segments of one radius follow each other in a straight line, the two spheres of a tube
 * cancel the overlapping hemispheres of the tubes, and the beads of both segments cancel each
 * other. */
#ifndef CORCAST_FIELD_BLOB_H
#define CORCAST_FIELD_BLOB_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

enum {
    BLOB_TUBES = 2,
    BLOB_BEAD_PAIRS = 2,
    BLOB_COMPONENTS = 3 * BLOB_TUBES + 4 * BLOB_BEAD_PAIRS,
    /* POV-Ray counts a tube as three components: its body and two hemispheres. */
    BLOB_POVRAY_COMPONENTS = BLOB_COMPONENTS + 2 * BLOB_TUBES,
    BLOB_POVRAY_LIMIT = 1000000 /* a blob of POV-Ray must have fewer components than this */
};

/* One tube of a segment. Its radius is in units of the vessel's radius. */
typedef struct BlobTube {
    double radius, strength;
} BlobTube;

/* A pair of beads at each end of a segment. Lengths are in units of the vessel's radius. */
typedef struct BlobBead {
    double offset;           /* distance of either bead from the end */
    double radius, strength; /* of the bead inside the segment; the bead beyond the end has the
                              * strength -strength */
} BlobBead;

/* The tubes and beads of a segment. */
typedef struct BlobShape {
    BlobTube tube[BLOB_TUBES];
    BlobBead bead[BLOB_BEAD_PAIRS];
} BlobShape;

/* The initialiser of blob_shape, for sources that need its numbers as constants.
 * tests/fit/fit_blob.c fitted them to the potential divided by its value on the surface, e^-2. The
 * strength of tube[0] is not fitted: blob_first_strength computes it from the other numbers. */
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
/* Returns a ball (centre and radius in mm) outside which the field of a segment with the shape
 * blob_shape is 0. */
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

/* Returns the field of the components of one segment at x, mm, and sets *gradient to the gradient
 * of this field, 1/mm. */
double blob_components_at(const BlobComponent components[BLOB_COMPONENTS], Vec3 x, Vec3 *gradient);

/* Returns the field at x, mm, of one segment with the shape blob_shape. */
double blob_segment_value(const FieldSegment *segment, Vec3 x);

/* Maximum number of roots that blob_roots returns. Reason for 16 not recorded. */
enum { BLOB_ROOTS = 16 };

/* The first roots along a ray. */
typedef struct BlobRoots {
    int n;                /* number of roots in t */
    double t[BLOB_ROOTS]; /* distances along the ray, mm, ascending. Error: at most 1e-12 times the
                           * smallest radius among the components that the ray meets, plus rounding
                           * to double */
    bool is_complete;     /* true: no root is missing in the interval or, if n is BLOB_ROOTS, before
                           * the last root. false: the ray may touch the surface, where two roots
                           * are too close to be told from none */
} BlobRoots;

/* Finds the first roots in (t_min, t_max): points at which the field of all segments crosses 1
 * along the ray, in either direction. This function is the reference where the root finders of two
 * renderers disagree: it bisects intervals in long double, and uses no acceleration structure.
 *
 * segments  n segments with the shape blob_shape; n may be 0.
 * ray      its direction must be a unit vector.
 * roots    receives the roots.
 * Errors   STATUS_MEMORY.
 * Cost     O(n) for n segments. */
MUST_CHECK Status blob_roots(const FieldSegment *segments, size_t n, Ray ray, double t_min,
                             double t_max, BlobRoots *roots, Err *err);

#endif
