/* A Geometry: the shape of vessels, as primitives (cylinders, spheres, joints), as the segments of
 * an implicit surface, or as a mesh of triangles. stage_geometry [stage/stage.h] builds it from a
 * tree. Coordinates are right-handed and in mm.
 *
 * A segment is identified by its segment index: the index of the tree node at which the segment
 * ends. The same index therefore means the same segment in every model of a tree and in its
 * Appearance. Some indices have no segment: the indices of roots, and of segments that cannot be
 * drawn. A smooth tree [stage/smooth.h] divides each segment of the tree into pieces. There, every
 * piece counts as a segment with its own index; all pieces of one segment have its SWC id. */
#ifndef CORCAST_SCENE_GEOMETRY_H
#define CORCAST_SCENE_GEOMETRY_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/models.h"
#include "scene/triangles.h"
#include <stdint.h>

/* The largest absolute value of a coordinate. POV-Ray ignores hits that are farther than this along
 * a ray (its constant MAX_DISTANCE). */
#define SCENE_FARTHEST_MM 1e7

typedef enum PrimitiveKind { PRIMITIVE_CYLINDER, PRIMITIVE_SPHERE, PRIMITIVE_JOINT } PrimitiveKind;

/* A primitive: a cylinder from a to b closed by two discs, a sphere around a, or a joint. A joint
 * is the ruled surface between a circle around a and a circle around b [geom/joint.h]. */
typedef struct Primitive {
    PrimitiveKind kind : 8;
    bool round_a, round_b;       /* cylinder: a sphere covers its end at a, at b */
    bool free_a : 1, free_b : 1; /* cylinder: its end at a, at b is flat and touches no other
                                  * vessel */
    uint32_t segment;            /* segment index */
    Vec3 a, b;
    double radius_mm;   /* > 0; joint: radius at a */
    double radius_b_mm; /* joint only: radius at b, > 0 */
    const Vec3 *axes;   /* joint only: unit normals of the circles at a and b, both pointing from a
                         * towards b; borrowed from the geometry */
} Primitive;

/* Returns the frame of a joint, to be used for many rays. `primitive` must be a PRIMITIVE_JOINT.
 * The frame borrows its axes. */
JointFrame primitive_joint(const Primitive *primitive);

/* Returns the radius at b of any primitive. */
static inline double primitive_radius_b(const Primitive *primitive)
{
    return primitive->kind == PRIMITIVE_JOINT ? primitive->radius_b_mm : primitive->radius_mm;
}

/* The values of a primitive that do not depend on the ray. A sphere has none. */
typedef union PrimitiveFrame {
    CylinderFrame cylinder;
    JointFrame joint;
} PrimitiveFrame;

/* Computes the frame of a primitive, for primitive_hits. The frame of a joint borrows its axes. */
PrimitiveFrame primitive_frame(const Primitive *primitive);

/* Finds all intersections of the infinite line of the ray with the primitive, in any order. A
 * cylinder is intersected with its two discs, even if they are round ends. Returns the number of
 * hits, 0 to 4. */
static inline int primitive_hits(const Primitive *primitive, const PrimitiveFrame *frame, Ray ray,
                                 Hit hits[4])
{
    switch (primitive->kind) {
    case PRIMITIVE_CYLINDER:
        return hit_cylinder(ray, &frame->cylinder, hits);
    case PRIMITIVE_SPHERE:
        return hit_sphere(ray, primitive->a, primitive->radius_mm, hits);
    case PRIMITIVE_JOINT:
        return hit_joint(ray, &frame->joint, hits);
    }
    return 0;
}

/* Returns true if each circle of a joint lies on one side of the other circle's plane. The ruled
 * surface and the two discs then bound a solid; otherwise rulings cross. */
bool primitive_joint_is_solid(const Primitive *joint);

/* One term of an implicit surface: a Gaussian line potential, or the components of a blob that
 * approximate it [METHODS section 2]. */
typedef struct FieldSegment {
    Vec3 a, b;        /* ends of the segment, different */
    double radius_mm; /* > 0 */
    uint32_t segment; /* segment index */
} FieldSegment;

/* The level of the surface, e^-2. At this level, the surface of a long segment is a cylinder of the
 * segment's radius. */
#define FIELD_LEVEL 0.13533528323661270

/* The groups of field segments that blend. The solid is the union, over all groups, of the sets
 * where the sum of the group's terms exceeds FIELD_LEVEL. No group is a subset of another group. If
 * n_groups is 0, all segments form one group. */
typedef struct Blend {
    size_t n_groups;
    IndexLists members; /* per group: indices in Geometry.segments */
    IndexLists groups;  /* per field segment: the groups that contain it, at least one */
} Blend;

/* The shape of the vessels. Does not change after stage_geometry has built it. All arrays are
 * owned. */
typedef struct Geometry {
    SceneModel model;
    Primitive *primitives; /* empty for a model of an implicit surface or of triangles */
    size_t n_primitives;
    size_t n_ends;          /* the last n_ends primitives are spheres at the ends of cylinders; each
                             * has the radius and the segment index of its cylinder */
    bool implied_ends;      /* true: the spheres at the ends of cylinders are not stored; only
                             * round_a and round_b record them */
    Vec3 *axes;             /* two per joint [Primitive.axes] */
    FieldSegment *segments; /* empty for a model of primitives */
    size_t n_segments;
    Blend blend;
    VesselMesh mesh;  /* for a model of triangles: the surface of `segments`; its labels are indices
                       * in `segments` */
    bool open_joints; /* true: a disc of a joint is not covered, so that a ray may hit the inside of
                       * the joint */
    uint32_t *ids;    /* per segment index: SWC id, > 0 if the segment is drawn */
    size_t n_ids;
    size_t drawn; /* number of segments of the tree that the geometry represents */
    Box bounds;   /* contains the whole geometry, including the implicit surface */
    Vec3 origin;  /* position of this geometry's origin in the coordinates of the tree */
} Geometry;

/* Frees the arrays and zeroes *geometry. */
void geometry_release(Geometry *geometry);

/* Sets geometry->bounds from the primitives and field segments. */
void geometry_find_bounds(Geometry *geometry);
/* Copies a geometry of cylinders and spheres, with each radius multiplied by factors[segment
 * index], for one moment of a pulsation. A sphere at an end of a cylinder has the same segment
 * index as the cylinder, so both keep equal radii. Release *out with geometry_release. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status geometry_with_scaled_radii(const Geometry *original, const double *factors,
                                             Geometry *out, Err *err);

/* Returns the segment index of primitive `item`, or, if the model has no primitives, of field
 * segment `item`. */
static inline uint32_t geometry_segment(const Geometry *geometry, size_t item)
{
    return model_has(geometry->model, MODEL_PRIMITIVES) ? geometry->primitives[item].segment
                                                        : geometry->segments[item].segment;
}

/* Copies the primitives of a geometry with implied_ends, and adds a sphere for each round end. Sets
 * *all to the *n primitives, which the caller frees with free(). The axes of joints stay borrowed
 * from `geometry`. Errors: STATUS_MEMORY. */
MUST_CHECK Status geometry_with_ends(const Geometry *geometry, Primitive **all, size_t *n,
                                     Err *err);

/* Copies some field segments of a geometry. `indices` holds n ascending indices in whole->segments.
 * The groups of the part are the groups of the whole, without segments that are not in the part.
 * The part has neither primitives nor ids. Release *part with geometry_release. Errors:
 * STATUS_MEMORY. O(n log n) if few segments blend. */
MUST_CHECK Status geometry_part(const Geometry *whole, const uint32_t *indices, size_t n,
                                Geometry *part, Err *err);

/* Lengths are in mm. */
typedef struct Ball {
    Vec3 center;
    double radius;
} Ball;

/* Balls that bound the geometry. Every primitive and field segment has two balls, around its ends:
 * item i has the balls 2 i and 2 i + 1. The convex hulls of these pairs contain the whole geometry.
 * An implicit surface extends beyond its segments by 0.551 radii at free ends, and by less than one
 * radius where vessels meet; its balls therefore have twice the radius. geometry_balls returns the
 * number of balls; geometry_ball returns ball `number`, 0 <= number < geometry_balls. */
size_t geometry_balls(const Geometry *geometry);
Ball geometry_ball(const Geometry *geometry, size_t number);

/* Checks that every number is finite, that radii are above 0, and that everything is within
 * SCENE_FARTHEST_MM of the origin. Errors: STATUS_INPUT, with the SWC id of the segment. */
MUST_CHECK Status geometry_check(const Geometry *geometry, Err *err);

#endif
