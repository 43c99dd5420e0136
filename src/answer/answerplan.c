/* Makes the data that all pixels share: faces, their hierarchy, lights, beams. Everything here is
 * exact or has a proven error, except the pixels that a face covers and the boxes of the search
 * tree: those are computed in plain doubles and widened by far more than their rounding errors. */
#include "answer/answerplan.h"

#include <stdlib.h>

/* Widening of the pixels that a face covers. Positions in pixels have errors near 1e-9. */
static const double screen_pad_px = 1e-4;
/* Widening of boxes, as a fraction of the diagonal of the scene. */
static const double box_pad = 1e-7;

/* ---- assumptions ----------------------------------------------------------------------------- */

static Status check_effects(const View *view, Err *err)
{
    const Effects *effects = &view->effects;
    const char *what = effects->outline.width_px > 0 ? "outlines"
                       : effects->halo.width_px > 0  ? "halos"
                       : effects->xray.per_mm > 0    ? "an x-ray"
                       : effects->grade.present      ? "a graded background"
                       : view->transparent           ? "a transparent background"
                                                     : NULL;
    if (!what)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "`look`: no bounds can be proved for %s; use a look without "
                   "it",
                   what);
}

static Status check_model(SceneModel model, const AnswerParams *params, Err *err)
{
    const unsigned with_areas = MODEL_CYLINDERS | MODEL_BALLS | MODEL_TRIANGLES;
    if (params->pattern > 0 || model_is_of(model, with_areas))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "`area`: no bounds can be proved yet for the model %s; use `pattern` instead of "
                   "`area`, or one of the models %s",
                   models[model].name, models_of(with_areas).text);
}

/* Returns the smallest product of the box's points and a direction. */
static double least_along(Box box, Vec3 direction)
{
    return (direction.x > 0 ? box.low.x : box.high.x) * direction.x +
           (direction.y > 0 ? box.low.y : box.high.y) * direction.y +
           (direction.z > 0 ? box.low.z : box.high.z) * direction.z;
}

static Status check_camera(const AnswerPlan *plan, Err *err)
{
    const Camera *camera = &plan->scene->view.camera;
    const double at = vec3_dot(camera->location, camera->direction);
    for (size_t i = 0; i < plan->n; i++)
        if (!(least_along(plan->faces[i].box, camera->direction) > at + plan->pad_mm))
            return err_set(err, STATUS_USAGE,
                           "`location`: a vessel is not in front of the camera (segment %u); "
                           "answers need all vessels in front of it",
                           plan->scene->geometry.ids[plan->faces[i].segment]);
    return STATUS_OK;
}

/* Vessels must be in front of the plane from which parallel light comes. */
static Status check_lights(const AnswerPlan *plan, Err *err)
{
    const View *view = &plan->scene->view;
    const Box bounds = plan->scene->geometry.bounds;
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        const Vec3 away = vec3_sub(light->target, light->location);
        if (light->parallel && plan->params.shadows && light->casts_shadows &&
            !(least_along(bounds, away) > vec3_dot(light->location, away)))
            return err_set(err, STATUS_USAGE,
                           "`look`: the parallel light %zu has a position behind a vessel; its "
                           "position must be in front of all vessels, as seen along the light",
                           i + 1);
    }
    return STATUS_OK;
}

/* ---- making ---------------------------------------------------------------------------------- */

static Status make_tree(AnswerPlan *plan, Err *err)
{
    const Box bounds = plan->scene->geometry.bounds;
    plan->pad_mm = box_pad * vec3_distance(bounds.low, bounds.high);
    Box *boxes;
    TRY(mem_calloc(&boxes, plan->n, sizeof *boxes, "boxes", err));
    for (size_t i = 0; i < plan->n; i++)
        boxes[i] = box_padded(plan->faces[i].box, plan->pad_mm);
    const Status status = boxtree_build(boxes, plan->n, &plan->tree, err);
    free(boxes);
    return status;
}

/* Makes the frames of all walls for a constant direction. */
static Status make_frames(const AnswerPlan *plan, Form3 direction, WallFrame **frames, Err *err)
{
    TRY(mem_calloc(frames, plan->n + 1, sizeof **frames, "frames", err));
    const Beam beam = beam_of(form3_of(0, 0, 0), direction);
    for (size_t i = 0; i < plan->n; i++)
        if (plan->faces[i].kind == FACE_WALL)
            (*frames)[i] = wall_frame(&plan->faces[i], &beam);
    return STATUS_OK;
}

static Status make_lights(AnswerPlan *plan, Err *err)
{
    const View *view = &plan->scene->view;
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        LightRays *rays = &plan->lights[i];
        rays->light = light;
        rays->points = plan->params.shadows && light->casts_shadows ? light_points(light) : 0;
        if (!light->parallel)
            continue;
        rays->towards =
            form3_unit(form3_sub(form3_exact(light->location), form3_exact(light->target)));
        TRY(make_frames(plan, rays->towards, &rays->frames, err));
    }
    return STATUS_OK;
}

/* Returns the pixels that the corners of a box span, which contain what is in the box. */
static PixelRect box_on_screen(const Camera *camera, Box box)
{
    double low_x = (double)INFINITY, high_x = -low_x, low_y = low_x, high_y = -low_x;
    for (int i = 0; i < 8; i++) {
        const Vec3 corner = {i & 1 ? box.low.x : box.high.x, i & 2 ? box.low.y : box.high.y,
                             i & 4 ? box.low.z : box.high.z};
        const CameraPoint at = camera_point(camera, corner);
        low_x = fmin(low_x, at.x);
        high_x = fmax(high_x, at.x);
        low_y = fmin(low_y, at.y);
        high_y = fmax(high_y, at.y);
    }
    const double left = fmin(fmax(floor(low_x - screen_pad_px), -1), camera->width);
    const double top = fmin(fmax(floor(low_y - screen_pad_px), -1), camera->height);
    const double right = fmin(fmax(ceil(high_x + screen_pad_px), -1), camera->width);
    const double bottom = fmin(fmax(ceil(high_y + screen_pad_px), -1), camera->height);
    return (PixelRect){(int)left, (int)top, (int)(right - left), (int)(bottom - top)};
}

static Status make_screen(AnswerPlan *plan, Err *err)
{
    TRY(mem_calloc(&plan->screen, plan->n + 1, sizeof *plan->screen, "rectangles", err));
    for (size_t i = 0; i < plan->n; i++)
        plan->screen[i] = box_on_screen(&plan->scene->view.camera, plan->faces[i].box);
    return STATUS_OK;
}

/* Bounds the colors of a finish: all lights shine fully, on a pigment of this color. */
static double most_of(const Finish *finish, double pigment, double light)
{
    return (pigment * (double)finish->ambient +
            light * (pigment * (double)finish->diffuse + (double)finish->phong +
                     (double)finish->specular)) *
           (1 + 1e-6);
}

static void bound_colors(AnswerPlan *plan)
{
    const Scene *scene = plan->scene;
    const View *view = &scene->view;
    for (int c = 0; c < 3; c++) {
        double light = 0, pigment = 0;
        for (size_t i = 0; i < view->n_lights; i++)
            light += fabs(rgb_channel(view->lights[i].color, c));
        for (size_t i = 0; i < plan->n; i++) {
            const Rgb color = appearance_color(&scene->appearance, plan->faces[i].segment);
            pigment = box_max(pigment, rgb_channel(color, c));
        }
        plan->most[c] = box_max(rgb_channel(view->background, c),
                                most_of(&scene->appearance.finish, pigment, light));
        if (plan->has_ground)
            plan->most[c] =
                box_max(plan->most[c],
                        most_of(&view->ground.finish, rgb_channel(view->ground.color, c), light));
        plan->least[c] = 0;
        for (size_t i = 0; i < view->n_lights; i++)
            if (rgb_channel(view->lights[i].color, c) < 0)
                plan->least[c] = -plan->most[c];
    }
}

/* At a distance of R >= 5.6 / k from a segment, its term is at most exp(-R^2), and its gradient at
 * most 12 k exp(-R^2): the derivative across the axis is 2 k sqrt(q) times the term, and that along
 * it is at most k exp(-R^2) / sqrt(pi). */
static void set_field(AnswerPlan *plan)
{
    const Geometry *geometry = &plan->scene->geometry;
    plan->is_field = model_has(geometry->model, MODEL_FIELD);
    plan->is_blob = model_has(geometry->model, MODEL_BLOB);
    plan->level = plan->is_blob ? 1 : FIELD_LEVEL;
    plan->shadow_from_mm = plan->is_blob ? 10 * SHADOW_FROM_MM : SHADOW_FROM_MM;
    if (!model_has(geometry->model, MODEL_POTENTIAL))
        return;
    plan->dropped = (double)geometry->n_segments * ISOSURFACE_CUTOFF;
    for (size_t i = 0; i < geometry->n_segments; i++)
        plan->dropped_slope += 12 * ISOSURFACE_CUTOFF * 1.4143 / geometry->segments[i].radius_mm;
}

Status answerplan_make(const Scene *scene, const AnswerParams *params, AnswerPlan *plan, Err *err)
{
    const Geometry *geometry = &scene->geometry;
    *plan =
        (AnswerPlan){.scene = scene, .params = *params, .has_ground = scene->view.ground.present};
    TRY(check_model(geometry->model, params, err));
    TRY(check_effects(&scene->view, err));
    TRY(faces_make(geometry, &scene->view.ground, &plan->faces, &plan->n, err));
    plan->n -= plan->has_ground;
    TRY(make_tree(plan, err));
    TRY(check_camera(plan, err));
    TRY(check_lights(plan, err));
    TRY(make_lights(plan, err));
    TRY(make_screen(plan, err));
    bound_colors(plan);
    set_field(plan);
    if (scene->view.camera.projection == PROJECTION_PERSPECTIVE)
        return STATUS_OK;
    const Form3 direction = form3_exact(scene->view.camera.direction);
    TRY(make_frames(plan, direction, &plan->frames, err));
    plan->parallel = beam_of(form3_of(0, 0, 0), direction);
    plan->parallel.frames = plan->frames;
    return STATUS_OK;
}

void answerplan_release(AnswerPlan *plan)
{
    for (size_t i = 0; i < VIEW_MAX_LIGHTS; i++)
        free(plan->lights[i].frames);
    boxtree_release(&plan->tree);
    free(plan->faces);
    free(plan->frames);
    free(plan->screen);
    *plan = (AnswerPlan){0};
}

/* ---- beams ----------------------------------------------------------------------------------- */

/* Positions are fractions of the picture. The error covers the rounding of renderers, so that the
 * answer holds for the positions that they compute. */
Beam answerplan_beam(const AnswerPlan *plan, double x, double y, const double along[2],
                     const double across[2])
{
    const Camera *camera = &plan->scene->view.camera;
    const double error = 0x1p-50 * (1 + fabs(x / camera->width) + fabs(y / camera->height));
    const Form right = {x / camera->width - 0.5, along[0] / camera->width,
                        across[0] / camera->width, error};
    const Form up = {0.5 - y / camera->height, -along[1] / camera->height,
                     -across[1] / camera->height, error};
    const Form3 offset = form3_add(form3_mul(form3_exact(camera->right), right),
                                   form3_mul(form3_exact(camera->up), up));
    if (camera->projection == PROJECTION_PERSPECTIVE)
        return beam_of(form3_exact(camera->location),
                       form3_add(form3_exact(camera->direction), offset));
    Beam beam = plan->parallel;
    beam.origin = form3_add(form3_exact(camera->location), offset);
    return beam;
}

/* Narrows [*near, *far] to the part of the path from `from` that is in the slab. */
static bool clip(double from, double rate, double low, double high, double *near, double *far)
{
    if (fabs(rate) < 1e-300)
        return from >= low && from <= high;
    const double a = (low - from) / rate, b = (high - from) / rate;
    *near = box_max(*near, box_min(a, b));
    *far = box_min(*far, box_max(a, b));
    return *near <= *far;
}

static bool path_meets(const Box *box, Vec3 from, double reach, Vec3 towards, double far)
{
    double near = 0;
    return clip(from.x, towards.x, box->low.x - reach, box->high.x + reach, &near, &far) &&
           clip(from.y, towards.y, box->low.y - reach, box->high.y + reach, &near, &far) &&
           clip(from.z, towards.z, box->low.z - reach, box->high.z + reach, &near, &far);
}

void answerplan_blockers(const AnswerPlan *plan, Vec3 from, double reach, Vec3 towards, double far,
                         FaceList *list)
{
    uint32_t stack[BOXTREE_DEPTH + 2];
    int top = 0;
    list->n = 0;
    stack[top++] = 0;
    while (top > 0) {
        const uint32_t index = stack[--top];
        const BoxNode *node = &plan->tree.nodes[index];
        if (!path_meets(&node->box, from, reach, towards, far))
            continue;
        for (uint32_t i = 0; i < node->n_items; i++)
            list->faces[list->n++] = plan->tree.items[node->first + i];
        if (node->n_items == 0) {
            stack[top++] = node->first;
            stack[top++] = index + 1;
        }
    }
}
