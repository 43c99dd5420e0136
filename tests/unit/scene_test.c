#include "scene/scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

typedef struct Fixture {
    Primitive primitive;
    FieldSegment segment;
    Light light;
    Scene scene;
} Fixture;

/* All places `far` mm along (1, -2, 3) from where they would be. */
static void fixture_init(Fixture *f, double far)
{
    Vec3 move = {far, -2 * far, 3 * far};
    *f = (Fixture){
        .primitive = {.a = vec3_add(move, vec3(1.25, 2, 3)), .b = vec3_add(move, vec3(4, 5, -6))},
        .segment = {.a = vec3_add(move, vec3(1.5, 2, 3)), .b = vec3_add(move, vec3(4, 5.5, -6))},
        .light = {.location = vec3_add(move, vec3(70, 80, 90)), .target = move}};
    f->scene = (Scene){.camera = {.location = vec3_add(move, vec3(0, 0, 90)),
                                  .right = {12, 0, 0},
                                  .up = {0, 9, 0},
                                  .direction = {0, 0, -1},
                                  .width = 40,
                                  .height = 30},
                       .lights = &f->light,
                       .n_lights = 1,
                       .primitives = &f->primitive,
                       .n_primitives = 1,
                       .segments = &f->segment,
                       .n_segments = 1,
                       .bounds = {vec3_add(move, vec3(1, 2, -6)), vec3_add(move, vec3(4, 6, 3))}};
}

static void assert_vec3(Vec3 a, double x, double y, double z)
{
    assert_true(a.x == x && a.y == y && a.z == z);
}

static void a_scene_near_the_origin_stays(void **state)
{
    (void)state;
    Fixture f;
    fixture_init(&f, 20);
    scene_move_to_origin(&f.scene);
    assert_vec3(f.scene.origin, 0, 0, 0);
    assert_vec3(f.primitive.a, 21.25, -38, 63);
}

static void a_scene_far_from_the_origin_moves_as_a_whole(void **state)
{
    (void)state;
    Fixture f;
    fixture_init(&f, 1048576); /* where quarters are exact */
    Ray before = camera_ray(&f.scene.camera, 7, 11);
    double near_before, far_before, near_after, far_after;
    scene_depth_range(&f.scene, &near_before, &far_before);
    scene_move_to_origin(&f.scene);
    Vec3 o = f.scene.origin;
    assert_true(o.x == round(o.x) && o.y == round(o.y) && o.z == round(o.z));
    assert_true(vec3_distance(o, vec3(1048576, -2097152, 3145728)) < 10);
    Vec3 at = vec3_sub(vec3(1048576, -2097152, 3145728), o);
    assert_vec3(f.primitive.a, at.x + 1.25, at.y + 2, at.z + 3);
    assert_vec3(f.primitive.b, at.x + 4, at.y + 5, at.z - 6);
    assert_vec3(f.segment.a, at.x + 1.5, at.y + 2, at.z + 3);
    assert_vec3(f.segment.b, at.x + 4, at.y + 5.5, at.z - 6);
    assert_vec3(f.light.location, at.x + 70, at.y + 80, at.z + 90);
    assert_vec3(f.light.target, at.x, at.y, at.z);
    assert_vec3(f.scene.bounds.low, at.x + 1, at.y + 2, at.z - 6);
    Ray after = camera_ray(&f.scene.camera, 7, 11);
    assert_true(vec3_distance(vec3_add(after.origin, o), before.origin) < 1e-9);
    scene_depth_range(&f.scene, &near_after, &far_after);
    assert_true(near_after == near_before && far_after == far_before);
}

/* POV-Ray's limits [docs/POVRAY.md, section 4]. */
static void a_ground_is_not_seen_along_itself_nor_beyond_all_bounds(void **state)
{
    (void)state;
    const Ground ground = {.present = true, .normal = {0, 1, 0}, .offset_mm = -1e-4};
    double t;
    assert_false(ground_hit(&ground, (Ray){{0, 0, 0}, {1, -0.99e-10, 0}}, 0, HUGE_VAL, &t));
    assert_true(ground_hit(&ground, (Ray){{0, 0, 0}, {1, -1.01e-10, 0}}, 0, HUGE_VAL, &t));
    assert_true(fabs(t - 1e-4 / 1.01e-10) < 1);
    const Vec3 down = {0, -1, 0};
    assert_true(ground_hit(&ground, (Ray){{0, 0.999e7, 0}, down}, 0, HUGE_VAL, &t));
    assert_false(ground_hit(&ground, (Ray){{0, 1.001e7, 0}, down}, 0, HUGE_VAL, &t));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_near_the_origin_stays),
        cmocka_unit_test(a_scene_far_from_the_origin_moves_as_a_whole),
        cmocka_unit_test(a_ground_is_not_seen_along_itself_nor_beyond_all_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
