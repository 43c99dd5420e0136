/* A box or an upright cylinder that vessels leave through flat faces: a block that is cast about
 * them, or the plate that they stand on. */
#ifndef CORCAST_PRINT_CASING_H
#define CORCAST_PRINT_CASING_H

#include "print/solid.h"

typedef struct Casing {
    Box box;       /* mm; of a cylinder, the one about it */
    bool is_round; /* a cylinder of two flat faces */
    int axis;      /* of a cylinder: 0, 1 or 2 */
} Casing;

/* The sides of the prism that stands for a cylinder. */
enum { CASING_SIDES = 96 };

/* The faces of a casing: 2 axis, and one more where its coordinate is the higher one. */
enum { CASING_FACES = 6 };

static inline int face_axis(int face)
{
    return face / 2;
}
static inline bool face_is_low(int face)
{
    return face % 2 == 0;
}
static inline double face_place(const Casing *casing, int face)
{
    return vec3_component(face_is_low(face) ? casing->box.low : casing->box.high, face_axis(face));
}
/* Out of the casing. */
static inline Vec3 face_normal(int face)
{
    double way = face_is_low(face) ? -1 : 1;
    return vec3(face_axis(face) == 0 ? way : 0, face_axis(face) == 1 ? way : 0,
                face_axis(face) == 2 ? way : 0);
}

/* Whether vessels may leave through a face: those of a cylinder's side may not. */
bool casing_has_face(const Casing *casing, int face);
/* Whether a disc about a point of a face lies in the face with so much room. */
bool casing_holds_disc(const Casing *casing, int face, Vec3 at, double radius_mm);

/* A way out of the casing: n points of the solid on the face, by rising angle about the axis of a
 * segment, which leads out of the casing if `is_rising`. */
typedef struct CasingHole {
    int face;
    bool is_rising;
    uint32_t *points; /* borrowed */
    uint32_t n;
} CasingHole;

/* Adds the casing's faces to the solid, with MESH_CAP and MESH_FRAME. STATUS_INFEASIBLE where
 * holes touch. */
MUST_CHECK Status casing_add(Solid *solid, const Casing *casing, const CasingHole *holes, size_t n,
                             Err *err);

#endif
