/* Planes of geometry that are drawn beside a picture do not change its colors. */
#include "render/render.h"
#include "unit.h"

#include "treeio/treeio.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "test_stage.h"

enum { SIDE = 40 };

static Err err;

/* Two lights that cast shadows: one of parallel rays, and a point or an area. */
typedef enum { NO_EFFECTS, LINES, XRAY, EFFECT_KINDS } EffectKind;

static Look look_of(EffectKind effects, bool soft)
{
    Look look = {.color = {0.5f, 0.1f, 0.2f},
                 .background = {0.9f, 1, 1},
                 .finish = {.ambient = 0.2f, .diffuse = 0.6f, .brilliance = 1, .roughness = 0.05f},
                 .lights = {{.direction = {1, 0.7, -0.1}, .color = {0.8f, 0.8f, 0.8f}},
                            {.is_point = true,
                             .direction = {1.5, 0.3, 1},
                             .color = {0.4f, 0.3f, 0.3f},
                             .samples = soft ? 3 : 1,
                             .size = soft ? 0.7 : 0}},
                 .n_lights = 2};
    if (effects == XRAY)
        look.effects.xray_per_diameter = 1;
    if (effects == LINES)
        look.effects = (LookEffects){.outline_width = 1.5,
                                     .outline_radii = 10,
                                     .outline_deeper = 0.5,
                                     .crease_deg = 120,
                                     .halo_width = 1.2,
                                     .halo_radii = 10,
                                     .halo_deeper = 1.5};
    return look;
}

/* Colors of the picture in two bands, as users get them. */
static void draw(const Scene *scene, const RenderParams *params, float out[3 * SIDE * SIDE])
{
    enum { FIRST = 24 };
    Renderer *renderer;
    assert_int_equal(renderer_new(&scene->geometry, params, &renderer, &err), STATUS_OK);
    for (int first = 0; first < SIDE; first += FIRST) {
        Frame rows;
        int n = first + FIRST < SIDE ? FIRST : SIDE - first;
        assert_int_equal(
            renderer_rows(renderer, &scene->view, &scene->appearance, first, n, &rows, &err),
            STATUS_OK);
        memcpy(out + 3 * SIDE * first, rows.color.values,
               3 * (size_t)SIDE * (size_t)n * sizeof *out);
        frame_release(&rows);
    }
    renderer_free(renderer);
}

static void assert_planes_change_nothing(const Scene *scene, RenderParams params, const char *what)
{
    static float alone[3 * SIDE * SIDE], beside[3 * SIDE * SIDE];
    draw(scene, &params, alone);
    enum { DEPTH = 1, NORMAL = 2, ID = 4 };
    const int wanted[] = {DEPTH, NORMAL, ID, DEPTH | NORMAL | ID};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        const int planes = wanted[i];
        params.want_depth = planes & DEPTH;
        params.want_normal = planes & NORMAL;
        params.want_id = planes & ID;
        draw(scene, &params, beside);
        if (memcmp(alone, beside, sizeof alone) != 0)
            fail_msg("planes %d change colors of %s, antialias %d, occlusion %d, shadows %d, thin "
                     "%d",
                     planes, what, params.antialias, params.occlusion, params.shadows,
                     params.cover_thin);
    }
}

static Scene scene_of(SceneModel model, EffectKind effects, bool soft)
{
    Tree tree;
    Scene scene;
    StageParams params = stage_square(model, SIDE);
    const Look look = look_of(effects, soft);
    params.view.view = VIEW_ISO;
    assert_int_equal(tree_read(&tree, "tests/data/coronary.swc", &err), STATUS_OK);
    assert_int_equal(stage_all(&tree, &look, &params, &scene, NULL, &err), STATUS_OK);
    tree_release(&tree);
    return scene;
}

static void planes_change_no_color(void **state)
{
    (void)state;
    static const struct {
        SceneModel model;
        RenderMethod method;
        const char *name;
    } engines[] = {{SCENE_ROUNDED, RENDER_TRACE, "trace"},
                   {SCENE_JOINED, RENDER_RASTER, "raster"},
                   {SCENE_CYLINDERS, RENDER_ZBUFFER, "zbuffer"},
                   {SCENE_BLOB, RENDER_FASTEST, "field"},
                   {SCENE_ROUNDED, RENDER_FASTEST, "fastest"}};
    for (size_t i = 0; i < sizeof engines / sizeof *engines; i++)
        for (int kind = 0; kind < 2 * EFFECT_KINDS; kind++) {
            Scene scene = scene_of(engines[i].model, kind / 2, kind % 2);
            for (int setting = 0; setting < 8; setting++) {
                const RenderParams params = {.method = engines[i].method,
                                             .threads = 1,
                                             .antialias = setting & 1 ? 2 : 1,
                                             .shadows = setting & 2,
                                             .occlusion = setting & 4 ? 4 : 0,
                                             .cover_thin = engines[i].method == RENDER_FASTEST,
                                             .want_color = true};
                assert_planes_change_nothing(&scene, params, engines[i].name);
            }
            scene_release(&scene);
        }
}

/* A plane between the vessels and their first light, which hides that light. */
static Ground plane_before_light(const Scene *scene)
{
    const Light *light = &scene->view.lights[0];
    const Box *box = &scene->geometry.bounds;
    const Vec3 away = vec3_normalized(vec3_sub(light->target, light->location));
    const double radius = vec3_distance(box->low, box->high) / 2;
    return (Ground){.present = true,
                    .normal = away,
                    .offset_mm = vec3_dot(away, box_center(*box)) - 1.1 * radius};
}

/* What was prepared with the plane does not serve without it, and the other way round. */
static void another_ground_is_drawn_as_by_a_new_renderer(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        Scene scene = scene_of(i / 2 ? SCENE_BLOB : SCENE_ROUNDED, NO_EFFECTS, false);
        const Ground ground = plane_before_light(&scene);
        const RenderParams params = {.method = RENDER_FASTEST,
                                     .threads = 1,
                                     .antialias = 1,
                                     .shadows = true,
                                     .want_color = true};
        Renderer *renderer;
        Frame rows, fresh;
        double sums[2] = {0, 0};
        assert_int_equal(renderer_new(&scene.geometry, &params, &renderer, &err), STATUS_OK);
        for (int turn = 0; turn < 2; turn++) {
            scene.view.ground = (turn + i) % 2 ? ground : (Ground){0};
            assert_int_equal(
                renderer_rows(renderer, &scene.view, &scene.appearance, 0, SIDE, &rows, &err),
                STATUS_OK);
            assert_int_equal(render(&scene, &params, &fresh, NULL, &err), STATUS_OK);
            assert_memory_equal(rows.color.values, fresh.color.values,
                                3 * (size_t)SIDE * SIDE * sizeof(float));
            for (int k = 0; k < 3 * SIDE * SIDE; k++)
                sums[turn] += (double)fresh.color.values[k];
            frame_release(&rows);
            frame_release(&fresh);
        }
        assert_true(fabs(sums[0] - sums[1]) > 5); /* the plane hides light from vessels */
        renderer_free(renderer);
        scene_release(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_change_no_color),
        cmocka_unit_test(another_ground_is_drawn_as_by_a_new_renderer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
