/* Bounds the light on a surface, and finds its blockers. The shading model is that of
 * render/light/shade.c, in real numbers instead of rounded ones. */
#include "answer/light.h"

static const Form one = {1, 0, 0, 0};

/* ---- surfaces -------------------------------------------------------------------------------- */

/* Returns the fraction of the background's color in a surface: linear in depth between near_mm and
 * far_mm, and constant outside. The fade must be on. */
static Form fade_of(const Fade *fade, Form depth)
{
    const Form near = form_of(fade->near_mm, 0);
    const Form reach = form_sub(form_of(fade->far_mm, 0), near);
    const Form part = form_mul(form_sub(depth, near), form_inverse(reach));
    const Form cut = form_sub(form_positive(part), form_positive(form_sub(part, one)));
    const Form nearest = form_of(fade->nearest, 0);
    return form_known(
        form_add(nearest, form_mul(cut, form_sub(form_of(fade->farthest, 0), nearest))), 0, 1);
}

FormSurface surface_at(const AnswerPlan *plan, const Beam *beam, const FaceHit *hit)
{
    const Scene *scene = plan->scene;
    const bool ground = hit->face->kind == FACE_GROUND;
    FormSurface s = {.hit = hit,
                     .finish = ground ? &scene->view.ground.finish : &scene->appearance.finish,
                     .pigment = ground ? scene->view.ground.color
                                       : appearance_color(&scene->appearance, hit->face->segment),
                     .point = form3_add(beam->origin, form3_mul(beam->direction, hit->depth)),
                     .normal = hit_normal(hit, beam),
                     .view = beam->unit,
                     .keep = one};
    Form fade = form_of(0, 0);
    if (!ground && fade_is_on(&scene->view.fade)) {
        fade = fade_of(&scene->view.fade, form_mul(hit->depth, beam->length));
        s.keep = form_sub(one, fade);
    }
    for (int c = 0; c < 3; c++)
        s.base.channels[c] =
            form_add(form_scale(s.keep, (double)s.finish->ambient * rgb_channel(s.pigment, c)),
                     form_scale(fade, rgb_channel(scene->view.background, c)));
    return s;
}

/* ---- lights ---------------------------------------------------------------------------------- */

/* Returns a highlight, cos^exponent. The cosine is cut to what cosines can be. */
static Form highlight(Form cosine, double exponent)
{
    return form_power(form_known(cosine, -1, 1), exponent);
}

static Form phong_of(const FormSurface *s, Form3 towards, Form cosine)
{
    const Form facing = form3_dot(s->view, s->normal);
    const Form mirrored =
        form_sub(form3_dot(s->view, towards), form_scale(form_mul(facing, cosine), 2));
    return form_scale(highlight(mirrored, (double)s->finish->phong_size), (double)s->finish->phong);
}

/* Blinn's highlight. The exponent is rounded to single precision, as POV-Ray stores it. */
static Form specular_of(const FormSurface *s, Form3 towards)
{
    const Form3 halfway = form3_sub(towards, s->view);
    const Form cosine =
        form_mul(form3_dot(halfway, s->normal), form_inverse(form3_length(halfway)));
    const float exponent = 1 / s->finish->roughness;
    return form_scale(highlight(cosine, (double)exponent), (double)s->finish->specular);
}

static Form3 direction_to(const AnswerPlan *plan, const FormSurface *s, size_t light)
{
    const LightRays *rays = &plan->lights[light];
    if (rays->light->parallel)
        return rays->towards;
    return form3_unit(form3_sub(form3_exact(rays->light->location), s->point));
}

/* Where the surface may face away, a highlight may be there or not. */
static Form maybe_none(Form light, bool faces)
{
    return faces ? light : form_hull(light, form_of(0, 0));
}

LightTerm light_term(const AnswerPlan *plan, const FormSurface *s, size_t light)
{
    const Finish *finish = s->finish;
    const Rgb color = plan->lights[light].light->color;
    const Form3 towards = direction_to(plan, s, light);
    const Form cosine = form_known(form3_dot(s->normal, towards), -1, 1);
    const bool faces = form_low(cosine) > 0;
    if (form_high(cosine) <= 0)
        return (LightTerm){.is_zero = true};
    LightTerm result = {.is_facing = form_low(cosine) > LIGHT_GRAZES};
    const Form diffuse =
        form_scale(finish->brilliance == 1 ? form_positive(cosine)
                                           : form_power(cosine, (double)finish->brilliance),
                   (double)finish->diffuse);
    Form gloss = form_of(0, 0);
    if (finish->phong > 0)
        gloss = form_add(gloss, maybe_none(phong_of(s, towards, cosine), faces));
    if (finish->specular > 0)
        gloss = form_add(gloss, maybe_none(specular_of(s, towards), faces));
    for (int c = 0; c < 3; c++)
        result.color.channels[c] =
            form_mul(form_scale(form_add(form_scale(diffuse, rgb_channel(s->pigment, c)), gloss),
                                rgb_channel(color, c)),
                     s->keep);
    return result;
}

/* ---- shadows --------------------------------------------------------------------------------- */

Beam light_beam(const AnswerPlan *plan, const FormSurface *s, size_t light, int point)
{
    const LightRays *rays = &plan->lights[light];
    if (rays->light->parallel) {
        Beam beam = {.origin = s->point,
                     .direction = rays->towards,
                     .unit = rays->towards,
                     .length = one,
                     .inverse = one,
                     .frames = rays->frames};
        return beam;
    }
    const Light at = light_at_point(rays->light, point);
    return beam_of(s->point, form3_sub(form3_exact(at.location), s->point));
}

double surface_reach(const FormSurface *s)
{
    const Form3 p = s->point;
    return box_max(form_high(p.x) - p.x.c, box_max(form_high(p.y) - p.y.c, form_high(p.z) - p.z.c));
}

void light_blockers(const AnswerPlan *plan, const FormSurface *s, const Beam *beam, size_t light,
                    double reach, FaceList *list)
{
    const Vec3 from = vec3(s->point.x.c, s->point.y.c, s->point.z.c);
    const Vec3 towards = vec3(beam->direction.x.c, beam->direction.y.c, beam->direction.z.c);
    const double far = plan->lights[light].light->parallel ? (double)INFINITY : 1 + 1e-6;
    answerplan_blockers(plan, from, reach, towards, far, list);
}

/* Returns true if the faces belong to one convex solid. */
static bool one_solid(const Face *a, const Face *b)
{
    return a->solid == b->solid || faces_form_capsule(a, b) || faces_form_capsule(b, a);
}

bool blocker_at(const AnswerPlan *plan, const FormSurface *s, const Beam *beam, size_t light,
                uint32_t face, LightBlocker *blocker)
{
    const Face *other = &plan->faces[face];
    blocker->n_between = 0;
    if (one_solid(s->hit->face, other) || !face_hit(other, face, beam, &blocker->hit))
        return false;
    const Form depth = blocker->hit.depth;
    if (form_high(depth) <= 0)
        return false;
    if (!(form_low(depth) > 0))
        blocker->between[blocker->n_between++] = depth;
    else if (other->kind == FACE_TRIANGLE && plan->params.pattern > 0 &&
             !(form_low(form_mul(depth, beam->length)) > SHADOW_FROM_MM))
        blocker->between[blocker->n_between++] = form_of(0, (double)INFINITY);
    if (plan->lights[light].light->parallel)
        return true;
    const Form left = form_sub(one, depth);
    if (form_high(left) <= 0)
        return false;
    if (!(form_low(left) > 0))
        blocker->between[blocker->n_between++] = left;
    return true;
}

/* Returns the height of a point above the ground. */
static Form height_of(const Face *ground, Form3 point)
{
    return form_sub(form3_dot(ground->axis, point), form_of(ground->offset, 0));
}

/* The path ends at a point light, or at the plane through the location of a parallel light, across
 * its direction. The ground blocks it if its ends are on two sides. */
int ground_blocks(const AnswerPlan *plan, const FormSurface *s, const Beam *beam, size_t light)
{
    const Face *ground = &plan->faces[plan->n];
    if (!plan->has_ground || s->hit->face == ground)
        return 0;
    Form distance = one;
    if (plan->lights[light].light->parallel)
        distance = form3_dot(form3_sub(form3_exact(plan->lights[light].light->location), s->point),
                             beam->direction);
    const Form begins = height_of(ground, s->point);
    const Form ends = height_of(ground, form3_add(s->point, form3_mul(beam->direction, distance)));
    if ((form_low(begins) > 0 && form_low(ends) > 0) ||
        (form_high(begins) < 0 && form_high(ends) < 0))
        return 0;
    return (form_low(begins) > 0 && form_high(ends) < 0) ||
                   (form_high(begins) < 0 && form_low(ends) > 0)
               ? 1
               : -1;
}

bool light_beam_leaves(const FormSurface *s, const Beam *beam)
{
    return form_low(form3_dot(s->normal, beam->unit)) > 0;
}

int own_solid_blocks(const FormSurface *s, const Beam *beam)
{
    const Face *face = s->hit->face;
    if (face->kind >= FACE_SEGMENT) /* not convex: the whole surface decides */
        return 0;
    const double graze = 0.5 * SHADOW_FROM_MM / face->radius;
    return light_beam_leaves(s, beam)                             ? 0
           : form_high(form3_dot(s->normal, beam->unit)) < -graze ? 1
                                                                  : -1;
}
