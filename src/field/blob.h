/* The blob: what stands in for the potential in POV-Ray's `blob`, whose fields are quartics.
 * Exported by the room's door.
 *
 * At x, a component of radius R and strength S adds S (1 - d^2 / R^2)^2, d < R being the distance
 * of x from its segment, a sphere's from its centre; the surface is where the sum is 1
 * [shape/blob.cpp of POV-Ray 3.7.0.10; docs/POVRAY.md section 9]. A vessel segment is a few
 * components [docs/METHODS.md section 2.6]: tubes along it; at each end, for each tube, a sphere of
 * minus half its strength; and pairs of beads on the axis, as far within the end as beyond it, of
 * opposite strengths. In a chain of one radius what stands at the end of one segment is cancelled
 * by the next, whatever the numbers. */
#ifndef CORCAST_FIELD_BLOB_H
#define CORCAST_FIELD_BLOB_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/scene.h"

enum {
    BLOB_TUBES = 2,
    BLOB_BEADS = 2,
    BLOB_COMPONENTS = 3 * BLOB_TUBES + 4 * BLOB_BEADS,
    /* As POV-Ray counts: a tube's body and its two halves of a ball are three. */
    BLOB_POVRAY_COMPONENTS = BLOB_COMPONENTS + 2 * BLOB_TUBES,
    BLOB_POVRAY_LIMIT = 1000000 /* POV-Ray draws fewer than this in one blob */
};

/* Lengths over the vessel's radius. */
typedef struct BlobTube {
    double radius, strength;
} BlobTube;

typedef struct BlobBead {
    double offset; /* from the end, inwards; its opposite stands as far outwards */
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

/* The strength that tube[0] must have for a long vessel to have its own radius. */
double blob_first_strength(const BlobShape *shape);

/* The field of a segment is 0 beyond this many of its radii from it. */
double blob_reach(const BlobShape *shape);
/* A ball that holds all of the field of a segment by blob_shape. */
Ball blob_ball(const FieldSegment *segment);

typedef struct BlobComponent {
    Vec3 a, b;        /* ends of a tube's axis; of a sphere, both its centre */
    double radius_mm; /* > 0 */
    double strength;  /* not 0 */
} BlobComponent;

static inline bool blob_component_is_tube(int number)
{
    return number < BLOB_TUBES;
}

/* The components of a segment: the tubes first. */
void blob_components(const BlobShape *shape, const FieldSegment *segment,
                     BlobComponent components[BLOB_COMPONENTS]);

/* The sum over the components at x, and its gradient (1/mm). */
double blob_components_at(const BlobComponent components[BLOB_COMPONENTS], Vec3 x, Vec3 *gradient);

/* The same of a segment by blob_shape. */
double blob_term(const FieldSegment *segment, Vec3 x);

#endif
