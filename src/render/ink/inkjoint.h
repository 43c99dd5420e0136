/* Where the outline of a joint runs, for a viewer. */
#ifndef CORCAST_RENDER_INKJOINT_H
#define CORCAST_RENDER_INKJOINT_H

#include "scene/scene.h"

/* The unit direction from a point to the viewer, and how far away that is, mm. */
Vec3 towards_viewer(const Camera *camera, Vec3 point, double *distance);

/* The outward unit normal of a joint at an angle, in radians, of the ellipse that is `way`, from 0
 * to 1, from its first circle to its second. */
Vec3 joint_normal(const JointFrame *joint, double angle, double way);

enum { JOINT_OUTLINES = 8 };
/* The angles at which the outline crosses one of a joint's ellipses, ascending; how many. */
int joint_outline(const Camera *camera, const JointFrame *joint, double way,
                  double angles[JOINT_OUTLINES]);
/* The one of these angles that is near an angle. */
double joint_outline_near(const Camera *camera, const JointFrame *joint, double angle, double way);

/* Whether the edge between a joint and the cylinder at its end 0 or 1 is part of the outline there:
 * of the two walls that meet the viewer sees one from behind. */
bool joint_edge_is_outline(const Camera *camera, const JointFrame *joint, int end, double angle);

#endif
