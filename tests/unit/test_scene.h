/* Parts shared by test scenes: ids, and lights and a finish with no number at its default. */
#ifndef CORCAST_TESTS_TEST_SCENE_H
#define CORCAST_TESTS_TEST_SCENE_H

#include "scene/scene.h"

enum { MOST_TEST_IDS = 4096 };

/* For Geometry.ids: segment i has the id i + 1. */
static inline uint32_t *test_ids(void)
{
    static uint32_t ids[MOST_TEST_IDS];
    for (uint32_t i = 0; i < MOST_TEST_IDS; i++)
        ids[i] = i + 1;
    return ids;
}

/* A parallel and a point light, both with shadows. */
static inline void light_test_scene(Scene *scene)
{
    scene->view.lights[0] = (Light){.location = {30, 80, 90},
                                    .color = {0.9f, 0.8f, 0.7f},
                                    .parallel = true,
                                    .casts_shadows = true};
    scene->view.lights[1] =
        (Light){.location = {-60, 20, 75}, .color = {0.2f, 0.3f, 0.4f}, .casts_shadows = true};
    scene->view.n_lights = 2;
    scene->view.background = (Rgb){0.25f, 0.5f, 1};
    scene->appearance.finish = (Finish){.ambient = 0.1f,
                                        .diffuse = 0.7f,
                                        .brilliance = 1.3f,
                                        .phong = 0.4f,
                                        .phong_size = 35,
                                        .specular = 0.1f,
                                        .roughness = 0.07f};
}

#endif
