/* How much of the sky is seen, against what geometry says. */
#include "render/occlusion.h"

#include "render/render.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static Err err;

static double open_part(const Scene *scene, Vec3 point, Vec3 normal, int rays, double turn)
{
    Caster *caster;
    assert_int_equal(caster_new(scene, NULL, 1, &caster, &err), STATUS_OK);
    double open = occlusion_open(caster, 0, point, normal, rays, turn);
    caster_free(caster);
    return open;
}

/* A ball of radius r at the distance d along the normal hides r^2 / d^2 of what counts. */
static void a_ball_overhead_hides_the_square_of_its_sine(void **state)
{
    (void)state;
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .a = {2, 3, 10}, .b = {2, 3, 10}, .id = 2};
    const Scene scene = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
    for (double sine = 0.1; sine < 0.95; sine += 0.2) {
        ball.radius_mm = 10 * sine;
        double open = open_part(&scene, vec3(2, 3, 0), vec3(0, 0, 1), 4000, 0.3);
        assert_true(fabs(open - (1 - sine * sine)) < 1e-3);
    }
}

/* Of a plane at the angle a to the surface, all but (1 + cos a) / 2. */
static void a_plane_hides_what_its_angle_says(void **state)
{
    (void)state;
    Primitive far = {
        .kind = PRIMITIVE_SPHERE, .a = {0, 900, 0}, .b = {0, 900, 0}, .radius_mm = 1e-3};
    const Scene scene = {.model = SCENE_ROUNDED,
                         .primitives = &far,
                         .n_primitives = 1,
                         .ground = {.present = true, .normal = {0, 1, 0}, .offset_mm = -5}};
    for (double angle = 0; angle < 3.2; angle += 0.4) {
        Vec3 normal = vec3(sin(angle) * 0.6, cos(angle), sin(angle) * 0.8);
        double open = open_part(&scene, vec3(1, 2, 3), normal, 4000, 0.7);
        assert_true(fabs(open - (1 + cos(angle)) / 2) < 5e-3);
    }
}

static void few_rays_are_right_on_average(void **state)
{
    (void)state;
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .a = {3, 0, 10}, .b = {3, 0, 10}, .radius_mm = 4};
    const Scene scene = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
    double many = open_part(&scene, vec3(0, 0, 0), vec3(0, 0, 1), 20000, 0), sum = 0;
    for (int j = 0; j < 32; j++)
        for (int i = 0; i < 32; i++)
            sum += open_part(&scene, vec3(0, 0, 0), vec3(0, 0, 1), 8, occlusion_turn(i, j));
    assert_true(fabs(sum / 1024 - many) < 4e-3);
}

static void turns_are_spread_over_the_circle(void **state)
{
    (void)state;
    int count[10] = {0};
    for (int j = 0; j < 100; j++)
        for (int i = 0; i < 100; i++) {
            double turn = occlusion_turn(i + 0.25, j - 0.25);
            assert_true(turn >= 0 && turn < 1);
            count[(int)(10 * turn)]++;
        }
    for (int k = 0; k < 10; k++)
        assert_true(count[k] > 850 && count[k] < 1150);
}

/* Two balls side by side under no light: what is between them is darker than what is outside. */
static void only_ambient_light_is_held_back(void **state)
{
    (void)state;
    Primitive balls[] = {
        {.kind = PRIMITIVE_SPHERE, .a = {-2, 0, 0}, .radius_mm = 2, .id = 2, .color = {1, 1, 1}},
        {.kind = PRIMITIVE_SPHERE, .a = {2, 0, 0}, .radius_mm = 2, .id = 3, .color = {1, 1, 1}}};
    const Scene scene = {.model = SCENE_ROUNDED,
                         .primitives = balls,
                         .n_primitives = 2,
                         .finish = {.ambient = 0.5f, .diffuse = 0.5f, .brilliance = 1},
                         .camera = {.location = {0, 0, 20},
                                    .right = {10, 0, 0},
                                    .up = {0, 10, 0},
                                    .direction = {0, 0, -1},
                                    .width = 100,
                                    .height = 100}};
    RenderParams params = {.threads = 2, .antialias = 1, .occlusion = 64, .want_color = true};
    Frame with, without;
    assert_int_equal(render(&scene, &params, &with, NULL, &err), STATUS_OK);
    params.occlusion = 0;
    assert_int_equal(render(&scene, &params, &without, NULL, &err), STATUS_OK);
    const float *row = with.color.values + (size_t)3 * 50 * 100;
    assert_true(without.color.values[3 * (50 * 100 + 70)] == 0.5f);
    assert_true(fabsf(row[3 * 70] - 0.5f) < 0.02f); /* the top of a ball sees it all */
    assert_true(row[3 * 51] < 0.3f);                /* where they touch */
    assert_true(fabsf(row[3 * 30] - row[3 * 69]) < 0.03f);
    frame_release(&with);
    frame_release(&without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_overhead_hides_the_square_of_its_sine),
        cmocka_unit_test(a_plane_hides_what_its_angle_says),
        cmocka_unit_test(few_rays_are_right_on_average),
        cmocka_unit_test(turns_are_spread_over_the_circle),
        cmocka_unit_test(only_ambient_light_is_held_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
