/* Integrates functions over the intersection of a polygon with a disc about the origin, or over the
 * shade of a ball, edge by edge.
 *
 * An edge is split where it crosses the circle. The part inside the circle forms a triangle with
 * the origin, the part outside a sector. Both integrals have closed forms.
 *
 * For a ball, the integrand outside the circle is r^3 / (d^2 + s^2)^(3/2), at the distance s from
 * the origin and the height d. Along a ray from the origin, it integrates to a difference of
 * r^3 / sqrt(d^2 + s^2). This, over the angle to a straight edge at distance h, integrates to a
 * difference of r^3 / d asin(d sin a / sqrt(d^2 + h^2)), where a is the angle from the direction of
 * the edge's nearest point. */
#include "voxel/disc.h"

#include "base/base.h"

#include <math.h>
#include <stdbool.h>

static double cross(DiscPoint p, DiscPoint q)
{
    return p.u * q.v - p.v * q.u;
}

static double dot(DiscPoint p, DiscPoint q)
{
    return p.u * q.u + p.v * q.v;
}

/* The part of an edge, from p to q, that is inside the circle. */
typedef struct EdgeInside {
    DiscPoint in, out; /* its ends */
    bool enters;       /* the edge enters the circle at `in`; else `in` is p */
    bool leaves;       /* the edge leaves the circle at `out`; else `out` is q */
} EdgeInside;

/* Finds the part of the edge inside the circle. Returns false if there is none. */
static bool cut_edge(DiscPoint p, DiscPoint q, double radius2, EdgeInside *inside)
{
    DiscPoint d = {q.u - p.u, q.v - p.v};
    double a = dot(d, d), b = dot(p, d), root2 = b * b - a * (dot(p, p) - radius2);
    if (!(root2 > 0 && a > 0))
        return false;
    double root = sqrt(root2), from = (-b - root) / a, to = (-b + root) / a;
    inside->enters = from > 0;
    inside->leaves = to < 1;
    inside->in = from > 0 ? (DiscPoint){p.u + from * d.u, p.v + from * d.v} : p;
    inside->out = to < 1 ? (DiscPoint){p.u + to * d.u, p.v + to * d.v} : q;
    return to > 0 && from < 1;
}

static void add_triangle(DiscIntegrals *part, DiscPoint p, DiscPoint q)
{
    double area = cross(p, q) / 2;
    part->one += area;
    part->u += area * (p.u + q.u) / 3;
    part->v += area * (p.v + q.v) / 3;
}

/* Adds the sector between the directions of p and q, which are less than half a turn apart. */
static void add_sector(DiscIntegrals *part, DiscPoint p, DiscPoint q, double radius)
{
    double angle = elementary_atan2(cross(p, q), dot(p, q)), third = radius * radius * radius / 3;
    double to_p = third / sqrt(dot(p, p)), to_q = third / sqrt(dot(q, q));
    part->one += radius * radius * angle / 2;
    part->u += q.v * to_q - p.v * to_p;
    part->v += p.u * to_p - q.u * to_q;
}

void discintegrals_add(DiscIntegrals *part, DiscPoint p, DiscPoint q, double radius)
{
    EdgeInside inside;
    if (p.u == q.u && p.v == q.v)
        return;
    if (!cut_edge(p, q, radius * radius, &inside)) {
        add_sector(part, p, q, radius);
        return;
    }
    if (inside.enters)
        add_sector(part, p, inside.in, radius);
    add_triangle(part, inside.in, inside.out);
    if (inside.leaves)
        add_sector(part, inside.out, q, radius);
}

/* Returns the integral over the triangle of the origin, p and q, whose edge from p to q is outside
 * the circle. It is the sum of the sector inside the circle and the part beyond the circle. `above`
 * is the height of the ball's centre above the plane. The circle is empty if the ball does not
 * reach the plane. */
static double ball_integral_outside(DiscPoint p, DiscPoint q, double radius, double above)
{
    DiscPoint edge = {q.u - p.u, q.v - p.v};
    double turn = cross(p, q), length = sqrt(dot(edge, edge));
    if (turn == 0)
        return 0;
    double h = fabs(turn) / length, pp = dot(p, p), qq = dot(q, q), d2 = above * above;
    double at_p = elementary_atan2(above * dot(p, edge) / length, h * sqrt(d2 + pp));
    double at_q = elementary_atan2(above * dot(q, edge) / length, h * sqrt(d2 + qq));
    double angle = elementary_atan2(turn, dot(p, q)), r2 = radius * radius;
    return fmax(0, r2 - d2) * angle / 2 +
           r2 * radius * (angle / fmax(radius, above) - copysign(at_q - at_p, turn) / above);
}

double ballcone_edge(DiscPoint p, DiscPoint q, double radius, double above)
{
    double height = fabs(above), shade = 0;
    EdgeInside inside;
    if (!cut_edge(p, q, radius * radius - height * height, &inside))
        return ball_integral_outside(p, q, radius, height);
    if (inside.enters)
        shade += ball_integral_outside(p, inside.in, radius, height);
    if (inside.leaves)
        shade += ball_integral_outside(inside.out, q, radius, height);
    return cross(inside.in, inside.out) / 2 + shade;
}
