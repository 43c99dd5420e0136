#include "render/render.h"

#include "render/field.h"
#include "render/halving.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "field_scenes.h"
#include <cmocka.h>
#include <stdio.h>

static const CellParams cells = {.beta = 3};

static Halving *halving_of(const Scene *scene)
{
    Halving *halving = NULL;
    assert_int_equal(halving_new(scene, &cells, &halving, NULL), STATUS_OK);
    return halving;
}

/* A ray from 200 mm away through a place near some segment. */
static Ray random_ray(const TestScene *test, Random *random)
{
    const FieldSegment *segment = &test->segments[random_bits(random) % test->scene.n_segments];
    Vec3 at = vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), random_uniform(random));
    at = vec3_add_scaled(at, random_direction(random), 0.8 * segment->radius_mm);
    Vec3 direction = random_direction(random);
    return (Ray){vec3_add_scaled(at, direction, -200), direction};
}

static void what_it_sees_is_the_surface_to_its_accuracy(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 61);
    size_t seen = 0, grazing = 0;
    for (int kind = 0; kind < N_TAME_KINDS; kind++) {
        TestScene test;
        make_test_scene((SceneKind)kind, &random, &test);
        Halving *halving = halving_of(&test.scene);
        FieldIndex *index;
        FieldScratch *scratch;
        assert_int_equal(fieldindex_build(&test.scene, &index, NULL), STATUS_OK);
        assert_int_equal(fieldscratch_new(fieldindex_size(index), &scratch, NULL), STATUS_OK);
        for (int i = 0; i < 3000; i++) {
            Ray ray = random_ray(&test, &random);
            Hit hit;
            double t;
            Vec3 normal;
            uint32_t segment, exact_segment;
            bool found = halving_first_hit(halving, ray, 1e-4, &hit, &segment);
            bool exact =
                field_first_hit(index, scratch, ray, 1e-4, INFINITY, &t, &normal, &exact_segment);
            double cosine = exact ? -vec3_dot(normal, ray.direction) : 0;
            if (found && (!exact || hit.t < t))
                cosine = exact ? fmin(cosine, fabs(vec3_dot(hit.normal, ray.direction))) : 0;
            if (cosine < 0.05) {
                grazing += found || exact;
                continue;
            }
            assert_true(found);
            seen++;
            double radius = test.segments[segment].radius_mm;
            double allowed = cell_accuracy(radius) + cell_displacement(radius, ERF_FAST) / cosine;
            assert_true(fabs(hit.t - t) <= allowed);
            assert_true(vec3_dot(hit.normal, normal) > cos(0.05));
        }
        fieldscratch_free(scratch);
        fieldindex_free(index);
        halving_free(halving);
    }
    printf("  %zu rays seen alike, %zu graze\n", seen, grazing);
    assert_true(seen > 5000 && grazing < seen / 10);
}

static void a_hit_is_behind_the_wall_by_less_than_the_accuracy(void **state)
{
    (void)state;
    TestScene test = {.scene = {.segments = test.segments}};
    put_segment(&test, vec3(-38.5, 0, 0), vec3(49, 0, 0), 0.73);
    Halving *halving = halving_of(&test.scene);
    for (double y = -0.7; y < 0.7; y += 0.0137) {
        Ray ray = {vec3(2.385, y, 30), vec3(0, 0, -1)};
        Hit hit;
        uint32_t segment;
        assert_true(halving_first_hit(halving, ray, 1e-4, &hit, &segment));
        double wall = 30 - sqrt(0.73 * 0.73 - y * y);
        assert_true(hit.t >= wall - 1e-9 && hit.t < wall + cell_accuracy(0.73) + 1e-9);
        assert_int_equal(segment, 0);
    }
    halving_free(halving);
}

static void a_shadow_ray_leaves_its_own_wall_alone(void **state)
{
    (void)state;
    TestScene test = {.scene = {.segments = test.segments}};
    put_segment(&test, vec3(-38.5, 0, 0), vec3(49, 0, 0), 0.73);
    put_segment(&test, vec3(-38.5, 0, 5), vec3(49, 0, 5), 0.41);
    Halving *halving = halving_of(&test.scene);
    double inside = 0.5 * cell_accuracy(0.73);
    Vec3 start = vec3(2.385, 0, 0.73 - inside);
    assert_true(halving_any_hit(halving, (Ray){start, vec3(0, 0, 1)}, 1e-3, 60));
    assert_false(halving_any_hit(halving, (Ray){start, vec3(0, 0, 1)}, 1e-3, 3.5));
    assert_false(halving_any_hit(halving, (Ray){start, vec3_normalized(vec3(0, 1, 1))}, 1e-3, 60));
    assert_true(halving_any_hit(halving, (Ray){start, vec3(0, 0, -1)}, 1e-3, 60));
    /* Nearly along the wall it is met again, as POV-Ray has it. */
    assert_true(
        halving_any_hit(halving, (Ray){start, vec3_normalized(vec3(0, 1, 0.05))}, 1e-3, 60));
    halving_free(halving);
}

static void an_empty_scene_shows_nothing(void **state)
{
    (void)state;
    Scene scene = {.model = SCENE_ISOSURFACE};
    Halving *halving = halving_of(&scene);
    Hit hit;
    uint32_t segment;
    Ray ray = {vec3(0, 0, 30), vec3(0, 0, -1)};
    assert_false(halving_first_hit(halving, ray, 1e-4, &hit, &segment));
    assert_false(halving_any_hit(halving, ray, 1e-3, 60));
    halving_free(halving);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_it_sees_is_the_surface_to_its_accuracy),
        cmocka_unit_test(a_hit_is_behind_the_wall_by_less_than_the_accuracy),
        cmocka_unit_test(a_shadow_ray_leaves_its_own_wall_alone),
        cmocka_unit_test(an_empty_scene_shows_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
