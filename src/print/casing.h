/* A casing: a box or a cylinder with holes in its flat faces. There are two: the block around
 * vessels, which the vessels leave through ports; and the base plate, on which support pins stand.
 * casing_add adds a casing to a solid.
 *
 * Face numbers: 2 axis is the face at the low coordinate along an axis, 2 axis + 1 the face at the
 * high coordinate. Private to the module print. */
#ifndef CORCAST_PRINT_CASING_H
#define CORCAST_PRINT_CASING_H

#include "print/solid.h"

typedef struct Casing {
    Box box;       /* mm; of a cylinder, the box around it */
    bool is_round; /* true: a cylinder, with two flat faces; false: a box, with six */
    int axis;      /* axis of a cylinder: 0, 1 or 2; unused for a box */
} Casing;

/* Number of sides of the prism that approximates a cylinder. The reason for the number is not
 * recorded. casing_holds_disc keeps holes within 0.998 radii of the axis, inside the prism, whose
 * inscribed circle has 0.9995 radii. */
enum { CASING_SIDES = 96 };

/* Number of faces of a box. */
enum { CASING_FACES = 6 };

/* Returns the axis that a face is perpendicular to. */
static inline int face_axis(int face)
{
    return face / 2;
}
/* Returns true if a face is at the low coordinate along its axis. */
static inline bool face_is_low(int face)
{
    return face % 2 == 0;
}
/* Returns the coordinate of a face along its axis, mm. */
static inline double face_coordinate(const Casing *casing, int face)
{
    return vec3_component(face_is_low(face) ? casing->box.low : casing->box.high, face_axis(face));
}
/* Returns the unit normal of a face, out of the casing. */
static inline Vec3 face_normal(int face)
{
    double out = face_is_low(face) ? -1 : 1;
    return vec3(face_axis(face) == 0 ? out : 0, face_axis(face) == 1 ? out : 0,
                face_axis(face) == 2 ? out : 0);
}

/* Returns true if the casing has this flat face. A cylinder has only the two across its axis. */
bool casing_has_face(const Casing *casing, int face);
/* Returns true if a disc in a face is inside the face. `at` is the disc's centre, a point of the
 * face, mm. The casing must have the face. */
bool casing_holds_disc(const Casing *casing, int face, Vec3 at, double radius_mm);

/* A hole in a face, where a port or a pin meets the casing. */
typedef struct CasingHole {
    int face;
    bool is_rising;   /* true: the axis of the segment of the port or pin, from its first to its
                       * second end, points out of the casing */
    uint32_t *points; /* points of the hole's edge, as indices in the solid, by ascending angle
                       * about the segment's axis; borrowed */
    uint32_t n;       /* number of points */
} CasingHole;

/* Adds the casing's faces, with their holes, to the solid. The triangles have the label MESH_CAP |
 * MESH_FRAME.
 *
 * holes    n holes; each must be inside its face.
 * Errors   STATUS_INFEASIBLE if holes touch each other, STATUS_MEMORY. */
MUST_CHECK Status casing_add(Solid *solid, const Casing *casing, const CasingHole *holes, size_t n,
                             Err *err);

#endif
