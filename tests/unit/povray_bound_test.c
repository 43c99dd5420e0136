/* The boxes that POV-Ray tests along a ray. tests/povray/behaviour_test.sh confirms this on
 * POV-Ray itself. */
#include "render/cast/povray_bound.h"
#include "unit.h"

#include <math.h>

/* Its sides are numbers of single precision, 2^-19 from their neighbours. */
static const Box box = {{-31.5, 17.25, -0.75}, {-31.25, 17.5, 0.25}};

static bool looks_into(Vec3 origin, Vec3 direction)
{
    double order;
    const BoundRay ray = bound_ray((Ray){origin, direction});
    return povray_looks_into(&ray, box, &order);
}

static bool looks_down_at(double x, double y)
{
    return looks_into(vec3(x, y, 142.4), vec3(0, 0, -1));
}

/* Inside by 2e-7, which the rounding to single precision takes away, and by 2e-6. */
static void a_parallel_ray_in_the_plane_of_a_side_misses_it_in_x_alone(void **state)
{
    (void)state;
    const double near = 2e-7, off = 2e-6;
    assert_false(looks_down_at(box.low.x + near, 17.375));
    assert_true(looks_down_at(box.low.x + off, 17.375));
    assert_false(looks_down_at(box.high.x - near, 17.375));
    assert_true(looks_down_at(box.high.x - off, 17.375));
    assert_true(looks_down_at(-31.375, box.low.y + near));
    assert_true(looks_down_at(-31.375, box.high.y - near));
    assert_false(looks_down_at(-31.375, box.high.y + off));
    assert_true(looks_into(vec3(-90, 17.375, box.low.z), vec3(1, 0, 0)));
    assert_true(looks_into(vec3(-31.375, -90, box.high.z), vec3(0, 1, 0)));
    assert_false(looks_into(vec3(box.high.x, -90, 0), vec3(0, 1, 0)));
}

static void a_slanted_ray_sees_what_it_meets(void **state)
{
    (void)state;
    const Vec3 middle = box_center(box);
    for (int i = 0; i < 8; i++) {
        const Vec3 along =
            vec3_normalized(vec3(i & 1 ? 0.3 : -0.3, i & 2 ? 0.4 : -0.4, i & 4 ? 0.5 : -0.5));
        const Vec3 before = vec3_add_scaled(middle, along, -70);
        assert_true(looks_into(before, along));
        assert_true(looks_into(middle, along));
        assert_false(looks_into(before, vec3_scale(along, -1)));
        assert_false(looks_into(vec3_add_scaled(before, vec3(1, 0, 0), 1), along));
    }
}

static void the_order_is_that_in_which_boxes_begin(void **state)
{
    (void)state;
    double order;
    const BoundRay down = bound_ray((Ray){vec3(-31.375, 17.375, 142.4), vec3(0, 0, -1)});
    assert_true(povray_looks_into(&down, box, &order));
    assert_float_equal(order, 142.15, 2e-5);
    const BoundRay up = bound_ray((Ray){vec3(-31.375, 17.375, -0.25), vec3(0, 0, 1)});
    assert_true(povray_looks_into(&up, box, &order));
    assert_float_equal(order, -0.5, 2e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_parallel_ray_in_the_plane_of_a_side_misses_it_in_x_alone),
        cmocka_unit_test(a_slanted_ray_sees_what_it_meets),
        cmocka_unit_test(the_order_is_that_in_which_boxes_begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
