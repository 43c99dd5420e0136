/* Computes the ambient visibility of one point by rays: the fraction of cosine-weighted directions
 * in which nothing is hit.
 *
 * Directions are points of a disc, lifted to the hemisphere above the disc (Malley's method). Their
 * density is then proportional to their cosine to the normal, so that the mean needs no weights.
 * The points of the disc form a sunflower pattern: point k of n lies at the radius sqrt((k + u) /
 * n), turned by k golden angles, with u in [0, 1). They are evenly spread for every n.
 *
 * The same points at every pixel would leave bands. The pattern is therefore turned by another
 * angle, with another u, from pixel to pixel, which leaves fine grain with the right mean. */
#include "render/light/rayocclusion.h"

#include <math.h>

/* u is the fractional part of this number times the turn: u runs from 0 to 1 twelve times while the
 * pattern turns once. Pixels with nearly equal turns thus have all values of u. With 1, u would be
 * the turn, and the patterns of neighbours would be alike. */
static const double shifts_per_turn = 12;
static const double golden_part =
    0.3819660112501051; /* the golden angle as a fraction of a full turn */

/* Two unit vectors that span the plane perpendicular to a normal. */
typedef struct Axes {
    Vec3 a, b;
} Axes;

/* Returns two unit vectors perpendicular to the normal and to each other. Source: T. Duff et al.:
 * Building an orthonormal basis, revisited, J. Comput. Graph. Tech. 6 (2017) 1-8. */
static Axes axes_about(Vec3 n)
{
    double sign = copysign(1, n.z), s = -1 / (sign + n.z), t = n.x * n.y * s;
    return (Axes){{1 + sign * n.x * n.x * s, sign * t, -sign * n.x},
                  {t, sign + n.y * n.y * s, -n.y}};
}

double rayocclusion_ambient(Caster *caster, int worker, const Ground *ground, Vec3 point,
                            Vec3 normal, int rays, double turn)
{
    Axes axes = axes_about(normal);
    int open = 0;
    double shift = turn * shifts_per_turn - floor(turn * shifts_per_turn);
    for (int k = 0; k < rays; k++) {
        double part = (k + shift) / rays, radius = sqrt(part);
        double angle = FULL_TURN * (k * golden_part + turn);
        Vec3 direction = vec3_scale(normal, sqrt(1 - part));
        direction = vec3_add_scaled(direction, axes.a, radius * elementary_cos(angle));
        direction = vec3_add_scaled(direction, axes.b, radius * elementary_sin(angle));
        open += !caster_shadow(caster, worker, ground, point, vec3_normalized(direction), HUGE_VAL);
    }
    return (double)open / rays;
}

/* Interleaved gradient noise: J. Jimenez, Next generation post processing in Call of Duty: Advanced
 * Warfare, SIGGRAPH 2014. Every 3 x 3 neighbours have values spread over 0 to 1. */
double rayocclusion_turn(double i, double j)
{
    double slope = 0.06711056 * i + 0.00583715 * j;
    double turn = 52.9829189 * (slope - floor(slope));
    return turn - floor(turn);
}
