#include "render/tile/tilelook.h"

#include <string.h>

Status tilelook_make(const Scene *scene, Vec3 location, const Vec3 axes[3], TileLight **lights,
                     TileLook *look, Err *err)
{
    TileLight *made;
    TRY(mem_calloc(&made, scene->n_lights, sizeof *made, "lights", err));
    for (size_t i = 0; i < scene->n_lights; i++) {
        const Light *light = &scene->lights[i];
        Vec3 v = light->parallel ? vec3_normalized(vec3_sub(light->location, light->target))
                                 : vec3_sub(light->location, location);
        made[i] = (TileLight){.towards = {(float)vec3_dot(v, axes[0]), (float)vec3_dot(v, axes[1]),
                                          (float)vec3_dot(v, axes[2])},
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

void tilelook_encode(const TileKernels *kernels, const SrgbCodes *codes,
                     float color[3][TILE_SAMPLES], const uint8_t *state,
                     const uint8_t background[3], int columns, int rows, uint8_t *pixels,
                     size_t stride)
{
    if (columns == TILE_SIDE && rows == TILE_SIDE) {
        kernels->encode(codes, color, state, background, pixels, stride);
        return;
    }
    uint8_t whole[TILE_SIDE][3 * TILE_SIDE];
    kernels->encode(codes, color, state, background, whole[0], sizeof whole[0]);
    for (int row = 0; row < rows; row++)
        memcpy(pixels + (size_t)row * stride, whole[row], 3 * (size_t)columns);
}
