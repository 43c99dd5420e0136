/* Counts how many points of a light are visible from each shading point, by one light view per
 * point of the light, or by rays. All light views answer the queries of a run of consecutive
 * shading points before the next run begins. A run has so few points that its queries stay in the
 * cache. */
#include "render/light/shadowpass.h"

#include "render/cast/caster.h"
#include <stdlib.h>
#include <string.h>

Status shadowpass_init(const Drawing *drawing, LightBins *const *bins, int n_views,
                       const bool *hidden, ShadowPass *pass, Err *err)
{
    const RenderParams *params = drawing->params;
    size_t n = (size_t)params->threads * (size_t)n_views;
    pass->n_views = n_views;
    pass->n_queues = n;
    TRY(mem_calloc(&pass->queues, n, sizeof *pass->queues, "lights", err));
    for (size_t i = 0; i < n; i++)
        TRY(shadowqueue_new(bins[i % (size_t)n_views], params->kernels, hidden, &pass->queues[i],
                            err));
    return STATUS_OK;
}

void shadowpass_release(ShadowPass *pass)
{
    for (size_t i = 0; pass->queues && i < pass->n_queues; i++)
        shadowqueue_free(pass->queues[i]);
    free(pass->queues);
    *pass = (ShadowPass){0};
}

Status shadowpass_run(const ShadowPass *pass, size_t begin, size_t end, int worker, Err *err)
{
    const ShadowClient *client = &pass->client;
    ShadowQueue **queues = &pass->queues[worker * pass->n_views];
    uint8_t shadowed[SHADOW_RUN];
    uint16_t n_dark[SHADOW_RUN];
    uint64_t wanted[SHADOW_RUN / TILE_SAMPLES];
    const size_t n = end - begin;
    for (size_t i = 0; i < n; i += TILE_SAMPLES) {
        HitPoints points = {.x = {0}};
        size_t count = n - i < TILE_SAMPLES ? n - i : TILE_SAMPLES;
        uint64_t bits = client->locate(client->context, begin + i, count, &points);
        for (int k = 0; k < pass->n_views; k++)
            shadowqueue_add(queues[k], &points, NULL, bits, (uint32_t)i);
        wanted[i / TILE_SAMPLES] = bits;
    }
    memset(n_dark, 0, n * sizeof *n_dark);
    for (int k = 0; k < pass->n_views; k++) {
        memset(shadowed, 0, n);
        TRY(shadowqueue_answer(queues[k], shadowed, err));
        for (size_t i = 0; i < n; i++)
            n_dark[i] = (uint16_t)(n_dark[i] + shadowed[i]);
    }
    for (size_t i = 0; i < n; i++) {
        bool queried = wanted[i / TILE_SAMPLES] >> i % TILE_SAMPLES & 1;
        client->store(client->context, begin + i, queried ? pass->n_views - n_dark[i] : 0);
    }
    return STATUS_OK;
}

int shadowrays_count(const Drawing *drawing, int worker, const Light *light, int set, Vec3 point)
{
    int n = 0;
    for (int k = 0; k < light_points(light); k++) {
        if (!sampleset_has(set, light, k))
            continue;
        LightDirection to_light = light_direction_to_point(light, k, point);
        n += !caster_shadow(drawing->caster, worker, &drawing->view->ground, point,
                            to_light.towards, to_light.distance);
    }
    return n;
}
