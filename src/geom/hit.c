/* Intersects lines with spheres and cylinders.
 *
 * The formulas and limits are those of POV-Ray 3.7 [docs/POVRAY.md section 4], so that silhouettes
 * fall on the same pixels. The wall of a cylinder is intersected in the plane perpendicular to its
 * axis. POV-Ray transforms the line to a unit cylinder instead; in that plane the two differ only
 * by a similarity transformation. */
#include "geom/hit.h"

static const double epsilon = 1e-10; /* POV-Ray's EPSILON */

CylinderFrame cylinder_frame(Vec3 a, Vec3 b, double radius)
{
    Vec3 span = vec3_sub(b, a);
    double length = vec3_length(span);
    return (CylinderFrame){a, vec3_scale(span, 1 / length), length, radius};
}

int hit_sphere(Ray ray, Vec3 center, double radius, Hit hits[2])
{
    Vec3 to_center = vec3_sub(center, ray.origin);
    double distance2 = vec3_dot(to_center, to_center);
    double closest = vec3_dot(to_center, ray.direction);
    double half_chord2 = radius * radius - distance2 + closest * closest;
    if (half_chord2 <= epsilon)
        return 0;
    double half_chord = sqrt(half_chord2);
    for (int i = 0; i < 2; i++) {
        double t = closest + (i ? half_chord : -half_chord);
        hits[i].t = t;
        hits[i].normal = vec3_scale(vec3_sub(ray_at(ray, t), center), 1 / radius);
    }
    return 2;
}

int hit_cylinder(Ray ray, const CylinderFrame *cylinder, Hit hits[4])
{
    int count = 0;
    Vec3 axis = cylinder->axis;
    Vec3 from_base = vec3_sub(ray.origin, cylinder->base);
    double origin_along = vec3_dot(from_base, axis);
    double direction_along = vec3_dot(ray.direction, axis);
    Vec3 origin_across = vec3_add_scaled(from_base, axis, -origin_along);
    Vec3 direction_across = vec3_add_scaled(ray.direction, axis, -direction_along);
    double radius2 = cylinder->radius * cylinder->radius;

    /* The wall: a t^2 + 2 b t + c = 0. */
    double a = vec3_dot(direction_across, direction_across);
    double b = vec3_dot(origin_across, direction_across);
    double c = vec3_dot(origin_across, origin_across) - radius2;
    if (a > epsilon) {
        double discriminant = b * b - a * c;
        if (discriminant >= 0) {
            double root = sqrt(discriminant);
            for (int i = 0; i < 2; i++) {
                double t = (-b + (i ? root : -root)) / a;
                double along = origin_along + t * direction_along;
                if (along < 0 || along > cylinder->length)
                    continue;
                Vec3 across = vec3_add_scaled(origin_across, direction_across, t);
                hits[count++] = (Hit){t, vec3_normalized(across)};
            }
        }
    }
    /* The two end discs. */
    if (fabs(direction_along) > epsilon) {
        for (int i = 0; i < 2; i++) {
            double t = ((i ? cylinder->length : 0) - origin_along) / direction_along;
            Vec3 across = vec3_add_scaled(origin_across, direction_across, t);
            if (vec3_dot(across, across) <= radius2)
                hits[count++] = (Hit){t, i ? axis : vec3_scale(axis, -1)};
        }
    }
    return count;
}
