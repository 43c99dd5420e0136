/* Slow: walks in small steps along each ray. Checks the proofs and the numbers of the blob. */
/* The blob: its numbers (docs/METHODS.md section 2.6), and its first hits against a walk in small
 * steps over a field written down once more, from POV-Ray's definition. */
#include "field/field.h"
#include "render/field/kernel_blob.h"
#include "stage/stage.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>

#include "../fit/blob_deviation.h"
#include "field_scenes.h"
#include "test_search.h"

static TestSearch cast_of(const Geometry *geometry)
{
    return testsearch_open(&blob_search, geometry, NULL);
}

static TestScene empty_scene(void)
{
    TestScene test;
    memset(&test, 0, sizeof test);
    test.geometry.model = SCENE_BLOB;
    return test;
}

/* Where a ray from far outside towards `center` first meets the blob: the distance from there, or
 * -1. */
static double radius_towards(const Geometry *geometry, Vec3 center, Vec3 outwards)
{
    TestSearch cast = cast_of(geometry);
    Vec3 d = vec3_normalized(outwards);
    Ray ray = {vec3_add_scaled(center, d, 50), vec3_scale(d, -1)};
    RayHit hit;
    bool found = testsearch_first(&cast, ray, 0, 100, &hit);
    testsearch_close(&cast);
    return found ? 50 - hit.t : -1;
}

/* ---- the field in long double, component by component ---------------------------------------- */

static long double segment_at(const FieldSegment *segment, LongVec3 x)
{
    return exact_blob_term(segment, x, NULL);
}

static long double field_at(const Geometry *geometry, LongVec3 x)
{
    long double sum = 0;
    for (size_t i = 0; i < geometry->n_segments; i++)
        sum += segment_at(&geometry->segments[i], x);
    return sum;
}

static LongVec3 long_at(Ray ray, long double t)
{
    return (LongVec3){(long double)ray.origin.x + t * (long double)ray.direction.x,
                      (long double)ray.origin.y + t * (long double)ray.direction.y,
                      (long double)ray.origin.z + t * (long double)ray.direction.z};
}

/* ---- what the fit promises ------------------------------------------------------------------- */

static void a_long_vessel_has_its_own_radius(void **state)
{
    (void)state;
    assert_int_equal(BLOB_COMPONENTS, 14);
    assert_int_equal(BLOB_POVRAY_COMPONENTS, 18);
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(-20, 3, 1), vec3(20, -3, 2), 1.7);
    Vec3 middle = vec3(0.4, -0.06, 1.51);
    double radius = radius_towards(&test.geometry, middle, vec3(0.15, 1, 0));
    assert_true(fabs(radius - 1.7) < 1e-10);
    assert_true(fabs(blob_first_strength(&blob_shape) - blob_shape.tube[0].strength) < 1e-12);
}

/* Also where segments are much shorter than their radius. */
static void a_chain_of_one_radius_is_one_vessel(void **state)
{
    (void)state;
    const double nodes[] = {-11, -6.2, -6.15, -5, -0.3, 0.02, 4.1, 7.7, 12};
    TestScene chain = empty_scene(), whole = empty_scene();
    chain.geometry.segments = chain.segments;
    whole.geometry.segments = whole.segments;
    Vec3 axis = vec3_normalized(vec3(1, -0.4, 0.3)), side = vec3_normalized(vec3(0.4, 1, 0));
    for (int i = 0; i < 8; i++)
        put_segment(&chain, vec3_scale(axis, nodes[i]), vec3_scale(axis, nodes[i + 1]), 1.3);
    put_segment(&whole, vec3_scale(axis, nodes[0]), vec3_scale(axis, nodes[8]), 1.3);
    for (double t = -8; t < 8; t += 0.013) {
        double radius = radius_towards(&chain.geometry, vec3_scale(axis, t), side);
        assert_true(fabs(radius - 1.3) < 1.3e-6);
    }
    Random random;
    random_seed(&random, 81);
    for (int i = 0; i < 20000; i++) {
        Vec3 x = vec3_add(vec3_scale(axis, uniform(&random, -14, 14)), random_point(&random, 2));
        long double one = field_at(&whole.geometry, long_vec3(x));
        assert_true(fabsl(field_at(&chain.geometry, long_vec3(x)) - one) < 1e-12L);
    }
}

static void free_ends_overshoot_as_those_of_the_potential(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(-20, 0, 0), vec3(0, 0, 0), 1.7);
    double reach = radius_towards(&test.geometry, vec3(0, 0, 0), vec3(1, 0, 0)) / 1.7;
    assert_true(fabs(reach - 0.551) < 0.1);
    assert_true(fabs(reach - overshoot_of(&blob_shape)) < 1e-9);
}

static void the_blob_is_near_the_potential_at_bifurcations(void **state)
{
    (void)state;
    static Spot spots[MAX_SPOTS];
    const struct {
        double length, limit;
    } forks[] = {{8, 0.03}, {2, 0.036}};
    for (int l = 0; l < 2; l++)
        for (int i = 0; i < N_RATIOS; i++)
            for (int j = 0; j < N_ANGLES; j++) {
                Fork fork = fork_of(deviation_ratios[i], deviation_angles[j], forks[l].length);
                int n = find_spots(&fork, 0.3, spots);
                Deviation worst = worst_deviation(&blob_shape, &fork, spots, n);
                assert_true(n > 200 / (l + 1));
                if (!(fabs(worst.radii) < forks[l].limit))
                    fail_msg("off by %g of the radius at ratio %g, angle %g, length %g",
                             worst.radii, deviation_ratios[i], deviation_angles[j],
                             forks[l].length);
            }
}

static void components_add_up_to_the_term_and_its_gradient(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 82);
    for (int i = 0; i < 2000; i++) {
        FieldSegment segment = {.a = random_point(&random, 3),
                                .b = random_point(&random, 3),
                                .radius_mm = uniform(&random, 0.2, 2)};
        Vec3 x = random_point(&random, 4), gradient;
        BlobComponent components[BLOB_COMPONENTS];
        blob_components(&blob_shape, &segment, components);
        double term = blob_components_at(components, x, &gradient);
        assert_true(term == blob_segment_value(&segment, x));
        assert_true(fabsl((long double)term - segment_at(&segment, long_vec3(x))) < 1e-13L);
        const double h = 1e-6;
        Vec3 by = {blob_segment_value(&segment, vec3(x.x + h, x.y, x.z)) -
                       blob_segment_value(&segment, vec3(x.x - h, x.y, x.z)),
                   blob_segment_value(&segment, vec3(x.x, x.y + h, x.z)) -
                       blob_segment_value(&segment, vec3(x.x, x.y - h, x.z)),
                   blob_segment_value(&segment, vec3(x.x, x.y, x.z + h)) -
                       blob_segment_value(&segment, vec3(x.x, x.y, x.z - h))};
        assert_true(vec3_distance(vec3_scale(by, 0.5 / h), gradient) < 1e-4);
        double reach = blob_reach(&blob_shape) * segment.radius_mm;
        Vec3 away = vec3_add_scaled(segment.a, random_direction(&random), reach * 1.0001);
        if (vec3_dot(vec3_sub(away, segment.a), vec3_sub(segment.b, segment.a)) < 0)
            assert_true(blob_segment_value(&segment, away) == 0);
    }
}

/* ---- first hits ------------------------------------------------------------------------------ */

/* Rays at random, along a vessel, across one, and along an axis of the world. */
static Ray random_ray(Random *random, const TestScene *test, int i)
{
    const FieldSegment *segment = &test->segments[i % (int)test->geometry.n_segments];
    Vec3 axis = vec3_normalized(vec3_sub(segment->b, segment->a));
    Vec3 through =
        vec3_add_scaled(segment->a, vec3_sub(segment->b, segment->a), uniform(random, -0.2, 1.2));
    through = vec3_add_scaled(through, random_direction(random),
                              segment->radius_mm * uniform(random, 0, 1.6));
    Vec3 d = random_direction(random);
    if (i % 5 == 1)
        d = axis;
    else if (i % 5 == 2)
        d = random_normal_to(random, axis);
    else if (i % 5 == 3)
        d = vec3(0, 0, -1);
    return (Ray){vec3_add_scaled(through, d, -60), d};
}

typedef struct Tally {
    int rays, hits, grazing;
} Tally;

/* No sample before the hit is inside, none that is missed is; the hit is on the surface. Samples
 * are `step` apart; what is inside by less than `slack` grazes. */
static void check_ray(const TestSearch *cast, const TestScene *test, Ray ray, long double step,
                      Tally *tally)
{
    const long double slack = 1e-9L;
    const double t_max = 120;
    RayHit found;
    bool hit = testsearch_first(cast, ray, 0, t_max, &found);
    assert_true(testsearch_any(cast, ray, 0, t_max) == hit);
    tally->rays++;
    tally->hits += hit;
    for (long double s = 45; s < (hit ? (long double)found.t - 1e-6L : 75); s += step) {
        long double value = field_at(&test->geometry, long_at(ray, s));
        tally->grazing += value > 1 && value <= 1 + slack;
        if (value > 1 + slack)
            fail_msg("inside at %Lg, before the hit at %g", s, hit ? found.t : -1);
    }
    if (!hit)
        return;
    const Vec3 normal = found.normal;
    LongVec3 x = long_at(ray, (long double)found.t);
    assert_true(fabsl(field_at(&test->geometry, x) - 1) < 1e-9L);
    assert_true(fabs(vec3_length(normal) - 1) < 1e-12);
    const long double h = 1e-5L;
    long double inwards = 0;
    LongVec3 back = {x.x - h * (long double)normal.x, x.y - h * (long double)normal.y,
                     x.z - h * (long double)normal.z};
    inwards = field_at(&test->geometry, back);
    assert_true(inwards > 1 - 1e-9L);
    long double most = segment_at(&test->segments[found.index], x);
    for (size_t i = 0; i < test->geometry.n_segments; i++)
        assert_true(segment_at(&test->segments[i], x) <= most + 1e-9L);
}

static void first_hits_are_those_of_a_walk_in_small_steps(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 83);
    Tally tally = {0};
    for (int kind = 0; kind < N_TAME_KINDS; kind++)
        for (int scene = 0; scene < 2; scene++) {
            TestScene test;
            make_test_scene((SceneKind)kind, &random, &test);
            TestSearch cast = cast_of(&test.geometry);
            for (int i = 0; i < 60 / SHARE; i++)
                check_ray(&cast, &test, random_ray(&random, &test, i), 0.03L, &tally);
            testsearch_close(&cast);
        }
    print_message("%d rays, %d hits, %d samples graze\n", tally.rays, tally.hits, tally.grazing);
    assert_true(tally.hits > tally.rays / 3 && tally.hits < tally.rays);
}

static void a_ray_from_within_finds_its_way_out(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(-20, 0, 0), vec3(20, 0, 0), 1.7);
    TestSearch cast = cast_of(&test.geometry);
    RayHit hit;
    const Ray ray = {{0.3, 0.4, 0}, {0, 1, 0}};
    assert_true(testsearch_first(&cast, ray, 1e-2, INFINITY, &hit));
    assert_true(fabs(hit.t - 1.3) < 1e-12);
    assert_true(vec3_distance(hit.normal, vec3(0, 1, 0)) < 1e-12);
    assert_false(testsearch_any(&cast, ray, 1.3 + 1e-9, INFINITY));
    assert_false(testsearch_any(&cast, ray, 1e-2, 1.3 - 1e-9));
    testsearch_close(&cast);
}

/* Radii over four decades, all through one point. */
static void many_segments_in_one_place_are_no_trouble(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 84);
    TestScene test;
    make_test_scene(KIND_WIDE_STAR, &random, &test);
    TestSearch cast = cast_of(&test.geometry);
    int hits = 0;
    for (int i = 0; i < 3000; i++) {
        Ray ray = random_ray(&random, &test, i);
        RayHit hit;
        if (!testsearch_first(&cast, ray, 0, INFINITY, &hit))
            continue;
        hits++;
        assert_true(isfinite(hit.t) && fabs(vec3_length(hit.normal) - 1) < 1e-12);
        assert_true(fabsl(field_at(&test.geometry, long_at(ray, (long double)hit.t)) - 1) < 1e-4L);
    }
    assert_true(hits > 500);
    testsearch_close(&cast);
}

/* ---- terms in tiles -------------------------------------------------------------------------- */

/* A line that passes a segment of radius 1, and what kernel_blob.h says of the second derivative
 * along it. */
typedef struct Line {
    Ray ray;
    double bend;
} Line;

/* The squared distance of the line through the ray from a point, and how far along it that is. */
static double line_distance2(Ray ray, Vec3 x)
{
    Vec3 from = vec3_sub(x, ray.origin);
    Vec3 off = vec3_add_scaled(from, ray.direction, -vec3_dot(from, ray.direction));
    return vec3_dot(off, off);
}

static double distance_to(const FieldSegment *segment, Vec3 x)
{
    Vec3 span = vec3_sub(segment->b, segment->a);
    double along = vec3_dot(vec3_sub(x, segment->a), span) / vec3_dot(span, span);
    return vec3_distance(x, vec3_add_scaled(segment->a, span, fmin(fmax(along, 0), 1)));
}

static double curved(double curved, double width, double distance2)
{
    return curved * (1 - distance2 / (width * width));
}

static Line random_line(Random *random, const FieldSegment *segment)
{
    Vec3 span = vec3_sub(segment->b, segment->a), axis = vec3_normalized(span);
    Vec3 through = vec3_add_scaled(segment->a, span, uniform(random, -0.1, 1.1));
    through = vec3_add_scaled(through, random_direction(random), uniform(random, 0, 1.7));
    Line line = {.ray = {through, random_direction(random)}};
    double end2 = fmin(line_distance2(line.ray, segment->a), line_distance2(line.ray, segment->b));
    double distance = HUGE_VAL, sine = vec3_length(vec3_cross(axis, line.ray.direction));
    for (double t = -12; t < 12; t += 0.01)
        distance = fmin(distance, distance_to(segment, ray_at(line.ray, t)));
    line.bend =
        fmax(curved((double)NEAR_END_CURVED, (double)NEAR_END_WIDTH, end2),
             curved((double)NEAR_AXIS_CURVED, (double)NEAR_AXIS_WIDTH, distance * distance));
    line.bend = fmax(line.bend,
                     fmax(curved((double)FAR_CURVED, (double)FAR_WIDTH, distance * distance), 0));
    if (end2 > pow(blob_reach(&blob_shape), 2))
        line.bend *= sine * sine;
    return line;
}

/* The second derivative is that of the slope between two places. */
static void check_line(const FieldSegment *segment, const Line *line)
{
    const double h = 0.004;
    double before = 0;
    for (double t = -3.5; t < 3.5; t += h) {
        Vec3 x = ray_at(line->ray, t), d = line->ray.direction;
        LongVec3 gradient;
        double term = (double)exact_blob_term(segment, long_vec3(x), &gradient);
        double slope =
            (double)gradient.x * d.x + (double)gradient.y * d.y + (double)gradient.z * d.z;
        double distance = distance_to(segment, x), bend = (slope - before) / h;
        Vec3 span = vec3_sub(segment->b, segment->a);
        double length = vec3_length(span);
        double along = vec3_dot(vec3_sub(x, segment->a), span) / length;
        double inside = fmax(fmin(along, length - along), 0);
        double most = (double)ENVELOPE * exp(2 - 2 * distance * distance) *
                      fmin(0.5 + (double)INWARDS * inside, 1);
        assert_true(term <= most && term >= -(double)DIP);
        double steepness = sqrt(
            (double)(gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z));
        double within = 1 - pow(distance / blob_reach(&blob_shape), 2);
        assert_true(steepness <= fmax((double)STEEPNESS * within, 1e-12));
        if (t > -3.5 && (bend > line->bend || bend < -1.25 * line->bend))
            fail_msg("%g at %g of a segment of %g, %g away, bound %g", bend, t,
                     vec3_distance(segment->a, segment->b), distance, line->bend);
        before = slope;
    }
}

static void the_bounds_of_terms_hold(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 86);
    for (int i = 0; i < 1500; i++) {
        double length = pow(10, uniform(&random, -2.5, 0.8));
        FieldSegment segment = {.radius_mm = 1, .a = random_point(&random, 1)};
        segment.b = vec3_add_scaled(segment.a, random_direction(&random), length);
        Line line = random_line(&random, &segment);
        check_line(&segment, &line);
    }
}

/* ---- the witness ----------------------------------------------------------------------------- */

static BlobRoots roots_of(const Geometry *geometry, Ray ray, double t_min, double t_max)
{
    BlobRoots roots;
    assert_int_equal(
        blob_roots(geometry->segments, geometry->n_segments, ray, t_min, t_max, &roots, NULL),
        STATUS_OK);
    return roots;
}

static void roots_of_two_vessels_are_where_their_walls_are(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(-20, 0, 0), vec3(20, 0, 0), 1.7);
    put_segment(&test, vec3(-20, 9, 0), vec3(20, 9, 0), 0.6);
    const Ray ray = {{0.3, -50, 0}, {0, 1, 0}};
    const double walls[] = {48.3, 51.7, 58.4, 59.6};
    BlobRoots roots = roots_of(&test.geometry, ray, 0, INFINITY);
    assert_true(roots.is_complete);
    assert_int_equal(roots.n, 4);
    for (int i = 0; i < 4; i++)
        assert_true(fabs(roots.t[i] - walls[i]) < 1e-12);
    roots = roots_of(&test.geometry, ray, 48.4, 51.6);
    assert_true(roots.is_complete && roots.n == 0);
    roots = roots_of(&test.geometry, ray, 50, 58.5);
    assert_int_equal(roots.n, 2);
}

/* A ray beside a wall by a part in 10^9 of the radius, inside and outside of it. */
static void a_wall_is_grazed_or_missed_by_a_hair(void **state)
{
    (void)state;
    TestScene test = empty_scene();
    test.geometry.segments = test.segments;
    put_segment(&test, vec3(-20, 0, 0), vec3(20, 0, 0), 1.7);
    const Ray inside = {{0.3, -50, 1.7 * (1 - 1e-9)}, {0, 1, 0}};
    const Ray outside = {{0.3, -50, 1.7 * (1 + 1e-9)}, {0, 1, 0}};
    BlobRoots roots = roots_of(&test.geometry, inside, 0, INFINITY);
    double half = 1.7 * sqrt(2e-9);
    assert_true(roots.is_complete);
    assert_int_equal(roots.n, 2);
    assert_true(fabs(roots.t[0] - (50 - half)) < 1e-6 && fabs(roots.t[1] - (50 + half)) < 1e-6);
    roots = roots_of(&test.geometry, outside, 0, INFINITY);
    assert_true(roots.is_complete && roots.n == 0);
}

static void the_witness_agrees_with_the_renderer(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 85);
    int hits = 0, roots_found = 0;
    for (int kind = 0; kind < N_TAME_KINDS; kind++) {
        TestScene test;
        make_test_scene((SceneKind)kind, &random, &test);
        TestSearch cast = cast_of(&test.geometry);
        for (int i = 0; i < 100; i++) {
            Ray ray = random_ray(&random, &test, i);
            RayHit found;
            bool hit = testsearch_first(&cast, ray, 0, 120, &found);
            const double t = found.t;
            BlobRoots roots = roots_of(&test.geometry, ray, 0, 120);
            assert_true(roots.is_complete);
            assert_true(hit == (roots.n > 0));
            if (!hit)
                continue;
            hits++;
            roots_found += roots.n;
            if (!(fabs(t - roots.t[0]) < 1e-7))
                fail_msg("%s: the first root is at %.12g, the hit at %.12g", kind_names[kind],
                         roots.t[0], t);
            for (int k = 0; k < roots.n; k++) {
                LongVec3 x = long_at(ray, (long double)roots.t[k]);
                assert_true(fabsl(field_at(&test.geometry, x) - 1) < 1e-10L);
                assert_true(k == 0 || roots.t[k] > roots.t[k - 1]);
            }
        }
        testsearch_close(&cast);
    }
    print_message("%d hits, %d roots\n", hits, roots_found);
    assert_true(hits > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_long_vessel_has_its_own_radius),
        cmocka_unit_test(a_chain_of_one_radius_is_one_vessel),
        cmocka_unit_test(free_ends_overshoot_as_those_of_the_potential),
        cmocka_unit_test(the_blob_is_near_the_potential_at_bifurcations),
        cmocka_unit_test(components_add_up_to_the_term_and_its_gradient),
        cmocka_unit_test(first_hits_are_those_of_a_walk_in_small_steps),
        cmocka_unit_test(a_ray_from_within_finds_its_way_out),
        cmocka_unit_test(many_segments_in_one_place_are_no_trouble),
        cmocka_unit_test(the_bounds_of_terms_hold),
        cmocka_unit_test(roots_of_two_vessels_are_where_their_walls_are),
        cmocka_unit_test(a_wall_is_grazed_or_missed_by_a_hair),
        cmocka_unit_test(the_witness_agrees_with_the_renderer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
