/* Ambient visibility, compared with geometry. */
#include "render/light/rayocclusion.h"
#include "unit.h"

#include "render/job.h"
#include "render/light/occlusion.h"
#include "render/light/occlusionkernels.h"
#include "render/render.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_scene.h"

static Err err;

static const Ground no_ground;

static double open_part(const Geometry *geometry, const Ground *ground, Vec3 point, Vec3 normal,
                        int rays, double turn)
{
    Caster *caster;
    assert_int_equal(caster_new(geometry, NULL, 1, &caster, &err), STATUS_OK);
    double open = rayocclusion_ambient(caster, 0, ground, point, normal, rays, turn);
    caster_free(caster);
    return open;
}

/* A ball of radius r at the distance d along the normal hides r^2 / d^2 of what counts. */
static void a_ball_overhead_hides_the_square_of_its_sine(void **state)
{
    (void)state;
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .a = {2, 3, 10}, .b = {2, 3, 10}};
    const Geometry geometry = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
    for (double sine = 0.1; sine < 0.95; sine += 0.2) {
        ball.radius_mm = 10 * sine;
        double open = open_part(&geometry, &no_ground, vec3(2, 3, 0), vec3(0, 0, 1), 4000, 0.3);
        assert_true(fabs(open - (1 - sine * sine)) < 1e-3);
    }
}

/* Of a plane at the angle a to the surface, all but (1 + cos a) / 2. */
static void a_plane_hides_what_its_angle_says(void **state)
{
    (void)state;
    Primitive far = {
        .kind = PRIMITIVE_SPHERE, .a = {0, 900, 0}, .b = {0, 900, 0}, .radius_mm = 1e-3};
    const Geometry geometry = {.model = SCENE_ROUNDED, .primitives = &far, .n_primitives = 1};
    const Ground ground = {.present = true, .normal = {0, 1, 0}, .offset_mm = -5};
    for (double angle = 0; angle < 3.2; angle += 0.4) {
        Vec3 normal = vec3(sin(angle) * 0.6, cos(angle), sin(angle) * 0.8);
        double open = open_part(&geometry, &ground, vec3(1, 2, 3), normal, 4000, 0.7);
        assert_true(fabs(open - (1 + cos(angle)) / 2) < 5e-3);
    }
}

static void few_rays_are_right_on_average(void **state)
{
    (void)state;
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .a = {3, 0, 10}, .b = {3, 0, 10}, .radius_mm = 4};
    const Geometry geometry = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
    double many = open_part(&geometry, &no_ground, vec3(0, 0, 0), vec3(0, 0, 1), 20000, 0), sum = 0;
    for (int j = 0; j < 32; j++)
        for (int i = 0; i < 32; i++)
            sum += open_part(&geometry, &no_ground, vec3(0, 0, 0), vec3(0, 0, 1), 8,
                             rayocclusion_turn(i, j));
    assert_true(fabs(sum / 1024 - many) < 4e-3);
}

/* A ball overhead hides the points of the disc within its sine: of N points k + u of N, by area. */
static void points_lie_outwards_by_area(void **state)
{
    (void)state;
    enum { RAYS = 7 };
    const double turn = 0.2385, shift = 12 * turn - floor(12 * turn);
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .a = {0, 0, 10}, .b = {0, 0, 10}};
    const Geometry geometry = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
    for (int k = 0; k < RAYS; k++)
        for (int side = 0; side < 2; side++) {
            ball.radius_mm = 10 * sqrt((k + shift) / RAYS + (side ? 1e-6 : -1e-6));
            double open =
                open_part(&geometry, &no_ground, vec3(0, 0, 0), vec3(0, 0, 1), RAYS, turn);
            assert_true(fabs(open - (RAYS - k - side) / (double)RAYS) < 1e-12);
        }
}

/* The direction round the normal, in degrees, of point k of three: that of a small ball that hides
 * it. */
static double direction_of(int k, double turn)
{
    const double shift = 12 * turn - floor(12 * turn), out = sqrt((k + shift) / 3);
    double first = -1, last = -1;
    for (int step = 0; step < 3600; step++) {
        double angle = step * 6.283185307179586 / 3600;
        Vec3 center = vec3(out * cos(angle), out * sin(angle), sqrt(1 - out * out));
        Primitive ball = {.kind = PRIMITIVE_SPHERE, .a = center, .b = center, .radius_mm = 0.01};
        const Geometry geometry = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
        if (open_part(&geometry, &no_ground, vec3(0, 0, 0), vec3(0, 0, 1), 3, turn) == 1)
            continue;
        first = first < 0 || step / 10.0 - last > 90 ? step / 10.0 : first;
        last = step / 10.0;
    }
    assert_true(last - first < 5);
    return (first + last) / 2;
}

static double degrees_between(double a, double b)
{
    double degrees = fabs(a - b);
    return degrees > 180 ? 360 - degrees : degrees;
}

static void points_are_golden_angles_apart(void **state)
{
    (void)state;
    const double turn = 0.2385;
    double first = direction_of(0, turn), second = direction_of(1, turn);
    assert_true(fabs(degrees_between(first, second) - 137.508) < 0.2);
    assert_true(fabs(degrees_between(second, direction_of(2, turn)) - 137.508) < 0.2);
    /* A turn later by a twelfth leaves u alone. */
    double turned = direction_of(0, turn + 1.0 / 12);
    assert_true(fabs(degrees_between(first, turned) - 30) < 0.2);
}

/* J. Jimenez: Next generation post processing in Call of Duty: Advanced Warfare. SIGGRAPH 2014;
 * worked out in decimals. */
static void turns_are_interleaved_gradient_noise(void **state)
{
    (void)state;
    assert_true(fabs(rayocclusion_turn(1, 0) - 0.555713357813584) < 1e-9);
    assert_true(fabs(rayocclusion_turn(0, 1) - 0.309269245057135) < 1e-9);
    assert_true(fabs(rayocclusion_turn(37.25, 101.75) - 0.969711563119490) < 1e-9);
    assert_true(fabs(rayocclusion_turn(640, 479) - 0.565166883061425) < 1e-9);
}

static void turns_are_spread_over_the_circle(void **state)
{
    (void)state;
    int count[10] = {0};
    for (int j = 0; j < 100; j++)
        for (int i = 0; i < 100; i++) {
            double turn = rayocclusion_turn(i + 0.25, j - 0.25);
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
    Primitive balls[] = {{.kind = PRIMITIVE_SPHERE, .a = {-2, 0, 0}, .radius_mm = 2, .segment = 0},
                         {.kind = PRIMITIVE_SPHERE, .a = {2, 0, 0}, .radius_mm = 2, .segment = 1}};
    const Scene scene = {
        .geometry = {.model = SCENE_ROUNDED,
                     .primitives = balls,
                     .n_primitives = 2,
                     .ids = test_ids()},
        .appearance = {.finish = {.ambient = 0.5f, .diffuse = 0.5f, .brilliance = 1},
                       .color = {1, 1, 1}},
        .view = {.camera = {.location = {0, 0, 20},
                            .right = {10, 0, 0},
                            .up = {0, 10, 0},
                            .direction = {0, 0, -1},
                            .width = 100,
                            .height = 100}}};
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

/* Returns the part of an upward beam that a bar of radius 1 leaves free, `height` above its place.
 * The bar is as long as any beam is wide. */
static double free_under_a_bar(const OcclusionKernels *kernels, double height, float widening,
                               double facing)
{
    FieldSegment bar = {.a = {-100, 0, 0}, .b = {100, 0, 0}, .radius_mm = 1};
    const Geometry geometry = {.model = SCENE_ISOSURFACE, .segments = &bar, .n_segments = 1};
    const OcclusionLine up = {.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .widening = widening};
    OccluderSet beams;
    OcclusionPoints places = {0};
    ConeScratch work = {0};
    uint8_t answer;
    assert_int_equal(occluderset_new(&geometry, &beams, &err), STATUS_OK);
    assert_int_equal(occlusionpoints_new(1, &places, &err), STATUS_OK);
    assert_int_equal(conescratch_new(1, &work, &err), STATUS_OK);
    places.position[2][0] = (float)-height;
    places.normal[0][0] = (float)sqrt(1 - facing * facing);
    places.normal[2][0] = (float)facing;
    kernels->trace(&beams, &up, &places, &work, &answer);
    conescratch_release(&work);
    occlusionpoints_release(&places);
    occluderset_release(&beams);
    return (double)answer / CONE_UNBLOCKED;
}

/* The bar covers 1 / w of a beam whose half width is w. */
static void a_beam_widens_to_three_and_a_half_radii(void **state)
{
    (void)state;
    for (RenderKernels kind = KERNELS_PORTABLE; kind <= render_fastest_kernels(); kind++) {
        const OcclusionKernels *kernels = occlusionkernels[kind - KERNELS_PORTABLE];
        assert_true(free_under_a_bar(kernels, 8, 0.1F, 1) == 0);
        for (double height = 15; height < 100; height += 10) {
            double wide = fmin(0.1 * height, 3.5), low = fmin(0.04 * height, 3.5);
            double all = free_under_a_bar(kernels, height, 0.1F, 1);
            double near_horizon = free_under_a_bar(kernels, height, 0.1F, 0.04);
            assert_true(fabs(all - (1 - 1 / wide)) <= 0.5 / CONE_UNBLOCKED + 1e-5);
            assert_true(fabs(near_horizon - fmax(0, 1 - 1 / low)) <= 0.5 / CONE_UNBLOCKED + 1e-5);
        }
    }
}

/* Returns what is seen of the sky by the second of two places at one point that are neighbours in
 * the picture. It faces so many degrees away from the first. A ball is below the horizon of the
 * first place and above that of the second. */
static double seen_by_the_second(double degrees)
{
    const double angle = degrees * 3.141592653589793 / 180, low = 3.141592653589793 / 7;
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .radius_mm = 3.5};
    ball.a = ball.b = vec3(10 * cos(low), 0, -10 * sin(low));
    const Geometry geometry = {.model = SCENE_ROUNDED, .primitives = &ball, .n_primitives = 1};
    const View view = {.n_lights = 0};
    const RenderParams params = {.threads = 1, .occlusion = 64};
    const Drawing drawing = {.geometry = &geometry, .view = &view, .params = &params};
    uint32_t numbers[2] = {0, 1};
    PixelVisibility light = {.width = 2, .rows = 1, .samples_per_side = 1, .point_index = numbers};
    ShadingPoint places[2] = {
        shadingpoint_of(&light, SURFACE_VESSEL, vec3(0, 0, 0), vec3(0, 0, 1), 0.1),
        shadingpoint_of(&light, SURFACE_VESSEL, vec3(0, 0, 0), vec3(sin(angle), 0, cos(angle)),
                        0.1)};
    OccluderSet beams;
    light.points = places;
    assert_int_equal(occluderset_new(&geometry, &beams, &err), STATUS_OK);
    assert_int_equal(occlusion_compute(&drawing, &beams, &light, &err), STATUS_OK);
    double open = (double)light.ambient[1];
    assert_true(light.ambient[0] == 1);
    free(light.ambient);
    occluderset_release(&beams);
    return open;
}

static void a_place_asks_for_its_quad_up_to_60_degrees(void **state)
{
    (void)state;
    assert_true(seen_by_the_second(58) == 1);
    assert_true(seen_by_the_second(62) < 0.98);
}

/* One pixel alone sees something, which the sample sees, too. */
static void a_sample_takes_light_from_up_to_two_pixels_away(void **state)
{
    (void)state;
    enum { SIDE = 9 };
    uint32_t numbers[SIDE * SIDE];
    ShadingPoint place = {.normal = {0, 0, 1}, .pixel_mm = 0.1F};
    const PixelVisibility light = {.width = SIDE,
                                   .rows = SIDE,
                                   .samples_per_side = 1,
                                   .point_index = numbers,
                                   .points = &place};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            bool is_near = abs(x - 4) <= 2 && abs(y - 4) <= 2;
            memset(numbers, 0xff, sizeof numbers); /* NO_HIT */
            numbers[SIDE * y + x] = 0;
            assert_int_equal(pixelvisibility_find_pixel(&light, 4, 4, &place),
                             is_near ? (uint32_t)(SIDE * y + x) : NO_HIT);
        }
}

/* Asks about one line, of which one quad of the nine says that it is free. */
static void quads_weigh_by_their_distance_from_the_pixel(void **state)
{
    (void)state;
    static const double parts[2][3] = {{3, 4, 1}, {1, 4, 3}};
    float upward[3][ANSWER_STEP] = {{0}, {0}, {1}};
    const OcclusionLines lines = {.upward = {upward[0], upward[1], upward[2]}, .n = ANSWER_STEP};
    const float normal[3] = {0, 0, 1};
    uint8_t bytes[QUADS_AROUND][ANSWER_STEP] = {{0}};
    QuadAnswers answers = {.n = QUADS_AROUND};
    for (int quad = 0; quad < QUADS_AROUND; quad++) {
        answers.of[quad] = bytes[quad];
        answers.quad[quad] = (uint8_t)quad;
    }
    for (RenderKernels kind = KERNELS_PORTABLE; kind <= render_fastest_kernels(); kind++)
        for (int pixel = 0; pixel < QUAD; pixel++)
            for (int quad = 0; quad < QUADS_AROUND; quad++) {
                double weight = parts[pixel % 2][quad % 3] * parts[pixel / 2][quad / 3];
                bytes[quad][0] = CONE_UNBLOCKED;
                double open = (double)occlusionkernels[kind - KERNELS_PORTABLE]->ambient(
                    &lines, &answers, 1, pixel, normal);
                bytes[quad][0] = 0;
                assert_true(fabs(open - weight / 64) < 1e-6);
            }
}

/* Tries both orders of two places whose distance, in pixels, is across the surface of the first. */
static void a_surface_ends_five_quarters_of_a_pixel_off_its_plane(void **state)
{
    (void)state;
    const PixelVisibility light = {.samples_per_side = 1};
    const Vec3 slanted = vec3(0.6, 0, 0.8);
    for (int outside = 0; outside < 2; outside++) {
        double off = (outside ? 1.26 : 1.24) * 0.3;
        ShadingPoint one =
            shadingpoint_of(&light, SURFACE_VESSEL, vec3(0, 0, 0), vec3(0, 0, 1), 0.3);
        ShadingPoint other =
            shadingpoint_of(&light, SURFACE_VESSEL, vec3(-off / 3, 5, off), slanted, 0.3);
        assert_int_equal(shadingpoints_share_surface(&one, &other), !outside);
        assert_int_equal(shadingpoints_share_surface(&other, &one), !outside);
        other.surface = SURFACE_GROUND;
        assert_false(shadingpoints_share_surface(&one, &other));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_overhead_hides_the_square_of_its_sine),
        cmocka_unit_test(a_plane_hides_what_its_angle_says),
        cmocka_unit_test(few_rays_are_right_on_average),
        cmocka_unit_test(points_lie_outwards_by_area),
        cmocka_unit_test(points_are_golden_angles_apart),
        cmocka_unit_test(turns_are_interleaved_gradient_noise),
        cmocka_unit_test(turns_are_spread_over_the_circle),
        cmocka_unit_test(only_ambient_light_is_held_back),
        cmocka_unit_test(a_beam_widens_to_three_and_a_half_radii),
        cmocka_unit_test(a_place_asks_for_its_quad_up_to_60_degrees),
        cmocka_unit_test(a_surface_ends_five_quarters_of_a_pixel_off_its_plane),
        cmocka_unit_test(quads_weigh_by_their_distance_from_the_pixel),
        cmocka_unit_test(a_sample_takes_light_from_up_to_two_pixels_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
