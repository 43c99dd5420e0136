/* Writes the joints between vessels for POV-Ray, as isosurfaces.
 *
 * A joint is the ruled surface between two circles, which POV-Ray does not have. The surface is
 * algebraic of degree 4, so a `poly` could represent it. But POV-Ray expands the polynomial at the
 * start of the ray: from a distance of D radii the coefficients lose a factor of D^4 in precision,
 * and small vessels dissolve. An `isosurface` whose function is 0 on the surface is evaluated at
 * points near the surface and keeps full precision. POV-Ray then finds the surface to within 2e-9
 * radii.
 *
 * The function [docs/METHODS.md section 7]. The coordinates are those of the first circle: x is
 * along e_1, y along f, and z along the circle's axis; the unit of length is the radius r_1. A
 * ruling connects the points of the two circles at the same angle p. Projected to (x, z), it is a
 * straight line from (cos p, 0) to a point of the line from a = C_2(pi) to b = C_2(0). Let l in [0,
 * 1] be the position along a ruling. The points of equal l lie in a plane parallel to y, on an
 * ellipse. One diameter of the ellipse goes from (1
 * - l) (-1, 0) + l a to (1 - l) (1, 0) + l b. Its half axis along y is R = 1 - l + l r_2 / r_1. Let
 * s in [-1, 1] be the position along the diameter. Then G = y^2 - R^2 (1 - s^2) is 0 on the
 * surface. For given x and z, l is a root of a quadratic equation: (x, z) must be on the diameter
 * of l.
 *
 * Where ellipses bunch together, the gradient of G is unbounded. G is therefore multiplied by J,
 * the determinant of the derivative of (x, z) with respect to (l, s). Outside the planes of the two
 * circles and of the rulings in y = 0, the function is the distance from these planes instead. The
 * function nowhere exceeds half of max_gradient times the distance from the surface. Without the
 * factor of one half, this bound suffices for POV-Ray to find the first root. The factor is needed
 * because POV-Ray skips rays near a ray that missed. */
#include "emit/povray_members.h"
#include "emit/povray_text.h"
#include "emit/values.h"

/* For each number in a function, POV-Ray searches the list of all such numbers. If a scene has more
 * than MANY joints, each joint therefore stores its six numbers in two transform functions, which
 * are not searched. A joint then has three functions. POV-Ray can hold 1,048,575 functions, hence
 * MAX_EXACT. With more joints, all joints are meshes of SIDES_OF_MANY sides. */
enum { MANY = 8000, MAX_EXACT = 349000, SIDES_OF_MANY = 16 };

/* The second circle in the frame of the function: the plane y = 0, unit r_1. */
typedef struct JointPlane {
    double ax, az, bx, bz; /* the ends a and b of its diameter in the plane */
    double ratio;          /* r_2 / r_1 */
} JointPlane;

/* Numbers of intervals in l and s at whose ends the gradient of J G is sampled to find its maximum,
 * and the factor that allows for larger values between the samples. The gradient changes slowly
 * along a ruling, hence few steps in l. More samples would permit a smaller factor, which makes
 * POV-Ray faster. */
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

/* Returns the length of the gradient of J G at the point (l, s) of the surface. Its component along
 * y is the mean slope from the surface to the side of the joint's bounding box. */
static double gradient_at(const JointPlane *plane, double l, double s)
{
    /* (half_x, half_z) is half of the diameter, the derivative of (x, z) with respect to s;
     * (change_x, change_z) is the derivative with respect to l. J is their cross product. */
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

/* Counts the joints among all primitives and among the primitives that are written. */
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

Status put_joint_macros(Text *out, const void *context, Err *err)
{
    const PovrayGeometry *geometry = context;
    Values values = {.digits = geometry->params->digits};
    size_t all, written;
    count_joints(geometry, &all, &written);
    geometry->report->joint_sides = written > MAX_EXACT ? SIDES_OF_MANY : 0;
    add_count(&values, "sides", (size_t)geometry->report->joint_sides);
    add_flag(&values, "many_joints", all > MANY);
    return values_expand(&values, geometry->params, "povray/joints.inc", out, err);
}

void put_joint(Text *text, const EmitParams *params, const Primitive *joint)
{
    JointFrame frame = primitive_joint(joint);
    Vec3 across = vec3_scale(frame.across, 1 / frame.radius);
    JointPlane plane = joint_plane(&frame, across, joint->axes[0]);
    /* The distances from the planes are multiplied by the lengths of the planes' normals, which are
     * not unit vectors. This is the largest of these lengths. */
    double sides =
        fmax(elementary_hypot(plane.ax + 1, plane.az), elementary_hypot(plane.bx - 1, plane.bz));
    /* If rulings cross, the function does not describe the surface, and the joint is drawn as a
     * mesh. */
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
