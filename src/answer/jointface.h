/* Intersects single rays with the joints of the model `joined` [geom/joint.h], with proven error
 * bounds. A joint is a ruled surface between two circles. It is closed by discs of cylinders, but
 * is not convex, so a ray may cross it up to four times. Private to the module answer. */
#ifndef CORCAST_ANSWER_JOINTFACE_H
#define CORCAST_ANSWER_JOINTFACE_H

#include "answer/faces.h"

/* Makes the face of a joint. The face borrows the primitive. */
Face joint_face(const Primitive *primitive, uint32_t solid);

enum { JOINT_HITS = 4 };

/* Finds all crossings of the line of a single ray with a joint, in any order, before and behind its
 * origin. Returns their number. Of each hit, sets face, depth, edges and v, the outward unit
 * normal. Returns -1 if the crossings are not decided, for example because the ray touches the
 * joint. */
int joint_hits(const Face *face, const Beam *ray, FaceHit hits[JOINT_HITS]);

/* Tests whether a joint blocks a shadow ray between `from_mm` and the light, which is at depth 1,
 * or at infinity if `parallel`. Returns 1 if it does, 0 if it does not, and -1 if this is not
 * decided, or if it blocks the ray nearer to its origin than `from_mm`.
 *
 * is_own  the ray starts on this joint; the crossing at its origin does not count. */
int joint_blocks(const Face *face, const Beam *ray, bool is_own, bool parallel, double from_mm);

#endif
