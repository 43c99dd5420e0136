#include "render/tile/tilelook.h"

Status tilelook_make(const View *view, const Finish *finish, const Viewpoint *eye,
                     TileLight **lights, TileLook *look, Err *err)
{
    TileLight *made;
    TRY(mem_calloc(&made, view->n_lights, sizeof *made, "lights", err));
    for (size_t i = 0; i < view->n_lights; i++) {
        const Light *light = &view->lights[i];
        Vec3 v =
            light->parallel
                ? viewpoint_to_frame(eye, vec3_normalized(vec3_sub(light->location, light->target)))
                : viewpoint_place(eye, light->location);
        made[i] = (TileLight){.towards = {(float)v.x, (float)v.y, (float)v.z},
                              .color = {light->color.r, light->color.g, light->color.b},
                              .parallel = light->parallel};
    }
    *lights = made;
    *look = (TileLook){*finish, made, view->n_lights};
    return STATUS_OK;
}

bool tilelook_needs_places(const View *view)
{
    bool needs = view->camera.projection == PROJECTION_PERSPECTIVE;
    for (size_t i = 0; i < view->n_lights; i++)
        needs |= !view->lights[i].parallel;
    return needs;
}

void tilesurface_init(Rgb color, TileSurface *surface)
{
    for (int sample = 0; sample < TILE_SAMPLES; sample++) {
        surface->direction[2][sample] = 1;
        surface->pigment[0][sample] = color.r;
        surface->pigment[1][sample] = color.g;
        surface->pigment[2][sample] = color.b;
    }
}
