/* Finds the outline of a joint in the view of a camera. A joint is a surface of straight rulings
 * between two circles [geom/joint.h]. The points at the same `fraction` of all rulings form an
 * ellipse: 0 is the first circle, 1 the second circle. The outline crosses an ellipse where the
 * surface normal is perpendicular to the line of sight. No function has state. */
#ifndef CORCAST_RENDER_INK_INKJOINT_H
#define CORCAST_RENDER_INK_INKJOINT_H

#include "scene/scene.h"

/* Returns the unit direction from a point to the viewer, and sets *distance to the distance in mm.
 * For an orthographic camera, this is the distance to the camera's plane. */
Vec3 towards_viewer(const Camera *camera, Vec3 point, double *distance);

/* Returns the outward unit normal of a joint.
 *
 * angle      position on the ellipse, radians: the angle p of geom/joint.h.
 * fraction   the ellipse, 0 to 1. */
Vec3 joint_normal(const JointFrame *joint, double angle, double fraction);

/* Maximum number of crossings. An ellipse has at most four. Where the outline only touches the
 * ellipse, rounding can produce false changes of sign; twice four leaves space for them. */
enum { JOINT_OUTLINES = 8 };
/* Finds the angles at which the outline crosses the ellipse `fraction`, ascending, in radians.
 * Returns their number, at most JOINT_OUTLINES. */
int joint_outline(const Camera *camera, const JointFrame *joint, double fraction,
                  double angles[JOINT_OUTLINES]);
/* Returns the angle in radians at which the outline crosses the ellipse `fraction`, found by a
 * fixed number of Newton steps from the guess `angle`. The guess must be near a crossing; otherwise
 * the result is any angle. */
double joint_outline_near(const Camera *camera, const JointFrame *joint, double angle,
                          double fraction);

/* Returns true if the edge between a joint and the cylinder at its end (0 or 1) is part of the
 * outline at `angle`. This is the case if one of the two surfaces that meet at the edge faces the
 * viewer and the other does not. */
bool joint_edge_is_outline(const Camera *camera, const JointFrame *joint, int end, double angle);

#endif
