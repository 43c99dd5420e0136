/* The ruled surface that joins the rims of two cylinders [N, figure 1; docs/METHODS.md section 7]:
 * straight lines between points of equal angle p of two circles,
 *   S(p, l) = (1 - l) C_1(p) + l C_2(p),  C_i(p) = c_i + r_i (cos p e_i + sin p f),  l in [0, 1],
 * where f is square to both axes and e_i = f x axis_i, so that the surface is twisted as
 * little as possible. */
#ifndef CORCAST_GEOM_JOINT_H
#define CORCAST_GEOM_JOINT_H

#include "geom/hit.h"

/* A joint, prepared for many rays: C_1 = base + cos p across + sin p radius side, and C_2 - C_1 =
 * span + cos p across_change + sin p radius_change side. */
typedef struct JointFrame {
    Vec3 base;                  /* c_1 */
    Vec3 span;                  /* c_2 - c_1 */
    Vec3 side;                  /* f, unit */
    Vec3 across, across_change; /* r_1 e_1 and r_2 e_2 - r_1 e_1 */
    double radius, radius_change;
} JointFrame;

/* Prepares the joint of two circles. Circle i has the centre center[i] and the radius radius[i] >
 * 0, and its plane is perpendicular to axis[i]. The axes are unit vectors, and both point from the
 * first circle towards the second. If the axes are parallel, f is an arbitrary perpendicular. */
JointFrame joint_frame(const Vec3 center[2], const Vec3 axis[2], const double radius[2]);

/* Returns the point of the surface at the parameters p and l. The angle p is given by its cosine
 * and sine. */
Vec3 joint_point(const JointFrame *joint, double cosine, double sine, double l);

/* Finds the intersections of the line with the surface, in no particular order. Returns their
 * number, at most 4. A line misses if it only grazes the surface: its two intersections are then
 * closer than 2^-32 of half a turn in the angle p. Normals are unit vectors; they point outwards if
 * each circle lies on one side of the other circle's plane. */
int hit_joint(Ray ray, const JointFrame *joint, Hit hits[4]);

#endif
