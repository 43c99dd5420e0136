/* The looks of templates/looks: the light on vessels of all directions. */
#include "stage/stage.h"
#include "unit.h"

#include "render/render.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "test_stage.h"

static Err err;

enum { TUBES = 12, SIDE = 240 };

/* Tubes of radius 1.6 side by side, each turned in the picture's plane by 15 degrees more than the
 * one before. Tube k is node 2 k + 1, of id 2 k + 2. */
static void make_tubes(Tree *tree)
{
    assert_int_equal(tree_init(tree, 2 * (size_t)TUBES, NULL), STATUS_OK);
    for (int32_t k = 0; k < TUBES; k++) {
        double angle = k * 3.14159265358979323846 / TUBES;
        Vec3 center = vec3(14.0 * (k % 4), -14.0 * (k / 4), 0);
        Vec3 half = vec3(5 * cos(angle), 5 * sin(angle), 0);
        for (int32_t end = 0; end < 2; end++) {
            int32_t node = 2 * k + end;
            tree->parent[node] = end ? node - 1 : -1;
            tree->id[node] = node + 1;
            tree->radius_mm[node] = 1.6;
            tree->position[node] = vec3_add_scaled(center, half, end ? 1 : -1);
        }
    }
}

/* What the look's highlights add to a pixel of each tube at most, in the mean of the channels. */
static void measure_gleams(const Look *look, float gleam[TUBES])
{
    Tree tree;
    Frame shiny, dull;
    StageParams params = stage_defaults();
    params.geometry.model = SCENE_CYLINDERS;
    params.view.width = params.view.height = SIDE;
    const RenderParams asked = {.threads = 1, .antialias = 1, .want_color = true, .want_id = true};
    Scene scene;
    make_tubes(&tree);
    assert_int_equal(stage_all(&tree, look, &params, &scene, NULL, &err), STATUS_OK);
    assert_int_equal(render(&scene, &asked, &shiny, NULL, &err), STATUS_OK);
    scene.appearance.finish.phong = scene.appearance.finish.specular = 0;
    assert_int_equal(render(&scene, &asked, &dull, NULL, &err), STATUS_OK);
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        uint32_t id = shiny.id.ids[i];
        float more = 0;
        for (size_t c = 0; c < 3; c++)
            more += (shiny.color.values[3 * i + c] - dull.color.values[3 * i + c]) / 3;
        if (id)
            gleam[id / 2 - 1] = fmaxf(gleam[id / 2 - 1], more);
    }
    frame_release(&shiny);
    frame_release(&dull);
    scene_release(&scene);
    tree_release(&tree);
}

static void vessels_of_all_directions_gleam(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        float least; /* part of the light that a highlight has */
    } looks[] = {{"cast", 0.15f}, {"resin", 0.15f}, {"clinical", 0.1f},
                 {"ivory", 0.1f}, {"wax", 0.1f},    {"dark", 0.15f}};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        char path[64];
        Look look;
        float gleam[TUBES] = {0}, most = 0;
        snprintf(path, sizeof path, "templates/looks/%s.ini", looks[i].name);
        assert_int_equal(look_read(&look, path, &err), STATUS_OK);
        measure_gleams(&look, gleam);
        for (int k = 0; k < TUBES; k++)
            most = fmaxf(most, gleam[k]);
        for (int k = 0; k < TUBES; k++)
            if (gleam[k] < looks[i].least || gleam[k] < most * 0.4f)
                fail_msg("%s: the tube at %d degrees gleams by %g, the brightest by %g",
                         looks[i].name, 15 * k, (double)gleam[k], (double)most);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vessels_of_all_directions_gleam),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
