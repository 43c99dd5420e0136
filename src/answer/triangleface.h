/* Faces of the mesh model: triangles of the closed surface of the vessels.
 *
 * A triangle is the exact flat triangle between its three points. Its shading uses
 * the linear interpolation of the unit normals of the points, normalized; the shading of caps uses
 * their flat normal. The normal is turned to the side that the ray comes from. Used by faces.c. */
#ifndef CORCAST_ANSWER_TRIANGLEFACE_H
#define CORCAST_ANSWER_TRIANGLEFACE_H

#include "answer/faces.h"

/* Returns the face of a triangle. `mesh` is borrowed by the face. `segment` is the index of its
 * segment. */
Face triangle_face(const VesselMesh *mesh, uint32_t triangle, uint32_t segment);

/* Computes the hit of a beam with a triangle, from either side. Sets depth and edges of *hit.
 * Returns false if no ray of the beam hits the triangle. */
bool triangle_hit(const Face *face, const Beam *beam, FaceHit *hit);

/* Returns true if the face is a triangle that all rays of the beam would hit from inside. */
static inline bool triangle_faces_away(const Face *face, const Beam *beam)
{
    return face->kind == FACE_TRIANGLE && form_low(form3_dot(face->axis, beam->direction)) > 0;
}

/* Returns the unit normal for shading at all points where the beam meets the triangle, on the side
 * that the ray comes from. Where this side is not decided, the result encloses the normals of both
 * sides. */
Form3 triangle_normal(const Face *face, const Beam *beam);

#endif
