/* Slow: holds occlusion against a thousand rays a place, in trees of 20,000 segments. */
#include "render/render.h"

#include "grow/grow.h"
#include "render/light/occlusion.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_scene.h"
#include "test_stage.h"
#include <cmocka.h>

static Err err;

/* Colours of this look are the part of the sky that is seen. */
static const Look sky_look = {.color = {1, 1, 1}, .finish = {.ambient = 1, .brilliance = 1}};

static Tree grown(size_t terminals, const char *domain_spec)
{
    Domain domain;
    Tree tree;
    GrowParams params = grow_defaults();
    params.terminals = terminals;
    params.seed = 5;
    assert_int_equal(domain_parse(&domain, domain_spec, &err), STATUS_OK);
    assert_int_equal(grow_tree(&params, &domain, &tree, NULL, &err), STATUS_OK);
    domain_release(&domain);
    return tree;
}

static Scene staged(const Tree *tree, const Look *look, SceneModel model, int size, NamedView view)
{
    Scene scene;
    StageParams params = stage_defaults();
    params.geometry.model = model;
    params.view.width = params.view.height = size;
    params.view.view = view;
    params.view.shadows = true;
    assert_int_equal(stage_all(tree, look, &params, &scene, NULL, &err), STATUS_OK);
    return scene;
}

static RenderParams params_of(int occlusion)
{
    return (RenderParams){.method = RENDER_RASTER,
                          .threads = 2,
                          .antialias = 1,
                          .occlusion = occlusion,
                          .want_color = true,
                          .want_depth = true,
                          .want_normal = true};
}

/* What 1,024 rays from the place that a pixel sees say. */
static double by_rays(Caster *caster, const Scene *scene, const Frame *frame, int i, int j,
                      size_t pixel)
{
    const float *n = &frame->normal.values[3 * pixel];
    Vec3 point = ray_at(camera_ray(&scene->view.camera, i, j), (double)frame->depth.values[pixel]);
    return occlusion_open(caster, 0, &scene->view.ground, point,
                          vec3((double)n[0], (double)n[1], (double)n[2]), 1024,
                          occlusion_turn(i, j));
}

/* The error of 24 rows in the middle of the picture, at about so many places. */
static double error_of(const Scene *scene, int occlusion, size_t places)
{
    Renderer *renderer;
    Caster *caster;
    Frame frame;
    const RenderParams params = params_of(occlusion);
    int width = scene->view.camera.width, first = width / 2 / RENDER_BAND_STEP * RENDER_BAND_STEP;
    assert_int_equal(renderer_new(&scene->geometry, &params, &renderer, &err), STATUS_OK);
    assert_int_equal(
        renderer_rows(renderer, &scene->view, &scene->appearance, first, 24, &frame, &err),
        STATUS_OK);
    assert_int_equal(caster_new(&scene->geometry, NULL, 1, &caster, &err), STATUS_OK);
    size_t pixels = (size_t)width * 24, seen = 0, n = 0;
    for (size_t pixel = 0; pixel < pixels; pixel++)
        seen += isfinite(frame.depth.values[pixel]);
    double sum = 0;
    size_t step = seen / places + 1, number = 0;
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        if (!isfinite(frame.depth.values[pixel]) || number++ % step)
            continue;
        int i = (int)(pixel % (size_t)width), j = first + (int)(pixel / (size_t)width);
        double off =
            (double)frame.color.values[3 * pixel] - by_rays(caster, scene, &frame, i, j, pixel);
        sum += off * off;
        n++;
    }
    print_message("# of %zu places: %.4f\n", n, sqrt(sum / (double)n));
    assert_true(n > places / 2);
    caster_free(caster);
    renderer_free(renderer);
    frame_release(&frame);
    return sqrt(sum / (double)n);
}

static void occlusion_is_within_4_percent_of_1024_rays(void **state)
{
    (void)state;
    static const struct {
        const char *domain;
        NamedView view;
        SceneModel model;
    } cases[] = {{"disc:50", VIEW_FRONT, SCENE_ROUNDED},
                 {"ball:50", VIEW_ISO, SCENE_ROUNDED},
                 {"disc:50", VIEW_FRONT, SCENE_JOINED},
                 {"ball:50", VIEW_ISO, SCENE_ISOSURFACE}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Tree tree = grown(10000, cases[i].domain);
        Scene scene = staged(&tree, &sky_look, cases[i].model, 2000, cases[i].view);
        assert_true(error_of(&scene, 16, 400) < 0.04);
        scene_release(&scene);
        tree_release(&tree);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(occlusion_is_within_4_percent_of_1024_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
