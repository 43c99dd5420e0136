/* For a tree, each segment that can be drawn has a ball of its radius at each end, in any model, so
 * that all models have the same view. The shadow of a ball on the ground is an ellipse. It is
 * framed as the ball around the ellipse, which is never too small. For an area light, the corners
 * cast the shadows that reach farthest. */
#include "stage/subject.h"

/* Sine of 10 degrees: light at a lower angle above the ground casts shadows that are too long to be
 * framed. */
static const double least_slope = 0.17;

Subject subject_of(const ViewParams *params, const Geometry *geometry)
{
    Subject subject = {.geometry = geometry, .tree = params->tree, .box = geometry->bounds};
    if (params->box)
        subject.box = *params->box;
    if (params->box || !subject.tree)
        return subject;
    Box box = box_empty();
    for (size_t i = 0; i < subject.tree->n; i++) {
        Ball ends[2];
        for (int k = subject_ends(&subject, i, ends); k-- > 0;)
            box = box_with_ball(box, ends[k].center, ends[k].radius);
    }
    subject.box = box;
    return subject;
}

size_t subject_segments(const Subject *subject)
{
    return subject->tree ? subject->tree->n : geometry_balls(subject->geometry) / 2;
}

int subject_ends(const Subject *subject, size_t number, Ball ends[2])
{
    const Tree *tree = subject->tree;
    if (tree && !segment_can_be_drawn(tree, number))
        return 0;
    for (size_t k = 0; k < 2; k++) {
        if (!tree) {
            ends[k] = geometry_ball(subject->geometry, 2 * number + k);
            continue;
        }
        Vec3 end = tree->position[k ? number : (size_t)tree->parent[number]];
        ends[k] = (Ball){vec3_sub(end, subject->geometry->origin), tree->radius_mm[number]};
    }
    return 2;
}

/* ---- what is framed -------------------------------------------------------------------------- */

static void add_light(Framed *framed, const Light *light)
{
    const int n = light->samples, corners[] = {0, n - 1, n * (n - 1), n * n - 1};
    if (n < 2) {
        framed->lights[framed->n_lights++] = *light;
        return;
    }
    for (int k = 0; k < 4; k++) {
        double x = corners[k] % n ? 0.5 : -0.5, y = corners[k] / n ? 0.5 : -0.5;
        Light *corner = &framed->lights[framed->n_lights++];
        *corner = *light;
        corner->location = vec3_add_scaled(light->location, light->sides[0], x);
        corner->location = vec3_add_scaled(corner->location, light->sides[1], y);
    }
}

Framed framed_of(const Subject *subject, const ViewParams *params, const View *view)
{
    Framed framed = {.subject = subject, .domain = params->domain, .ground = view->ground};
    for (size_t i = 0; view->ground.present && i < view->n_lights; i++)
        if (view->lights[i].casts_shadows)
            add_light(&framed, &view->lights[i]);
    framed.box = subject->box;
    if (!framed.domain && framed.n_lights == 0)
        return framed;
    framed.box = box_empty();
    for (size_t i = 0; i < framed_segments(&framed); i++) {
        Ball ends[2];
        for (int k = framed_ends(&framed, i, ends); k-- > 0;)
            framed.box = box_with_ball(framed.box, ends[k].center, ends[k].radius);
    }
    return framed;
}

/* The edges of the domain along x serve as segments. */
static size_t own_segments(const Framed *framed)
{
    return framed->domain ? 4 : subject_segments(framed->subject);
}

static int own_ends(const Framed *framed, size_t number, Ball ends[2])
{
    const Box *box = framed->domain;
    if (!box)
        return subject_ends(framed->subject, number, ends);
    for (int k = 0; k < 2; k++) {
        Vec3 corner = vec3(k ? box->high.x : box->low.x, number & 1 ? box->high.y : box->low.y,
                           number & 2 ? box->high.z : box->low.z);
        ends[k] = (Ball){vec3_sub(corner, framed->subject->geometry->origin), 0};
    }
    return 2;
}

/* Replaces the ball by the ball around its shadow. Returns false if the shadow is too long. */
static bool cast_shadow(const Ground *ground, const Light *light, Ball *ball)
{
    Vec3 towards = light_direction(light, ball->center).towards;
    double slope = vec3_dot(ground->normal, towards);
    if (!(slope > least_slope))
        return false;
    double height = vec3_dot(ground->normal, ball->center) - ground->offset_mm;
    ball->center = vec3_add_scaled(ball->center, towards, -height / slope);
    ball->radius /= slope;
    return true;
}

size_t framed_segments(const Framed *framed)
{
    return own_segments(framed) * (1 + framed->n_lights);
}

int framed_ends(const Framed *framed, size_t number, Ball ends[2])
{
    size_t n = own_segments(framed), by = number / n;
    int count = own_ends(framed, number % n, ends), kept = 0;
    if (by == 0)
        return count;
    for (int k = 0; k < count; k++)
        if (cast_shadow(&framed->ground, &framed->lights[by - 1], &ends[k]))
            ends[kept++] = ends[k];
    return kept;
}
