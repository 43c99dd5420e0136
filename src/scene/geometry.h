/* The shape of vessels: primitives or an implicit field, in mm, right-handed.
 *
 * Segments are numbered as the fields of the tree number them, by the node at which they end, so
 * that the same number means the same segment in every model of a tree and in its Appearance. Not
 * every number is that of a segment: roots have none, and some segments cannot be drawn. */
#ifndef CORCAST_SCENE_GEOMETRY_H
#define CORCAST_SCENE_GEOMETRY_H

#include "base/base.h"
#include "geom/geom.h"
#include "scene/models.h"
#include "scene/triangles.h"
#include <stdint.h>

/* No coordinate may be larger: POV-Ray ignores what lies farther than this along a ray
 * (MAX_DISTANCE). */
#define SCENE_FARTHEST_MM 1e7

typedef enum PrimitiveKind { PRIMITIVE_CYLINDER, PRIMITIVE_SPHERE, PRIMITIVE_JOINT } PrimitiveKind;

/* A closed cylinder from a to b, a sphere about a, or the ruled surface between two circles about a
 * and b [geom/joint.h]. */
typedef struct Primitive {
    PrimitiveKind kind : 8;
    bool round_a, round_b;       /* of a cylinder: whether it has a round end about a, b */
    bool free_a : 1, free_b : 1; /* of a cylinder: whether its end at a, b is flat and meets none */
    uint32_t segment;            /* number of the segment that it stands for */
    Vec3 a, b;
    double radius_mm; /* > 0; of a joint, at a */
    /* Of a joint alone: the radius at b, > 0, and the unit axes across which the circles about a
     * and b lie, both leading from a on to b (borrowed from the geometry). */
    double radius_b_mm;
    const Vec3 *axes;
} Primitive;

/* A primitive that is a joint, prepared for many rays. */
JointFrame primitive_joint(const Primitive *primitive);

/* The radius at b of any primitive. */
static inline double primitive_radius_b(const Primitive *primitive)
{
    return primitive->kind == PRIMITIVE_JOINT ? primitive->radius_b_mm : primitive->radius_mm;
}

/* What rays are tested against for a primitive, made once for many; of a sphere nothing. */
typedef union PrimitiveFrame {
    CylinderFrame cylinder;
    JointFrame joint;
} PrimitiveFrame;

PrimitiveFrame primitive_frame(const Primitive *primitive);

/* All crossings of the line with the primitive, round ends left aside, in no order: how many. */
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

/* Whether each circle of a joint lies on one side of the other's plane, so that its wall and its
 * two discs bound a solid. Else rulings cross. */
bool primitive_joint_is_solid(const Primitive *joint);

/* One Gaussian line potential, or what stands in for it in a blob; METHODS section 2. */
typedef struct FieldSegment {
    Vec3 a, b;        /* different */
    double radius_mm; /* > 0 */
    uint32_t segment; /* number of the segment */
} FieldSegment;

/* e^-2, the level at which a long segment has its own radius. */
#define FIELD_LEVEL 0.13533528323661270

/* Which field segments blend. The solid is the union, over groups of them, of the sets where the
 * sum of the group's terms exceeds FIELD_LEVEL; no group holds all of another [scene/blend.h].
 * Where there is no group, all segments are one: the solid is the set where the sum of all terms
 * exceeds it. */
typedef struct Blend {
    size_t n_groups;
    IndexLists members; /* of each group: indices of Geometry.segments */
    IndexLists groups;  /* of each segment: the groups that it is a member of, one at least */
} Blend;

/* Constant once made [stage_geometry]. */
typedef struct Geometry {
    SceneModel model;
    Primitive *primitives; /* owned; empty for an implicit model */
    size_t n_primitives;
    /* The last n_ends primitives are spheres about an end of a cylinder, with its radius and
     * segment. */
    size_t n_ends;
    bool implied_ends;      /* there is none, and round_a and round_b alone tell of them */
    Vec3 *axes;             /* owned; of the primitives that are joints */
    FieldSegment *segments; /* owned; empty for a primitive model */
    size_t n_segments;
    Blend blend;
    VesselMesh mesh;  /* the wall of the segments, its labels their indices; empty but for a model
                       * of triangles */
    bool open_joints; /* rays may see the inside of a joint, where its discs are not covered */
    uint32_t *ids;    /* owned; SWC id of each segment, by its number; > 0 where it is drawn */
    size_t n_ids;
    size_t drawn; /* vessel segments that the geometry stands for */
    Box bounds;   /* of all of it; of a field widened by what the surface reaches beyond */
    Vec3 origin;  /* where the origin of all of this lies in the coordinates of the tree */
} Geometry;

void geometry_release(Geometry *geometry);

/* All primitives of a geometry with implied ends, those, too, in *all (owned), *n of them. */
MUST_CHECK Status geometry_with_ends(const Geometry *geometry, Primitive **all, size_t *n,
                                     Err *err);

/* Some field segments of a geometry, by rising index, as one of their own: *part (owned) has them,
 * numbered anew, and the groups that they blend in, without the segments that are not in the part;
 * of the rest what the whole has, but no primitives and no ids. O(n log n), where few segments
 * blend. */
MUST_CHECK Status geometry_part(const Geometry *whole, const uint32_t *indices, size_t n,
                                Geometry *part, Err *err);

typedef struct Ball {
    Vec3 center;
    double radius;
} Ball;

/* The balls about the two ends of every primitive and segment: numbers 0 to geometry_balls - 1.
 * Nothing lies outside all the convex hulls of a pair. The implicit surface reaches beyond its
 * segments by 0.551 r at free ends and by less than r where vessels meet, so that its balls have
 * twice the radius. */
size_t geometry_balls(const Geometry *geometry);
Ball geometry_ball(const Geometry *geometry, size_t number);

/* STATUS_INPUT unless every number is finite, radii are positive and everything lies within
 * SCENE_FARTHEST_MM of the origin, naming the id of the segment. */
MUST_CHECK Status geometry_check(const Geometry *geometry, Err *err);

#endif
