/* Intersects single rays with the joints of the model `joined` [geom/joint.h]: joint_hits finds the
 * crossings, as forms with proven error bounds, and joint_blocks tests a shadow ray. A joint is a
 * ruled surface between two circles. The end discs of the adjacent cylinders close it. It is not
 * convex, so a ray may cross it up to four times. Private to the module answer. */
#ifndef CORCAST_ANSWER_JOINTFACE_H
#define CORCAST_ANSWER_JOINTFACE_H

#include "answer/faces.h"

/* Makes the face of a joint. The face borrows the primitive. `solid` becomes Face.solid. */
Face joint_face(const Primitive *primitive, uint32_t solid);

enum { JOINT_HITS = 4 };

/* Finds all crossings of the line of a single ray with a joint, in any order, before and behind its
 * origin. Returns their number. Sets these members of each hit: face, depth, edges, and v, which is
 * the outward unit normal. Returns -1 if the crossings are not decided, for example because the ray
 * touches the joint. */
int joint_hits(const Face *face, const Beam *ray, FaceHit hits[JOINT_HITS]);

/* Tests whether a joint blocks a shadow ray between the distance `from_mm` from its origin and the
 * light. The light is at the ray's direction (depth 1), or at infinity if `parallel`. Returns 1 if
 * the joint blocks the ray, and 0 if it does not. Returns -1 if this is not decided, or if the
 * joint crosses the ray at a distance below `from_mm`, where renderers may ignore it.
 *
 * is_own  the ray starts on this joint; the crossing at its origin does not count. */
int joint_blocks(const Face *face, const Beam *ray, bool is_own, bool parallel, double from_mm);

#endif
