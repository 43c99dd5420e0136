/* Rays and triangles: the first triangle that is hit, the position, and the visible normal. */
#include "unit.h"

#include "base/base.h"
#include <math.h>
#include <stdint.h>

#include "test_search.h"

/* A triangle in the plane z = 2.385, its right angle at the origin of x and y, and normals that
 * lean outwards. */
static float points[3][3] = {{0, 0, 2.385F}, {4.25F, 0, 2.385F}, {0, 3.5F, 2.385F}};
static float normals[3][3] = {{-0.6F, 0, -0.8F}, {0, -0.6F, -0.8F}, {0.28F, 0.96F, 0}};
static uint32_t corners[1][3] = {{0, 1, 2}};

static TestSearch cast_one(uint32_t *label, Geometry *geometry)
{
    *geometry = (Geometry){.mesh = {points, normals, 3, corners, label, 1}};
    return testsearch_open(&triangle_search, geometry, NULL);
}

static const Vec3 parts = {0.2, 0.3, 0.5};

/* Through the place that has these parts of the three corners. */
static Ray ray_through_parts(void)
{
    return (Ray){{parts.y * 4.25, parts.z * 3.5, -1.5}, {0, 0, 1}};
}

static void a_normal_is_between_those_of_the_corners(void **state)
{
    (void)state;
    uint32_t label = 7;
    Geometry geometry;
    TestSearch cast = cast_one(&label, &geometry);
    RayHit hit;
    assert_true(testsearch_first(&cast, ray_through_parts(), 1e-4, INFINITY, &hit));
    assert_int_equal(hit.index, 7);
    assert_true(fabs(hit.t - 3.885) <= 1e-6 && hit.from_inside);
    Vec3 expected = vec3_normalized(
        vec3(-0.6 * parts.x + 0.28 * parts.z, -0.6 * parts.y + 0.96 * parts.z, -0.4));
    assert_true(vec3_distance(hit.normal, expected) < 1e-6);
    testsearch_close(&cast);
}

static void a_cap_has_the_normal_of_its_plane(void **state)
{
    (void)state;
    uint32_t label = 7 | MESH_CAP;
    Geometry geometry;
    TestSearch cast = cast_one(&label, &geometry);
    RayHit hit;
    assert_true(testsearch_first(&cast, ray_through_parts(), 1e-4, INFINITY, &hit));
    assert_int_equal(hit.index, 7);
    assert_true(vec3_distance(hit.normal, vec3(0, 0, 1)) < 1e-6);
    testsearch_close(&cast);
}

static void rays_beside_the_edges_and_short_of_the_plane_meet_nothing(void **state)
{
    (void)state;
    uint32_t label = 7;
    Geometry geometry;
    TestSearch cast = cast_one(&label, &geometry);
    const Vec3 up = {0, 0, 1}, inside = {1.125, 1.25, 0};
    RayHit hit;
    assert_false(testsearch_first(&cast, (Ray){{-0.001, 1.25, 0}, up}, 1e-4, INFINITY, &hit));
    assert_false(testsearch_first(&cast, (Ray){{1.125, -0.001, 0}, up}, 1e-4, INFINITY, &hit));
    assert_false(testsearch_first(&cast, (Ray){{2.127, 1.75, 0}, up}, 1e-4, INFINITY, &hit));
    assert_true(testsearch_first(&cast, (Ray){{2.123, 1.75, 0}, up}, 1e-4, INFINITY, &hit));
    assert_false(testsearch_first(&cast, (Ray){inside, up}, 2.386, INFINITY, &hit));
    assert_true(testsearch_any(&cast, (Ray){inside, up}, 1e-3, 2.386));
    assert_false(testsearch_any(&cast, (Ray){inside, up}, 1e-3, 2.384));
    testsearch_close(&cast);
}

/* Where a ray meets a triangle; T. Moller, B. Trumbore: Fast, minimum storage ray/triangle
 * intersection, J. Graph. Tools 2 (1997) 21-28. */
static double meeting(const VesselMesh *mesh, size_t triangle, Ray ray)
{
    const uint32_t *corner = mesh->triangles[triangle];
    Vec3 a = mesh_point(mesh, corner[0]), u = vec3_sub(mesh_point(mesh, corner[1]), a);
    Vec3 v = vec3_sub(mesh_point(mesh, corner[2]), a), p = vec3_cross(ray.direction, v);
    double determinant = vec3_dot(u, p);
    Vec3 from = vec3_sub(ray.origin, a), q = vec3_cross(from, u);
    double s = vec3_dot(from, p) / determinant, t = vec3_dot(ray.direction, q) / determinant;
    bool meets = fabs(determinant) > 1e-12 && s >= 0 && t >= 0 && s + t <= 1;
    double at = vec3_dot(v, q) / determinant;
    return meets && at > 1e-4 ? at : HUGE_VAL;
}

static double uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

enum { TRIANGLES = 300, RAYS = 4000 };

/* Of many small triangles in the unit cube. */
static void the_nearest_of_many_is_found(void **state)
{
    (void)state;
    static float place[3 * TRIANGLES][3];
    static uint32_t corner[TRIANGLES][3], labels[TRIANGLES];
    uint64_t seed = 23;
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        Vec3 middle = {uniform(&seed), uniform(&seed), uniform(&seed)};
        labels[i] = i;
        for (uint32_t k = 0; k < 3; k++) {
            corner[i][k] = 3 * i + k;
            for (int axis = 0; axis < 3; axis++)
                place[3 * i + k][axis] =
                    (float)(vec3_component(middle, axis) + 0.2 * (uniform(&seed) - 0.5));
        }
    }
    const VesselMesh mesh = {place, place, 3 * TRIANGLES, corner, labels, TRIANGLES};
    const Geometry geometry = {.mesh = mesh};
    TestSearch cast = testsearch_open(&triangle_search, &geometry, NULL);
    int met = 0;
    for (int i = 0; i < RAYS; i++) {
        Vec3 from = {uniform(&seed), uniform(&seed), uniform(&seed)};
        Vec3 to = {uniform(&seed), uniform(&seed), uniform(&seed)};
        Ray ray = {from, vec3_normalized(vec3_sub(to, from))};
        uint32_t nearest = TRIANGLES;
        double least = HUGE_VAL;
        for (uint32_t k = 0; k < TRIANGLES; k++) {
            double at = meeting(&mesh, k, ray);
            nearest = at < least ? k : nearest;
            least = fmin(least, at);
        }
        RayHit hit;
        bool found = testsearch_first(&cast, ray, 1e-4, INFINITY, &hit);
        assert_int_equal(found, nearest < TRIANGLES);
        met += found;
        if (!found)
            continue;
        assert_int_equal(hit.index, nearest);
        assert_true(fabs(hit.t - least) <= 1e-5);
        assert_true(testsearch_any(&cast, ray, 1e-4, least + 1e-4));
    }
    assert_in_range(met, RAYS / 4, RAYS);
    testsearch_close(&cast);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_normal_is_between_those_of_the_corners),
        cmocka_unit_test(a_cap_has_the_normal_of_its_plane),
        cmocka_unit_test(rays_beside_the_edges_and_short_of_the_plane_meet_nothing),
        cmocka_unit_test(the_nearest_of_many_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
