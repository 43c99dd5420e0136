/* The door of the room scene: what there is to draw, with no knowledge of trees.
 *
 * The world is right-handed, millimetres, colours linear RGB. A scene is either a list of
 * primitives or an implicit field, built once by `stage` and constant from then on. */
#ifndef CORCAST_SCENE_SCENE_H
#define CORCAST_SCENE_SCENE_H

#include "base/base.h"
#include "geom/geom.h"
#include <stdint.h>

typedef struct Rgb {
    float r, g, b;
} Rgb;

typedef enum Projection { PROJECTION_ORTHOGRAPHIC, PROJECTION_PERSPECTIVE } Projection;

/* Pixel (i, j), j from the top, looks along the ray through
 *   x0 = (i + 1/2) / W - 1/2,  y0 = ((H - 1) - (j - 1/2)) / H - 1/2:
 * orthographic: from location + x0 right + y0 up along direction;
 * perspective: from location along direction + x0 right + y0 up, normalised.
 * This is POV-Ray's camera (tracepixel.cpp of 3.7.0.10), order of evaluation included. */
typedef struct Camera {
    Projection projection;
    Vec3 location;
    Vec3 right;        /* full width: mm (orthographic), or per unit of direction (perspective) */
    Vec3 up;           /* full height likewise; right x up points against direction */
    Vec3 direction;    /* unit */
    int width, height; /* pixels */
} Camera;

/* The ray through the point (i + dx, j + dy) of the pixel grid, dx = dy = 0 at the centre of pixel
 * (i, j). Its direction is unit, so that its parameter t is the depth in mm along the ray from the
 * camera point (perspective) or from the plane through location (orthographic). */
Ray camera_ray(const Camera *camera, double i, double j);

/* A point light at `location`, or, when `parallel`, light that travels from `location` towards
 * `target` everywhere. With `samples` of 2 or more, a power of 2, its shadows are those of samples
 * x samples points, from edge to edge of the parallelogram of these sides about its location; all
 * else is that of the point. */
typedef struct Light {
    Vec3 location;
    Vec3 target;
    Rgb color;
    bool parallel;
    bool casts_shadows;
    int samples; /* 0 or 1: one point */
    Vec3 sides[2];
} Light;

/* POV-Ray's finish; METHODS section 3. */
typedef struct Finish {
    float ambient, diffuse, brilliance, phong, phong_size, specular, roughness;
} Finish;

/* A plane under or behind the vessels: the points x with normal . x = offset_mm. Only colour knows
 * of it; depth, normals and ids are of vessels. */
typedef struct Ground {
    bool present;
    Vec3 normal; /* unit, towards the vessels */
    double offset_mm;
    Rgb color;
    Finish finish;
} Ground;

/* Where a ray meets the ground, if it does so between `near_mm` and `far_mm`; POV-Ray's plane,
 * order of evaluation included (plane.cpp of 3.7.0.10). */
bool ground_hit(const Ground *ground, Ray ray, double near_mm, double far_mm, double *t);

typedef enum PrimitiveKind { PRIMITIVE_CYLINDER, PRIMITIVE_SPHERE, PRIMITIVE_JOINT } PrimitiveKind;

/* A closed cylinder from a to b, a sphere about a, or the ruled surface between two circles about a
 * and b [geom/joint.h]. */
typedef struct Primitive {
    PrimitiveKind kind;
    bool round_a, round_b; /* of a cylinder: whether one of the scene's ends is about a, about b */
    Vec3 a, b;
    double radius_mm; /* > 0; of a joint, at a */
    uint32_t id;      /* SWC id of the segment it stands for */
    Rgb color;
    /* Of a joint alone: the radius at b, > 0, and the unit axes across which the circles lie, both
     * leading from a on to b. */
    double radius_b_mm;
    Vec3 axis_a, axis_b;
} Primitive;

/* A primitive that is a joint, prepared for many rays. */
JointFrame primitive_joint(const Primitive *primitive);

/* Whether each circle of a joint lies on one side of the other's plane, so that its wall and its
 * two discs bound a solid. Else rulings cross. */
bool primitive_joint_is_solid(const Primitive *joint);

/* One Gaussian line potential, or what stands in for it in a blob; METHODS section 2. */
typedef struct FieldSegment {
    Vec3 a, b;        /* different */
    double radius_mm; /* > 0 */
    uint32_t id;
    Rgb color;
} FieldSegment;

/* e^-2, the level at which a long segment has its own radius. */
#define FIELD_LEVEL 0.13533528323661270

typedef enum SceneModel {
    SCENE_CYLINDERS,
    SCENE_JOINED,
    SCENE_ROUNDED,
    SCENE_ISOSURFACE,
    SCENE_BLOB
} SceneModel;

/* Which segments blend. Without `first`, all with all: the surface is where the sum of all terms is
 * FIELD_LEVEL. Else segment i blends with neighbors[first[i] .. first[i + 1]), which rise and hold
 * i itself, and the surface bounds the union over all i of where the sum of their terms exceeds
 * it. */
typedef struct Blend {
    size_t *first;       /* owned; one more than there are segments, or NULL */
    uint32_t *neighbors; /* owned */
} Blend;

/* Whether `other` is among those that segment `i` blends with. */
bool blend_joins(const Blend *blend, uint32_t i, uint32_t other);

typedef struct Scene {
    SceneModel model;
    Camera camera;
    Rgb background;
    Finish finish;
    Light *lights; /* owned */
    size_t n_lights;
    Ground ground;
    Primitive *primitives; /* owned; empty for an implicit model */
    size_t n_primitives;
    /* The last so many are spheres about an end of a cylinder, with its radius, id and color. */
    size_t n_ends;
    FieldSegment *segments; /* owned; empty for a primitive model */
    size_t n_segments;
    Blend blend;
    bool open_joints;   /* rays may see the inside of a joint, where its discs are not covered */
    size_t drawn;       /* vessel segments that the geometry stands for */
    bool uniform_color; /* every color is `color` */
    Rgb color;
    Box bounds;  /* of the geometry, mm; for the field widened by its overshoot */
    Vec3 origin; /* where the origin of all of this lies in the coordinates of the tree */
} Scene;

void scene_release(Scene *scene);

/* Moves a scene that lies far from the origin, for its size, next to it, by whole millimetres, so
 * that no digits are lost to the distance; nothing seen changes. POV-Ray keeps bounding boxes in
 * single
 * precision. */
void scene_move_to_origin(Scene *scene);

/* An interval of depth that holds all of the geometry, whatever the pixel. */
void scene_depth_range(const Scene *scene, double *near_mm, double *far_mm);

/* STATUS_INPUT unless every number is finite and in its range, directions are not zero, and
 * coordinates keep double precision meaningful. */
MUST_CHECK Status scene_check(const Scene *scene, Err *err);

#endif
