/* Intersects lines with a joint, the ruled surface between two circles C_1 and C_2 [joint.h]. A
 * ruling is the straight line between the points of the two circles at the same angle p.
 *
 * A line x(t) = o + t D meets the ruling of angle p only if the two lie in one plane: g(p) = D .
 * ((C_1(p) - o) x (C_2(p) - C_1(p))) = 0. g is a trigonometric polynomial of degree 2 without a
 * sin^2 term. At a root, its derivative is dg/dp = D . (S_p x S_l), where S_p and S_l are the
 * derivatives of S(p, l) = C_1(p) + l (C_2(p) - C_1(p)). The root is therefore simple unless the
 * line is tangent to the surface, whatever its direction.
 *
 * The circle is divided into two halves. With u = tan(p / 2) on one half, and tan((pi - p) / 2) on
 * the other, u is in [-1, 1], and g (1 + u^2)^2 is a quartic in u, whose roots quartic.c isolates.
 */
#include "geom/joint.h"

#include "geom/quartic.h"

/* The axes count as parallel if the sine of the angle between them is below this. */
static const double parallel = 1e-12;
/* Maximum distance of an intersection from the line, relative to the size of the joint. It rejects
 * rulings that run beside the line, parallel to it: g is 0 there too. It is far above the rounding
 * of a root, and far below a pixel. */
static const double off_line = 1e-6;
/* Maximum distance of l outside [0, 1]: the rounding of l, so that no gap opens at the rims, where
 * the joint meets its cylinders. */
static const double off_end = 1e-12;

/* Returns a vector perpendicular to a unit vector, of a length of at least 0.6. 0.6 is the cosine
 * of 53 degrees: the x or the y axis makes at least 36 degrees with the vector. */
static Vec3 any_perpendicular(Vec3 axis)
{
    Vec3 other = fabs(axis.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return vec3_cross(axis, other);
}

JointFrame joint_frame(const Vec3 center[2], const Vec3 axis[2], const double radius[2])
{
    Vec3 side = vec3_cross(axis[0], axis[1]);
    if (vec3_length(side) < parallel)
        side = any_perpendicular(axis[0]);
    side = vec3_normalized(side);
    /* The cross product of nearly parallel axes is not exactly perpendicular to them. Its part that
     * is perpendicular to the first axis is used. */
    side = vec3_normalized(vec3_add_scaled(side, axis[0], -vec3_dot(side, axis[0])));
    Vec3 across = vec3_scale(vec3_cross(side, axis[0]), radius[0]);
    return (JointFrame){.base = center[0],
                        .span = vec3_sub(center[1], center[0]),
                        .side = side,
                        .across = across,
                        .across_change =
                            vec3_sub(vec3_scale(vec3_cross(side, axis[1]), radius[1]), across),
                        .radius = radius[0],
                        .radius_change = radius[1] - radius[0]};
}

/* Sets *start to C_1(p) and *ruling to C_2(p) - C_1(p). */
static void joint_ruling(const JointFrame *joint, double cosine, double sine, Vec3 *start,
                         Vec3 *ruling)
{
    *start = vec3_add_scaled(joint->base, joint->across, cosine);
    *start = vec3_add_scaled(*start, joint->side, sine * joint->radius);
    *ruling = vec3_add_scaled(joint->span, joint->across_change, cosine);
    *ruling = vec3_add_scaled(*ruling, joint->side, sine * joint->radius_change);
}

Vec3 joint_point(const JointFrame *joint, double cosine, double sine, double l)
{
    Vec3 start, ruling;
    joint_ruling(joint, cosine, sine, &start, &ruling);
    return vec3_add_scaled(start, ruling, l);
}

static double triple(Vec3 a, Vec3 b, Vec3 c)
{
    return vec3_dot(a, vec3_cross(b, c));
}

/* Finds where the line meets the ruling of an angle at which g is 0. Returns false if that point is
 * off the ends of the ruling, or if the ruling is parallel to the line and beside it. The line
 * starts near the joint. */
static bool ruling_hit(const JointFrame *joint, Ray line, double cosine, double sine, Hit *hit)
{
    Vec3 start, ruling;
    joint_ruling(joint, cosine, sine, &start, &ruling);
    Vec3 from = vec3_sub(start, line.origin);
    Vec3 ruling_across = vec3_cross(line.direction, ruling), off = vec3_cross(line.direction, from);
    double l = -vec3_dot(off, ruling_across) / vec3_dot(ruling_across, ruling_across);
    if (!(l >= -off_end && l <= 1 + off_end))
        return false;
    Vec3 miss = vec3_add_scaled(off, ruling_across, l);
    double limit = off_line * (joint->radius + vec3_length(joint->span));
    if (vec3_dot(miss, miss) > limit * limit)
        return false;
    /* S_p x S_l points outwards. */
    Vec3 turn = vec3_scale(vec3_add_scaled(joint->across, joint->across_change, l), -sine);
    turn = vec3_add_scaled(turn, joint->side, cosine * (joint->radius + joint->radius_change * l));
    Vec3 normal = vec3_cross(turn, ruling);
    double length = vec3_length(normal);
    hit->t = vec3_dot(vec3_add_scaled(from, ruling, l), line.direction);
    hit->normal = vec3_scale(normal, 1 / length);
    return length > 0;
}

int hit_joint(Ray ray, const JointFrame *joint, Hit hits[4])
{
    /* The line is shifted to start at its point nearest to the joint's base, so that all numbers
     * are as small as the joint. */
    Vec3 d = ray.direction;
    double nearest = vec3_dot(vec3_sub(joint->base, ray.origin), d);
    Ray line = {ray_at(ray, nearest), d};
    Vec3 from = vec3_sub(joint->base, line.origin), side = joint->side;
    /* g = g_1 + cos g_cos + sin g_sin + cos^2 g_cos2 + cos sin g_cos_sin */
    double g_1 = triple(d, from, joint->span);
    double g_cos = triple(d, from, joint->across_change) + triple(d, joint->across, joint->span);
    double g_sin =
        joint->radius_change * triple(d, from, side) + joint->radius * triple(d, side, joint->span);
    double g_cos2 = triple(d, joint->across, joint->across_change);
    double g_cos_sin = joint->radius_change * triple(d, joint->across, side) +
                       joint->radius * triple(d, side, joint->across_change);
    int count = 0;
    for (int half = 1; half >= -1; half -= 2) { /* the sign of the cosine */
        double c = half * g_cos, both = half * g_cos_sin;
        /* half the Bernstein coefficients of g (1 + u^2)^2 on [-1, 1] */
        double b[5] = {2 * (g_1 - g_sin), c - both, 2.0 / 3 * (g_1 + 2 * g_cos2), c + both,
                       2 * (g_1 + g_sin)};
        double roots[4];
        int n = quartic_roots(b, -1, 1, roots);
        for (int i = 0; i < n && count < 4; i++) {
            double square = roots[i] * roots[i];
            double cosine = half * (1 - square) / (1 + square), sine = 2 * roots[i] / (1 + square);
            if (ruling_hit(joint, line, cosine, sine, &hits[count]))
                hits[count++].t += nearest;
        }
    }
    return count;
}
