/* Hits of rays with spheres, cylinders and boxes. */
#include "geom/geom.h"
#include "unit.h"

#include "base/base.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static double number(Random *random, double low, double high)
{
    return low + (high - low) * random_uniform(random);
}

static Vec3 point(Random *random, double size)
{
    double x = number(random, -size, size), y = number(random, -size, size);
    return vec3(x, y, number(random, -size, size));
}

static Vec3 unit(Random *random)
{
    for (;;) {
        Vec3 v = point(random, 1);
        double length = vec3_length(v);
        if (length > 0.1 && length <= 1)
            return vec3_scale(v, 1 / length);
    }
}

/* Signed distance to the surface of a closed cylinder: negative inside, zero on the wall or a
 * disc. */
static double cylinder_distance(const CylinderFrame *c, Vec3 x)
{
    Vec3 from = vec3_sub(x, c->base);
    double along = vec3_dot(from, c->axis);
    double across = vec3_length(vec3_add_scaled(from, c->axis, -along)) - c->radius;
    return fmax(across, fmax(-along, along - c->length));
}

static void hits_lie_on_the_cylinder_and_face_outwards(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 31);
    int with_hits = 0;
    for (int i = 0; i < 20000; i++) {
        Vec3 a = point(&random, 5);
        CylinderFrame c = cylinder_frame(a, vec3_add(a, vec3_scale(unit(&random), 3.7)), 1.3);
        Ray ray = {point(&random, 9), unit(&random)};
        Hit hits[4];
        int n = hit_cylinder(ray, &c, hits);
        assert_true(n == 0 || n == 2);
        with_hits += n > 0;
        for (int k = 0; k < n; k++) {
            Vec3 x = ray_at(ray, hits[k].t);
            assert_true(fabs(cylinder_distance(&c, x)) < 1e-9);
            assert_true(fabs(vec3_length(hits[k].normal) - 1) < 1e-12);
            Vec3 outside = vec3_add_scaled(x, hits[k].normal, 1e-6);
            Vec3 inside = vec3_add_scaled(x, hits[k].normal, -1e-6);
            assert_true(cylinder_distance(&c, outside) > 0);
            assert_true(cylinder_distance(&c, inside) < 0);
        }
    }
    assert_true(with_hits > 500);
}

static void rays_that_miss_the_cylinder_stay_outside(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 32);
    CylinderFrame c = cylinder_frame(vec3(-1, 0.3, 0), vec3(2, 1, 0.5), 0.8);
    for (int i = 0; i < 3000; i++) {
        Ray ray = {point(&random, 4), unit(&random)};
        Hit hits[4];
        if (hit_cylinder(ray, &c, hits) == 0)
            for (double t = -12; t < 12; t += 0.01)
                assert_true(cylinder_distance(&c, ray_at(ray, t)) > -1e-9);
    }
}

static void a_ray_along_the_axis_meets_both_discs(void **state)
{
    (void)state;
    CylinderFrame c = cylinder_frame(vec3(0, 0, 2), vec3(0, 0, 5), 0.25);
    Ray ray = {vec3(0.1, 0.05, -3), vec3(0, 0, 1)};
    Hit hits[4];
    assert_int_equal(hit_cylinder(ray, &c, hits), 2);
    assert_true(hits[0].t == 5 && hits[1].t == 8);
    ray.origin.x = 0.3;
    assert_int_equal(hit_cylinder(ray, &c, hits), 0);
}

static void hits_lie_on_the_sphere(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 33);
    for (int i = 0; i < 20000; i++) {
        Vec3 center = point(&random, 3);
        Ray ray = {point(&random, 8), unit(&random)};
        Hit hits[2];
        int n = hit_sphere(ray, center, 2.385, hits);
        Vec3 to = vec3_sub(center, ray.origin);
        double closest = vec3_length(vec3_cross(to, ray.direction));
        assert_int_equal(n, closest < 2.385 - 1e-9 ? 2 : 0);
        for (int k = 0; k < n; k++)
            assert_true(fabs(vec3_distance(ray_at(ray, hits[k].t), center) - 2.385) < 1e-9);
        assert_true(n == 0 || hits[0].t <= hits[1].t);
    }
}

static void boxes_are_met_even_along_their_faces(void **state)
{
    (void)state;
    const Box box = {{0, 0, 0}, {2, 3, 4}};
    const struct {
        Vec3 origin, direction;
        bool meets;
    } cases[] = {
        {{-1, 1, 1}, {1, 0, 0}, true},    {{-1, 0, 1}, {1, 0, 0}, true},
        {{-1, 3, 4}, {1, 0, 0}, true},    {{-1, 3, 4}, {1, -0.0, 0}, true},
        {{-1, 3.1, 1}, {1, 0, 0}, false}, {{3, 1, 1}, {1, 0, 0}, false},
        {{1, 1, 9}, {0, 0, -1}, true},    {{1, 1, 9}, {0, 0, 1}, false},
        {{1, 1, 1}, {0, 0, 1}, true},     {{-1, -1, -1}, {1, 1, 1}, true},
        {{-1, 5, 1}, {1, 1, 0}, false},   {{2, 3, 9}, {0, 0, -1}, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Vec3 d = cases[i].direction;
        double t0 = 0, t1 = 100;
        assert_int_equal(hit_box(cases[i].origin, vec3_inverse(d), &box, &t0, &t1), cases[i].meets);
    }
}

/* As in POV-Ray: a line whose half chord squared is at most 1e-10 misses. */
static void a_sphere_that_is_grazed_is_missed(void **state)
{
    (void)state;
    Hit hits[2];
    const Ray ray = {{0, 0, -3}, {0, 0, 1}};
    assert_int_equal(hit_sphere(ray, vec3(sqrt(1 - 0.99e-10), 0, 0), 1, hits), 0);
    assert_int_equal(hit_sphere(ray, vec3(sqrt(1 - 1.01e-10), 0, 0), 1, hits), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_lie_on_the_cylinder_and_face_outwards),
        cmocka_unit_test(rays_that_miss_the_cylinder_stay_outside),
        cmocka_unit_test(a_ray_along_the_axis_meets_both_discs),
        cmocka_unit_test(hits_lie_on_the_sphere),
        cmocka_unit_test(a_sphere_that_is_grazed_is_missed),
        cmocka_unit_test(boxes_are_met_even_along_their_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
