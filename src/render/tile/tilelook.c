#include "render/tile/tilelook.h"

Status tilelook_make(const Scene *scene, const Viewpoint *eye, TileLight **lights, TileLook *look,
                     Err *err)
{
    TileLight *made;
    TRY(mem_calloc(&made, scene->n_lights, sizeof *made, "lights", err));
    for (size_t i = 0; i < scene->n_lights; i++) {
        const Light *light = &scene->lights[i];
        Vec3 v =
            light->parallel
                ? viewpoint_to_frame(eye, vec3_normalized(vec3_sub(light->location, light->target)))
                : viewpoint_place(eye, light->location);
        made[i] = (TileLight){.towards = {(float)v.x, (float)v.y, (float)v.z},
                              .color = {light->color.r, light->color.g, light->color.b},
                              .parallel = light->parallel};
    }
    *lights = made;
    *look = (TileLook){scene->finish, made, scene->n_lights};
    return STATUS_OK;
}

bool tilelook_needs_places(const Scene *scene)
{
    bool needs = scene->camera.projection == PROJECTION_PERSPECTIVE;
    for (size_t i = 0; i < scene->n_lights; i++)
        needs |= !scene->lights[i].parallel;
    return needs;
}

void tilesurface_init(const Scene *scene, TileSurface *surface)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        surface->direction[2][sample] = 1;
        surface->pigment[0][sample] = scene->color.r;
        surface->pigment[1][sample] = scene->color.g;
        surface->pigment[2][sample] = scene->color.b;
    }
}
