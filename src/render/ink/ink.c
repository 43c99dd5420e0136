/* Draws a tree as line art: finds the visible outlines of its vessels as strokes on paper.
 *
 * The outline of a surface is where the line of sight is tangent to it. A cylinder has two straight
 * outlines along its wall, and a ball has a circle. A cylinder's end that is neither inside a ball
 * nor at a joint also shows the edge of its disc. A joint (the ruled surface between two ellipses)
 * is cut into ellipses, and its outline is followed from ellipse to ellipse. The outline continues
 * along the edge between a joint and its cylinder where the viewer sees one of the two surfaces
 * from behind.
 *
 * A point of an outline is drawn if nothing is in front of it and it is inside no vessel. One ray
 * from a point just beside the wall to the viewer tests both, because a ray that begins inside a
 * vessel meets the wall where it leaves. Every outline is followed in steps of half a line width.
 * Where the visibility changes within a step, bisection finds the change [A. Appel, Proc. 22nd ACM
 * Nat. Conf. (1967) 387-393, with rays instead of counted crossings]. No line is drawn where
 * vessels intersect, as illustrators do.
 *
 * Threads draw blocks of vessels. The blocks are appended in order, so that the drawing does not
 * depend on the number of threads. */
#include "render/ink/ink.h"

#include "render/cast/caster.h"
#include "render/ink/inkjoint.h"
#include "render/ink/inkpieces.h"
#include <math.h>
#include <stdlib.h>

/* Vessels that a thread draws at a time. The drawing does not depend on it. */
enum { BLOCK = 64 };
/* Minimum number of steps along a curve, for curves shorter than two line widths. An arc takes four
 * times as many, because a vessel may hide both sides of a circle. */
enum { LEAST_STEPS = 4 };
/* Bisections of a step in which the visibility changes: 2^-6 of half a line width is a hundredth of
 * a line width, too little to see. */
enum { HALVINGS = 6 };
/* Samples around the edge of a joint at which its part in the outline is tested: arcs of the edge
 * begin and end to within a degree. */
enum { FINE_SAMPLES = 384 };
/* Intervals between ellipses along a joint. Within an interval the outline is exact [ruled_point];
 * more intervals find outlines that begin or end within the joint more exactly. */
enum { RULINGS = 16 };

/* Distance from the wall at which the ray to the viewer begins, in radii, so that the wall does not
 * hide itself. */
#define BESIDE 1e-6
/* Maximum distance between a circle and the polygon that is drawn for it, mm of paper. It is less
 * than a dot of a typesetter of 2540 dots per inch, 0.01 mm. A smaller value makes larger files. */
#define SAGITTA_MM 0.004

/* A line drawing while it is made. */
typedef struct InkDrawing {
    const Geometry *geometry;
    const Camera *camera;
    Caster *caster;
    double mm_per_pixel, line_mm;
    double paper[2]; /* width and height, mm */
    Vec3 *joined;    /* ends of joints, sorted; owned */
    size_t n_joined;
    size_t n_blocks;
    InkPieces *pieces; /* per block; owned */
} InkDrawing;

/* The arguments for drawing one block of vessels. */
typedef struct InkPen {
    const InkDrawing *ink;
    int worker;
    InkPieces *pieces; /* receives the lines */
} InkPen;

/* A position on paper; `per_mm` is the scale at this point: mm on paper per mm across the view. */
typedef struct OnPaper {
    double at[2], per_mm;
} OnPaper;

/* ---- from the world to the paper ------------------------------------------------------------- */

/* Projects a point to the paper. */
static OnPaper on_paper(const InkDrawing *ink, Vec3 point)
{
    const CameraPoint projected = camera_point(ink->camera, point);
    return (OnPaper){{projected.x * ink->mm_per_pixel, projected.y * ink->mm_per_pixel},
                     projected.per_mm * ink->mm_per_pixel};
}

/* Returns true if no vessel is between the point and the viewer. */
static bool is_visible(const InkPen *pen, Vec3 point)
{
    static const Ground none;
    double distance;
    Vec3 towards = towards_viewer(pen->ink->camera, point, &distance);
    return !caster_shadow(pen->ink->caster, pen->worker, &none, point, towards, distance);
}

/* ---- curves ---------------------------------------------------------------------------------- */

typedef enum CurveKind { CURVE_LINE, CURVE_ARC, CURVE_RULED } CurveKind;

/* A curve with a parameter t from 0 to 1. CURVE_LINE: the line from `from` to `from` + `along`.
 * CURVE_ARC: a part of the circle about `from` through `from` + `u` and `from` + `v`. CURVE_RULED:
 * the outline of a joint between two of its ellipses. */
typedef struct InkCurve {
    CurveKind kind;
    Vec3 from, along, u, v;
    double begin, span;      /* arc: its first angle and its angle, in turns */
    const JointFrame *joint; /* ruled: borrowed */
    double angle[2];         /* ruled: approximate angles at which it begins and ends */
    double fraction[2];      /* ruled: positions of the two ellipses along the joint, 0 to 1 */
    Vec3 aside;              /* line: from a point of it to the start of the ray to the viewer */
    double shift[2];         /* line: from its projection to where it is drawn, mm of paper */
    double shrink;           /* arc: how much smaller it is drawn, in radii */
    double length_mm;        /* on paper */
    double width_mm;
} InkCurve;

/* Returns a point of an arc with its radius scaled by `radii`: a little more than 1 for the point
 * that is tested for visibility, 1 - curve->shrink for the point that is drawn. */
static Vec3 circle_point(const InkCurve *curve, double t, double radii)
{
    double angle = FULL_TURN * (curve->begin + t * curve->span);
    Vec3 out = vec3_add_scaled(vec3_scale(curve->u, elementary_cos(angle)), curve->v,
                               elementary_sin(angle));
    return vec3_add_scaled(curve->from, out, radii);
}

/* Returns a point of a joint's outline, and the normal there. Interpolates the angle, and finds the
 * nearest angle that is exactly on the outline. */
static Vec3 ruled_point(const InkDrawing *ink, const InkCurve *curve, double t, Vec3 *normal)
{
    double fraction = curve->fraction[0] + t * (curve->fraction[1] - curve->fraction[0]);
    double angle = curve->angle[0] + t * (curve->angle[1] - curve->angle[0]);
    angle = joint_outline_near(ink->camera, curve->joint, angle, fraction);
    *normal = joint_normal(curve->joint, angle, fraction);
    return joint_point(curve->joint, elementary_cos(angle), elementary_sin(angle), fraction);
}

static bool curve_is_visible(const InkPen *pen, const InkCurve *curve, double t)
{
    Vec3 point, normal;
    if (curve->kind == CURVE_ARC)
        point = circle_point(curve, t, 1 + BESIDE);
    else if (curve->kind == CURVE_LINE)
        point = vec3_add(vec3_add_scaled(curve->from, curve->along, t), curve->aside);
    else
        point = vec3_add_scaled(ruled_point(pen->ink, curve, t, &normal), normal,
                                BESIDE * curve->joint->radius);
    return is_visible(pen, point);
}

/* Adds a point of a joint's outline, moved inwards by half a line width. */
static Status add_ruled(const InkPen *pen, const InkCurve *curve, double t, Err *err)
{
    Vec3 normal, point = ruled_point(pen->ink, curve, t, &normal);
    OnPaper on = on_paper(pen->ink, point);
    double inwards = pen->ink->line_mm / 2 / on.per_mm;
    return inkpieces_add(pen->pieces,
                         on_paper(pen->ink, vec3_add_scaled(point, normal, -inwards)).at, err);
}

static Status add_point(const InkPen *pen, const InkCurve *curve, double t, Err *err)
{
    if (curve->kind == CURVE_RULED)
        return add_ruled(pen, curve, t, err);
    if (curve->kind == CURVE_ARC)
        return inkpieces_add(pen->pieces,
                             on_paper(pen->ink, circle_point(curve, t, 1 - curve->shrink)).at, err);
    OnPaper point = on_paper(pen->ink, vec3_add_scaled(curve->from, curve->along, t));
    point.at[0] += curve->shift[0];
    point.at[1] += curve->shift[1];
    return inkpieces_add(pen->pieces, point.at, err);
}

/* Draws the curve from t to `end`. An arc is drawn as a polygon with sides of at most an eighth of
 * a turn. */
static Status add_piece(const InkPen *pen, const InkCurve *curve, double t, double end, Err *err)
{
    double radius_mm = curve->length_mm / curve->span / FULL_TURN;
    double side =
        fmin(2 * elementary_acos(1 - fmin(SAGITTA_MM / radius_mm, 0.5)) / FULL_TURN, 0.125);
    int sides = curve->kind == CURVE_ARC ? (int)ceil((end - t) * curve->span / side) : 1;
    TRY(inkpieces_begin(pen->pieces, curve->width_mm, err));
    for (int k = 0; k < sides; k++)
        TRY(add_point(pen, curve, t + (end - t) * k / sides, err));
    return add_point(pen, curve, end, err);
}

/* Returns the parameter at which the visibility of the curve changes, between `same`, where it is
 * `visible`, and `other`, where it is not. */
static double visibility_change(const InkPen *pen, const InkCurve *curve, double same, double other,
                                bool visible)
{
    for (int k = 0; k < HALVINGS; k++) {
        double middle = (same + other) / 2;
        if (curve_is_visible(pen, curve, middle) == visible)
            same = middle;
        else
            other = middle;
    }
    return (same + other) / 2;
}

/* Draws the visible parts of a curve. */
static Status draw_curve(const InkPen *pen, const InkCurve *curve, Err *err)
{
    double wanted = ceil(2 * curve->length_mm / pen->ink->line_mm);
    int steps = (int)fmin(fmax(wanted, LEAST_STEPS * (curve->kind == CURVE_ARC ? 4 : 1)), 1e6);
    bool visible = curve_is_visible(pen, curve, 0);
    double begin = 0;
    for (int k = 1; k <= steps; k++) {
        double t = (double)k / steps;
        if (curve_is_visible(pen, curve, t) == visible)
            continue;
        double at = visibility_change(pen, curve, (double)(k - 1) / steps, t, visible);
        if (visible)
            TRY(add_piece(pen, curve, begin, at, err));
        begin = at;
        visible = !visible;
    }
    return visible ? add_piece(pen, curve, begin, 1, err) : STATUS_OK;
}

/* ---- vessels --------------------------------------------------------------------------------- */

static double distance_on_paper(const OnPaper *a, const OnPaper *b)
{
    return elementary_hypot(b->at[0] - a->at[0], b->at[1] - a->at[1]);
}

/* Returns the normal of the wall that is nearest to the direction to the viewer. */
static Vec3 front_normal(const Camera *camera, const Primitive *vessel)
{
    double distance;
    Vec3 middle = vec3_scale(vec3_add(vessel->a, vessel->b), 0.5);
    Vec3 towards = towards_viewer(camera, middle, &distance);
    Vec3 axis = vec3_normalized(vec3_sub(vessel->b, vessel->a));
    Vec3 front = vec3_add_scaled(towards, axis, -vec3_dot(towards, axis));
    return vec3_length(front) > 1e-6 ? vec3_normalized(front) : towards;
}

/* Draws a vessel as one line, as wide on paper as the vessel. */
static Status draw_thin(const InkPen *pen, const Primitive *vessel, const OnPaper ends[2], Err *err)
{
    const InkCurve axis = {.from = vessel->a,
                           .along = vec3_sub(vessel->b, vessel->a),
                           .aside = vec3_scale(front_normal(pen->ink->camera, vessel),
                                               (1 + BESIDE) * vessel->radius_mm),
                           .length_mm = distance_on_paper(&ends[0], &ends[1]),
                           .width_mm = vessel->radius_mm * (ends[0].per_mm + ends[1].per_mm)};
    return draw_curve(pen, &axis, err);
}

/* Draws one of the two lines along the wall of a cylinder, moved inwards by half a line width.
 * `normal` is the normal of the wall along the line. */
static Status draw_side(const InkPen *pen, const Primitive *vessel, Vec3 normal,
                        const OnPaper ends[2], Err *err)
{
    InkCurve side = {.from = vec3_add_scaled(vessel->a, normal, vessel->radius_mm),
                     .along = vec3_sub(vessel->b, vessel->a),
                     .aside = vec3_scale(normal, BESIDE * vessel->radius_mm),
                     .width_mm = pen->ink->line_mm};
    const OnPaper from = on_paper(pen->ink, side.from);
    const OnPaper to = on_paper(pen->ink, vec3_add(side.from, side.along));
    side.length_mm = distance_on_paper(&from, &to);
    double apart = distance_on_paper(&from, &ends[0]);
    for (int c = 0; c < 2 && apart > 0; c++)
        side.shift[c] = (ends[0].at[c] - from.at[c]) / apart * fmin(pen->ink->line_mm / 2, apart);
    return draw_curve(pen, &side, err);
}

/* Finds the unit normals, at most two, at which a cylinder's surface is viewed edge-on; none if the
 * viewer looks along the axis. */
static int edge_normals(const Camera *camera, const Primitive *vessel, Vec3 normals[2])
{
    double distance;
    Vec3 axis = vec3_normalized(vec3_sub(vessel->b, vessel->a));
    Vec3 towards = towards_viewer(camera, vessel->a, &distance);
    Vec3 across = vec3_cross(axis, towards);
    double sine = vec3_length(across), cosine = 0;
    if (sine < 1e-6)
        return 0;
    Vec3 side = vec3_scale(across, 1 / sine);
    Vec3 front = vec3_cross(side, axis);
    if (camera->projection == PROJECTION_PERSPECTIVE)
        cosine = vessel->radius_mm / (distance * sine);
    if (cosine >= 1)
        return 0;
    for (int k = 0; k < 2; k++)
        normals[k] = vec3_add_scaled(vec3_scale(front, cosine), side,
                                     (k ? -1 : 1) * sqrt(1 - cosine * cosine));
    return 2;
}

static int order_points(const void *a, const void *b)
{
    const Vec3 *p = a, *q = b;
    int order = compare_numbers(p->x, q->x);
    order = order ? order : compare_numbers(p->y, q->y);
    return order ? order : compare_numbers(p->z, q->z);
}

/* Returns true if a cylinder's end is neither inside a ball nor at a joint. */
static bool ends_in_disc(const InkDrawing *ink, Vec3 end)
{
    return !model_has(ink->geometry->model, MODEL_ROUND_ENDS) &&
           !bsearch(&end, ink->joined, ink->n_joined, sizeof end, order_points);
}

/* Draws a circle about an axis (unit). `paper_mm` is its radius on paper, by which the inward shift
 * of half a line width is converted to radii. */
static Status draw_circle(const InkPen *pen, Vec3 center, Vec3 axis, double radius, double paper_mm,
                          Err *err)
{
    InkCurve circle = {.kind = CURVE_ARC,
                       .span = 1,
                       .from = center,
                       .shrink = pen->ink->line_mm / 2 / paper_mm,
                       .length_mm = FULL_TURN * paper_mm,
                       .width_mm = pen->ink->line_mm};
    vec3_perpendiculars(axis, &circle.u, &circle.v);
    circle.u = vec3_scale(circle.u, radius);
    circle.v = vec3_scale(circle.v, radius);
    return draw_curve(pen, &circle, err);
}

/* Draws the two lines along the wall of a cylinder and the visible discs at its ends. A cylinder
 * that is narrower than two lines is drawn as one line. */
static Status draw_cylinder(const InkPen *pen, const Primitive *vessel, Err *err)
{
    const OnPaper ends[2] = {on_paper(pen->ink, vessel->a), on_paper(pen->ink, vessel->b)};
    Vec3 normals[2];
    if (vessel->radius_mm * fmax(ends[0].per_mm, ends[1].per_mm) <= pen->ink->line_mm)
        return draw_thin(pen, vessel, ends, err);
    int n = edge_normals(pen->ink->camera, vessel, normals);
    for (int k = 0; k < n; k++)
        TRY(draw_side(pen, vessel, normals[k], ends, err));
    const Vec3 axis = vec3_normalized(vec3_sub(vessel->b, vessel->a));
    for (int k = 0; k < 2; k++)
        if (ends_in_disc(pen->ink, k ? vessel->b : vessel->a))
            TRY(draw_circle(pen, k ? vessel->b : vessel->a, axis, vessel->radius_mm,
                            vessel->radius_mm * ends[k].per_mm, err));
    return STATUS_OK;
}

/* Draws the outline between two ellipses of a joint: from each angle of the first ellipse to the
 * nearest angle of the second. */
static Status draw_rulings(const InkPen *pen, const JointFrame *joint, const double fraction[2],
                           double length_mm, Err *err)
{
    double from[JOINT_OUTLINES], to[JOINT_OUTLINES];
    int n = joint_outline(pen->ink->camera, joint, fraction[0], from),
        m = joint_outline(pen->ink->camera, joint, fraction[1], to);
    for (int i = 0; i < n; i++) {
        double turn = 1; /* radians to the nearest angle of the second ellipse; farther ones are
                          * taken for another outline */
        for (int k = 0; k < m; k++) {
            double apart = remainder(to[k] - from[i], FULL_TURN);
            turn = fabs(apart) < fabs(turn) ? apart : turn;
        }
        const InkCurve outline = {.kind = CURVE_RULED,
                                  .joint = joint,
                                  .angle = {from[i], from[i] + turn},
                                  .fraction = {fraction[0], fraction[1]},
                                  .length_mm = length_mm,
                                  .width_mm = pen->ink->line_mm};
        if (turn < 1)
            TRY(draw_curve(pen, &outline, err));
    }
    return STATUS_OK;
}

/* Draws the arcs of the edge between a joint and its cylinder that are part of the outline. */
static Status draw_creases(const InkPen *pen, const JointFrame *joint, int end, double per_mm,
                           Err *err)
{
    double radius = joint->radius + end * joint->radius_change;
    const InkCurve circle = {.kind = CURVE_ARC,
                             .from = vec3_add_scaled(joint->base, joint->span, end),
                             .u = vec3_add_scaled(joint->across, joint->across_change, end),
                             .v = vec3_scale(joint->side, radius),
                             .shrink = pen->ink->line_mm / 2 / (radius * per_mm),
                             .width_mm = pen->ink->line_mm};
    for (int k = 0, next; k < FINE_SAMPLES; k = next) {
        next = k + 1;
        if (!joint_edge_is_outline(pen->ink->camera, joint, end,
                                   FULL_TURN * (k + 0.5) / FINE_SAMPLES))
            continue;
        while (next < FINE_SAMPLES &&
               joint_edge_is_outline(pen->ink->camera, joint, end,
                                     FULL_TURN * (next + 0.5) / FINE_SAMPLES))
            next++;
        InkCurve arc = circle;
        arc.begin = (double)k / FINE_SAMPLES;
        arc.span = (double)(next - k) / FINE_SAMPLES;
        arc.length_mm = FULL_TURN * radius * per_mm * arc.span;
        TRY(draw_curve(pen, &arc, err));
    }
    return STATUS_OK;
}

/* Draws the outline of a joint: interval by interval along the joint, then at its two edges. A
 * joint that is narrower than two lines is drawn as one line. */
static Status draw_joint(const InkPen *pen, const Primitive *vessel, Err *err)
{
    const OnPaper ends[2] = {on_paper(pen->ink, vessel->a), on_paper(pen->ink, vessel->b)};
    const JointFrame joint = primitive_joint(vessel);
    const double most = fmax(vessel->radius_mm, vessel->radius_b_mm);
    if (most * fmax(ends[0].per_mm, ends[1].per_mm) <= pen->ink->line_mm)
        return draw_thin(pen, vessel, ends, err);
    double length_mm = 2 * most * ends[0].per_mm / RULINGS;
    for (int k = 0; k < RULINGS; k++)
        TRY(draw_rulings(pen, &joint, (const double[]){(double)k / RULINGS, (k + 1.0) / RULINGS},
                         length_mm, err));
    for (int end = 0; end < 2; end++)
        TRY(draw_creases(pen, &joint, end, ends[end].per_mm, err));
    return STATUS_OK;
}

/* Draws the circle that is the outline of a ball: in perspective it lies nearer to the viewer than
 * the ball's middle, and is smaller. A ball that is narrower than two lines is not drawn; its
 * cylinders are drawn as lines. */
static Status draw_ball(const InkPen *pen, const Primitive *ball, Err *err)
{
    const OnPaper center = on_paper(pen->ink, ball->a);
    double radius_mm = ball->radius_mm * center.per_mm, distance;
    if (radius_mm <= pen->ink->line_mm)
        return STATUS_OK;
    Vec3 towards = towards_viewer(pen->ink->camera, ball->a, &distance);
    bool perspective = pen->ink->camera->projection == PROJECTION_PERSPECTIVE;
    double nearer = perspective ? ball->radius_mm / distance : 0; /* in radii */
    return draw_circle(pen, vec3_add_scaled(ball->a, towards, nearer * ball->radius_mm), towards,
                       ball->radius_mm * sqrt(fmax(0, 1 - nearer * nearer)), radius_mm, err);
}

static Status draw_block(size_t block, int worker, void *context, Err *err)
{
    const InkDrawing *ink = context;
    const InkPen pen = {ink, worker, &ink->pieces[block]};
    const size_t n = ink->geometry->n_primitives, end = (block + 1) * BLOCK;
    for (size_t i = block * BLOCK; i < n && i < end; i++) {
        const Primitive *vessel = &ink->geometry->primitives[i];
        TRY((vessel->kind == PRIMITIVE_SPHERE  ? draw_ball
             : vessel->kind == PRIMITIVE_JOINT ? draw_joint
                                               : draw_cylinder)(&pen, vessel, err));
    }
    return STATUS_OK;
}

/* Puts the pieces of all blocks together. */
static Status gather(const InkDrawing *ink, Strokes *strokes, Err *err)
{
    InkPieces all = {0};
    Status status = STATUS_OK;
    for (size_t b = 0; b < ink->n_blocks; b++)
        TRY_GOTO(inkpieces_append(&all, &ink->pieces[b], ink->paper, err));
    TRY_GOTO(inkpieces_join(&all, strokes, err));
done:
    inkpieces_release(&all);
    return status;
}

/* Lists the ends of all joints, sorted. */
static Status list_joined(InkDrawing *ink, Err *err)
{
    const Geometry *geometry = ink->geometry;
    TRY(mem_calloc(&ink->joined, 2 * geometry->n_primitives + 1, sizeof *ink->joined, "joints",
                   err));
    for (size_t i = 0; i < geometry->n_primitives; i++)
        if (geometry->primitives[i].kind == PRIMITIVE_JOINT) {
            ink->joined[ink->n_joined++] = geometry->primitives[i].a;
            ink->joined[ink->n_joined++] = geometry->primitives[i].b;
        }
    qsort(ink->joined, ink->n_joined, sizeof *ink->joined, order_points);
    return STATUS_OK;
}

static Status check_in_front(const Geometry *geometry, const Camera *camera, Err *err)
{
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *vessel = &geometry->primitives[i];
        if (!(camera_point(camera, vessel->a).per_mm > 0) ||
            !(camera_point(camera, vessel->b).per_mm > 0))
            return err_set(err, STATUS_USAGE,
                           "segment %u is not in front of the camera; a line drawing needs all "
                           "segments in front of it",
                           geometry->ids[vessel->segment]);
    }
    return STATUS_OK;
}

Status ink_strokes(const Geometry *geometry, const View *view, const InkParams *params,
                   Strokes *strokes, Err *err)
{
    const Camera *camera = &view->camera;
    int threads = params->threads > 0 ? params->threads : threads_available();
    InkDrawing ink = {.geometry = geometry,
                      .camera = camera,
                      .mm_per_pixel = params->width_mm / camera->width,
                      .line_mm = params->line_mm,
                      .n_blocks = (geometry->n_primitives + BLOCK - 1) / BLOCK};
    Status status;
    ink.paper[0] = params->width_mm;
    ink.paper[1] = camera->height * ink.mm_per_pixel;
    TRY(check_in_front(geometry, camera, err));
    TRY_GOTO(list_joined(&ink, err));
    TRY_GOTO(caster_new(geometry, NULL, threads, &ink.caster, err));
    TRY_GOTO(mem_calloc(&ink.pieces, ink.n_blocks, sizeof *ink.pieces, "strokes", err));
    caster_set_shadow_nearest(ink.caster, 1e-9); /* mm: rays begin BESIDE the wall, not on it */
    TRY_GOTO(threads_try(ink.n_blocks, threads, draw_block, &ink, err));
    TRY_GOTO(gather(&ink, strokes, err));
    strokes->width_mm = ink.paper[0];
    strokes->height_mm = ink.paper[1];
done:
    for (size_t b = 0; ink.pieces && b < ink.n_blocks; b++)
        inkpieces_release(&ink.pieces[b]);
    free(ink.joined);
    free(ink.pieces);
    caster_free(ink.caster);
    return status;
}
