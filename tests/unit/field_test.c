/* Slow: compares the potential with brute force. */
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>

#include "field_scenes.h"
#include "test_search.h"
#include <stdio.h>

typedef struct Setup {
    TestScene test;
    TestSearch search;
} Setup;

static void start(Setup *setup)
{
    setup->search = testsearch_open(&field_search, &setup->test.geometry, NULL);
}

static void finish(Setup *setup)
{
    testsearch_close(&setup->search);
}

static void begin_empty(Setup *setup)
{
    memset(setup, 0, sizeof *setup);
    setup->test.geometry.segments = setup->test.segments;
}

static bool first_hit(Setup *setup, Ray ray, double *t)
{
    RayHit hit = {.t = *t};
    bool found = testsearch_first(&setup->search, ray, 0, HUGE_VAL, &hit);
    *t = hit.t;
    return found;
}

/* The brute force: which terms may exceed e^-32 on a ray, between which parameters, and their sum
 * in long double. */
typedef struct Brute {
    const TestScene *test;
    Ray ray;
    uint32_t terms[MAX_SEGMENTS];
    int n_terms;
    double t0, t1, smallest_radius;
} Brute;

static Brute brute_start(const TestScene *test, Ray ray)
{
    Brute brute = {.test = test, .ray = ray, .smallest_radius = HUGE_VAL};
    brute.t0 = HUGE_VAL;
    brute.t1 = -HUGE_VAL;
    Vec3 d = ray.direction, inverse = vec3(1 / d.x, 1 / d.y, 1 / d.z);
    for (size_t i = 0; i < test->geometry.n_segments; i++) {
        const FieldSegment *segment = &test->segments[i];
        Box box = box_with_ball(box_empty(), segment->a, 4 * segment->radius_mm);
        box = box_with_ball(box, segment->b, 4 * segment->radius_mm);
        double t0 = 0, t1 = 1e9;
        if (!hit_box(ray.origin, inverse, &box, &t0, &t1))
            continue;
        brute.terms[brute.n_terms++] = (uint32_t)i;
        brute.t0 = fmin(brute.t0, t0);
        brute.t1 = fmax(brute.t1, t1);
        brute.smallest_radius = fmin(brute.smallest_radius, segment->radius_mm);
    }
    return brute;
}

static long double brute_excess(const Brute *brute, long double t, LongVec3 *gradient)
{
    Ray ray = brute->ray;
    LongVec3 x = {(long double)ray.origin.x + t * (long double)ray.direction.x,
                  (long double)ray.origin.y + t * (long double)ray.direction.y,
                  (long double)ray.origin.z + t * (long double)ray.direction.z};
    long double sum = -(long double)FIELD_LEVEL;
    for (int i = 0; i < brute->n_terms; i++) {
        LongVec3 part;
        sum += exact_term(&brute->test->segments[brute->terms[i]], x, gradient ? &part : NULL);
        if (gradient)
            *gradient =
                (LongVec3){gradient->x + part.x, gradient->y + part.y, gradient->z + part.z};
    }
    return sum;
}

/* Whether the ray starts inside: 1, else -1. */
static int brute_side(const Brute *brute)
{
    return brute->n_terms && brute_excess(brute, 0, NULL) >= 0 ? 1 : -1;
}

/* The first crossing of the level that fine steps see. */
static bool brute_first_hit(const Brute *brute, double *t)
{
    long double side = brute_side(brute), step = 0.05L * (long double)brute->smallest_radius;
    if (step < (long double)(brute->t1 - brute->t0) / 3000)
        step = (long double)(brute->t1 - brute->t0) / 3000;
    if (!brute->n_terms)
        return false;
    long double low = (long double)brute->t0;
    while (low < (long double)brute->t1) {
        long double high = low + step;
        if (side * brute_excess(brute, high, NULL) < 0) {
            for (int i = 0; i < 60; i++) {
                long double middle = (low + high) / 2;
                *(side * brute_excess(brute, middle, NULL) >= 0 ? &low : &high) = middle;
            }
            *t = (double)high;
            return true;
        }
        low = high;
    }
    return false;
}

typedef struct Tally {
    int rays, within, hits, grazing, steps_too_coarse;
    double worst_mm, worst_normal;
} Tally;

/* The hit satisfies the definition to 1e-7 of the level and the ray goes inwards there, or outwards
 * if it starts inside. */
static void check_hit(const Setup *setup, const Brute *brute, double t, Vec3 normal,
                      uint32_t segment, Tally *tally)
{
    LongVec3 gradient = {0, 0, 0};
    long double excess = brute_excess(brute, (long double)t, &gradient);
    Vec3 g = vec3((double)gradient.x, (double)gradient.y, (double)gradient.z);
    double steepness = vec3_length(g);
    assert_true(fabs((double)excess) < 1e-7 * FIELD_LEVEL + 1e-12 * steepness);
    assert_true(fabs(vec3_length(normal) - 1) < 1e-12);
    Vec3 turned = vec3_add_scaled(normal, g, 1 / steepness);
    if (steepness > 0.1 * FIELD_LEVEL)
        tally->worst_normal = fmax(tally->worst_normal, vec3_length(turned));
    assert_true(-brute_side(brute) * vec3_dot(g, brute->ray.direction) > -1e-4 * steepness);
    LongVec3 x = long_vec3(ray_at(brute->ray, t));
    long double largest = exact_term(&setup->test.segments[segment], x, NULL);
    for (size_t i = 0; i < setup->test.geometry.n_segments; i++)
        assert_true(exact_term(&setup->test.segments[i], x, NULL) <= largest + 1e-9L);
}

static void compare_with_brute_force(Setup *setup, Ray ray, Tally *tally)
{
    Brute brute = brute_start(&setup->test, ray);
    double expected = -1;
    RayHit found = {.t = -1};
    bool hit = testsearch_first(&setup->search, ray, 0, HUGE_VAL, &found);
    const double t = found.t;
    bool exists = brute_first_hit(&brute, &expected);
    tally->rays++;
    tally->within += brute_side(&brute) > 0;
    if (hit) {
        tally->hits++;
        check_hit(setup, &brute, t, found.normal, found.index, tally);
    }
    if (exists && (!hit || t > expected + 1e-4)) {
        /* Only a vessel, or from within one a gap, barely touched may be passed by. */
        long double peak = 0, side = -brute_side(&brute);
        for (double at = expected; at < expected + 0.1; at += 1e-5)
            peak = fmaxl(peak, side * brute_excess(&brute, (long double)at, NULL));
        assert_true(peak < 1e-7L);
        tally->grazing++;
    } else if (hit && (!exists || t < expected - 1e-4)) {
        /* A vessel between two of the steps: check_hit has confirmed it. */
        tally->steps_too_coarse++;
    } else if (hit) {
        tally->worst_mm = fmax(tally->worst_mm, fabs(t - expected));
    }
}

/* A ray through `target` from `distance` before it. */
static Ray ray_through(Vec3 target, Vec3 direction, double distance)
{
    return (Ray){vec3_add_scaled(target, direction, -distance), direction};
}

typedef enum RayKind {
    RAY_ANY,     /* through a place near a segment */
    RAY_TANGENT, /* past a segment at 1 + 1e-9 to 1 + 0.1 of its radius, or within */
    RAY_AXIAL,   /* along a segment, exactly or nearly */
    RAY_ALIGNED, /* along x, y or z */
    RAY_BUNDLE,  /* from one distant point */
    RAY_WITHIN,  /* from a place in or near a segment */
    N_RAY_KINDS
} RayKind;

static Ray random_ray(RayKind kind, const TestScene *test, Random *random)
{
    const FieldSegment *segment = &test->segments[random_bits(random) % test->geometry.n_segments];
    Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
    Vec3 at =
        vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), uniform(random, -0.05, 1.05));
    Vec3 place =
        vec3_add_scaled(at, random_direction(random), segment->radius_mm * uniform(random, 0, 1.6));
    switch (kind) {
    case RAY_TANGENT: {
        Vec3 across = random_normal_to(random, axis);
        Vec3 direction = random_normal_to(random, across);
        double gap = pow(10, uniform(random, -9, -1)) * (random_bits(random) & 1 ? 1 : -1);
        return ray_through(vec3_add_scaled(at, across, segment->radius_mm * (1 + gap)), direction,
                           70);
    }
    case RAY_AXIAL: {
        double tilt = random_bits(random) & 1 ? 0 : pow(10, uniform(random, -12, -2));
        Vec3 direction =
            vec3_normalized(vec3_add_scaled(axis, random_normal_to(random, axis), tilt));
        return ray_through(place, direction, 45.75);
    }
    case RAY_ALIGNED: {
        const Vec3 directions[] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                   {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
        return ray_through(place, directions[random_bits(random) % 6], 83.5);
    }
    case RAY_BUNDLE: {
        Vec3 eye = vec3(131.5, -47.25, 312.75);
        return (Ray){eye, vec3_normalized(vec3_sub(place, eye))};
    }
    case RAY_WITHIN:
        return (Ray){place, random_direction(random)};
    default:
        return ray_through(place, random_direction(random), uniform(random, 40, 90));
    }
}

static void agrees_with_brute_force_in_long_double(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 51);
    for (int kind = 0; kind < N_KINDS; kind++) {
        Tally tally = {0};
        for (int run = 0; run < (SHARE > 1 ? 1 : 4); run++) {
            Setup setup;
            make_test_scene((SceneKind)kind, &random, &setup.test);
            start(&setup);
            for (int i = 0; i < 150; i++) {
                Ray ray = random_ray((RayKind)(i % N_RAY_KINDS), &setup.test, &random);
                compare_with_brute_force(&setup, ray, &tally);
            }
            finish(&setup);
        }
        printf("  %-11s %d rays, %d from within, %d hits; off by %.1e mm, normals by %.1e at most; "
               "%d grazing, "
               "%d between the steps of the brute force\n",
               kind_names[kind], tally.rays, tally.within, tally.hits, tally.worst_mm,
               tally.worst_normal, tally.grazing, tally.steps_too_coarse);
        assert_true(tally.hits > tally.rays / 5);
        assert_true(tally.within > tally.rays / 40);
        assert_true(tally.worst_mm < 1e-4);
        assert_true(tally.worst_normal < 1e-6);
    }
}

static void a_long_vessel_is_met_at_its_radius_and_overshoots_its_ends(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    double r = 0.7345, t;
    put_segment(&setup.test, vec3(-20, 1, 2), vec3(20, 1, 2), r);
    start(&setup);
    assert_true(first_hit(&setup, (Ray){{3.25, 1, 50}, {0, 0, -1}}, &t));
    assert_true(fabs(t - (48 - r)) < 1e-12);
    assert_true(first_hit(&setup, (Ray){{60, 1, 2}, {-1, 0, 0}}, &t));
    assert_true(fabs((40 - t) / r - 0.55076) < 1e-5); /* erfinv(1 - 2 e^-2) / sqrt 2 */
    assert_false(first_hit(&setup, (Ray){{3.25, 1 + r * 1.0000001, 50}, {0, 0, -1}}, &t));
    assert_true(first_hit(&setup, (Ray){{3.25, 1 + r * 0.9999999, 50}, {0, 0, -1}}, &t));
    finish(&setup);
}

static void a_chain_of_one_radius_is_one_long_segment(void **state)
{
    (void)state;
    Setup chain, whole;
    begin_empty(&chain);
    begin_empty(&whole);
    Vec3 a = vec3(-4.2, 0.3, 1.1), span = vec3(9.5, 3.7, -2.3);
    const double cuts[] = {0, 0.013, 0.2, 0.34, 0.35, 0.61, 1};
    for (int i = 0; i < 6; i++)
        put_segment(&chain.test, vec3_add_scaled(a, span, cuts[i]),
                    vec3_add_scaled(a, span, cuts[i + 1]), 0.853);
    put_segment(&whole.test, a, vec3_add(a, span), 0.853);
    start(&chain);
    start(&whole);
    Random random;
    random_seed(&random, 52);
    int hits = 0;
    for (int i = 0; i < 3000; i++) {
        Ray ray = random_ray(RAY_ANY, &whole.test, &random);
        RayHit found, expected;
        bool hit = testsearch_first(&chain.search, ray, 0, HUGE_VAL, &found);
        assert_int_equal(hit, testsearch_first(&whole.search, ray, 0, HUGE_VAL, &expected));
        if (!hit)
            continue;
        hits++;
        double facing = -vec3_dot(expected.normal, ray.direction);
        assert_true(fabs(found.t - expected.t) * facing < 1e-8);
        assert_true(vec3_distance(found.normal, expected.normal) * facing < 1e-7);
    }
    assert_true(hits > 1000);
    finish(&chain);
    finish(&whole);
}

static void a_segment_shorter_than_a_sixth_of_its_radius_vanishes(void **state)
{
    (void)state;
    for (int visible = 0; visible < 2; visible++) {
        Setup setup;
        begin_empty(&setup);
        double length = visible ? 0.1706 : 0.1703, t; /* in radii; the limit is 0.17043 */
        put_segment(&setup.test, vec3(-length / 2, 0, 0), vec3(length / 2, 0, 0), 1);
        start(&setup);
        assert_int_equal(first_hit(&setup, (Ray){{0, 0, 9}, {0, 0, -1}}, &t), visible);
        assert_int_equal(first_hit(&setup, (Ray){{9, 0, 0}, {-1, 0, 0}}, &t), visible);
        finish(&setup);
    }
}

static void a_ray_from_inside_meets_the_wall_from_within(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    put_segment(&setup.test, vec3(-20, 0, 0), vec3(20, 0, 0), 1.23);
    put_segment(&setup.test, vec3(-20, 0, 7.5), vec3(20, 0, 7.5), 0.61);
    start(&setup);
    double t;
    RayHit hit;
    Ray ray = {{0.7, 0, -0.4}, {0, 0, 1}};
    assert_true(testsearch_first(&setup.search, ray, 0, HUGE_VAL, &hit));
    assert_true(fabs(hit.t - 1.63) < 1e-12);
    assert_int_equal(hit.index, 0);
    assert_true(vec3_distance(hit.normal, vec3(0, 0, 1)) < 1e-12);
    assert_false(testsearch_first(&setup.search, ray, 0, 1.62, &hit));
    /* From the surface outwards, and from it inwards. */
    assert_false(first_hit(&setup, (Ray){{0.7, 0, -1.23}, {0, 0, -1}}, &t));
    assert_true(first_hit(&setup, (Ray){{0.7, 0, -1.23}, {0, 0, 1}}, &t));
    finish(&setup);
}

static bool is_shadowed(Setup *setup, Vec3 from, Vec3 towards, double far)
{
    return testsearch_any(&setup->search, (Ray){from, towards}, 1e-3, far);
}

static void a_wall_is_lit_from_its_own_side_alone(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    double r = 12.3;
    put_segment(&setup.test, vec3(-200, 0, 0), vec3(200, 0, 0), r);
    start(&setup);
    const Vec3 up = {0, 0, 1};
    /* The lit place is on the surface, or off it by less than 1e-3 r to either side. */
    for (int off = -1; off <= 1; off++) {
        Vec3 bottom = vec3(0.7, 0, -r * (1 + 9e-4 * off)), top = vec3_scale(bottom, -1);
        assert_false(is_shadowed(&setup, top, up, HUGE_VAL));
        assert_true(is_shadowed(&setup, bottom, up, HUGE_VAL));
        if (off < 0)
            assert_false(is_shadowed(&setup, bottom, up, 1.9 * r));
    }
    /* Phi is e^(2 - 2 d^2 / r^2) of the level; where it is 1.01 of it at 1e-3 mm along the ray, or
     * more, the place is inside and in the dark. */
    assert_false(is_shadowed(&setup, vec3(0.7, 0, r * (1 - 2.45e-3) - 1e-3), up, HUGE_VAL));
    assert_true(is_shadowed(&setup, vec3(0.7, 0, r * (1 - 2.53e-3) - 1e-3), up, HUGE_VAL));
    finish(&setup);
}

/* A ray that enters the vessel where it starts is blocked if it is still inside at 1e-3 mm, even if
 * it is past the middle of its chord. One that leaves from a little below the surface is not. */
static void a_short_way_through_the_vessel_is_dark_only_for_a_ray_that_enters_it(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    double r = 12.3;
    put_segment(&setup.test, vec3(-200, 0, 0), vec3(200, 0, 0), r);
    start(&setup);
    const double chords[] = {0.8e-3, 1.2e-3, 1.5e-3, 1.9e-3, 5e-3};
    for (int i = 0; i < 5; i++) {
        const Vec3 inwards = vec3_normalized(vec3(0, 1, -chords[i] / (2 * r)));
        assert_int_equal(is_shadowed(&setup, vec3(0.7, 0, r), inwards, HUGE_VAL), chords[i] > 1e-3);
    }
    const Vec3 outwards = vec3_normalized(vec3(0, 1, 1e-4));
    assert_false(is_shadowed(&setup, vec3(0.7, 0, r - 5e-7), outwards, HUGE_VAL));
    finish(&setup);
}

static void looks_only_between_its_limits(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    for (int i = 0; i < 3; i++)
        put_segment(&setup.test, vec3(-9, 0, 5.0 * i), vec3(9, 0, 5.0 * i), 0.5);
    start(&setup);
    Ray ray = {{0.3, 0, -4}, {0, 0, 1}};
    const struct {
        double t_min, t_max, expected; /* 0: none */
    } cases[] = {{0, HUGE_VAL, 3.5}, {0, 3.49, 0},          {0, 3.51, 3.5},   {4.6, HUGE_VAL, 8.5},
                 {4.6, 8.4, 0},      {9.6, HUGE_VAL, 13.5}, {15, HUGE_VAL, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RayHit hit;
        bool found = testsearch_first(&setup.search, ray, cases[i].t_min, cases[i].t_max, &hit);
        assert_int_equal(found, cases[i].expected > 0);
        assert_true(!found || fabs(hit.t - cases[i].expected) < 1e-11);
    }
    finish(&setup);
}

static void of_equal_terms_the_lowest_segment_is_named(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    for (int i = 0; i < 5; i++)
        put_segment(&setup.test, vec3(-9, 0.5, 1), vec3(9, 0.5, 1), i < 2 ? 0.3 : 0.5);
    start(&setup);
    RayHit hit;
    const Ray ray = {{1, 0.625, 30}, {0, 0, -1}};
    assert_true(testsearch_first(&setup.search, ray, 0, HUGE_VAL, &hit));
    assert_int_equal(hit.index, 2);
    finish(&setup);
}

static void nothing_is_never_hit(void **state)
{
    (void)state;
    Setup setup;
    begin_empty(&setup);
    start(&setup);
    double t;
    assert_false(first_hit(&setup, (Ray){{0, 0, 5}, {0, 0, -1}}, &t));
    finish(&setup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_brute_force_in_long_double),
        cmocka_unit_test(a_long_vessel_is_met_at_its_radius_and_overshoots_its_ends),
        cmocka_unit_test(a_chain_of_one_radius_is_one_long_segment),
        cmocka_unit_test(a_segment_shorter_than_a_sixth_of_its_radius_vanishes),
        cmocka_unit_test(a_ray_from_inside_meets_the_wall_from_within),
        cmocka_unit_test(a_wall_is_lit_from_its_own_side_alone),
        cmocka_unit_test(a_short_way_through_the_vessel_is_dark_only_for_a_ray_that_enters_it),
        cmocka_unit_test(looks_only_between_its_limits),
        cmocka_unit_test(of_equal_terms_the_lowest_segment_is_named),
        cmocka_unit_test(nothing_is_never_hit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
