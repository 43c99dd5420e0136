/* The shape of vessels: primitives (cylinders, spheres, joints), the segments of an implicit field,
 * or a mesh of triangles. Coordinates are right-handed and in mm.
 *
 * A segment has the index of the node at which it ends, as in the fields of the tree. The same
 * index therefore means the same segment in every model of a tree and in its Appearance. Some
 * indices have no segment: those of roots, and those of segments that cannot be drawn. */
#ifndef CORCAST_SCENE_GEOMETRY_H
#define CORCAST_SCENE_GEOMETRY_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/models.h"
#include "scene/triangles.h"
#include <stdint.h>

/* The largest coordinate. POV-Ray ignores hits that are farther than this along a ray
 * (MAX_DISTANCE). */
#define SCENE_FARTHEST_MM 1e7

typedef enum PrimitiveKind { PRIMITIVE_CYLINDER, PRIMITIVE_SPHERE, PRIMITIVE_JOINT } PrimitiveKind;

/* A closed cylinder from a to b, a sphere around a, or the ruled surface between two circles around
 * a and b [geom/joint.h]. */
typedef struct Primitive {
    PrimitiveKind kind : 8;
    bool round_a, round_b;       /* cylinder: a ball covers its end at a, b */
    bool free_a : 1, free_b : 1; /* cylinder: its end at a, b is flat and touches no other vessel */
    uint32_t segment;            /* index of its segment */
    Vec3 a, b;
    double radius_mm;   /* > 0; joint: radius at a */
    double radius_b_mm; /* joint only: radius at b, > 0 */
    const Vec3 *axes;   /* joint only: unit normals of the circles at a and b, both pointing from a
                         * towards b; borrowed from the geometry */
} Primitive;

/* Prepares a joint for many rays. `primitive` must be a PRIMITIVE_JOINT. */
JointFrame primitive_joint(const Primitive *primitive);

/* Returns the radius at b of any primitive. */
static inline double primitive_radius_b(const Primitive *primitive)
{
    return primitive->kind == PRIMITIVE_JOINT ? primitive->radius_b_mm : primitive->radius_mm;
}

/* A primitive prepared for many rays. A sphere needs nothing. */
typedef union PrimitiveFrame {
    CylinderFrame cylinder;
    JointFrame joint;
} PrimitiveFrame;

/* Prepares a primitive for primitive_hits. The frame of a joint borrows its axes. */
PrimitiveFrame primitive_frame(const Primitive *primitive);

/* Finds all intersections of the line of the ray with the primitive, in any order. Ignores round
 * ends. Returns their number. */
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

/* A Gaussian line potential, or its approximation in a blob [METHODS section 2]. */
typedef struct FieldSegment {
    Vec3 a, b;        /* different */
    double radius_mm; /* > 0 */
    uint32_t segment; /* index of its segment */
} FieldSegment;

/* e^-2: the level set of a long segment at this level is a cylinder of the segment's radius. */
#define FIELD_LEVEL 0.13533528323661270

/* The groups of field segments that blend. The solid is the union, over all groups, of the sets
 * where the sum of the group's terms exceeds FIELD_LEVEL. No group is a subset of another. If there
 * are no groups, all segments blend: the solid is the set where the sum of all terms exceeds
 * FIELD_LEVEL. */
typedef struct Blend {
    size_t n_groups;
    IndexLists members; /* per group: positions in Geometry.segments */
    IndexLists groups;  /* per field segment: the groups that hold it, at least one */
} Blend;

/* Immutable once made [stage_geometry]. All arrays are owned. */
typedef struct Geometry {
    SceneModel model;
    Primitive *primitives; /* empty for a model of a field or of triangles */
    size_t n_primitives;
    size_t n_ends;     /* the last n_ends primitives are spheres at an end of a cylinder, with the
                        * cylinder's radius and segment */
    bool implied_ends; /* the spheres at ends are left out: only round_a and round_b record them */
    Vec3 *axes;        /* two per joint [Primitive.axes] */
    FieldSegment *segments; /* empty for a model of primitives */
    size_t n_segments;
    Blend blend;
    VesselMesh mesh;  /* for a model of triangles: the surface of the segments; its labels are
                       * positions in `segments` */
    bool open_joints; /* rays may hit the inside of a joint whose discs are not covered */
    uint32_t *ids;    /* per segment index: SWC id, > 0 if the segment is drawn */
    size_t n_ids;
    size_t drawn; /* number of segments of the tree that the geometry represents */
    Box bounds;   /* holds everything, including the reach of a field's surface */
    Vec3 origin;  /* position of this geometry's origin in the coordinates of the tree */
} Geometry;

/* Frees the arrays and zeroes *geometry. */
void geometry_release(Geometry *geometry);

/* Finds the bounds of primitives and field segments. A field has no spheres at ends. */
void geometry_find_bounds(Geometry *geometry);
/* Copies a geometry of cylinders and spheres for a moment at which vessels beat. Each radius is
 * multiplied by factors[segment index]. A sphere at an end of a cylinder has the same segment index
 * as the cylinder, so both keep equal radii. Release *out with geometry_release. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status geometry_beaten(const Geometry *still, const double *factors, Geometry *out,
                                  Err *err);

/* Returns the segment index of primitive `item`, or of field segment `item` of a model without
 * primitives. */
static inline uint32_t geometry_segment(const Geometry *geometry, size_t item)
{
    return model_has(geometry->model, MODEL_PRIMITIVES) ? geometry->primitives[item].segment
                                                        : geometry->segments[item].segment;
}

/* Copies the primitives of a geometry with implied ends, and adds a sphere for each round end. The
 * *n primitives in *all are owned by the caller. Errors: STATUS_MEMORY. */
MUST_CHECK Status geometry_with_ends(const Geometry *geometry, Primitive **all, size_t *n,
                                     Err *err);

/* Copies some field segments of a geometry. `indices` holds n rising positions in whole->segments.
 * The groups of the part are those of the whole, without segments that are not in the part. The
 * part has neither primitives nor ids. Release *part with geometry_release. Errors: STATUS_MEMORY.
 * O(n log n) if few segments blend. */
MUST_CHECK Status geometry_part(const Geometry *whole, const uint32_t *indices, size_t n,
                                Geometry *part, Err *err);

typedef struct Ball {
    Vec3 center;
    double radius;
} Ball;

/* The balls around the two ends of every primitive and field segment: item i has the balls 2 i and
 * 2 i + 1. The convex hulls of these pairs contain the whole geometry. An implicit surface extends
 * beyond its segments by 0.551 r at free ends and by less than r where vessels meet; its balls
 * therefore have twice the radius. geometry_balls returns the number of balls; geometry_ball
 * returns ball `number`, 0 <= number < geometry_balls. */
size_t geometry_balls(const Geometry *geometry);
Ball geometry_ball(const Geometry *geometry, size_t number);

/* Checks that every number is finite, that radii are positive and that everything lies within
 * SCENE_FARTHEST_MM of the origin. Errors: STATUS_INPUT, which names the segment's id. */
MUST_CHECK Status geometry_check(const Geometry *geometry, Err *err);

#endif
