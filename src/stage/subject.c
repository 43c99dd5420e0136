/* Of the tree, its segments that can be drawn have a ball at each end, of their radius: whatever
 * the model, views about it are the same. The shadow of a ball on the ground is an ellipse; it is
 * framed as the ball about the ellipse, so never too small. Of an area light the corners cast the
 * shadows that reach farthest. */
#include "stage/subject.h"

/* Light that comes lower over the ground than 10 degrees casts shadows too long to be framed. */
static const double least_slope = 0.17;

Subject subject_of(const ViewParams *params, const Geometry *geometry)
{
    Subject subject = {.geometry = geometry, .tree = params->tree, .box = geometry->bounds};
    if (!subject.tree)
        return subject;
    subject.box = box_empty();
    for (size_t i = 0; i < subject_balls(&subject); i++) {
        Ball ball;
        if (subject_ball(&subject, i, &ball))
            subject.box = box_with_ball(subject.box, ball.center, ball.radius);
    }
    return subject;
}

size_t subject_balls(const Subject *subject)
{
    return subject->tree ? 2 * subject->tree->n : geometry_balls(subject->geometry);
}

bool subject_ball(const Subject *subject, size_t number, Ball *ball)
{
    const Tree *tree = subject->tree;
    const size_t i = number / 2;
    if (!tree) {
        *ball = geometry_ball(subject->geometry, number);
        return true;
    }
    if (!segment_can_be_drawn(tree, i))
        return false;
    Vec3 end = tree->position[number % 2 ? i : (size_t)tree->parent[i]];
    *ball = (Ball){vec3_sub(end, subject->geometry->origin), tree->radius_mm[i]};
    return true;
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
    framed.box = box_empty();
    for (size_t i = 0; i < framed_balls(&framed); i++) {
        Ball ball;
        if (framed_ball(&framed, i, &ball))
            framed.box = box_with_ball(framed.box, ball.center, ball.radius);
    }
    if (!framed.domain && framed.n_lights == 0)
        framed.box = subject->box;
    return framed;
}

static size_t own_balls(const Framed *framed)
{
    return framed->domain ? 8 : subject_balls(framed->subject);
}

static bool own_ball(const Framed *framed, size_t number, Ball *ball)
{
    const Box *box = framed->domain;
    if (!box)
        return subject_ball(framed->subject, number, ball);
    Vec3 corner = vec3(number & 1 ? box->high.x : box->low.x, number & 2 ? box->high.y : box->low.y,
                       number & 4 ? box->high.z : box->low.z);
    *ball = (Ball){vec3_sub(corner, framed->subject->geometry->origin), 0};
    return true;
}

/* Makes the ball that about its shadow; false when that is too long. */
static bool cast_shadow(const Ground *ground, const Light *light, Ball *ball)
{
    Vec3 towards = light_way(light, ball->center).towards;
    double slope = vec3_dot(ground->normal, towards);
    if (!(slope > least_slope))
        return false;
    double height = vec3_dot(ground->normal, ball->center) - ground->offset_mm;
    ball->center = vec3_add_scaled(ball->center, towards, -height / slope);
    ball->radius /= slope;
    return true;
}

size_t framed_balls(const Framed *framed)
{
    return own_balls(framed) * (1 + framed->n_lights);
}

bool framed_ball(const Framed *framed, size_t number, Ball *ball)
{
    size_t n = own_balls(framed), by = number / n;
    return own_ball(framed, number % n, ball) &&
           (by == 0 || cast_shadow(&framed->ground, &framed->lights[by - 1], ball));
}
