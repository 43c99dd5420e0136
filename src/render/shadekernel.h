/* shade.c's model for the samples of a tile, several at once and in single precision: included by
 * each source that compiles it for its lanes, SHADE_KERNEL being the name of the function. */
#ifndef SHADE_KERNEL
#error "define SHADE_KERNEL, the name of the function"
#endif

#include "render/lanes.h"
#include "render/tilekernels.h"

/* x^y of x in (0, 1], y >= 0: by squaring where y is a small whole number, as it mostly is. What is below
 * 1e-15 need not be right, and so never comes near the slow arithmetic of tiny numbers. */
LANE_FN Lanes lanes_power(Lanes x, float y)
{
    const Lanes least = lanes_set(1e-15f);
    unsigned whole = y <= 256 ? (unsigned)y : 0;
    if (whole > 0 && (float)whole == y) {
        x = lanes_max(x, least);
        Lanes power = whole & 1 ? x : lanes_set(1);
        while (whole >>= 1) {
            x = lanes_max(x * x, least);
            if (whole & 1)
                power = lanes_max(power * x, least);
        }
        return power;
    }
    return lanes_exp_minus(-y * lanes_log(lanes_max(x, lanes_set(1e-30f))));
}

typedef struct Shading {
    const TileLook *look;
    const TileSurface *surface;
    int first;
    Lanes normal[3], direction[3], color[3];
} Shading;

LANE_FN Lanes inner(const Lanes a[3], const Lanes b[3])
{
    return lanes_fma(a[0], b[0], lanes_fma(a[1], b[1], a[2] * b[2]));
}

LANE_FN Lanes phong(const Shading *shading, const Lanes towards[3])
{
    const Finish *finish = &shading->look->finish;
    Lanes twice = -2.0f * inner(shading->direction, shading->normal), mirrored[3];
    for (int c = 0; c < 3; c++)
        mirrored[c] = lanes_fma(shading->normal[c], twice, shading->direction[c]);
    Lanes cosine = inner(mirrored, towards);
    LaneMask seen = cosine > (finish->phong_size >= 60 ? 0.0008f : 0.0f);
    Lanes power = lanes_power(cosine, finish->phong_size) * finish->phong;
    return lanes_select(seen, power, lanes_set(0));
}

LANE_FN Lanes specular(const Shading *shading, const Lanes towards[3])
{
    const Finish *finish = &shading->look->finish;
    Lanes halfway[3];
    for (int c = 0; c < 3; c++)
        halfway[c] = towards[c] - shading->direction[c];
    Lanes length = lanes_sqrt(inner(halfway, halfway));
    Lanes cosine = inner(halfway, shading->normal) / lanes_max(length, lanes_set(1e-30f));
    Lanes power = lanes_power(cosine, 1 / finish->roughness) * finish->specular;
    return lanes_select(cosine > 0.0f, power, lanes_set(0));
}

LANE_FN void to_light(const Shading *shading, const TileLight *light, Lanes towards[3])
{
    for (int c = 0; c < 3; c++)
        towards[c] = lanes_set(light->towards[c]);
    if (light->parallel)
        return;
    for (int c = 0; c < 3; c++)
        towards[c] -= lanes_load(&shading->surface->point[c][shading->first]);
    Lanes per_length = 1.0f / lanes_sqrt(inner(towards, towards));
    for (int c = 0; c < 3; c++)
        towards[c] *= per_length;
}

LANE_FN void add_light(Shading *shading, size_t number)
{
    const Finish *finish = &shading->look->finish;
    const TileLight *light = &shading->look->lights[number];
    Lanes towards[3];
    to_light(shading, light, towards);
    Lanes cosine = inner(shading->normal, towards);
    LaneMask lit = cosine >= 1e-10f;
    for (int lane = 0; shading->surface->shadowed && lane < LANES; lane++)
        if (shading->surface->shadowed[number][shading->first + lane])
            lit[lane] = 0;
    if (!lanes_any(lit))
        return;
    Lanes diffuse = finish->brilliance == 1 ? cosine : lanes_power(cosine, finish->brilliance);
    diffuse *= finish->diffuse;
    Lanes highlight = lanes_set(0);
    if (finish->phong > 0)
        highlight += phong(shading, towards);
    if (finish->specular > 0)
        highlight += specular(shading, towards);
    for (int c = 0; c < 3; c++) {
        Lanes pigment = lanes_load(&shading->surface->pigment[c][shading->first]);
        Lanes sum = lanes_fma(pigment, diffuse, highlight) * light->color[c];
        shading->color[c] += lanes_select(lit, sum, lanes_set(0));
    }
}

LANE_FN bool any_hit_among(const uint8_t *state)
{
    uint8_t any = 0;
    for (int lane = 0; lane < LANES; lane++)
        any |= state[lane];
    return any != TILE_MISS;
}

LANE_TARGET static void SHADE_KERNEL(const TileLook *look, const TileSurface *surface,
                                     float color[3][TILE_SAMPLES])
{
    for (int first = 0; first < TILE_SAMPLES; first += LANES) {
        if (!any_hit_among(surface->hits->state + first))
            continue;
        Shading shading;
        shading.look = look;
        shading.surface = surface;
        shading.first = first;
        for (int c = 0; c < 3; c++) {
            shading.normal[c] = lanes_load(&surface->hits->normal[c][first]);
            shading.direction[c] = lanes_load(&surface->direction[c][first]);
            shading.color[c] = lanes_load(&surface->pigment[c][first]) * look->finish.ambient;
        }
        Lanes away = inner(shading.normal, shading.direction);
        for (int c = 0; c < 3; c++)
            shading.normal[c] = lanes_select(away > 0.0f, -shading.normal[c], shading.normal[c]);
        for (size_t i = 0; i < look->n_lights; i++)
            add_light(&shading, i);
        for (int c = 0; c < 3; c++)
            lanes_store(&color[c][first], shading.color[c]);
    }
}
