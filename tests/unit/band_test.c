/* Bands have exactly the bytes of the whole picture. */
#include "render/render.h"
#include "unit.h"

#include "render/light/bandvisibility.h"
#include "stage/stage.h"
#include "treeio/treeio.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_stage.h"
#include <stdio.h>

enum { WIDTH = 83, HEIGHT = 61 };

static Err err;

static Look look = {
    .color = {0.5f, 0.1f, 0.2f},
    .background = {0.9f, 1, 1},
    .finish = {.ambient = 0.1f,
               .diffuse = 0.6f,
               .brilliance = 1,
               .phong = 0.3f,
               .phong_size = 31,
               .roughness = 0.05f},
    .lights = {{.direction = {-0.5, 0.7, 1}, .color = {0.8f, 0.8f, 0.8f}},
               {.is_point = true, .direction = {1.5, 0.3, 1}, .color = {0.2f, 0.3f, 0.3f}}},
    .n_lights = 2,
    .ground = {
        .normal = {0.1, 0.3, 1}, .color = {0.8f, 0.7f, 0.9f}, .ambient = 0.3, .diffuse = 0.5}};

static Scene staged(SceneModel model, Projection projection)
{
    Tree tree;
    Scene scene;
    StageParams params = stage_defaults();
    params.geometry.model = model;
    params.view.projection = projection;
    params.view.view = VIEW_ISO;
    params.view.shadows = true;
    params.view.width = WIDTH;
    params.view.height = HEIGHT;
    assert_int_equal(tree_read(&tree, "tests/golden/ball60.swc", &err), STATUS_OK);
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, &err), STATUS_OK);
    tree_release(&tree);
    return scene;
}

static void assert_same_rows(const Frame *whole, const Frame *band, int first)
{
    size_t width = (size_t)whole->color.width;
    size_t start = (size_t)first * width, n = (size_t)band->color.height * width;
    assert_memory_equal(whole->color.values + 3 * start, band->color.values, 3 * n * sizeof(float));
    assert_memory_equal(whole->depth.values + start, band->depth.values, n * sizeof(float));
    assert_memory_equal(whole->normal.values + 3 * start, band->normal.values,
                        3 * n * sizeof(float));
    assert_memory_equal(whole->id.ids + start, band->id.ids, n * sizeof(uint32_t));
}

/* `step` rows at a time. */
static void assert_bands_are_the_whole(const Scene *scene, const RenderParams *params, int step)
{
    const int height = scene->view.camera.height;
    Frame whole;
    RenderStats stats;
    Renderer *renderer;
    assert_int_equal(render(scene, params, &whole, &stats, &err), STATUS_OK);
    assert_int_equal(whole.color.height, height);
    assert_int_equal(renderer_new(&scene->geometry, params, &renderer, &err), STATUS_OK);
    for (int first = 0; first < height; first += step) {
        Frame band;
        int rows = step < height - first ? step : height - first;
        assert_int_equal(
            renderer_rows(renderer, &scene->view, &scene->appearance, first, rows, &band, &err),
            STATUS_OK);
        assert_int_equal(band.color.height, rows);
        assert_int_equal(band.id.height, rows);
        assert_same_rows(&whole, &band, first);
        frame_release(&band);
    }
    assert_true(renderer_stats(renderer).rays >= stats.rays);
    renderer_free(renderer);
    frame_release(&whole);
}

static RenderParams all_planes(int antialias, double threshold)
{
    return (RenderParams){.threads = 2,
                          .antialias = antialias,
                          .antialias_threshold = threshold,
                          .want_color = true,
                          .want_depth = true,
                          .want_normal = true,
                          .want_id = true};
}

static void bands_have_the_bytes_of_the_whole(void **state)
{
    (void)state;
    static const struct {
        int antialias, step;
        double threshold;
        int occlusion;
    } cases[] = {{1, 8, 0, 5}, {3, 16, 0, 0}, {2, 8, 0.05, 2}, {3, 24, 0.2, 0}};
    for (SceneModel model = SCENE_CYLINDERS; model <= SCENE_BLOB; model++)
        for (int projection = 0; projection < 2; projection++) {
            look.ground.present = projection == 1;
            Scene scene = staged(model, (Projection)projection);
            for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
                RenderParams params = all_planes(cases[i].antialias, cases[i].threshold);
                params.shadows = i % 2 == 0;
                params.occlusion = cases[i].occlusion;
                assert_bands_are_the_whole(&scene, &params, cases[i].step);
            }
            scene_release(&scene);
        }
}

static void bands_of_tiles_have_the_bytes_of_the_whole(void **state)
{
    (void)state;
    static const struct {
        int antialias, step;
        double threshold;
    } cases[] = {{1, 8, 0}, {3, 16, 0}, {2, 8, 0.05}};
    look.ground.present = false;
    for (SceneModel model = SCENE_CYLINDERS; model <= SCENE_ROUNDED; model++)
        for (int projection = 0; projection < 2; projection++) {
            Scene scene = staged(model, (Projection)projection);
            for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
                RenderParams params = all_planes(cases[i].antialias, cases[i].threshold);
                params.method = RENDER_RASTER;
                params.shadows = i != 1;
                assert_bands_are_the_whole(&scene, &params, cases[i].step);
            }
            scene_release(&scene);
        }
}

/* Bands of some blocks of rows, of which each has the lists of the lights made for its places. */
static void bands_have_the_soft_shadows_of_the_whole(void **state)
{
    (void)state;
    const Look plain = look;
    look.lights[1].samples = 4;
    look.lights[1].size = 0.7;
    for (int ground = 0; ground < 2; ground++)
        for (SceneModel model = SCENE_CYLINDERS; model <= SCENE_BLOB; model++) {
            look.ground.present = ground == 1;
            Scene scene = staged(model, (Projection)ground);
            scene.view.camera.height = 4 * VISIBILITY_BLOCK + 11;
            scene.view.camera.width = 2 * WIDTH;
            RenderParams params = all_planes(1, 0);
            params.method = RENDER_RASTER;
            params.shadows = true;
            assert_bands_are_the_whole(&scene, &params, VISIBILITY_BLOCK + 8);
            scene_release(&scene);
        }
    look = plain;
}

/* Draws the first rows twice and tells how often they were prepared in all. */
static size_t prepared(Renderer *renderer, const Scene *scene, Frame *rows)
{
    assert_int_equal(renderer_rows(renderer, &scene->view, &scene->appearance, 0, 8, rows, &err),
                     STATUS_OK);
    frame_release(rows);
    assert_int_equal(renderer_rows(renderer, &scene->view, &scene->appearance, 0, 8, rows, &err),
                     STATUS_OK);
    return renderer_stats(renderer).preparations;
}

static void assert_rows_of_today(const Scene *scene, const RenderParams *params, Frame *rows)
{
    Frame whole;
    assert_int_equal(render(scene, params, &whole, NULL, &err), STATUS_OK);
    assert_same_rows(&whole, rows, 0);
    frame_release(&whole);
    frame_release(rows);
}

static void bands_prepare_again_for_another_view_alone_not_for_other_colors(void **state)
{
    (void)state;
    static const SceneModel either[] = {SCENE_JOINED, SCENE_ISOSURFACE};
    look.ground.present = false;
    for (size_t i = 0; i < 2; i++) {
        Scene scene = staged(either[i], PROJECTION_ORTHOGRAPHIC);
        RenderParams params = all_planes(1, 0);
        Renderer *renderer;
        Frame rows;
        params.method = RENDER_RASTER;
        params.shadows = true;
        assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
        assert_int_equal(prepared(renderer, &scene, &rows), 1);
        assert_rows_of_today(&scene, &params, &rows);
        scene.view.camera.location =
            vec3_add_scaled(scene.view.camera.location, scene.view.camera.right, 0.125);
        assert_int_equal(prepared(renderer, &scene, &rows), 2);
        assert_rows_of_today(&scene, &params, &rows);
        scene.view.lights[0].location =
            vec3_add_scaled(scene.view.lights[0].location, scene.view.camera.up, 3);
        assert_int_equal(prepared(renderer, &scene, &rows), 3);
        assert_rows_of_today(&scene, &params, &rows);
        Rgb colors[200];
        for (size_t k = 0; k < sizeof colors / sizeof *colors; k++)
            colors[k] = (Rgb){0.1f, (float)k / 200, 0.7f};
        assert_true(scene.geometry.n_ids <= sizeof colors / sizeof *colors);
        scene.appearance.colors = colors;
        scene.appearance.finish.diffuse = 0.4f;
        scene.view.background.r = 0.375f;
        assert_int_equal(prepared(renderer, &scene, &rows), 3);
        assert_rows_of_today(&scene, &params, &rows);
        scene.appearance.colors = NULL;
        params.antialias = 2;
        renderer_antialias(renderer, 2);
        assert_int_equal(prepared(renderer, &scene, &rows), 4);
        assert_rows_of_today(&scene, &params, &rows);
        renderer_free(renderer);
        scene_release(&scene);
    }
}

/* As POV-Ray sees it. */
static void bands_of_povrays_view_have_the_bytes_of_the_whole(void **state)
{
    (void)state;
    Scene scene = staged(SCENE_ISOSURFACE, PROJECTION_ORTHOGRAPHIC);
    const CellParams cells = {0};
    RenderParams params = all_planes(2, 0.05);
    params.povray_cells = &cells;
    assert_bands_are_the_whole(&scene, &params, 40);
    scene_release(&scene);
}

typedef struct Said {
    double last;
    int calls;
} Said;

static bool rises(double fraction, void *context)
{
    Said *said = context;
    assert_true(fraction >= said->last && fraction <= 1);
    said->last = fraction;
    said->calls++;
    return true;
}

static void progress_rises_from_band_to_band(void **state)
{
    (void)state;
    for (SceneModel model = SCENE_ROUNDED; model <= SCENE_ISOSURFACE; model++) {
        Scene scene = staged(model, PROJECTION_ORTHOGRAPHIC);
        Said said = {0};
        const RenderParams params = {.threads = 1,
                                     .antialias = 2,
                                     .want_color = true,
                                     .progress = rises,
                                     .progress_context = &said};
        Renderer *renderer;
        assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
        for (int first = 0; first < HEIGHT; first += 32) {
            Frame band;
            int rows = first + 32 < HEIGHT ? 32 : HEIGHT - first;
            assert_int_equal(
                renderer_rows(renderer, &scene.view, &scene.appearance, first, rows, &band, &err),
                STATUS_OK);
            frame_release(&band);
        }
        assert_true(said.calls >= 16 && said.last > 0.8);
        renderer_free(renderer);
        scene_release(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_have_the_bytes_of_the_whole),
        cmocka_unit_test(bands_of_tiles_have_the_bytes_of_the_whole),
        cmocka_unit_test(bands_have_the_soft_shadows_of_the_whole),
        cmocka_unit_test(bands_prepare_again_for_another_view_alone_not_for_other_colors),
        cmocka_unit_test(bands_of_povrays_view_have_the_bytes_of_the_whole),
        cmocka_unit_test(progress_rises_from_band_to_band),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
