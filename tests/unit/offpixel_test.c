/* Thin vessels of a grown tree have the same shadows from light views, and from the points of
 * area lights, as from rays. */
#include "render/field/fieldtiles.h"
#include "render/light/offpixel.h"
#include "render/raster/rasterbins.h"
#include "render/render.h"
#include "render/thin/thinvessels.h"
#include "unit.h"

#include "render/cast/caster.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test_grow.h"
#include "test_stage.h"

enum { SIDE = 240, TERMINALS = 3000 / (SHARE > 1 ? 3 : 1) };

static Err err;
static Tree tree;

static const Look plain = {.color = {0.8f, 0.6f, 0.4f},
                           .finish = {.ambient = 0.1f, .diffuse = 0.8f, .brilliance = 1}};

static int grow(void **state)
{
    (void)state;
    tree = test_grown("ball:20", TERMINALS, 11);
    return 0;
}

static int forget(void **state)
{
    (void)state;
    tree_release(&tree);
    return 0;
}

/* A parallel light, one of a point, and an area light of 3 x 3 points. */
static void light(Scene *scene)
{
    Vec3 middle = box_center(scene->geometry.bounds);
    scene->view.n_lights = 3;
    scene->view.lights[0] = (Light){.location = vec3_add(middle, vec3(33, 57, 71)),
                                    .target = middle,
                                    .color = {0.9f, 0.8f, 0.7f},
                                    .parallel = true,
                                    .casts_shadows = true};
    scene->view.lights[1] = (Light){.location = vec3_add(middle, vec3(-47, 29, 61)),
                                    .color = {0.5f, 0.4f, 0.3f},
                                    .casts_shadows = true};
    scene->view.lights[2] = (Light){.location = vec3_add(middle, vec3(21, -65, 43)),
                                    .color = {0.3f, 0.4f, 0.5f},
                                    .casts_shadows = true,
                                    .samples = 3,
                                    .sides = {{17, 0, 0}, {0, 9, 11}}};
}

static Scene staged(SceneModel model, Projection projection)
{
    Scene scene;
    StageParams params = stage_square(model, SIDE);
    params.view.projection = projection;
    assert_int_equal(stage_all(&tree, &plain, &params, &scene, NULL, &err), STATUS_OK);
    light(&scene);
    return scene;
}

/* The thin vessels of a scene, and a drawing. */
typedef struct Sight {
    Scene scene;
    ThinVessels thin;
    RenderParams params;
    Drawing drawing;
    Viewpoint frame;
} Sight;

static void see(SceneModel model, Projection projection, Sight *sight)
{
    *sight = (Sight){.scene = staged(model, projection)};
    sight->params = (RenderParams){.method = RENDER_FASTEST, .threads = 2, .shadows = true};
    sight->frame = viewpoint_of_camera(&sight->scene.view.camera);
    assert_int_equal(thinvessels_find(&sight->scene.geometry, &sight->scene.view.camera,
                                      (ThinWidths){1, 0}, 2, &sight->thin, &err),
                     STATUS_OK);
    assert_int_equal(caster_new(&sight->scene.geometry, NULL, 2, &sight->drawing.caster, &err),
                     STATUS_OK);
    sight->drawing.geometry = &sight->scene.geometry;
    sight->drawing.view = &sight->scene.view;
    sight->drawing.params = &sight->params;
}

static void forget_sight(Sight *sight)
{
    caster_free(sight->drawing.caster);
    thinvessels_release(&sight->thin);
    scene_release(&sight->scene);
}

static void look_from(Sight *sight, const ShadowEngine *engine, size_t number,
                      OffPixelPoints *places)
{
    const Light *light = &sight->scene.view.lights[number];
    const LightBinsParams params = {
        .engine = engine, .drawing = &sight->drawing, .frame = sight->frame};
    for (int k = 0; k < light_points(light); k++) {
        const Light point = light_at_point(light, k);
        LightBins *bins;
        assert_int_equal(lightbins_new(&params, &point, 1, &bins, &err), STATUS_OK);
        assert_int_equal(offpixel_query(&sight->drawing, &(OffPixelViews){&bins, 1, &sight->frame},
                                        number, places, &err),
                         STATUS_OK);
        lightbins_free(bins);
    }
}

/* All answers but `most` of a million are those of rays. */
static void have_the_shadows_of_rays(SceneModel model, Projection projection,
                                     const ShadowEngine *engine, size_t most)
{
    Sight sight;
    see(model, projection, &sight);
    OffPixelPoints seen = sight.thin.lights, cast = sight.thin.lights;
    assert_int_equal(offpixel_init(&sight.scene.view, &seen, &err), STATUS_OK);
    assert_int_equal(offpixel_init(&sight.scene.view, &cast, &err), STATUS_OK);
    size_t asked = 0, dark = 0, off = 0;
    for (size_t k = 0; k < sight.scene.view.n_lights; k++) {
        size_t points = (size_t)light_points(&sight.scene.view.lights[k]);
        look_from(&sight, engine, k, &seen);
        offpixel_trace(&sight.drawing, k, &cast);
        for (size_t i = 0; i < seen.n; i++) {
            asked += points;
            dark += points - cast.n_visible[k][i];
            off += (size_t)abs(seen.n_visible[k][i] - cast.n_visible[k][i]);
        }
    }
    print_message("%zu of %zu dark, %zu off\n", dark, asked, off);
    assert_true(asked > 20000 / SHARE && dark > asked / 50 && dark < asked / 2);
    assert_true(off * 1000000 <= most * asked);
    offpixel_release(&seen);
    offpixel_release(&cast);
    forget_sight(&sight);
}

static void those_of_primitives_have_the_shadows_of_rays(void **state)
{
    (void)state;
    have_the_shadows_of_rays(SCENE_ROUNDED, PROJECTION_ORTHOGRAPHIC, &raster_shadows, 100);
    have_the_shadows_of_rays(SCENE_ROUNDED, PROJECTION_PERSPECTIVE, &raster_shadows, 100);
    have_the_shadows_of_rays(SCENE_CYLINDERS, PROJECTION_PERSPECTIVE, &raster_shadows, 100);
    have_the_shadows_of_rays(SCENE_JOINED, PROJECTION_PERSPECTIVE, &raster_shadows, 100);
}

static void those_of_fields_have_the_shadows_of_rays(void **state)
{
    (void)state;
    have_the_shadows_of_rays(SCENE_ISOSURFACE, PROJECTION_ORTHOGRAPHIC, &field_shadows, 100);
    have_the_shadows_of_rays(SCENE_ISOSURFACE, PROJECTION_PERSPECTIVE, &field_shadows, 100);
    have_the_shadows_of_rays(SCENE_BLOB, PROJECTION_ORTHOGRAPHIC, &field_shadows, 100);
}

/* ---- pictures -------------------------------------------------------------------------------- */

static RenderParams covering(RenderMethod method, int threads)
{
    return (RenderParams){.method = method,
                          .threads = threads,
                          .antialias = 1,
                          .shadows = true,
                          .cover_thin = true,
                          .want_color = true};
}

/* Leaves one light. */
static void leave_light(Scene *scene, size_t number)
{
    scene->view.lights[0] = scene->view.lights[number];
    scene->view.n_lights = 1;
}

/* The segments of a field that are not thin. */
static Geometry rest_of(const Sight *sight)
{
    const Geometry *whole = &sight->scene.geometry;
    uint32_t *wide = calloc(whole->n_segments, sizeof *wide);
    size_t n = 0;
    Geometry rest;
    assert_non_null(wide);
    for (uint32_t i = 0; i < whole->n_segments; i++)
        if (!sight->thin.layer.is_thin[i])
            wide[n++] = i;
    assert_int_equal(geometry_part(whole, wide, n, &rest, &err), STATUS_OK);
    free(wide);
    return rest;
}

/* The depths of all but thin vessels. */
static Frame depths_of_rest(SceneModel model)
{
    Sight sight;
    Frame frame;
    see(model, PROJECTION_ORTHOGRAPHIC, &sight);
    Scene rest = sight.scene;
    rest.geometry = rest_of(&sight);
    rest.geometry.ids = sight.scene.geometry.ids;
    const RenderParams params = {.method = RENDER_FASTEST, .antialias = 1, .want_depth = true};
    assert_int_equal(render(&rest, &params, &frame, NULL, &err), STATUS_OK);
    rest.geometry.ids = NULL;
    geometry_release(&rest.geometry);
    forget_sight(&sight);
    return frame;
}

/* Lit by one light, drawn by views from it and by rays to all of its points. Surfaces, which share
 * soft shadows in the former, are left out. */
static void looks_as_by_rays(SceneModel model, size_t number)
{
    Scene scene = staged(model, PROJECTION_ORTHOGRAPHIC);
    Frame traced, drawn, lit, depths = depths_of_rest(model);
    RenderParams params = covering(RENDER_TRACE, 2);
    leave_light(&scene, number);
    assert_int_equal(render(&scene, &params, &traced, NULL, &err), STATUS_OK);
    params.method = RENDER_FASTEST;
    assert_int_equal(render(&scene, &params, &drawn, NULL, &err), STATUS_OK);
    params.shadows = false;
    assert_int_equal(render(&scene, &params, &lit, NULL, &err), STATUS_OK);
    size_t thin = 0, dark = 0, off = 0;
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        float color = drawn.color.values[3 * i];
        if (isfinite(depths.depth.values[i]) || color == scene.view.background.r)
            continue;
        thin++;
        dark += color < lit.color.values[3 * i] - 0.01f;
        off += fabsf(traced.color.values[3 * i] - color) > 1e-5f;
    }
    print_message("%zu of %zu pixels darker, %zu off\n", dark, thin, off);
    assert_true(thin > 3000 / SHARE && dark * 50 > thin && off * 2000 <= thin);
    frame_release(&depths);
    frame_release(&traced);
    frame_release(&drawn);
    frame_release(&lit);
    scene_release(&scene);
}

static void look_as_by_rays(void **state)
{
    (void)state;
    for (size_t number = 0; number < 3; number++)
        looks_as_by_rays(SCENE_ISOSURFACE, number);
}

static void in_bands_as_whole(SceneModel model, size_t n_lights, int antialias)
{
    Scene scene = staged(model, PROJECTION_ORTHOGRAPHIC);
    scene.view.n_lights = n_lights;
    RenderParams params = covering(RENDER_FASTEST, 1);
    Renderer *renderer;
    Frame whole;
    params.antialias = antialias;
    assert_int_equal(render(&scene, &params, &whole, NULL, &err), STATUS_OK);
    params.threads = 3;
    assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
    /* Other lights first, which are to be forgotten. */
    View other = scene.view;
    leave_light(&scene, 1);
    for (int first = 0; first < SIDE; first += 56) {
        const View *views[] = {&scene.view, &other};
        for (int k = 0; k < 2; k++) {
            Frame band;
            int rows = SIDE - first < 56 ? SIDE - first : 56;
            assert_int_equal(
                renderer_rows(renderer, views[k], &scene.appearance, first, rows, &band, &err),
                STATUS_OK);
            const float *in_whole = whole.color.values + (size_t)(3 * first * SIDE);
            size_t size = (size_t)(3 * rows * SIDE) * sizeof(float);
            if (k == 1)
                assert_memory_equal(in_whole, band.color.values, size);
            else
                assert_memory_not_equal(in_whole, band.color.values, size);
            frame_release(&band);
        }
    }
    renderer_free(renderer);
    frame_release(&whole);
    scene_release(&scene);
}

static void have_the_same_bytes_whatever_threads_and_bands(void **state)
{
    (void)state;
    in_bands_as_whole(SCENE_JOINED, 3, 1);
    in_bands_as_whole(SCENE_ISOSURFACE, 3, 2);
    in_bands_as_whole(SCENE_BLOB, 3, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(those_of_primitives_have_the_shadows_of_rays),
        cmocka_unit_test(those_of_fields_have_the_shadows_of_rays),
        cmocka_unit_test(look_as_by_rays),
        cmocka_unit_test(have_the_same_bytes_whatever_threads_and_bands),
    };
    return cmocka_run_group_tests_name("lonelight", tests, grow, forget);
}
