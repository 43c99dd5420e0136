/* One place for all that happens to a ray after it has met a vessel or none, whichever way that was
 * found, so that every model is lit alike. */
#include "render/light/raycolor.h"

#include "render/light/occlusion.h"
#include "render/light/shade.h"
#include <math.h>

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

bool raycolor_is_needed(const View *view, const RenderParams *params)
{
    bool soft = false;
    for (size_t i = 0; i < view->n_lights; i++)
        soft |= view->lights[i].casts_shadows && view->lights[i].samples > 1;
    return params->occlusion > 0 || view->ground.present || (params->shadows && soft);
}

Rgb ray_color(const RayColoring *with, int worker, Ray ray, double i, double j,
              const Surfel *surfel)
{
    const View *view = with->view;
    const Ground *ground = &view->ground;
    double t = surfel ? surfel->t : HUGE_VAL;
    bool on_ground = ground_hit(ground, ray, NEAREST_SEEN_MM, t, &t);
    if (!on_ground && !surfel)
        return view->background;
    ShadowContext context = {with->caster, ground, worker};
    ShadePoint at = {.finish = on_ground ? &ground->finish : &with->appearance->finish,
                     .pigment = on_ground ? ground->color
                                          : appearance_color(with->appearance, surfel->segment),
                     .point = ray_at(ray, t),
                     .normal = on_ground ? ground->normal : surfel->normal,
                     .direction = ray.direction,
                     .open = 1};
    if (vec3_dot(at.normal, ray.direction) > 0)
        at.normal = vec3_scale(at.normal, -1);
    if (with->params->occlusion > 0)
        at.open = occlusion_open(with->caster, worker, ground, at.point, at.normal,
                                 with->params->occlusion, occlusion_turn(i, j));
    return shade(view, &at, with->params->shadows ? shadowed : NULL, &context);
}
