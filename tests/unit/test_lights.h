/* The lights and the finish of test scenes: a parallel and a point light, both with shadows, and no
 * number of the finish at its default. */
#ifndef CORCAST_TESTS_TEST_LIGHTS_H
#define CORCAST_TESTS_TEST_LIGHTS_H

#include "scene/scene.h"

static inline void light_test_scene(Scene *scene, Light lights[2])
{
    lights[0] = (Light){.location = {30, 80, 90},
                        .color = {0.9f, 0.8f, 0.7f},
                        .parallel = true,
                        .casts_shadows = true};
    lights[1] =
        (Light){.location = {-60, 20, 75}, .color = {0.2f, 0.3f, 0.4f}, .casts_shadows = true};
    scene->lights = lights;
    scene->n_lights = 2;
    scene->background = (Rgb){0.25f, 0.5f, 1};
    scene->finish = (Finish){.ambient = 0.1f,
                             .diffuse = 0.7f,
                             .brilliance = 1.3f,
                             .phong = 0.4f,
                             .phong_size = 35,
                             .specular = 0.1f,
                             .roughness = 0.07f};
}

#endif
