/* Finds the outline of a joint as a camera sees it. */
#ifndef CORCAST_RENDER_INKJOINT_H
#define CORCAST_RENDER_INKJOINT_H

#include "scene/scene.h"

/* Returns the unit direction from a point to the viewer, and sets *distance to the viewer's
 * distance, mm: for an orthographic camera, that of its plane. */
Vec3 towards_viewer(const Camera *camera, Vec3 point, double *distance);

/* Returns the outward unit normal of a joint.
 *
 * angle    on the ellipse, radians.
 * way      selects the ellipse: 0 is the joint's first circle, 1 its second. */
Vec3 joint_normal(const JointFrame *joint, double angle, double way);

enum { JOINT_OUTLINES = 8 };
/* Finds the angles, ascending, at which the outline crosses one of the joint's ellipses. Returns
 * their number. */
int joint_outline(const Camera *camera, const JointFrame *joint, double way,
                  double angles[JOINT_OUTLINES]);
/* Returns the angle at which the outline crosses the ellipse `way`, starting from a guess. */
double joint_outline_near(const Camera *camera, const JointFrame *joint, double angle, double way);

/* Returns true if the edge between a joint and the cylinder at its end (0 or 1) is part of the
 * outline at `angle`: one of the two surfaces that meet there faces the viewer, the other does not.
 */
bool joint_edge_is_outline(const Camera *camera, const JointFrame *joint, int end, double angle);

#endif
