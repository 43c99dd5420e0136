/* Computes the color of one camera ray from the surface that it hits: ground, ambient occlusion,
 * shadows, shading and fading with depth. It does not depend on the engine that found the hit, so
 * that every model is lit in the same manner. The ground is intersected here and not by the
 * casters, because it belongs to the view and appears in the color plane only. */
#include "render/light/raycolor.h"

#include "render/light/rayocclusion.h"
#include "render/light/shade.h"
#include "render/light/visibility.h"
#include "render/planes.h"
#include <math.h>

/* The context of `shadowed`, a ShadowTest [shade.h]. */
typedef struct ShadowContext {
    Caster *caster;
    const Ground *ground;
    int worker;
} ShadowContext;

static bool shadowed(void *context, Vec3 point, Vec3 towards, double distance)
{
    const ShadowContext *shadow = context;
    return caster_shadow(shadow->caster, shadow->worker, shadow->ground, point, towards, distance);
}

/* Sets the ambient and light visibility of the shading input from the pixel of the sample at (i,
 * j). */
static void add_shared(const Drawing *drawing, double i, double j, double t, bool on_ground,
                       float light_visibility[VIEW_MAX_LIGHTS], ShadingInput *at)
{
    const PixelVisibility *visibility = drawing->visibility;
    ShadingPoint seen =
        shadingpoint_of(visibility, on_ground ? SURFACE_GROUND : SURFACE_VESSEL, at->point,
                        at->normal, pixelvisibility_pixel_mm(&drawing->view->camera, t));
    uint32_t pixel = pixelvisibility_find_pixel(visibility, i, j, &seen);
    at->ambient = (double)pixelvisibility_ambient(visibility, pixel);
    for (size_t k = 0; k < drawing->view->n_lights; k++)
        light_visibility[k] = pixelvisibility_light(visibility, k, pixel);
    at->light_visibility = light_visibility;
}

bool raycolor_is_needed(const View *view, const RenderParams *params)
{
    return params->occlusion > 0 || view->ground.present || softshadows_are_on(view, params);
}

/* Returns the color of the vessel at a hit: of its segment, or blended between segments. */
static Rgb pigment_of(const Drawing *drawing, const Surfel *surfel, Vec3 point)
{
    const Appearance *appearance = drawing->appearance;
    if (!drawing->mean)
        return appearance_color(appearance, surfel->segment);
    return appearance_blended(appearance, caster_mean(drawing->caster, drawing->mean, surfel,
                                                      appearance->positions, point));
}

Rgb ray_color(const Drawing *drawing, int worker, Ray ray, double i, double j, const Surfel *surfel)
{
    const View *view = drawing->view;
    const Appearance *appearance = drawing->appearance;
    const RenderParams *params = drawing->params;
    const Ground *ground = &view->ground;
    double t = surfel ? surfel->t : HUGE_VAL;
    bool on_ground = ground_hit(ground, ray, NEAREST_VISIBLE_MM, t, &t);
    if (!on_ground && !surfel)
        return view->background;
    float light_visibility[VIEW_MAX_LIGHTS];
    ShadowContext context = {drawing->caster, ground, worker};
    Vec3 point = ray_at(ray, t);
    ShadingInput at = {.finish = on_ground ? &ground->finish : &appearance->finish,
                       .pigment = on_ground ? ground->color : pigment_of(drawing, surfel, point),
                       .point = point,
                       .normal = on_ground ? ground->normal : surfel->normal,
                       .direction = ray.direction,
                       .ambient = 1};
    if (vec3_dot(at.normal, ray.direction) > 0)
        at.normal = vec3_scale(at.normal, -1);
    if (drawing->visibility)
        add_shared(drawing, i, j, t, on_ground, light_visibility, &at);
    else if (params->occlusion > 0)
        at.ambient = rayocclusion_ambient(drawing->caster, worker, ground, at.point, at.normal,
                                          params->occlusion, rayocclusion_turn(i, j));
    const Rgb color = shade(view, &at, params->shadows ? shadowed : NULL, &context);
    return on_ground ? color : rgb_mixed(color, view->background, fade_at(&view->fade, t));
}

void raycolor_store(const Drawing *drawing, int worker, int column, int row, const Surfel *surfel,
                    Frame *frame)
{
    const Camera *camera = &drawing->view->camera;
    const size_t pixel = (size_t)row * (size_t)camera->width + (size_t)column;
    const int j = drawing->band.first + row;
    if (surfel)
        planes_store(frame, pixel, surfel->t, surfel->normal,
                     drawing->geometry->ids[surfel->segment]);
    else
        planes_store_nothing(frame, pixel, 1);
    if (frame->color.values)
        planes_store_color(
            frame, pixel,
            ray_color(drawing, worker, camera_ray(camera, column, j), column, j, surfel));
}
