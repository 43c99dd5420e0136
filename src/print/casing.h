/* A box or a cylinder with flat faces that vessels leave through: a block that is cast about
 * vessels, or the plate that they stand on. */
#ifndef CORCAST_PRINT_CASING_H
#define CORCAST_PRINT_CASING_H

#include "print/solid.h"

typedef struct Casing {
    Box box;       /* mm; of a cylinder, the box about it */
    bool is_round; /* a cylinder, with two flat faces */
    int axis;      /* of a cylinder: 0, 1 or 2 */
} Casing;

/* Number of sides of the prism that stands for a cylinder. */
enum { CASING_SIDES = 96 };

/* Faces have the indices 2 axis (low coordinate) and 2 axis + 1 (high coordinate). */
enum { CASING_FACES = 6 };

static inline int face_axis(int face)
{
    return face / 2;
}
static inline bool face_is_low(int face)
{
    return face % 2 == 0;
}
/* Returns the coordinate of a face along its axis, mm. */
static inline double face_coordinate(const Casing *casing, int face)
{
    return vec3_component(face_is_low(face) ? casing->box.low : casing->box.high, face_axis(face));
}
/* Returns the unit vector out of the casing. */
static inline Vec3 face_normal(int face)
{
    double out = face_is_low(face) ? -1 : 1;
    return vec3(face_axis(face) == 0 ? out : 0, face_axis(face) == 1 ? out : 0,
                face_axis(face) == 2 ? out : 0);
}

/* Returns true if vessels may leave through a face. They may not leave through a cylinder's side.
 */
bool casing_has_face(const Casing *casing, int face);
/* Returns true if the disc of this radius about a point of a face is inside the face. */
bool casing_holds_disc(const Casing *casing, int face, Vec3 at, double radius_mm);

/* A hole in a face. */
typedef struct CasingHole {
    int face;
    bool is_rising; /* the axis of the segment leads out of the casing here */
    uint32_t
        *points; /* of the solid, on the face, by rising angle about the segment's axis; borrowed */
    uint32_t n;
} CasingHole;

/* Adds the casing's faces to the solid, with the labels MESH_CAP and MESH_FRAME. Errors:
 * STATUS_INFEASIBLE if holes touch, STATUS_MEMORY. */
MUST_CHECK Status casing_add(Solid *solid, const Casing *casing, const CasingHole *holes, size_t n,
                             Err *err);

#endif
