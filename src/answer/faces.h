/* The faces of a scene, and where beams hit them, with proven errors.
 *
 * The vessels are a union of convex solids: closed cylinders and balls. A ray from outside enters a
 * cylinder through its wall or through an end disc, and a ball through its front. A hit is such an
 * entry. The first hit of the union is the nearest of these entries, because the ray starts outside
 * all solids. An end disc that a ball covers is never visible and has no face.
 *
 * A beam is a set of rays origin + depth * direction. The direction may have any length and may
 * vary; depths of one ray are compared only with each other. */
#ifndef CORCAST_ANSWER_FACES_H
#define CORCAST_ANSWER_FACES_H

#include "answer/affine.h"
#include "scene/scene.h"

typedef enum FaceKind { FACE_WALL, FACE_BALL, FACE_DISC, FACE_GROUND } FaceKind;

typedef struct Face {
    FaceKind kind;
    uint32_t segment; /* index of its segment */
    uint32_t solid;   /* index of the primitive; faces of one convex solid cast no shadow on each
                       * other */
    Vec3 at, end;     /* wall: its ends; ball, disc: `at` is the centre */
    double radius;
    Form3 axis;    /* wall: unit, from `at` to `end`; disc, ground: outward unit normal */
    Form length;   /* wall */
    double offset; /* ground: points with normal . x = offset */
    Box box;       /* holds the face */
} Face;

/* A wall in a beam: m is the unit vector across direction and axis, k the unit vector along the
 * direction's part across the axis. */
typedef struct WallFrame {
    Form3 m, k;
    Form inverse; /* 1 / length of direction x axis */
    Form along;   /* direction . axis */
} WallFrame;

typedef struct Beam {
    Form3 origin, direction;
    Form3 unit;              /* direction / its length */
    Form length;             /* of the direction */
    Form inverse;            /* 1 / length */
    const WallFrame *frames; /* per face, for a direction that is the same in all beams; NULL:
                              * frames are computed */
} Beam;

/* Completes a beam of origin and direction. */
Beam beam_of(Form3 origin, Form3 direction);

WallFrame wall_frame(const Face *face, const Beam *beam);

enum { HIT_EDGES = 4 };

/* A hit of a face by the rays at which all edges are >= 0. */
typedef struct FaceHit {
    const Face *face;
    Form depth;
    Form edges[HIT_EDGES];  /* edges that may be negative come first */
    int pending;            /* number of edges that may be negative */
    Form s, w;              /* wall and ball: for the normal */
    const WallFrame *frame; /* wall; of the beam, or own_frame, so that a hit cannot be copied */
    WallFrame own_frame;
    Form3 v; /* ball: from the centre to the ray, across it */
} FaceHit;

/* Computes the hit of a face. Returns false if no ray of the beam hits it. */
bool face_hit(const Face *face, size_t index, const Beam *beam, FaceHit *hit);
/* Returns the outward unit normal at a hit. */
Form3 hit_normal(const FaceHit *hit, const Beam *beam);

/* Returns true if the wall and the ball are parts of one capsule: they have the same radius, and
 * the ball is at an end of the wall. A capsule is convex, and its wall is in front of its ball
 * wherever both are hit. */
bool faces_form_capsule(const Face *wall, const Face *ball);

/* Makes the faces of a geometry of cylinders and balls, all ends explicit, and of the ground of a
 * view. *faces is owned by the caller. The ground, if present, is the last face. Errors:
 * STATUS_MEMORY. */
MUST_CHECK Status faces_make(const Geometry *geometry, const Ground *ground, Face **faces,
                             size_t *n, Err *err);

#endif
