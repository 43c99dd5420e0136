/* Makes the faces (surfaces) of a scene, and computes where beams hit them, with proven error
 * bounds.
 *
 * faces_make lists the faces of a scene; for each beam (beam_of), call face_hit, then hit_normal.
 * In the models of cylinders and balls, the vessels are a union of convex solids. A ray from
 * outside enters a cylinder through its wall (lateral surface) or through an end disc, and a ball
 * through its front. A hit is such an entry. A camera ray starts outside all solids, so the first
 * hit of the union is the nearest of these entries. An end disc that a ball covers is never visible
 * and has no face. Meshes have a face per triangle. Isosurfaces and blobs have a face per segment:
 * their surface is a level set of a sum, the potential, to which each segment adds a term.
 *
 * A beam is a set of rays origin + depth * direction, one for each point of a rectangle of the
 * picture. Origin and direction are forms: affine functions over this rectangle, with an error
 * bound [answer/affine.h]. The direction need not be a unit vector: a depth is a length in mm only
 * after multiplication by the length of the direction. */
#ifndef CORCAST_ANSWER_FACES_H
#define CORCAST_ANSWER_FACES_H

#include "answer/affine.h"
#include "scene/scene.h"

/* Returns the constant form of a point or vector, with an error bound of 0. */
static inline Form3 form3_exact(Vec3 v)
{
    return form3_of(v.x, v.y, v.z);
}

typedef enum FaceKind {
    FACE_WALL,     /* the lateral surface of a cylinder */
    FACE_BALL,     /* a sphere */
    FACE_DISC,     /* an end of a cylinder */
    FACE_GROUND,   /* the ground plane */
    FACE_SEGMENT,  /* a segment of the potential or of a blob [answer/isosurface.h] */
    FACE_TRIANGLE, /* a triangle of a mesh [answer/triangleface.h] */
    FACE_JOINT     /* a joint between cylinders [answer/jointface.h] */
} FaceKind;

typedef struct Face {
    FaceKind kind;
    uint32_t segment; /* index of the face's segment; unused for the ground */
    uint32_t solid;   /* index of the face's primitive, segment or triangle. The faces of one
                       * primitive are the surface of one convex solid, so they cast no shadow on
                       * each other */
    Vec3 at, end;     /* wall, segment: the ends of its axis, mm; ball, disc: both are the centre */
    double radius;    /* mm; unused for joints */
    Form3 axis;       /* wall, segment: unit vector from `at` to `end`; disc, ground, triangle:
                       * outward unit normal */
    Form length;      /* wall, segment: distance from `at` to `end`, mm */
    double offset;    /* ground: the plane axis . x = offset, mm */
    const VesselMesh *mesh; /* triangle: its mesh; borrowed */
    const Primitive *joint; /* joint: its primitive; borrowed */
    Box box;                /* bounding box; unused for the ground */
} Face;

/* Vectors that depend only on the direction of a beam and on the axis of a wall. Beams with equal
 * directions can share them. The forms have infinite errors if the direction may be parallel to the
 * axis for some ray. face_hit then computes forms with infinite errors, too, so the face counts as
 * possibly hit. */
typedef struct WallFrame {
    /* m = direction x axis, normalized. k = the component of the direction perpendicular to the
     * axis, normalized. */
    Form3 m, k;
    Form inverse; /* 1 / length of direction x axis */
    Form along;   /* direction . axis */
} WallFrame;

typedef struct Beam {
    Form3 origin, direction;
    Form3 unit;              /* direction / length */
    Form length;             /* length of the direction */
    Form inverse;            /* 1 / length */
    const WallFrame *frames; /* per face: frames for `direction`, shared by all beams with this
                              * direction, such as those of an orthographic camera; NULL: face_hit
                              * computes the frame; borrowed */
} Beam;

/* Returns the beam with this origin and direction, and without frames. */
Beam beam_of(Form3 origin, Form3 direction);

/* Returns the frame of a wall for the beam's direction. `face` must be a FACE_WALL. */
WallFrame wall_frame(const Face *face, const Beam *beam);

/* Maximum number of edges of a face: a wall has two silhouettes and two ends. */
enum { HIT_EDGES = 4 };

/* The hit of a beam with a face. An edge is a function over the beam's rectangle that is 0 on one
 * border of the face and negative outside. A ray hits the face if all edges are >= 0 at the ray's
 * point. */
typedef struct FaceHit {
    const Face *face;
    Form depth;            /* valid for the rays that hit the face */
    Form edges[HIT_EDGES]; /* n_edges edges that may be negative for some ray; edges that are >= 0
                            * everywhere are left out */
    int n_edges;
    /* s: half of the length of a chord, mm. For a ball, the chord is the part of the ray's line
     * inside the ball. For a wall, ray and wall are projected along the wall's axis, and the chord
     * is the part of the projected line inside the wall's circle. w: for a wall, the signed
     * distance of the ray's line from the axis, mm. */
    Form s, w;
    const WallFrame *frame; /* wall: points to a frame of the beam, or to own_frame. Code that
                             * copies a FaceHit whose `frame` points to own_frame must set `frame`
                             * of the copy to the copy's own_frame */
    WallFrame own_frame;
    Form3 v; /* ball: vector from the centre to the nearest point of the ray's line, mm; segment,
              * joint: outward unit normal */
} FaceHit;

/* Computes the hit of a beam with a face. `index` is the position of the face in beam->frames; it
 * is ignored if beam->frames is NULL. Returns false if no ray of the beam hits the face; *hit is
 * then undefined. Always returns false for a segment, because only all segments together have a
 * surface, and for a joint, which a ray may hit several times [answer/jointface.h]. */
bool face_hit(const Face *face, size_t index, const Beam *beam, FaceHit *hit);
/* Returns the outward unit normal at a hit. Requires that face_hit returned true for this beam, or
 * that hit->v of a segment or a joint was set. The normals of the ground, triangles and joints
 * point to the side that the ray comes from. */
Form3 hit_normal(const FaceHit *hit, const Beam *beam);
/* Returns the normal, or its negative, whichever points against the direction. If this differs
 * between the rays of the beam, or is not decided, the result encloses both. */
Form3 normal_against(Form3 normal, Form3 direction);

/* Returns true if the wall and the ball are parts of one capsule: they have the same radius, and
 * the ball is at an end of the wall. `wall` must be a FACE_WALL, and `ball` a FACE_BALL. A capsule
 * is convex, and its wall is in front of its ball wherever both are hit. */
bool faces_form_capsule(const Face *wall, const Face *ball);

/* Terms of the potential below this value are left out. n segments add n times this value to the
 * error of the potential: 1e-8 for a million segments, where the surface has the level 0.135. */
#define ISOSURFACE_CUTOFF 1e-14
/* Distance from a segment, in radii, beyond which its term is below ISOSURFACE_CUTOFF: the term is
 * at most exp(-2 distance^2 / radius^2). */
#define ISOSURFACE_REACH 4.0148

/* Makes the faces of a geometry of cylinders and balls, of segments of the potential, or of
 * triangles, and of the ground of a view. Requires that geometry->implied_ends is false, so that
 * the geometry has the balls at the ends of cylinders as primitives.
 *
 * ground  view->ground. It has no face if ground->present is false.
 * faces   receives the array, which the caller frees. The ground, if there is one, is the last
 *         face.
 * n       receives the number of faces, including the ground.
 * Errors  STATUS_MEMORY. */
MUST_CHECK Status faces_make(const Geometry *geometry, const Ground *ground, Face **faces,
                             size_t *n, Err *err);

#endif
