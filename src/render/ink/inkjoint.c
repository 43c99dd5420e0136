/* The angle between a joint's wall and the way to the viewer changes its sign where the joint's
 * outline crosses one of its ellipses: signs at 48 angles find where, Newton's iteration the angle.
 * There are two such places on an ellipse that is seen from the side, and up to four where the wall
 * is bent inwards. */
#include "render/ink/inkjoint.h"

#include <math.h>

enum { SAMPLES = 48, NEWTON = 4 };

Vec3 towards_viewer(const Camera *camera, Vec3 point, double *distance)
{
    Vec3 away = vec3_sub(camera->location, point);
    if (camera->projection == PROJECTION_PERSPECTIVE) {
        *distance = vec3_length(away);
        return vec3_scale(away, 1 / *distance);
    }
    *distance = -vec3_dot(away, camera->direction);
    return vec3_scale(camera->direction, -1);
}

Vec3 joint_normal(const JointFrame *joint, double angle, double way)
{
    const double c = elementary_cos(angle), s = elementary_sin(angle);
    Vec3 across = vec3_add_scaled(joint->across, joint->across_change, way);
    double radius = joint->radius + way * joint->radius_change;
    Vec3 turn = vec3_add_scaled(vec3_scale(across, -s), joint->side, radius * c);
    Vec3 ruling = vec3_add_scaled(joint->span, joint->across_change, c);
    Vec3 normal = vec3_cross(turn, vec3_add_scaled(ruling, joint->side, joint->radius_change * s));
    Vec3 out = vec3_add_scaled(vec3_scale(across, c), joint->side, radius * s);
    return vec3_normalized(vec3_scale(normal, vec3_dot(normal, out) < 0 ? -1 : 1));
}

/* The cosine between a joint's normal and the way to the viewer: 0 on its outline. */
static double joint_slant(const Camera *camera, const JointFrame *joint, double angle, double way)
{
    double distance;
    Vec3 point = joint_point(joint, elementary_cos(angle), elementary_sin(angle), way);
    return vec3_dot(joint_normal(joint, angle, way), towards_viewer(camera, point, &distance));
}

double joint_outline_near(const Camera *camera, const JointFrame *joint, double angle, double way)
{
    const double step = 1e-5;
    for (int k = 0; k < NEWTON; k++) {
        double slant = joint_slant(camera, joint, angle, way);
        double slope = (joint_slant(camera, joint, angle + step, way) - slant) / step;
        if (fabs(slope) > 1e-6)
            angle -= fmin(fmax(slant / slope, -0.1), 0.1);
    }
    return angle;
}

int joint_outline(const Camera *camera, const JointFrame *joint, double way,
                  double angles[JOINT_OUTLINES])
{
    int n = 0;
    const double first = 0.0357; /* apart from the plane of the axes, which is often seen edge-on */
    double before = joint_slant(camera, joint, first, way);
    for (int k = 1; k <= SAMPLES && n < JOINT_OUTLINES; k++) {
        double angle = first + FULL_TURN * k / SAMPLES;
        double slant = joint_slant(camera, joint, angle, way);
        if ((slant > 0) != (before > 0))
            angles[n++] = joint_outline_near(
                camera, joint, angle - FULL_TURN / SAMPLES * slant / (slant - before), way);
        before = slant;
    }
    return n;
}

bool joint_edge_is_outline(const Camera *camera, const JointFrame *joint, int end, double angle)
{
    double distance;
    Vec3 point = joint_point(joint, elementary_cos(angle), elementary_sin(angle), end);
    Vec3 center = vec3_add_scaled(joint->base, joint->span, end);
    double slant = vec3_dot(vec3_sub(point, center), towards_viewer(camera, point, &distance));
    return (slant > 0) != (joint_slant(camera, joint, angle, end) > 0);
}
