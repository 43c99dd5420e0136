/* The outline of a cylinder is two lines along its wall, that of a ball is a circle: where the wall
 * is seen edge-on. A cylinder that ends in discs (SCENE_CYLINDERS) has their edges besides. Where
 * such a curve is part of the picture's outline, nothing is in front of it, and it lies inside
 * nothing: a ray from beside it to the viewer meets no vessel, since one that begins inside a
 * vessel leaves it. So every curve is followed in steps of half a line, and where what is seen
 * changes, the place is halved down to a hundredth of a line [A. Appel, Proc. 22nd ACM Nat. Conf.
 * (1967) 387-393, with rays instead of counted crossings].
 *
 * Where vessels run into one another no line is drawn, as illustrators leave it out, too.
 *
 * Blocks of vessels are the unit of work and are put together in order, so that the drawing does
 * not depend on the number of threads. */
#include "render/ink/ink.h"

#include "render/cast/caster.h"
#include "render/ink/inkpieces.h"
#include <math.h>
#include <stdlib.h>

enum { BLOCK = 64, LEAST_STEPS = 4, HALVINGS = 6 };

/* How far beside a wall, in radii, the ray begins. */
#define BESIDE 1e-6
/* How far a drawn polygon may be off its circle, mm. */
#define SAGITTA_MM 0.004

typedef struct Hand {
    const Geometry *geometry;
    const Camera *camera;
    Caster *caster;
    double mm_per_pixel, line_mm;
    double paper[2]; /* width and height, mm */
    size_t n_blocks;
    InkPieces *pieces; /* of each block */
    Status *status;    /* likewise */
    Err *errors;       /* likewise */
} Hand;

/* A place on paper; `per_mm` is how many mm of paper a mm across the view takes there. */
typedef struct OnPaper {
    double at[2], per_mm;
} OnPaper;

/* ---- from the world to the paper ------------------------------------------------------------- */

static OnPaper on_paper(const Hand *hand, Vec3 point)
{
    const CameraPoint seen = camera_point(hand->camera, point);
    return (OnPaper){{seen.x * hand->mm_per_pixel, seen.y * hand->mm_per_pixel},
                     seen.per_mm * hand->mm_per_pixel};
}

/* The direction from a point to the viewer, and how far away that is. */
static Vec3 towards_viewer(const Camera *camera, Vec3 point, double *distance)
{
    Vec3 away = vec3_sub(camera->location, point);
    if (camera->projection == PROJECTION_PERSPECTIVE) {
        *distance = vec3_length(away);
        return vec3_scale(away, 1 / *distance);
    }
    *distance = -vec3_dot(away, camera->direction);
    return vec3_scale(camera->direction, -1);
}

static bool is_seen(const Hand *hand, int worker, Vec3 point)
{
    static const Ground none;
    double distance;
    Vec3 towards = towards_viewer(hand->camera, point, &distance);
    return !caster_shadow(hand->caster, worker, &none, point, towards, distance);
}

/* ---- curves ---------------------------------------------------------------------------------- */

/* A line from `from` to `from` + `along`, or a circle about `from` through the ends of `u` and `v`,
 * both with a parameter from 0 to 1. */
typedef struct Curve {
    bool is_circle;
    Vec3 from, along, u, v;
    Vec3 aside;       /* of a line: from it to where the ray to the viewer begins */
    double shift[2];  /* of a line: where it is drawn, from where it is seen, mm of paper */
    double shrink;    /* of a circle: how much smaller it is drawn, in radii */
    double length_mm; /* on paper */
    double width_mm;
} Curve;

/* Where a point of the curve is looked at, and, times 1 - `inwards` of its radius, drawn. */
static Vec3 circle_point(const Curve *curve, double t, double radii)
{
    double angle = 6.283185307179586 * t;
    Vec3 out = vec3_add_scaled(vec3_scale(curve->u, cos(angle)), curve->v, sin(angle));
    return vec3_add_scaled(curve->from, out, radii);
}

static bool curve_is_seen(const Hand *hand, int worker, const Curve *curve, double t)
{
    Vec3 place = curve->is_circle
                     ? circle_point(curve, t, 1 + BESIDE)
                     : vec3_add(vec3_add_scaled(curve->from, curve->along, t), curve->aside);
    return is_seen(hand, worker, place);
}

static Status add_point(const Hand *hand, const Curve *curve, double t, InkPieces *pieces, Err *err)
{
    if (curve->is_circle)
        return inkpieces_add(pieces, on_paper(hand, circle_point(curve, t, 1 - curve->shrink)).at,
                             err);
    OnPaper place = on_paper(hand, vec3_add_scaled(curve->from, curve->along, t));
    place.at[0] += curve->shift[0];
    place.at[1] += curve->shift[1];
    return inkpieces_add(pieces, place.at, err);
}

/* Draws the curve from t to end; a circle as a polygon. */
static Status add_piece(const Hand *hand, const Curve *curve, double t, double end,
                        InkPieces *pieces, Err *err)
{
    double radius_mm = curve->length_mm / 6.283185307179586;
    double side = fmin(2 * acos(1 - fmin(SAGITTA_MM / radius_mm, 0.5)) / 6.283185307179586, 0.125);
    int sides = curve->is_circle ? (int)ceil((end - t) / side) : 1;
    TRY(inkpieces_begin(pieces, curve->width_mm, err));
    for (int k = 0; k < sides; k++)
        TRY(add_point(hand, curve, t + (end - t) * k / sides, pieces, err));
    return add_point(hand, curve, end, pieces, err);
}

/* The place between a parameter where the curve is seen or not, as `seen` says, and one where it is
 * not so. */
static double change(const Hand *hand, int worker, const Curve *curve, double same, double other,
                     bool seen)
{
    for (int k = 0; k < HALVINGS; k++) {
        double middle = (same + other) / 2;
        if (curve_is_seen(hand, worker, curve, middle) == seen)
            same = middle;
        else
            other = middle;
    }
    return (same + other) / 2;
}

/* Draws the parts of a curve that are seen. */
static Status draw_curve(const Hand *hand, int worker, const Curve *curve, InkPieces *pieces,
                         Err *err)
{
    double wanted = ceil(2 * curve->length_mm / hand->line_mm);
    int steps = (int)fmin(fmax(wanted, LEAST_STEPS * (curve->is_circle ? 4 : 1)), 1e6);
    bool seen = curve_is_seen(hand, worker, curve, 0);
    double begin = 0;
    for (int k = 1; k <= steps; k++) {
        double t = (double)k / steps;
        if (curve_is_seen(hand, worker, curve, t) == seen)
            continue;
        double at = change(hand, worker, curve, (double)(k - 1) / steps, t, seen);
        if (seen)
            TRY(add_piece(hand, curve, begin, at, pieces, err));
        begin = at;
        seen = !seen;
    }
    return seen ? add_piece(hand, curve, begin, 1, pieces, err) : STATUS_OK;
}

/* ---- vessels ---------------------------------------------------------------------------------
 */

static double distance_on_paper(const OnPaper *a, const OnPaper *b)
{
    return hypot(b->at[0] - a->at[0], b->at[1] - a->at[1]);
}

/* The wall's normal that is nearest to the viewer's direction. */
static Vec3 front_normal(const Camera *camera, const Primitive *vessel)
{
    double distance;
    Vec3 middle = vec3_scale(vec3_add(vessel->a, vessel->b), 0.5);
    Vec3 towards = towards_viewer(camera, middle, &distance);
    Vec3 axis = vec3_normalized(vec3_sub(vessel->b, vessel->a));
    Vec3 front = vec3_add_scaled(towards, axis, -vec3_dot(towards, axis));
    return vec3_length(front) > 1e-6 ? vec3_normalized(front) : towards;
}

/* A vessel that is one line on paper. */
static Status draw_thin(const Hand *hand, int worker, const Primitive *vessel,
                        const OnPaper ends[2], InkPieces *pieces, Err *err)
{
    const Curve axis = {
        .from = vessel->a,
        .along = vec3_sub(vessel->b, vessel->a),
        .aside = vec3_scale(front_normal(hand->camera, vessel), (1 + BESIDE) * vessel->radius_mm),
        .length_mm = distance_on_paper(&ends[0], &ends[1]),
        .width_mm = vessel->radius_mm * (ends[0].per_mm + ends[1].per_mm)};
    return draw_curve(hand, worker, &axis, pieces, err);
}

/* One of the two lines along the wall of a cylinder; `normal` is the wall's there. */
static Status draw_side(const Hand *hand, int worker, const Primitive *vessel, Vec3 normal,
                        const OnPaper ends[2], InkPieces *pieces, Err *err)
{
    Curve side = {.from = vec3_add_scaled(vessel->a, normal, vessel->radius_mm),
                  .along = vec3_sub(vessel->b, vessel->a),
                  .aside = vec3_scale(normal, BESIDE * vessel->radius_mm),
                  .width_mm = hand->line_mm};
    const OnPaper from = on_paper(hand, side.from);
    const OnPaper to = on_paper(hand, vec3_add(side.from, side.along));
    side.length_mm = distance_on_paper(&from, &to);
    double apart = distance_on_paper(&from, &ends[0]);
    for (int c = 0; c < 2 && apart > 0; c++)
        side.shift[c] = (ends[0].at[c] - from.at[c]) / apart * fmin(hand->line_mm / 2, apart);
    return draw_curve(hand, worker, &side, pieces, err);
}

/* The unit normals, at most two, where a cylinder's wall is seen edge-on; none where the viewer
 * looks along the axis. */
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

/* The edge of one of the discs that close a cylinder. */
static Status draw_edge(const Hand *hand, int worker, const Primitive *vessel, Vec3 center,
                        double per_mm, InkPieces *pieces, Err *err)
{
    double radius_mm = vessel->radius_mm * per_mm;
    Curve edge = {.is_circle = true,
                  .from = center,
                  .shrink = hand->line_mm / 2 / radius_mm,
                  .length_mm = 6.283185307179586 * radius_mm,
                  .width_mm = hand->line_mm};
    vec3_across(vec3_normalized(vec3_sub(vessel->b, vessel->a)), &edge.u, &edge.v);
    edge.u = vec3_scale(edge.u, vessel->radius_mm);
    edge.v = vec3_scale(edge.v, vessel->radius_mm);
    return draw_curve(hand, worker, &edge, pieces, err);
}

static Status draw_cylinder(const Hand *hand, int worker, const Primitive *vessel,
                            InkPieces *pieces, Err *err)
{
    const OnPaper ends[2] = {on_paper(hand, vessel->a), on_paper(hand, vessel->b)};
    Vec3 normals[2];
    if (vessel->radius_mm * fmax(ends[0].per_mm, ends[1].per_mm) <= hand->line_mm)
        return draw_thin(hand, worker, vessel, ends, pieces, err);
    int n = edge_normals(hand->camera, vessel, normals);
    for (int k = 0; k < n; k++)
        TRY(draw_side(hand, worker, vessel, normals[k], ends, pieces, err));
    for (int k = 0; k < 2 && hand->geometry->model == SCENE_CYLINDERS; k++)
        TRY(draw_edge(hand, worker, vessel, k ? vessel->b : vessel->a, ends[k].per_mm, pieces,
                      err));
    return STATUS_OK;
}

static Status draw_ball(const Hand *hand, int worker, const Primitive *ball, InkPieces *pieces,
                        Err *err)
{
    const OnPaper center = on_paper(hand, ball->a);
    double radius_mm = ball->radius_mm * center.per_mm, distance;
    if (radius_mm <= hand->line_mm)
        return STATUS_OK;
    Vec3 towards = towards_viewer(hand->camera, ball->a, &distance);
    bool perspective = hand->camera->projection == PROJECTION_PERSPECTIVE;
    double nearer = perspective ? ball->radius_mm / distance : 0; /* in radii */
    double radius = ball->radius_mm * sqrt(fmax(0, 1 - nearer * nearer));
    Curve circle = {.is_circle = true,
                    .from = vec3_add_scaled(ball->a, towards, nearer * ball->radius_mm),
                    .shrink = hand->line_mm / 2 / radius_mm,
                    .length_mm = 6.283185307179586 * radius_mm,
                    .width_mm = hand->line_mm};
    vec3_across(towards, &circle.u, &circle.v);
    circle.u = vec3_scale(circle.u, radius);
    circle.v = vec3_scale(circle.v, radius);
    return draw_curve(hand, worker, &circle, pieces, err);
}

static void draw_block(size_t block, int worker, void *context)
{
    const Hand *hand = context;
    size_t n = hand->geometry->n_primitives, end = (block + 1) * BLOCK;
    for (size_t i = block * BLOCK; i < n && i < end && hand->status[block] == STATUS_OK; i++) {
        const Primitive *vessel = &hand->geometry->primitives[i];
        hand->status[block] = (vessel->kind == PRIMITIVE_SPHERE ? draw_ball : draw_cylinder)(
            hand, worker, vessel, &hand->pieces[block], &hand->errors[block]);
    }
}

/* Puts the pieces of all blocks together. */
static Status gather(const Hand *hand, Strokes *strokes, Err *err)
{
    InkPieces all = {0};
    Status status = STATUS_OK;
    for (size_t b = 0; b < hand->n_blocks && status == STATUS_OK; b++) {
        status = hand->status[b];
        if (status != STATUS_OK)
            *err = hand->errors[b];
        else
            status = inkpieces_append(&all, &hand->pieces[b], hand->paper, err);
    }
    if (status == STATUS_OK)
        status = inkpieces_join(&all, strokes, err);
    inkpieces_release(&all);
    return status;
}

static Status check_in_front(const Geometry *geometry, const Camera *camera, Err *err)
{
    for (size_t i = 0; i < geometry->n_primitives; i++) {
        const Primitive *vessel = &geometry->primitives[i];
        if (!(camera_point(camera, vessel->a).per_mm > 0) ||
            !(camera_point(camera, vessel->b).per_mm > 0))
            return err_set(err, STATUS_USAGE,
                           "segment %u is not in front of the camera, as all of a line drawing "
                           "must be",
                           geometry->ids[vessel->segment]);
    }
    return STATUS_OK;
}

Status ink_draw(const Geometry *geometry, const View *view, const InkParams *params,
                Strokes *strokes, Err *err)
{
    const Camera *camera = &view->camera;
    int threads = params->threads > 0 ? params->threads : threads_available();
    Hand hand = {.geometry = geometry,
                 .camera = camera,
                 .mm_per_pixel = params->width_mm / camera->width,
                 .line_mm = params->line_mm,
                 .n_blocks = (geometry->n_primitives + BLOCK - 1) / BLOCK};
    Status status;
    hand.paper[0] = params->width_mm;
    hand.paper[1] = camera->height * hand.mm_per_pixel;
    TRY(check_in_front(geometry, camera, err));
    TRY_GOTO(caster_new(geometry, NULL, threads, &hand.caster, err));
    TRY_GOTO(mem_calloc(&hand.pieces, hand.n_blocks, sizeof *hand.pieces, "strokes", err));
    TRY_GOTO(mem_calloc(&hand.status, hand.n_blocks, sizeof *hand.status, "strokes", err));
    TRY_GOTO(mem_calloc(&hand.errors, hand.n_blocks, sizeof *hand.errors, "strokes", err));
    caster_shadow_from(hand.caster, 1e-9);
    threads_for(hand.n_blocks, threads, draw_block, &hand);
    TRY_GOTO(gather(&hand, strokes, err));
    strokes->width_mm = hand.paper[0];
    strokes->height_mm = hand.paper[1];
done:
    for (size_t b = 0; hand.pieces && b < hand.n_blocks; b++)
        inkpieces_release(&hand.pieces[b]);
    free(hand.pieces);
    free(hand.status);
    free(hand.errors);
    caster_free(hand.caster);
    return status;
}
