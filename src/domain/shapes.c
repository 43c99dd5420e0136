/* The domains that have a formula, centred at the origin, with y up: disc, ball, rectangle, box,
 * ellipsoid; and the wall of a left ventricle (the shell): an ellipsoid without a smaller
 * ellipsoid, its cavity, cut off at the base. All except the shell are convex.
 *
 * A tolerance t is added to the semi-axes of an ellipsoid. The ellipsoid with the semi-axes a + t
 * is within t of the one with the semi-axes a: in any direction u, it extends to |((a_i + t) u_i)|,
 * which is at most |(a_i u_i)| + t. By the same argument, a point outside the cavity's ellipsoid
 * with the semi-axes a - t is at most t deep in the cavity. */
#include "domain/kinds.h"

#include <string.h>

static double square(double x)
{
    return x * x;
}

/* Reads the numbers of a shape: `n_positive`, which must be there and at least DOMAIN_MIN_MM, and
 * up to `n_optional` more of either sign. */
static Status load_sizes(Domain *domain, int n_positive, int n_optional, const char *example,
                         const char *values, Err *err)
{
    const DomainOps *ops = domain->ops;
    int most = n_positive + n_optional, n = 0;
    for (const char *at = values; at; n++) {
        char number[64] = "";
        size_t length = strcspn(at, ",");
        if (length < sizeof number)
            memcpy(number, at, length);
        double value = 0;
        double least = n < n_positive ? DOMAIN_MIN_MM : -DOMAIN_MAX_MM;
        if (!number_parse(number, &value) || !(value >= least && value <= DOMAIN_MAX_MM))
            return err_set(err, STATUS_USAGE,
                           "'%.*s' is not a number of mm from %g to %g; %s:%s, as in %s:%s",
                           (int)length, at, least, DOMAIN_MAX_MM, ops->shape.name,
                           ops->shape.parameters, ops->shape.name, example);
        if (n < most)
            domain->parameter[n] = value;
        at = at[length] ? at + length + 1 : NULL;
    }
    if (n < n_positive || n > most)
        return err_set(err, STATUS_USAGE, "%d number%s, but the shape is %s:%s, as in %s:%s", n,
                       n == 1 ? "" : "s", ops->shape.name, ops->shape.parameters, ops->shape.name,
                       example);
    domain->n_parameters = n;
    return STATUS_OK;
}

/* Returns the first three numbers of the shape. */
static Vec3 size_vector(const Domain *domain)
{
    return vec3(domain->parameter[0], domain->parameter[1], domain->parameter[2]);
}

/* Discs and balls: compares the distance from the centre with the radius. */
static bool round_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    double reach = domain->parameter[0] + tolerance_mm;
    return vec3_dot(point, point) <= reach * reach;
}

static bool box_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    return box_contains(domain->own_bounds, point, tolerance_mm);
}

/* Returns the point, scaled so that the ellipsoid with the semi-axes axes + widening becomes the
 * unit ball. */
static Vec3 in_unit_ball(Vec3 point, Vec3 axes, double widening)
{
    return vec3(point.x / (axes.x + widening), point.y / (axes.y + widening),
                point.z / (axes.z + widening));
}

static bool ellipsoid_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    Vec3 unit = in_unit_ball(point, size_vector(domain), tolerance_mm);
    return vec3_dot(unit, unit) <= 1;
}

/* How the bounds and the volume of a simple shape follow from its sizes. */
typedef struct SimpleShape {
    int dimension, n_sizes; /* n_sizes 1: one size for all axes */
    double half;            /* half the extent along an axis, divided by the size along it */
    double volume;          /* volume or area, divided by the product of the sizes of all axes */
    const char *example;
} SimpleShape;

static const SimpleShape simple[SIMPLE_SHAPES] = {{2, 1, 1, PI, "50"},
                                                  {3, 1, 1, 4.0 / 3 * PI, "30"},
                                                  {2, 2, 0.5, 1, "60,40"},
                                                  {3, 3, 0.5, 1, "40,30,20"},
                                                  {3, 3, 1, 4.0 / 3 * PI, "40,50,30"}};

/* Reads the sizes of a shape of the table `simple`, and sets bounds, volume and inlet, which is the
 * point of the shape that is highest along y. */
static Status simple_load(Domain *domain, const char *values, Err *err)
{
    const SimpleShape *shape = &simple[domain->ops - simple_ops];
    TRY(load_sizes(domain, shape->n_sizes, 0, shape->example, values, err));
    const double *size = domain->parameter;
    bool one = shape->n_sizes == 1, flat = shape->dimension == 2;
    Vec3 along = vec3(size[0], size[!one], flat ? 0 : size[one ? 0 : 2]);
    Vec3 half = vec3_scale(along, shape->half);
    domain->dimension = shape->dimension;
    domain->bounds = (Box){vec3_sub(vec3(0, 0, 0), half), half};
    domain->volume = shape->volume * along.x * along.y * (flat ? 1 : along.z);
    domain->inlet = vec3(0, half.y, 0);
    return STATUS_OK;
}

const DomainOps simple_ops[SIMPLE_SHAPES] = {
    {.shape = {"disc", "R", "flat disc of radius R mm around the origin"},
     .is_convex = true,
     .load = simple_load,
     .inside = round_inside},
    {.shape = {"ball", "R", "ball of radius R mm around the origin"},
     .is_convex = true,
     .load = simple_load,
     .inside = round_inside},
    {.shape = {"rect", "W,H", "flat rectangle, sides W and H mm, centered on the origin"},
     .is_convex = true,
     .load = simple_load,
     .inside = box_inside},
    {.shape = {"box", "A,B,C", "box, sides A, B and C mm, centered on the origin"},
     .is_convex = true,
     .load = simple_load,
     .inside = box_inside},
    {.shape = {"ellipsoid", "A,B,C", "ellipsoid, semi-axes A, B and C mm, centered on the origin"},
     .is_convex = true,
     .load = simple_load,
     .inside = ellipsoid_inside},
};

/* Indices of the shell's numbers. They are: the semi-axes of the outer ellipsoid, how much shorter
 * the cavity's semi-axes are, and the height of the base. */
enum { SHELL_THICKNESS = 3, SHELL_BASE = 4 };

/* Returns the semi-axes of the cavity, the inner surface of the shell. */
static Vec3 cavity_axes(const Domain *domain)
{
    double thickness = domain->parameter[SHELL_THICKNESS];
    return vec3_sub(size_vector(domain), vec3(thickness, thickness, thickness));
}

/* Returns the volume of an ellipsoid below the height `top`, in [-axes.y, axes.y]. */
static double volume_below(Vec3 axes, double top)
{
    double s = top / axes.y;
    return PI * axes.x * axes.y * axes.z * (2.0 / 3 + s - s * s * s / 3);
}

/* Returns the radius along x of an ellipsoid at the height `y`, in [-axes.y, axes.y]. */
static double radius_at(Vec3 axes, double y)
{
    return axes.x * sqrt(1 - square(y / axes.y));
}

/* DomainOps.load. The inlet is in the middle of the wall at the base. */
static Status shell_load(Domain *domain, const char *values, Err *err)
{
    TRY(load_sizes(domain, 4, 1, "30,50,30,10,20", values, err));
    Vec3 outer = size_vector(domain), cavity = cavity_axes(domain);
    if (domain->n_parameters == SHELL_BASE)
        domain->parameter[SHELL_BASE] = cavity.y / 2;
    domain->n_parameters = SHELL_BASE + 1;
    if (!(fmin(cavity.x, fmin(cavity.y, cavity.z)) > 0))
        return err_set(err, STATUS_USAGE,
                       "the THICKNESS %.9g must be less than each of the semi-axes A, B and C",
                       domain->parameter[SHELL_THICKNESS]);
    double base = domain->parameter[SHELL_BASE];
    if (!(fabs(base) < cavity.y))
        return err_set(err, STATUS_USAGE,
                       "the height BASE %.9g must be between -%.9g and %.9g, B - THICKNESS, so "
                       "that the cavity is open there",
                       base, cavity.y, cavity.y);
    double widest = base < 0 ? radius_at(outer, base) / outer.x : 1;
    domain->dimension = 3;
    domain->bounds = (Box){vec3(-outer.x * widest, -outer.y, -outer.z * widest),
                           vec3(outer.x * widest, base, outer.z * widest)};
    domain->volume = volume_below(outer, base) - volume_below(cavity, base);
    domain->inlet = vec3((radius_at(outer, base) + radius_at(cavity, base)) / 2, base, 0);
    return STATUS_OK;
}

/* Returns true if the segment from a to b is in the shell. The outer ellipsoid, cut off at the
 * base, is convex, so that only the two ends are tested. The whole segment must be outside the
 * cavity: in the coordinates in which the cavity is the unit ball, its distance from the origin is
 * at least 1. */
static bool shell_holds(const Domain *domain, Vec3 a, Vec3 b, double tolerance_mm)
{
    Vec3 outer = size_vector(domain), cavity = cavity_axes(domain);
    Vec3 outer_a = in_unit_ball(a, outer, tolerance_mm);
    Vec3 outer_b = in_unit_ball(b, outer, tolerance_mm);
    double top = domain->parameter[SHELL_BASE] + tolerance_mm;
    if (vec3_dot(outer_a, outer_a) > 1 || vec3_dot(outer_b, outer_b) > 1 || a.y > top || b.y > top)
        return false;
    if (fmin(cavity.x, fmin(cavity.y, cavity.z)) <= tolerance_mm)
        return true;
    Vec3 cavity_a = in_unit_ball(a, cavity, -tolerance_mm);
    Vec3 cavity_b = in_unit_ball(b, cavity, -tolerance_mm);
    return vec3_distance2_along(vec3_scale(cavity_a, -1), vec3_sub(cavity_b, cavity_a)) >= 1;
}

static bool shell_inside(const Domain *domain, Vec3 point, double tolerance_mm)
{
    return shell_holds(domain, point, point, tolerance_mm);
}

static bool shell_holds_segment(const Domain *domain, Vec3 a, Vec3 b)
{
    return shell_holds(domain, a, b, domain->slack_mm);
}

const DomainOps shell_ops = {
    .shape = {"shell", "A,B,C,THICKNESS[,BASE]",
              "wall of a left ventricle: ellipsoid with a cavity, cut off at the height BASE"},
    .load = shell_load,
    .inside = shell_inside,
    .holds_segment = shell_holds_segment,
};
