/* Slow: compares ambient visibility with a thousand rays per shading point, in trees of 20,000
 * segments. */
#include "render/render.h"
#include "unit.h"

#include "render/light/rayocclusion.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_grow.h"
#include "test_scene.h"
#include "test_stage.h"

static Err err;

/* Colors of this look are the part of the sky that is seen. */
static const Look sky_look = {.color = {1, 1, 1}, .finish = {.ambient = 1, .brilliance = 1}};

static Scene staged(const Tree *tree, const Look *look, SceneModel model, int size, NamedView view)
{
    Scene scene;
    StageParams params = stage_square(model, size);
    params.view.view = view;
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
    return rayocclusion_ambient(caster, 0, &scene->view.ground, point,
                                vec3((double)n[0], (double)n[1], (double)n[2]), 1024,
                                rayocclusion_turn(i, j));
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
    } cases[] = {{"disc:50", VIEW_FRONT, SCENE_JOINED},
                 {"ball:50", VIEW_ISO, SCENE_ROUNDED},
                 {"ball:28.8", VIEW_ISO, SCENE_JOINED}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Tree tree = test_grown(cases[i].domain, 10000, 5);
        Scene scene = staged(&tree, &sky_look, cases[i].model, 2000, cases[i].view);
        double error = error_of(&scene, 16, 200);
        if (!(error < 0.04))
            fail_msg("%s: %.4f", cases[i].domain, error);
        scene_release(&scene);
        tree_release(&tree);
    }
}

/* A ball over the ground under an area light, looked at from above. */
static Scene ball_over_ground(SceneModel model, int size)
{
    static Primitive ball = {
        .kind = PRIMITIVE_SPHERE, .a = {0.3, 0.2, 3}, .b = {0.3, 0.2, 3}, .radius_mm = 1.7};
    static FieldSegment rod = {.a = {-2, 0.2, 3}, .b = {2.5, 0.4, 3.4}, .radius_mm = 0.9};
    Scene scene = {
        .geometry = {.model = model, .ids = test_ids(), .bounds = {{-4, -3, 0}, {5, 3, 6}}},
        .appearance = {.color = {0.6f, 0.5f, 0.4f}},
        .view = {.camera = {.location = {0, 0, 40},
                            .right = {24, 0, 0},
                            .up = {0, 24, 0},
                            .direction = {0, 0, -1},
                            .width = size,
                            .height = size},
                 .ground = {.present = true,
                            .normal = {0, 0, 1},
                            .color = {0.9f, 0.8f, 0.7f},
                            .finish = {.ambient = 0.3f, .diffuse = 0.6f, .brilliance = 1}}}};
    light_test_scene(&scene);
    scene.view.lights[0] = (Light){.location = {4, -3, 12},
                                   .color = {0.9f, 0.8f, 0.7f},
                                   .casts_shadows = true,
                                   .samples = 4,
                                   .sides = {{3, 0, 0}, {0, 3, 0}}};
    scene.geometry.primitives = &ball;
    scene.geometry.n_primitives = model == SCENE_ROUNDED;
    scene.geometry.segments = &rod;
    scene.geometry.n_segments = model != SCENE_ROUNDED;
    return scene;
}

static Frame drawn(const Scene *scene, RenderParams params)
{
    Frame frame;
    params.want_depth = params.want_normal = false;
    assert_int_equal(render(scene, &params, &frame, NULL, &err), STATUS_OK);
    return frame;
}

static void assert_same_pixels(const Frame *a, const Frame *b)
{
    size_t n = 3 * (size_t)a->color.width * (size_t)a->color.height;
    assert_memory_equal(a->color.values, b->color.values, n * sizeof(float));
}

/* The largest difference of two pictures, and the root of the mean squared one. */
static float largest_difference(const Frame *a, const Frame *b, double *rms)
{
    size_t n = 3 * (size_t)a->color.width * (size_t)a->color.height;
    float largest = 0;
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        float off = fabsf(a->color.values[i] - b->color.values[i]);
        largest = fmaxf(largest, off);
        sum += (double)off * (double)off;
    }
    *rms = sqrt(sum / (double)n);
    return largest;
}

static void shared_light_does_not_depend_on_threads_or_bands(void **state)
{
    (void)state;
    for (SceneModel model = SCENE_ROUNDED; model <= SCENE_BLOB; model++) {
        Scene scene = ball_over_ground(model, 67);
        RenderParams params = params_of(5);
        params.shadows = true;
        params.antialias = 2;
        params.threads = 1;
        Frame whole = drawn(&scene, params);
        params.threads = 3;
        Frame other = drawn(&scene, params);
        assert_same_pixels(&whole, &other);
        Renderer *renderer;
        assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
        for (int first = 0; first < 67; first += 16) {
            Frame band;
            int rows = first + 16 < 67 ? 16 : 67 - first;
            assert_int_equal(
                renderer_rows(renderer, &scene.view, &scene.appearance, first, rows, &band, &err),
                STATUS_OK);
            assert_memory_equal(band.color.values, whole.color.values + (size_t)3 * 67 * first,
                                (size_t)3 * 67 * rows * sizeof(float));
            frame_release(&band);
        }
        renderer_free(renderer);
        frame_release(&other);
        frame_release(&whole);
    }
}

/* One vessel, of a few pixels: sets of pixels that nobody is in ask nothing. */
static void a_vessel_of_a_few_pixels_has_its_sky(void **state)
{
    (void)state;
    Scene scene = ball_over_ground(SCENE_ROUNDED, 9);
    scene.view.ground.present = false;
    scene.view.n_lights = 0;
    scene.appearance.finish = (Finish){.ambient = 1, .brilliance = 1};
    Frame frame = drawn(&scene, params_of(3));
    /* A ball alone sees all of it: the middle has its own color. */
    assert_float_equal(frame.color.values[3 * (4 * 9 + 4)], 0.6f, 1e-4f);
    frame_release(&frame);
}

/* Of one vessel, stout enough for its end to be seen by many pixels. */
static void flat_ends_that_meet_no_vessel_see_the_whole_sky(void **state)
{
    (void)state;
    static const SceneModel flat[] = {SCENE_CYLINDERS, SCENE_JOINED};
    Tree tree;
    assert_int_equal(tree_init(&tree, 2, &err), STATUS_OK);
    tree.parent[1] = 0;
    tree.position[1] = vec3(0.2, 0.3, 31);
    tree.radius_mm[0] = tree.radius_mm[1] = 4.7;
    for (size_t i = 0; i < sizeof flat / sizeof *flat; i++) {
        Scene scene = staged(&tree, &sky_look, flat[i], 61, VIEW_FRONT);
        Frame frame = drawn(&scene, params_of(16));
        for (int x = 20; x <= 40; x++)
            assert_float_equal(frame.color.values[3 * (30 * 61 + x)], 1, 1e-4f);
        frame_release(&frame);
        scene_release(&scene);
    }
    tree_release(&tree);
}

/* The kernels fuse nothing where beams are found; shading is within 2e-5 of the light. */
static void kernels_find_the_same_sky(void **state)
{
    (void)state;
    Scene scene = ball_over_ground(SCENE_ROUNDED, 67);
    RenderParams params = params_of(16);
    params.kernels = KERNELS_PORTABLE;
    Frame portable = drawn(&scene, params);
    for (RenderKernels kernels = KERNELS_AVX2; kernels <= render_fastest_kernels(); kernels++) {
        double rms;
        params.kernels = kernels;
        Frame other = drawn(&scene, params);
        assert_true(largest_difference(&portable, &other, &rms) < 1e-4f);
        frame_release(&other);
    }
    frame_release(&portable);
}

/* Ground, and lights that are points, are exact to rounding but where edges pass a sample. */
static void the_ground_of_tiles_is_that_of_rays(void **state)
{
    (void)state;
    for (SceneModel model = SCENE_ROUNDED; model <= SCENE_ISOSURFACE; model++)
        for (int slanted = 0; slanted < 2; slanted++) {
            Scene scene = ball_over_ground(model, 141);
            RenderParams params = params_of(0);
            scene.view.lights[0].samples = 0;
            if (slanted) {
                scene.view.camera.projection = PROJECTION_PERSPECTIVE;
                scene.view.camera.location = vec3(0, -32, 24);
                scene.view.camera.direction = vec3(0, 0.8, -0.6);
                scene.view.camera.right = vec3(0.7, 0, 0);
                scene.view.camera.up = vec3(0, 0.42, 0.56);
            }
            params.shadows = true;
            Frame tiles = drawn(&scene, params);
            params.method = RENDER_TRACE;
            Frame rays = drawn(&scene, params);
            size_t off = 0;
            for (size_t i = 0; i < (size_t)3 * 141 * 141; i++)
                off += fabsf(tiles.color.values[i] - rays.color.values[i]) > 1e-4f;
            assert_true(off <= 6);
            frame_release(&tiles);
            frame_release(&rays);
        }
}

/* A quarter of the points a pixel, in squares of two by two, is all of them on average. */
static void soft_shadows_are_the_mean_over_all_points(void **state)
{
    (void)state;
    for (SceneModel model = SCENE_ROUNDED; model <= SCENE_ISOSURFACE; model++) {
        Scene scene = ball_over_ground(model, 201);
        RenderParams params = params_of(0);
        double rms;
        params.shadows = true;
        Frame shared = drawn(&scene, params);
        params.method = RENDER_TRACE;
        Frame rays = drawn(&scene, params);
        /* A point of 16 moves a picture by 0.9 * 0.6 / 16 at its shadow's edge. */
        assert_true(largest_difference(&shared, &rays, &rms) < 0.1f);
        assert_true(rms < 0.005);
        frame_release(&shared);
        frame_release(&rays);
    }
}

/* Below a ball of radius r, d away, all but r^2 / d^2 is open; far out all. */
static void the_ground_sees_what_a_ball_leaves(void **state)
{
    (void)state;
    Scene scene = ball_over_ground(SCENE_ROUNDED, 97);
    RenderParams params = params_of(64);
    scene.view.n_lights = 0;
    scene.view.ground.finish = (Finish){.ambient = 1, .brilliance = 1};
    scene.view.ground.color = (Rgb){1, 1, 1};
    /* Along 45 degrees past the ball on to the ground right below it. */
    scene.view.camera.location = vec3(0.3 - 32, 0.2, 32);
    scene.view.camera.direction = vec3(0.70710678118654757, 0, -0.70710678118654757);
    scene.view.camera.right = vec3(0, -12, 0);
    scene.view.camera.up = vec3(6, 0, 6);
    Frame frame = drawn(&scene, params);
    /* The middle of the picture is the ground right below the ball. */
    double open = (double)frame.color.values[3 * (48 * 97 + 48)];
    assert_true(fabs(open - (1 - 1.7 * 1.7 / 9)) < 0.03);
    frame_release(&frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shared_light_does_not_depend_on_threads_or_bands),
        cmocka_unit_test(a_vessel_of_a_few_pixels_has_its_sky),
        cmocka_unit_test(flat_ends_that_meet_no_vessel_see_the_whole_sky),
        cmocka_unit_test(kernels_find_the_same_sky),
        cmocka_unit_test(the_ground_of_tiles_is_that_of_rays),
        cmocka_unit_test(soft_shadows_are_the_mean_over_all_points),
        cmocka_unit_test(the_ground_sees_what_a_ball_leaves),
        cmocka_unit_test(occlusion_is_within_4_percent_of_1024_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
