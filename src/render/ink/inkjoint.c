/* Finds where the outline of a joint crosses one of the joint's ellipses.
 *
 * At a crossing, the cosine between the joint's normal and the direction to the viewer (the slant)
 * changes its sign. The signs at SAMPLES angles bracket the crossings, and Newton's method refines
 * them. An ellipse that is viewed from the side has two crossings, and up to four if the surface is
 * bent inwards. */
#include "render/ink/inkjoint.h"

#include <math.h>

/* Number of angles at which signs are taken. Two crossings within 360 / 48 = 7.5 degrees of each
 * other are missed: there the outline only touches the ellipse. */
enum { SAMPLES = 48 };
/* Number of Newton steps. They start at most 7.5 degrees from the crossing, and each doubles the
 * number of correct digits: three suffice for 8 digits, one is spare. */
enum { NEWTON_STEPS = 4 };

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

Vec3 joint_normal(const JointFrame *joint, double angle, double fraction)
{
    const double c = elementary_cos(angle), s = elementary_sin(angle);
    Vec3 across = vec3_add_scaled(joint->across, joint->across_change, fraction);
    double radius = joint->radius + fraction * joint->radius_change;
    Vec3 turn = vec3_add_scaled(vec3_scale(across, -s), joint->side, radius * c);
    Vec3 ruling = vec3_add_scaled(joint->span, joint->across_change, c);
    Vec3 normal = vec3_cross(turn, vec3_add_scaled(ruling, joint->side, joint->radius_change * s));
    Vec3 out = vec3_add_scaled(vec3_scale(across, c), joint->side, radius * s);
    return vec3_normalized(vec3_scale(normal, vec3_dot(normal, out) < 0 ? -1 : 1));
}

/* Returns the cosine between a joint's normal and the direction to the viewer. It is 0 on the
 * outline. */
static double joint_slant(const Camera *camera, const JointFrame *joint, double angle,
                          double fraction)
{
    double distance;
    Vec3 point = joint_point(joint, elementary_cos(angle), elementary_sin(angle), fraction);
    return vec3_dot(joint_normal(joint, angle, fraction), towards_viewer(camera, point, &distance));
}

double joint_outline_near(const Camera *camera, const JointFrame *joint, double angle,
                          double fraction)
{
    const double step = 1e-5; /* radians, of the numerical derivative */
    for (int k = 0; k < NEWTON_STEPS; k++) {
        double slant = joint_slant(camera, joint, angle, fraction);
        double slope = (joint_slant(camera, joint, angle + step, fraction) - slant) / step;
        /* A step is at most 0.1 radians, about the distance of two samples, so that it cannot jump
         * to another crossing. */
        if (fabs(slope) > 1e-6)
            angle -= fmin(fmax(slant / slope, -0.1), 0.1);
    }
    return angle;
}

int joint_outline(const Camera *camera, const JointFrame *joint, double fraction,
                  double angles[JOINT_OUTLINES])
{
    int n = 0;
    const double first = 0.0357; /* radians: avoids the plane of the axes, which is often viewed
                                  * edge-on */
    double before = joint_slant(camera, joint, first, fraction);
    for (int k = 1; k <= SAMPLES && n < JOINT_OUTLINES; k++) {
        double angle = first + FULL_TURN * k / SAMPLES;
        double slant = joint_slant(camera, joint, angle, fraction);
        if ((slant > 0) != (before > 0))
            angles[n++] = joint_outline_near(
                camera, joint, angle - FULL_TURN / SAMPLES * slant / (slant - before), fraction);
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
