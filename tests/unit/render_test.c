/* Rendering of single rays and pixels: cameras, shading, antialiasing, shadows. */
#include "render/render.h"
#include "unit.h"

#include "render/light/resample.h"
#include "render/light/shade.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "test_search.h"

static double number(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static Vec3 point(Random *random, double size)
{
    double x = number(random, -size, size), y = number(random, -size, size);
    return vec3(x, y, number(random, -size, size));
}

enum { N_PRIMITIVES = 237 };

/* Cylinders and spheres thrown into a cube; of a fixed seed. */
static void throw_primitives(Primitive primitives[N_PRIMITIVES])
{
    Random random;
    random_seed(&random, 2385);
    for (uint32_t i = 0; i < N_PRIMITIVES; i++) {
        Vec3 a = point(&random, 10);
        primitives[i] = (Primitive){.kind = i % 3 ? PRIMITIVE_CYLINDER : PRIMITIVE_SPHERE,
                                    .a = a,
                                    .b = i % 3 ? vec3_add(a, point(&random, 3)) : a,
                                    .radius_mm = number(&random, 0.05, 0.8),
                                    .segment = i};
    }
}

static int hits_of(const Primitive *primitive, Ray ray, Hit hits[4])
{
    if (primitive->kind == PRIMITIVE_SPHERE)
        return hit_sphere(ray, primitive->a, primitive->radius_mm, hits);
    CylinderFrame frame = cylinder_frame(primitive->a, primitive->b, primitive->radius_mm);
    return hit_cylinder(ray, &frame, hits);
}

static void the_hierarchy_finds_what_trying_all_finds(void **state)
{
    (void)state;
    static Primitive primitives[N_PRIMITIVES];
    throw_primitives(primitives);
    const Geometry geometry = {.primitives = primitives, .n_primitives = N_PRIMITIVES};
    TestSearch search = testsearch_open(&primitive_search, &geometry, NULL);
    Random random;
    random_seed(&random, 17);
    int found = 0;
    for (int i = 0; i < 5000; i++) {
        Ray ray = {point(&random, 14), {0, 0, 0}};
        ray.direction = i % 5 ? vec3_normalized(vec3_sub(point(&random, 8), ray.origin))
                              : vec3(0, i % 2 ? 1 : -1, 0);
        double nearest = INFINITY, least = 1e-4;
        for (size_t p = 0; p < N_PRIMITIVES; p++) {
            Hit hits[4];
            int n = hits_of(&primitives[p], ray, hits);
            for (int k = 0; k < n; k++)
                if (hits[k].t >= least)
                    nearest = fmin(nearest, hits[k].t);
        }
        RayHit hit;
        bool seen = testsearch_first(&search, ray, least, INFINITY, &hit);
        assert_int_equal(seen, isfinite(nearest));
        if (seen)
            assert_true(hit.t == nearest);
        assert_int_equal(testsearch_any(&search, ray, least, 6), seen && nearest < 6);
        found += seen;
    }
    assert_true(found > 500);
    testsearch_close(&search);
}

/* The color of the origin under one light, seen along a direction. */
static Rgb seen_under(const Light *light, const Finish *finish, Rgb pigment, Vec3 direction,
                      ShadowTest *shadow, void *context)
{
    const View view = {.lights = {*light}, .n_lights = 1};
    const ShadingInput at = {finish, pigment, {0, 0, 0}, {0, 0, 1}, direction, 1, NULL};
    return shade(&view, &at, shadow, context);
}

/* A plane facing +z, lit from straight above the viewer's shoulder. */
static void shading_is_the_formula(void **state)
{
    (void)state;
    Light light = {
        .location = {0, 30, 40}, .target = {0, 0, 0}, .color = {1, 0.5f, 0.25f}, .parallel = true};
    Finish finish = {.ambient = 0.125f,
                     .diffuse = 0.5f,
                     .brilliance = 1,
                     .phong = 0.25f,
                     .phong_size = 2,
                     .specular = 0,
                     .roughness = 0.05f};
    Rgb pigment = {0.5f, 0.25f, 1};
    Rgb seen = seen_under(&light, &finish, pigment, vec3(0, 0, -1), NULL, NULL);
    /* cos alpha = cos beta = 0.8: ambient + light (diffuse pigment 0.8 + phong 0.8^2) */
    assert_true(fabs((double)seen.r - (0.125 * 0.5 + (0.5 * 0.5 * 0.8 + 0.25 * 0.64))) < 1e-6);
    assert_true(fabs((double)seen.g - (0.125 * 0.25 + 0.5 * (0.5 * 0.25 * 0.8 + 0.25 * 0.64))) <
                1e-6);
    assert_true(fabs((double)seen.b - (0.125 + 0.25 * (0.5 * 0.8 + 0.25 * 0.64))) < 1e-6);

    finish.phong = 0;
    finish.specular = 0.5f;
    finish.roughness = 0.25f; /* exponent 4, half vector (0, 0.3, 0.9) / |.| */
    seen = seen_under(&light, &finish, pigment, vec3(0, 0, -1), NULL, NULL);
    double cosine = 0.9 / sqrt(0.09 + 0.81);
    assert_true(fabs((double)seen.r - (0.0625 + 0.2 + 0.5 * pow(cosine, 4))) < 1e-6);
}

/* Brilliance is an exponent of the diffuse cosine alone. */
static void brilliance_is_the_exponent_of_the_cosine(void **state)
{
    (void)state;
    Light light = {.location = {0, 30, 40}, .color = {1, 1, 1}, .parallel = true};
    Finish finish = {.diffuse = 0.5f, .brilliance = 2.5f, .phong = 0.25f, .phong_size = 3};
    const Rgb pigment = {0.8f, 0.4f, 0.2f};
    Rgb seen = seen_under(&light, &finish, pigment, vec3(0, 0, -1), NULL, NULL);
    assert_true(fabs((double)seen.r - (0.5 * 0.8 * pow(0.8, 2.5) + 0.25 * 0.512)) < 1e-6);
}

/* A light along the surface adds its highlight from a cosine of 1e-10 on. */
static void a_light_counts_from_a_least_cosine_on(void **state)
{
    (void)state;
    for (int lit = 0; lit < 2; lit++) {
        Light light = {
            .location = {1, 0, lit ? 1.01e-10 : 0.99e-10}, .color = {1, 1, 1}, .parallel = true};
        Finish finish = {.ambient = 0.25f, .phong = 0.5f, .phong_size = 1};
        Rgb seen = seen_under(&light, &finish, (Rgb){1, 1, 1}, vec3(0.6, 0, -0.8), NULL, NULL);
        assert_true(fabs((double)seen.r - (lit ? 0.25 + 0.5 * 0.6 : 0.25)) < 1e-6);
    }
}

static bool always(void *context, Vec3 at, Vec3 towards, double distance)
{
    (void)at;
    (void)towards;
    *(double *)context = distance;
    return true;
}

static void a_shadow_leaves_the_ambient_light(void **state)
{
    (void)state;
    Light light = {.location = {0, 3, 4}, .color = {1, 1, 1}, .casts_shadows = true};
    Finish finish = {.ambient = 0.25f, .diffuse = 0.5f, .brilliance = 1};
    Rgb pigment = {0.5f, 0.5f, 0.5f};
    double distance = 0;
    Rgb seen = seen_under(&light, &finish, pigment, vec3(0, 0, -1), always, &distance);
    assert_true(seen.r == 0.125f);
    assert_true(fabs(distance - 5) < 1e-12);
    light.casts_shadows = false;
    seen = seen_under(&light, &finish, pigment, vec3(0, 0, -1), always, &distance);
    assert_true(fabs((double)seen.r - (0.125 + 0.25 * 0.8)) < 1e-6);
}

/* Hides what lies to the left. */
static bool left(void *context, Vec3 at, Vec3 towards, double distance)
{
    (void)context;
    return at.x + towards.x * distance < -0.1;
}

/* Hides what lies far to the right. */
static bool far_right(void *context, Vec3 at, Vec3 towards, double distance)
{
    (void)context;
    return at.x + towards.x * distance > 1.49;
}

/* The light on a surface below an area light of 4 x 4 points, `width` mm along x; 0.5 unshadowed.
 */
static float soft_light(double width, ShadowTest *blocked)
{
    Light light = {.location = {0, 0, 5},
                   .color = {1, 1, 1},
                   .casts_shadows = true,
                   .samples = 4,
                   .sides = {{width, 0, 0}, {0, 3, 0}}};
    Finish finish = {.diffuse = 0.5f, .brilliance = 1};
    Rgb white = {1, 1, 1};
    return seen_under(&light, &finish, white, vec3(0, 0, -1), blocked, NULL).r;
}

static void a_soft_shadow_weighs_the_points_of_the_light_alike(void **state)
{
    (void)state;
    assert_true(soft_light(3, left) == 0.25f); /* columns at -1.5, -0.5, 0.5, 1.5: two of four */
    assert_true(soft_light(0.15, left) == 0.5f);
}

/* The last column of four stands on the edge, 1.5 mm from the middle. */
static void the_points_of_a_soft_light_reach_its_edges(void **state)
{
    (void)state;
    assert_true(soft_light(3, far_right) == 0.375f);
    assert_true(soft_light(2.9, far_right) == 0.5f);
}

static void the_back_of_a_surface_gets_no_light(void **state)
{
    (void)state;
    Light light = {.location = {0, 0, -9}, .color = {1, 1, 1}};
    Finish finish = {
        .ambient = 0.25f, .diffuse = 0.5f, .brilliance = 1, .phong = 1, .phong_size = 1};
    Rgb seen = seen_under(&light, &finish, (Rgb){1, 1, 1}, vec3(0, 0, -1), NULL, NULL);
    assert_true(seen.r == 0.25f);
}

/* One sphere of radius 2 in the middle of a 40 x 20 picture, 20 x 10 mm. */
static Frame render_sphere(int threads, int antialias)
{
    static Primitive sphere = {.kind = PRIMITIVE_SPHERE, .radius_mm = 2};
    static uint32_t id = 70000;
    const Scene scene = {
        .geometry = {.model = SCENE_ROUNDED, .primitives = &sphere, .n_primitives = 1, .ids = &id},
        .appearance = {.finish = {.diffuse = 1, .brilliance = 1}, .color = {0.5f, 0.25f, 0.125f}},
        .view = {.camera = {.projection = PROJECTION_ORTHOGRAPHIC,
                            .location = {0, 0, 30},
                            .right = {20, 0, 0},
                            .up = {0, 10, 0},
                            .direction = {0, 0, -1},
                            .width = 40,
                            .height = 20},
                 .background = {0.25f, 0.5f, 1},
                 .lights = {{.location = {0, 0, 50}, .color = {1, 1, 1}, .parallel = true}},
                 .n_lights = 1}};
    const RenderParams params = {.threads = threads,
                                 .antialias = antialias,
                                 .want_color = true,
                                 .want_depth = true,
                                 .want_normal = true,
                                 .want_id = true};
    Frame frame;
    assert_int_equal(render(&scene, &params, &frame, NULL, NULL), STATUS_OK);
    return frame;
}

static void the_planes_of_a_sphere_are_the_sphere(void **state)
{
    (void)state;
    Frame frame = render_sphere(1, 1);
    for (int j = 0; j < 20; j++)
        for (int i = 0; i < 40; i++) {
            int pixel = 40 * j + i;
            double x = (i + 0.5) / 2 - 10, y = 5 - (j + 0.5) / 2, square = 4 - x * x - y * y;
            assert_int_equal(frame.id.ids[pixel], square > 0 ? 70000 : 0);
            if (square <= 0) {
                assert_true(isinf(frame.depth.values[pixel]));
                assert_true(frame.color.values[3 * pixel + 2] == 1);
                continue;
            }
            const float *normal = &frame.normal.values[3 * pixel];
            assert_true(fabs((double)frame.depth.values[pixel] - (30 - sqrt(square))) < 1e-5);
            assert_true(fabs((double)normal[0] - x / 2) < 1e-6);
            assert_true(fabs((double)normal[1] - y / 2) < 1e-6);
            assert_true(fabs((double)frame.color.values[3 * pixel] - 0.5 * sqrt(square) / 2) <
                        1e-6);
        }
    frame_release(&frame);
}

static void the_picture_does_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    for (int antialias = 1; antialias <= 3; antialias += 2) {
        Frame one = render_sphere(1, antialias);
        for (int threads = 2; threads <= 7; threads += 5) {
            Frame many = render_sphere(threads, antialias);
            assert_memory_equal(one.color.values, many.color.values, 40 * 20 * 3 * sizeof(float));
            assert_memory_equal(one.depth.values, many.depth.values, 40 * 20 * sizeof(float));
            frame_release(&many);
        }
        frame_release(&one);
    }
}

/* The red of the sphere's picture at a point in mm from its middle. */
static double red_at(double x, double y)
{
    double square = 4 - x * x - y * y;
    return square > 0 ? 0.5 * sqrt(square) / 2 : 0.25;
}

static void antialiasing_weighs_the_centre_and_the_grid_alike(void **state)
{
    (void)state;
    Frame frame = render_sphere(1, 3);
    for (int pixel = 0; pixel < 40 * 20; pixel++) {
        double i = pixel % 40, j = pixel / 40;
        double mean = red_at((i + 0.5) / 2 - 10, 5 - (j + 0.5) / 2) / 10;
        for (int k = 0; k < 9; k++) {
            double x = i + 0.5 + (k % 3 - 1) / 3.0, y = j + 0.5 + (k / 3 - 1) / 3.0;
            mean += red_at(x / 2 - 10, 5 - y / 2) / 10;
        }
        assert_true(fabs((double)frame.color.values[3 * pixel] - mean) < 1e-5);
    }
    frame_release(&frame);
}

/* By the threshold or more, in the square root of a channel clipped to [0, 1]; corners do not
 * count. */
static void pixels_that_differ_from_a_neighbour_are_sampled_again(void **state)
{
    (void)state;
    enum { SIDE = 5 };
    Plane color;
    assert_int_equal(plane_init(&color, SIDE, SIDE, 3, NULL), STATUS_OK);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        color.values[i] = i % 3 == 2 ? 1.7f : 0.25f;
    color.values[3 * (2 * SIDE + 2) + 1] = 0.390625f; /* 0.5 and 0.625, exact */
    color.values[3 * (2 * SIDE + 2) + 2] = 1.2f;      /* as white as the others */
    for (int above = 0; above < 2; above++) {
        const float threshold = above ? nextafterf(0.125f, 1) : 0.125f;
        const RenderParams params = {.threads = 1, .antialias_threshold = (double)threshold};
        Resampling more = resampling_for(2);
        assert_int_equal(resampling_choose(&more, &params, &(Band){0}, &color, NULL), STATUS_OK);
        for (int i = 0; i < SIDE * SIDE; i++) {
            int steps = abs(i % SIDE - 2) + abs(i / SIDE - 2);
            assert_int_equal(more.mask[i], !above && steps <= 1);
        }
        resampling_release(&more);
    }
    plane_release(&color);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hierarchy_finds_what_trying_all_finds),
        cmocka_unit_test(shading_is_the_formula),
        cmocka_unit_test(brilliance_is_the_exponent_of_the_cosine),
        cmocka_unit_test(a_light_counts_from_a_least_cosine_on),
        cmocka_unit_test(a_shadow_leaves_the_ambient_light),
        cmocka_unit_test(a_soft_shadow_weighs_the_points_of_the_light_alike),
        cmocka_unit_test(the_points_of_a_soft_light_reach_its_edges),
        cmocka_unit_test(the_back_of_a_surface_gets_no_light),
        cmocka_unit_test(the_planes_of_a_sphere_are_the_sphere),
        cmocka_unit_test(the_picture_does_not_depend_on_the_number_of_threads),
        cmocka_unit_test(antialiasing_weighs_the_centre_and_the_grid_alike),
        cmocka_unit_test(pixels_that_differ_from_a_neighbour_are_sampled_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
