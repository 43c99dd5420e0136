/* An edge is cut where it crosses the circle. With the origin, what is within makes a triangle, and
 * what is beyond a sector; both have closed forms. */
#include "voxel/disc.h"

#include <math.h>

static double cross(DiscPoint p, DiscPoint q)
{
    return p.u * q.v - p.v * q.u;
}

static void add_triangle(DiscPart *part, DiscPoint p, DiscPoint q)
{
    double area = cross(p, q) / 2;
    part->one += area;
    part->u += area * (p.u + q.u) / 3;
    part->v += area * (p.v + q.v) / 3;
}

/* Between the directions of p and q, which are less than half a turn apart. */
static void add_sector(DiscPart *part, DiscPoint p, DiscPoint q, double radius)
{
    double angle = atan2(cross(p, q), p.u * q.u + p.v * q.v);
    double third = radius * radius * radius / 3;
    double to_p = third / sqrt(p.u * p.u + p.v * p.v), to_q = third / sqrt(q.u * q.u + q.v * q.v);
    part->one += radius * radius * angle / 2;
    part->u += q.v * to_q - p.v * to_p;
    part->v += p.u * to_p - q.u * to_q;
}

void discpart_add(DiscPart *part, DiscPoint p, DiscPoint q, double radius)
{
    DiscPoint d = {q.u - p.u, q.v - p.v};
    double a = d.u * d.u + d.v * d.v, b = p.u * d.u + p.v * d.v;
    double c = p.u * p.u + p.v * p.v - radius * radius, root2 = b * b - a * c;
    if (!(a > 0))
        return;
    double root = root2 > 0 ? sqrt(root2) : 0;
    double from = (-b - root) / a, to = (-b + root) / a;
    if (root2 <= 0 || to <= 0 || from >= 1) {
        add_sector(part, p, q, radius);
        return;
    }
    DiscPoint in = from > 0 ? (DiscPoint){p.u + from * d.u, p.v + from * d.v} : p;
    DiscPoint out = to < 1 ? (DiscPoint){p.u + to * d.u, p.v + to * d.v} : q;
    if (from > 0)
        add_sector(part, p, in, radius);
    add_triangle(part, in, out);
    if (to < 1)
        add_sector(part, out, q, radius);
}
