/* The volumes that the rays of a tile can meet. */
#include "scene/scene.h"
#include "unit.h"

static const Box bounds = {{-20, -15, -9}, {22, 17, 11}};
static const PixelRect part = {31, 77, 40, 23};

/* A parallel light, a point light and an area light, and a ground with its horizon in sight. */
static View view_of(Projection projection)
{
    bool perspective = projection == PROJECTION_PERSPECTIVE;
    double scale = perspective ? 1 : 55;
    return (View){
        .camera = {.projection = projection,
                   .location = {30, -8.5, 40},
                   .right = {0.8 * scale, 0, -0.6 * scale},
                   .up = {0, 0.8 * scale, 0},
                   .direction = {-0.6, 0, -0.8},
                   .width = 160,
                   .height = 128},
        .lights = {{.location = {-40, 90, 60}, .target = {1, 2, 3}, .parallel = true},
                   {.location = {2.385, 60, 3.5}},
                   {.location = {35, 20, 25},
                    .round = true,
                    .samples = 4,
                    .sides = {{0, 6, 0}, {5, 0, -4}}}},
        .n_lights = 3,
        .ground = {.present = true, .normal = {0, 1, 0}, .offset_mm = -17.5},
    };
}

/* A ray through the part, or one of its samples beside a pixel. */
static Ray ray_of_part(const View *view, Random *random)
{
    return camera_ray(&view->camera, part.left - 0.5 + part.width * random_uniform(random),
                      part.top - 0.5 + part.height * random_uniform(random));
}

static bool meets_at(const RayVolume *volume, Vec3 place)
{
    return rayvolume_meets(volume, (Box){place, place});
}

static RayVolume *rayvolume_of(const View *view, bool shadows)
{
    Err err;
    RayVolume *volume = NULL;
    must(rayvolume_new(view, bounds, part, shadows, &volume, &err), &err);
    return volume;
}

static void what_rays_through_the_part_meet_is_in_sight(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    for (int projection = 0; projection < 2; projection++) {
        View view = view_of((Projection)projection);
        RayVolume *volume = rayvolume_of(&view, false);
        for (int n = 0; n < 20000; n++) {
            Vec3 place = ray_at(ray_of_part(&view, &random), 90 * random_uniform(&random));
            assert_true(!box_contains(bounds, place, 0) || meets_at(volume, place));
        }
        rayvolume_free(volume);
    }
}

/* Where a ray may start towards a light: somewhere before it leaves the bounds, or the ground. */
static Vec3 tile_hit_point(const View *view, Random *random)
{
    for (;;) {
        double t;
        Ray ray = ray_of_part(view, random);
        Vec3 place = ray_at(ray, 90 * random_uniform(random));
        if (box_contains(bounds, place, 0))
            return place;
        if (ground_hit(&view->ground, ray, 0, HUGE_VAL, &t))
            return ray_at(ray, t);
    }
}

static void what_stands_between_that_and_a_light_is_in_sight_of_shadows(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 77);
    for (int projection = 0; projection < 2; projection++) {
        View view = view_of((Projection)projection);
        RayVolume *volume = rayvolume_of(&view, true);
        size_t between = 0;
        for (int n = 0; n < 60000; n++) {
            const Light *light = &view.lights[n % 3];
            Vec3 from = tile_hit_point(&view, &random);
            int k = (int)(light_points(light) * random_uniform(&random));
            LightDirection way = light_direction_to_point(light, k, from);
            double part_of_way = random_uniform(&random);
            Vec3 place = vec3_add_scaled(from, way.towards, fmin(way.distance, 150) * part_of_way);
            between += box_contains(bounds, place, 0);
            assert_true(!box_contains(bounds, place, 0) || meets_at(volume, place));
        }
        assert_true(between > 10000);
        rayvolume_free(volume);
    }
}

/* The part of small boxes within the bounds that the volume meets. */
static double share_in_sight(const View *view, bool shadows)
{
    RayVolume *volume = rayvolume_of(view, shadows);
    Random random;
    size_t met = 0, n = 20000;
    random_seed(&random, 5);
    for (size_t i = 0; i < n; i++) {
        Vec3 at = vec3(-20 + 42 * random_uniform(&random), -15 + 32 * random_uniform(&random),
                       -9 + 20 * random_uniform(&random));
        met += rayvolume_meets(volume, box_with_ball(box_empty(), at, 0.1));
    }
    rayvolume_free(volume);
    return (double)met / (double)n;
}

static void most_of_the_rest_is_not_in_sight(void **state)
{
    (void)state;
    View view = view_of(PROJECTION_ORTHOGRAPHIC);
    assert_in_range((int)(1000 * share_in_sight(&view, false)), 20, 80);
    view.n_lights = 1;
    view.ground.present = false;
    assert_in_range((int)(1000 * share_in_sight(&view, true)), 80, 250);
}

static void without_a_part_everything_is_in_sight(void **state)
{
    (void)state;
    assert_true(meets_at(NULL, vec3(1e6, -3, 2)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_rays_through_the_part_meet_is_in_sight),
        cmocka_unit_test(what_stands_between_that_and_a_light_is_in_sight_of_shadows),
        cmocka_unit_test(most_of_the_rest_is_not_in_sight),
        cmocka_unit_test(without_a_part_everything_is_in_sight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
