/* Projects one primitive (cylinder, ball or joint) to a view. A primitive becomes an item: its
 * middle in double precision, everything else in single precision relative to that middle. Single
 * precision then has to hold only numbers as small as the primitive.
 *
 * An item is RASTER_EXACT if single precision cannot draw it to a thousandth of a pixel, or if the
 * kernels do not solve it: items that are near the viewer or around the viewer, longer than 16384
 * pixels, or viewed along their axis, and joints that may not be the surface of a solid. */
#include "render/raster/rasteritem.h"

/* Maximum length of an item that is drawn in single precision, pixels: 2^-24 of it is a thousandth
 * of a pixel. */
static const double max_length_px = 16384;
/* Sine of the smallest angle between axis and line of sight at which a cylinder is drawn in single
 * precision. Depths are divided by the sine, so that at 0.02 their errors are 50 times those of a
 * view from the side, 3e-6 of the item's length. A smaller value draws with larger errors, a larger
 * one leaves more cylinders to double precision. */
static const double min_sine = 0.02;

static void store_floats(float to[3], Vec3 v)
{
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

/* Turns a pair of vectors, such as those that span a circle, by an angle. */
static void turn_pair(Vec3 *a, Vec3 *b, double cosine, double sine)
{
    const Vec3 turned = vec3_add_scaled(vec3_scale(*a, cosine), *b, sine);
    *b = vec3_add_scaled(vec3_scale(*b, cosine), *a, -sine);
    *a = turned;
}

RasterJoint rasterjoint_make(const RasterView *view, const Primitive *primitive, Vec3 middle)
{
    RasterJoint made;
    JointFrame joint = rasterview_joint(view, primitive);
    const Vec3 base = vec3_sub(joint.base, middle), span = joint.span;
    const Vec3 sight = view->eye.perspective ? middle : vec3(0, 0, 1);
    /* The frame is left-handed. Reversing the direction of rotation keeps S_q x S_l pointing
     * outward. */
    joint.side = vec3_scale(joint.side, -1);
    Vec3 a = joint.across, b = vec3_scale(joint.side, joint.radius);
    Vec3 da = joint.across_change, db = vec3_scale(joint.side, joint.radius_change);
    /* The joint is turned so that q = 0 is the ruling that faces the line of sight most: the ruling
     * at which the first harmonic of sight . (S_q x S_l), halfway along the joint, is minimal. */
    double along_a = vec3_dot(sight, vec3_cross(vec3_add_scaled(a, da, 0.5), span));
    double along_b = vec3_dot(sight, vec3_cross(vec3_add_scaled(b, db, 0.5), span));
    double size = sqrt(along_a * along_a + along_b * along_b);
    double cosine = size > 0 ? -along_b / size : 1, sine = size > 0 ? along_a / size : 0;
    turn_pair(&a, &b, cosine, sine);
    turn_pair(&da, &db, cosine, sine);
    store_floats(made.base, base);
    store_floats(made.span, span);
    store_floats(made.a, a);
    store_floats(made.b, b);
    store_floats(made.da, da);
    store_floats(made.db, db);
    store_floats(made.by[0], vec3_add(vec3_cross(base, span), vec3_cross(b, db)));
    store_floats(made.by[1], vec3_add(vec3_cross(base, da), vec3_cross(a, span)));
    store_floats(made.by[2], vec3_add(vec3_cross(base, db), vec3_cross(b, span)));
    store_floats(made.by[3], vec3_sub(vec3_cross(a, da), vec3_cross(b, db)));
    store_floats(made.by[4], vec3_add(vec3_cross(a, db), vec3_cross(b, da)));
    return made;
}

/* Stores a plane through `center` with the normal `inward`, moved outwards by 1e-3 radii, a margin
 * for rounding and for hits beside the line [kernel_joint.h]. */
static void store_plane(float to[4], Vec3 inward, Vec3 center, double radius)
{
    store_floats(to, inward);
    to[3] = (float)(1e-3 * radius - vec3_dot(inward, center));
}

/* Returns the hull of a joint: the planes of its ends and a cone, half a thousandth wider, between
 * which the joint lies. `turn` is 1 if the item's axis leads from a to b, else -1. */
static RasterHull make_hull(const RasterView *view, const Primitive *primitive, Vec3 span,
                            double length, double turn)
{
    RasterHull hull;
    double a = primitive->radius_mm, b = primitive->radius_b_mm;
    bool tapers = fabs(a - b) < length;
    store_plane(hull.plane[0], viewpoint_frame_direction(&view->eye, primitive->axes[0]),
                vec3_scale(span, -0.5), a);
    store_plane(hull.plane[1],
                vec3_scale(viewpoint_frame_direction(&view->eye, primitive->axes[1]), -1),
                vec3_scale(span, 0.5), b);
    hull.middle = (float)((tapers ? (a + b) / 2 : max_of(a, b)) * 1.0005);
    hull.taper = (float)(tapers ? turn * (a - b) / length : 0);
    return hull;
}

/* The axis of a capsule in a view. */
typedef struct ItemAxis {
    double length;
    double sine, cosine; /* of the angle to the view direction; cosine >= 0 */
    double ex, ey;       /* unit vector across the view */
    double turn;         /* 1 if the axis leads from a to b, -1 if it leads from b to a */
} ItemAxis;

static ItemAxis axis_of(Vec3 span)
{
    ItemAxis axis = {.length = vec3_length(span), .sine = 1, .ex = 1, .turn = span.z < 0 ? -1 : 1};
    if (axis.length > 0) {
        double across = sqrt(span.x * span.x + span.y * span.y);
        axis.cosine = axis.turn * span.z / axis.length;
        axis.sine = across / axis.length;
        axis.ex = across > 0 ? axis.turn * span.x / across : 1;
        axis.ey = across > 0 ? axis.turn * span.y / across : 0;
    }
    return axis;
}

/* Returns the kind of a primitive that is neither close to the eye nor too long. */
static RasterKind kind_of(const Geometry *geometry, const RasterView *view,
                          const Primitive *primitive, const ItemAxis *axis)
{
    if (primitive->kind == PRIMITIVE_CYLINDER)
        return !view->eye.perspective && axis->sine < min_sine ? RASTER_EXACT : RASTER_CYLINDER;
    if (primitive->kind == PRIMITIVE_JOINT)
        return !geometry->open_joints && primitive_joint_is_solid(primitive) ? RASTER_JOINT
                                                                             : RASTER_EXACT;
    return RASTER_SPHERE;
}

/* Returns true if an item is close to the eye, or longer than single precision can draw. */
static bool needs_double(const RasterView *view, const RasterItem *item, const ItemAxis *axis,
                         double z, double radius)
{
    double near = z - axis->cosine * axis->length / 2 - radius;
    double pixel = min_of(view->step_x, -view->step_y) * (view->eye.perspective ? near : 1);
    return item_is_close(item) || axis->length / 2 + radius > max_length_px * pixel;
}

void rasteritem_make(const Geometry *geometry, const RasterView *view, uint32_t number,
                     RasterItem *item, RasterJoint *joint, RasterHull *hull)
{
    const Primitive *primitive = &geometry->primitives[number];
    Vec3 middle = vec3_scale(vec3_add(primitive->a, primitive->b), 0.5);
    middle = viewpoint_frame_point(&view->eye, middle);
    Vec3 span = viewpoint_frame_direction(&view->eye, vec3_sub(primitive->b, primitive->a));
    double radius = max_of(primitive->radius_mm, primitive_radius_b(primitive));
    if ((view->hidden && view->hidden[number]) || rasterreach_misses(view, middle, span, radius)) {
        item->rows = item->columns = rastertiles_of(NO_TILES);
        return;
    }
    const ItemAxis axis = axis_of(span);
    RasterKind kind = kind_of(geometry, view, primitive, &axis);
    if (kind == RASTER_JOINT && view->light)
        *hull = make_hull(view, primitive, span, axis.length, axis.turn);
    else if (kind == RASTER_JOINT)
        *joint = rasterjoint_make(view, primitive, middle);
    item->x = middle.x;
    item->y = middle.y;
    item->z = middle.z;
    item->ex = (float)axis.ex;
    item->ey = (float)axis.ey;
    item->sine = (float)axis.sine;
    item->cosine = (float)axis.cosine;
    item->radius = (float)radius;
    item->half = (float)(axis.length / 2);
    item->round_low = axis.turn > 0 ? primitive->round_a : primitive->round_b;
    item->round_high = axis.turn > 0 ? primitive->round_b : primitive->round_a;
    bool exact = needs_double(view, item, &axis, middle.z, radius);
    item->kind = (unsigned)(exact ? RASTER_EXACT : kind) & 3; /* two bits */
    rasterreach_set(view, item);
}
