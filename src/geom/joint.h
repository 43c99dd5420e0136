/* A joint: the ruled surface that connects the rims of two cylinders [Neumann et al. 1996, figure
 * 1; docs/METHODS.md section 7]. joint_frame prepares a joint, and hit_joint intersects it with
 * rays.
 *
 * The rims are the circles C_1 and C_2, with the centres c_i and radii r_i. The surface consists of
 * the straight lines between points with the same angle p:
 *
 *   S(p, l) = (1 - l) C_1(p) + l C_2(p),  C_i(p) = c_i + r_i (cos p e_i + sin p f),  l in [0, 1].
 *
 * f is a unit vector perpendicular to both axes, and e_i = f x axis_i. This choice of the angles
 * twists the surface as little as possible. */
#ifndef CORCAST_GEOM_JOINT_H
#define CORCAST_GEOM_JOINT_H

#include "geom/hit.h"

/* A joint, prepared for many rays:
 *   C_1(p) = base + cos p across + sin p radius side,
 *   C_2(p) - C_1(p) = span + cos p across_change + sin p radius_change side. */
typedef struct JointFrame {
    Vec3 base;                    /* c_1 */
    Vec3 span;                    /* c_2 - c_1 */
    Vec3 side;                    /* f, unit */
    Vec3 across, across_change;   /* r_1 e_1 and r_2 e_2 - r_1 e_1 */
    double radius, radius_change; /* r_1 and r_2 - r_1 */
} JointFrame;

/* Prepares the joint of two circles. Circle i has the centre center[i] and the radius radius[i] >
 * 0, and its plane is perpendicular to axis[i]. The axes are unit vectors, and both point from the
 * first circle towards the second. If the axes are parallel, f is an arbitrary perpendicular. */
JointFrame joint_frame(const Vec3 center[2], const Vec3 axis[2], const double radius[2]);

/* Returns the point of the surface at the parameters p and l. The angle p is given by its cosine
 * and sine. */
Vec3 joint_point(const JointFrame *joint, double cosine, double sine, double l);

/* Finds the intersections of the line through the ray, in both directions, with the surface, in no
 * particular order. ray.direction is a unit vector. Returns their number, at most 4. Two
 * intersections whose angles p differ by less than 2^-32 of half a turn are left out: the line only
 * grazes the surface there. Normals are unit vectors. They point outwards if each circle lies on
 * one side of the plane of the other circle. */
int hit_joint(Ray ray, const JointFrame *joint, Hit hits[4]);

#endif
