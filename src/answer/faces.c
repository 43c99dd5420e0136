/* Makes the faces of a scene and intersects beams with them, as in docs/ANSWERS.md, section 4.
 * Edges of a wall are linear in an orthographic view, so that silhouettes are cut exactly. */
#include "answer/jointface.h"
#include "answer/triangleface.h"
#include "field/field.h"

#include <stdlib.h>
#include <string.h>

/* ---- beams ----------------------------------------------------------------------------------- */

Beam beam_of(Form3 origin, Form3 direction)
{
    Beam beam = {.origin = origin, .direction = direction};
    beam.length = form3_length(direction);
    beam.inverse = form_inverse(beam.length);
    beam.unit = form3_mul(direction, beam.inverse);
    return beam;
}

WallFrame wall_frame(const Face *face, const Beam *beam)
{
    WallFrame frame;
    const Form3 across = form3_cross(beam->direction, face->axis);
    frame.inverse = form_inverse(form3_length(across));
    frame.m = form3_mul(across, frame.inverse);
    frame.along = form3_dot(beam->direction, face->axis);
    frame.k =
        form3_mul(form3_sub(beam->direction, form3_mul(face->axis, frame.along)), frame.inverse);
    return frame;
}

/* ---- hits ------------------------------------------------------------------------------------ */

/* Adds an edge. Returns false if no ray of the beam is inside it. */
static bool add_edge(FaceHit *hit, Form edge)
{
    if (form_high(edge) < 0)
        return false;
    if (!(form_low(edge) >= 0))
        hit->edges[hit->n_edges++] = edge;
    return true;
}

/* Everything about the hit is unknown. */
static bool unknown_hit(FaceHit *hit)
{
    const Form anything = form_of(0, (double)INFINITY);
    hit->depth = hit->s = hit->w = anything;
    hit->v = (Form3){anything, anything, anything};
    hit->edges[0] = anything;
    hit->n_edges = 1;
    return true;
}

/* A wall that is seen along its axis, to rounding errors: its slope moves rays across it by at most
 * `drift` mm, so only rays within `drift` of its outline can hit it. All others enter its disc. */
static bool hit_wall_end_on(const Face *face, Form3 from, FaceHit *hit)
{
    const Form3 across = form3_sub(from, form3_mul(face->axis, form3_dot(from, face->axis)));
    const double drift = 1e-11 * (form_high(face->length) + form_most(form3_length(from)));
    const Form distance2 = form3_dot(across, across);
    const double inner = face->radius - drift, outer = face->radius + drift;
    if (form_high(distance2) < inner * inner * (1 - 4 * FORM_U) ||
        form_low(distance2) > outer * outer * (1 + 4 * FORM_U))
        return false;
    return unknown_hit(hit);
}

static bool hit_wall(const Face *face, size_t index, const Beam *beam, FaceHit *hit)
{
    const Form3 from = form3_sub(beam->origin, form3_exact(face->at));
    if (!beam->frames)
        hit->own_frame = wall_frame(face, beam);
    const WallFrame *frame = beam->frames ? &beam->frames[index] : &hit->own_frame;
    hit->frame = frame;
    if (!(form_most(frame->inverse) < 1e12 * form_most(beam->inverse)))
        return form_high(form3_length(form3_cross(beam->unit, face->axis))) < 1e-11
                   ? hit_wall_end_on(face, from, hit)
                   : unknown_hit(hit);
    const Form radius = form_of(face->radius, 0);
    hit->w = form3_dot(from, frame->m);
    const Form left = form_add(radius, hit->w), right = form_sub(radius, hit->w);
    if (!add_edge(hit, left) || !add_edge(hit, right))
        return false;
    hit->s = form_sqrt(form_mul(left, right));
    hit->depth = form_neg(form_mul(form_add(form3_dot(from, frame->k), hit->s), frame->inverse));
    const Form t = form_add(form3_dot(from, face->axis), form_mul(hit->depth, frame->along));
    return add_edge(hit, t) && add_edge(hit, form_sub(face->length, t));
}

static bool hit_ball(const Face *face, const Beam *beam, FaceHit *hit)
{
    const Form3 from = form3_sub(beam->origin, form3_exact(face->at));
    const Form along = form3_dot(from, beam->unit);
    hit->v = form3_sub(from, form3_mul(beam->unit, along));
    const Form radius = form_of(face->radius, 0);
    const Form inside = form_sub(form_mul(radius, radius), form3_dot(hit->v, hit->v));
    if (!add_edge(hit, inside))
        return false;
    hit->s = form_sqrt(inside);
    hit->depth = form_neg(form_mul(form_add(along, hit->s), beam->inverse));
    return true;
}

/* Returns true if a disc seen edge-on, to rounding errors, is surely missed: a ray can only meet
 * its plane within reach if it runs nearly in that plane. */
static bool misses_edge_on(const Face *face, const Beam *beam, Form3 from, Form height, Form facing)
{
    const double reach = face->radius + form_most(form3_length(from));
    const double most = form_most(facing) * reach * form_most(beam->inverse) * (1 + 1e-12);
    return form_low(height) > most || form_high(height) < -most;
}

static bool hit_disc(const Face *face, const Beam *beam, FaceHit *hit)
{
    const Form3 from = form3_sub(beam->origin, form3_exact(face->at));
    const Form facing = form3_dot(face->axis, beam->direction);
    const Form height = form3_dot(from, face->axis);
    if (form_low(facing) >= 0)
        return false;
    if (!(form_high(facing) < 0)) {
        if (misses_edge_on(face, beam, from, height, facing))
            return false;
        if (!(form_low(facing) < -1e-9))
            return unknown_hit(hit);
    }
    hit->depth = form_neg(form_mul(height, form_inverse(facing)));
    const Form3 at = form3_add(from, form3_mul(beam->direction, hit->depth));
    const Form radius = form_of(face->radius, 0);
    return add_edge(hit, form_neg(facing)) &&
           add_edge(hit, form_sub(form_mul(radius, radius), form3_dot(at, at)));
}

static bool hit_ground(const Face *face, const Beam *beam, FaceHit *hit)
{
    const Form rate = form3_dot(face->axis, beam->direction);
    const Form height = form_sub(form_of(face->offset, 0), form3_dot(face->axis, beam->origin));
    hit->depth = form_mul(height, form_inverse(rate));
    return add_edge(hit, hit->depth) && add_edge(hit, form_sub(form_of(SCENE_FARTHEST_MM, 0),
                                                               form_mul(hit->depth, beam->length)));
}

bool face_hit(const Face *face, size_t index, const Beam *beam, FaceHit *hit)
{
    hit->face = face;
    hit->n_edges = 0;
    switch (face->kind) {
    case FACE_WALL:
        return hit_wall(face, index, beam, hit);
    case FACE_BALL:
        return hit_ball(face, beam, hit);
    case FACE_DISC:
        return hit_disc(face, beam, hit);
    case FACE_GROUND:
        return hit_ground(face, beam, hit);
    case FACE_TRIANGLE:
        return triangle_hit(face, beam, hit);
    case FACE_SEGMENT:
    case FACE_JOINT:
        break;
    }
    return false;
}

/* Returns the components cut to [-1, 1]. */
static Form3 unit_vector(Form3 v)
{
    return (Form3){form_known(v.x, -1, 1), form_known(v.y, -1, 1), form_known(v.z, -1, 1)};
}

Form3 normal_against(Form3 normal, Form3 direction)
{
    const Form rate = form3_dot(normal, direction);
    const Form3 back = form3_neg(normal);
    return form_high(rate) <= 0  ? normal
           : form_low(rate) >= 0 ? back
                                 : (Form3){form_hull(normal.x, back.x), form_hull(normal.y, back.y),
                                           form_hull(normal.z, back.z)};
}

Form3 hit_normal(const FaceHit *hit, const Beam *beam)
{
    const Face *face = hit->face;
    const Form by = form_inverse(form_of(face->radius, 0));
    switch (face->kind) {
    case FACE_WALL:
        return unit_vector(form3_mul(
            form3_sub(form3_mul(hit->frame->m, hit->w), form3_mul(hit->frame->k, hit->s)), by));
    case FACE_BALL:
        return unit_vector(form3_mul(form3_sub(hit->v, form3_mul(beam->unit, hit->s)), by));
    case FACE_DISC:
        return face->axis;
    case FACE_SEGMENT:
        return hit->v;
    case FACE_TRIANGLE:
        return triangle_normal(face, beam);
    case FACE_JOINT:
        return unit_vector(normal_against(hit->v, beam->direction));
    case FACE_GROUND:
        break;
    }
    return normal_against(face->axis, beam->direction);
}

bool faces_form_capsule(const Face *wall, const Face *ball)
{
    const Vec3 a = wall->at, b = wall->end, c = ball->at;
    return wall->kind == FACE_WALL && ball->kind == FACE_BALL && wall->radius == ball->radius &&
           ((a.x == c.x && a.y == c.y && a.z == c.z) || (b.x == c.x && b.y == c.y && b.z == c.z));
}

/* ---- making ---------------------------------------------------------------------------------- */

static Face disc_of(const Primitive *primitive, uint32_t solid, Vec3 at, Form3 outward)
{
    return (Face){.kind = FACE_DISC,
                  .segment = primitive->segment,
                  .solid = solid,
                  .at = at,
                  .end = at,
                  .radius = primitive->radius_mm,
                  .axis = outward,
                  .box = box_with_ball(box_empty(), at, primitive->radius_mm)};
}

/* Adds the faces of a primitive. Returns their number, at most 3. Balls cover all discs of a model
 * with round ends. */
static size_t add_faces(const Primitive *primitive, uint32_t solid, bool round, Face *faces)
{
    const Vec3 a = primitive->a, b = primitive->b;
    size_t n = 0;
    Face *face = &faces[n++];
    if (primitive->kind == PRIMITIVE_JOINT) {
        *face = joint_face(primitive, solid);
        return n;
    }
    *face = (Face){.kind = primitive->kind == PRIMITIVE_SPHERE ? FACE_BALL : FACE_WALL,
                   .segment = primitive->segment,
                   .solid = solid,
                   .at = a,
                   .end = b,
                   .radius = primitive->radius_mm,
                   .box = box_with_ball(box_with_ball(box_empty(), a, primitive->radius_mm), b,
                                        primitive->radius_mm)};
    if (face->kind == FACE_BALL)
        return n;
    const Form3 span = form3_sub(form3_exact(b), form3_exact(a));
    face->length = form3_length(span);
    face->axis = form3_unit(span);
    const Form3 axis = face->axis;
    if (!round && !primitive->round_a)
        faces[n++] = disc_of(primitive, solid, a, form3_neg(axis));
    if (!round && !primitive->round_b)
        faces[n++] = disc_of(primitive, solid, b, axis);
    return n;
}

/* Beyond `radii` radii from the segment, it adds nothing to the field. */
static Face segment_face(const FieldSegment *segment, uint32_t solid, double radii)
{
    const Form3 span = form3_sub(form3_exact(segment->b), form3_exact(segment->a));
    const double reach = radii * segment->radius_mm * (1 + 1e-5);
    return (Face){
        .kind = FACE_SEGMENT,
        .segment = segment->segment,
        .solid = solid,
        .at = segment->a,
        .end = segment->b,
        .radius = segment->radius_mm,
        .axis = form3_unit(span),
        .length = form3_length(span),
        .box = box_with_ball(box_with_ball(box_empty(), segment->a, reach), segment->b, reach)};
}

Status faces_make(const Geometry *geometry, const Ground *ground, Face **faces, size_t *n, Err *err)
{
    const bool round = model_has(geometry->model, MODEL_ROUND_ENDS);
    Face *made;
    const VesselMesh *mesh = &geometry->mesh;
    const size_t most = 3 * geometry->n_primitives + geometry->n_segments + mesh->n_triangles + 1;
    TRY(mem_calloc(&made, most, sizeof *made, "faces", err));
    *n = 0;
    for (size_t i = 0; i < geometry->n_primitives; i++)
        *n += add_faces(&geometry->primitives[i], (uint32_t)i, round, made + *n);
    for (uint32_t i = 0; i < mesh->n_triangles; i++)
        made[(*n)++] = triangle_face(mesh, i, geometry->segments[mesh_segment(mesh, i)].segment);
    const double radii =
        model_has(geometry->model, MODEL_BLOB) ? blob_reach(&blob_shape) : ISOSURFACE_REACH;
    for (size_t i = 0; i < geometry->n_segments && mesh->n_triangles == 0; i++)
        made[(*n)++] = segment_face(&geometry->segments[i], (uint32_t)i, radii);
    if (ground->present) {
        made[(*n)++] = (Face){.kind = FACE_GROUND,
                              .solid = (uint32_t)geometry->n_primitives,
                              .axis = form3_exact(ground->normal),
                              .offset = ground->offset_mm};
    }
    *faces = made;
    return STATUS_OK;
}
