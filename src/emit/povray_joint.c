/* POV-Ray has no ruled surface between two circles. It is of degree 4, so a `poly` holds it, but
 * POV-Ray expands a poly about the start of the ray: from a distance of D radii its coefficients
 * lose D^4 of their precision, and small vessels dissolve. An `isosurface` whose function is zero
 * on the surface is evaluated on the spot and keeps full precision; it is found to within 2e-9
 * radii.
 *
 * The function [docs/METHODS.md section 7]. In the frame of the first circle, x along e_1, y along
 * f, z along its axis, unit r_1, a ruling's x and z run straight from (cos p, 0) to a point of the
 * line from a = C_2(pi) to b = C_2(0). So the points of equal l lie in planes that hold the line
 * from (1 - l) (-1, 0) + l a to (1 - l) (1, 0) + l b, on the ellipse with that diameter in the
 * plane and the half axis R = 1 - l + l r_2 / r_1 along y. With s in [-1, 1] the place along the
 * diameter, G = y^2 - R^2 (1 - s^2), where l is the root of a quadratic: x and z lie on the line of
 * l. Where rulings bunch together G has no largest gradient, so that it is multiplied by J, the
 * area that (l, s) has in (x, z). Outside the planes of the circles and of the rulings in y = 0,
 * the distance to these stands in for it. It does not exceed half of max_gradient times the
 * distance from the surface anywhere: POV-Ray needs that without the half to find the first root,
 * and with it to be right when it skips rays near one that missed. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

/* POV-Ray holds 1,048,575 functions, of which a joint has three where there are many, so that its
 * six numbers are none in a list that POV-Ray looks through for each of them. */
enum { MANY = 8000, MOST_EXACT = 349000, SIDES_OF_MANY = 16 };

/* The frame that POV-Ray's function is in: the plane of the axes, unit r_1. */
typedef struct JointPlane {
    double ax, az, bx, bz; /* the second circle's ends across */
    double ratio;          /* r_2 / r_1 */
} JointPlane;

/* How often J G is sampled along l and s for its largest gradient, and what is added for the places
 * between. */
enum { STEPS_L = 4, STEPS_S = 16 };
static const double gradient_margin = 1.25;

static JointPlane joint_plane(const JointFrame *frame, Vec3 across, Vec3 axis)
{
    double unit = 1 / frame->radius;
    Vec3 second = vec3_add(frame->across, frame->across_change);
    double center_x = vec3_dot(frame->span, across), center_z = vec3_dot(frame->span, axis);
    double second_x = vec3_dot(second, across), second_z = vec3_dot(second, axis);
    return (JointPlane){.ax = (center_x - second_x) * unit,
                        .az = (center_z - second_z) * unit,
                        .bx = (center_x + second_x) * unit,
                        .bz = (center_z + second_z) * unit,
                        .ratio = 1 + frame->radius_change * unit};
}

/* The length of the gradient of J G at (l, s) of the surface; along y the mean slope from there to
 * the side of the box that holds the joint. */
static double gradient_at(const JointPlane *plane, double l, double s)
{
    /* Half the diameter, and the change of the point (l, s) with l: J is their cross product. */
    double turn_x = (plane->bx - plane->ax) / 2 - 1, turn_z = (plane->bz - plane->az) / 2;
    double half_x = 1 + l * turn_x, half_z = l * turn_z, half = elementary_hypot(half_x, half_z);
    double change_x = (plane->ax + plane->bx) / 2 + s * turn_x;
    double change_z = (plane->az + plane->bz) / 2 + s * turn_z;
    double along = (change_x * half_x + change_z * half_z) / half;
    double area = change_z * half_x - change_x * half_z;
    double axis = 1 + l * (plane->ratio - 1);
    double by_s = 2 * axis * axis * s;
    double by_l = -2 * axis * (plane->ratio - 1) * (1 - s * s);
    double by_y = fmax(1, plane->ratio) + axis * sqrt(1 - s * s);
    return elementary_hypot(area * by_y,
                            elementary_hypot(by_s * area / half, by_l * half - by_s * along));
}

static double largest_gradient(const JointPlane *plane)
{
    double largest = 0;
    for (int i = 0; i <= STEPS_L; i++)
        for (int k = 0; k <= STEPS_S; k++)
            largest = fmax(largest, gradient_at(plane, (double)i / STEPS_L, 2.0 * k / STEPS_S - 1));
    return gradient_margin * largest;
}

/* How many primitives are joints, of all, and of those that are written. */
static void count_joints(const PovrayGeometry *geometry, size_t *all, size_t *written)
{
    const Geometry *whole = &geometry->scene->geometry;
    const PovrayItems items = geometry->objects[0];
    *all = *written = 0;
    for (size_t i = 0; i < whole->n_primitives; i++)
        *all += whole->primitives[i].kind == PRIMITIVE_JOINT;
    for (size_t i = 0; i < items.n; i++)
        *written += whole->primitives[items.index[i]].kind == PRIMITIVE_JOINT;
}

Status put_joint_macros(Text *out, void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Values values = {.digits = geometry->params->digits};
    size_t all, written;
    count_joints(geometry, &all, &written);
    geometry->report->joint_sides = written > MOST_EXACT ? SIDES_OF_MANY : 0;
    add_count(&values, "sides", (size_t)geometry->report->joint_sides);
    add_flag(&values, "many_joints", all > MANY);
    return values_expand(&values, geometry->params, "povray/joints.inc", out, err);
}

void put_joint(Text *text, const EmitParams *params, const Primitive *joint)
{
    JointFrame frame = primitive_joint(joint);
    Vec3 across = vec3_scale(frame.across, 1 / frame.radius);
    JointPlane plane = joint_plane(&frame, across, joint->axes[0]);
    /* The distances to the planes are not divided by the lengths of their normals, either. */
    double sides =
        fmax(elementary_hypot(plane.ax + 1, plane.az), elementary_hypot(plane.bx - 1, plane.bz));
    /* The function is that of the surface only where rulings do not cross. */
    bool folded = !primitive_joint_is_solid(joint);
    double steepest = fmax(fmax(1, 2 * plane.ratio), sides);
    double scale = folded ? 0 : steepest / largest_gradient(&plane);
    put_text(text, "Vessel_Joint(<%v>,<%v>,<%v>,<%v>,%n,", frame.base, across, frame.side,
             joint->axes[0], frame.radius);
    put_text(text, "%n,%n,%n,%n,%n,%n,%n,%d,", plane.ax, plane.az, plane.bx, plane.bz, plane.ratio,
             scale, 2 * steepest, folded);
    put_paint(text, params, joint->segment);
    text_puts(text, ")\n");
}
