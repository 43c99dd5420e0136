/* How far vessels are cut back where they meet. */
#include "stage/cuts.h"
#include "unit.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static VesselEnd end_at(double degrees, double radius)
{
    double angle = degrees * 3.14159265358979323846 / 180;
    return (VesselEnd){vec3(cos(angle), sin(angle), 0), radius};
}

static void cut(const VesselEnd *ends, size_t n, double *cuts)
{
    uint64_t steps = 1000000000;
    assert_int_equal(cuts_compute(ends, n, cuts, &steps, NULL), STATUS_OK);
    assert_true(steps > 0);
}

/* How far the cuts are from the fixed point. */
static double defect(const VesselEnd *ends, size_t n, const double *cuts)
{
    double worst = 0;
    for (size_t i = 0; i < n; i++) {
        double pushed = 0;
        for (size_t j = 0; j < n; j++) {
            double sine = vec3_length(vec3_cross(ends[i].axis, ends[j].axis));
            if (i != j && sine > 1e-6)
                pushed = fmax(pushed, cuts[j] * vec3_dot(ends[i].axis, ends[j].axis) +
                                          ends[j].radius * sine);
        }
        worst = fmax(worst, fabs(cuts[i] - pushed) / (1 + pushed));
    }
    return worst;
}

static void two_equal_vessels_are_cut_to_where_their_inner_edges_meet(void **state)
{
    (void)state;
    const VesselEnd ends[] = {end_at(10, 1.3), end_at(85, 1.3)};
    double cuts[2];
    cut(ends, 2, cuts);
    for (int i = 0; i < 2; i++)
        assert_true(fabs(cuts[i] - 1.3 / tan(37.5 * 3.14159265358979323846 / 180)) < 1e-12);
}

static void a_thin_vessel_leaving_backwards_does_not_cut_a_thick_one(void **state)
{
    (void)state;
    const VesselEnd ends[] = {end_at(0, 2), end_at(140, 0.3)};
    double cuts[2];
    cut(ends, 2, cuts);
    double sine = sin(140 * 3.14159265358979323846 / 180);
    assert_true(cuts[0] == 0);
    assert_true(fabs(cuts[1] - 2 * sine) < 1e-12);
}

static void a_straight_vessel_is_not_cut(void **state)
{
    (void)state;
    const VesselEnd ends[] = {end_at(30, 1.1), end_at(210, 0.9)};
    double cuts[2];
    cut(ends, 2, cuts);
    assert_true(cuts[0] == 0 && cuts[1] == 0);
}

static void the_longest_of_the_cuts_that_others_ask_for_is_made(void **state)
{
    (void)state;
    const VesselEnd ends[] = {end_at(90, 1.2), end_at(-60, 1), end_at(-110, 0.8)};
    double cuts[3];
    cut(ends, 3, cuts);
    assert_true(defect(ends, 3, cuts) < 1e-12);
    assert_true(cuts[1] > 0.8 && cuts[2] > 1);
}

/* Directions thrown onto a sphere, or a circle. */
static VesselEnd throw_end(Random *random, bool flat)
{
    for (;;) {
        double x = 2 * random_uniform(random) - 1, y = 2 * random_uniform(random) - 1;
        Vec3 v = vec3(x, y, flat ? 0 : 2 * random_uniform(random) - 1);
        double length = vec3_length(v);
        if (length > 0.1 && length <= 1)
            return (VesselEnd){vec3_scale(v, 1 / length), 0.1 + random_uniform(random)};
    }
}

static void any_star_gets_the_fixed_point(void **state)
{
    (void)state;
    Random random;
    random_seed(&random, 2385);
    for (int round = 0; round < 400; round++) {
        VesselEnd ends[17];
        double cuts[17];
        size_t n = 2 + (size_t)(round % 16);
        for (size_t i = 0; i < n; i++)
            ends[i] = throw_end(&random, round % 3 == 0);
        cut(ends, n, cuts);
        for (size_t i = 0; i < n; i++)
            assert_true(cuts[i] >= 0);
        double worst = defect(ends, n, cuts);
        if (!(worst < 1e-9))
            fail_msg("star %d of %zu ends is off by %g", round, n, worst);
    }
}

static void two_thousand_vessels_at_one_place_get_it_too(void **state)
{
    (void)state;
    enum { N = 2000 };
    static VesselEnd ends[N];
    static double cuts[N];
    Random random;
    random_seed(&random, 5);
    for (size_t i = 0; i < N; i++)
        ends[i] = throw_end(&random, false);
    cut(ends, N, cuts);
    assert_true(defect(ends, N, cuts) < 1e-9);
}

static void cuts_that_take_more_comparisons_than_allowed_are_given_up(void **state)
{
    (void)state;
    enum { N = 700 };
    VesselEnd ends[N];
    double cuts[N];
    uint64_t steps = 2385;
    Random random;
    random_seed(&random, 11);
    for (size_t i = 0; i < N; i++)
        ends[i] = throw_end(&random, false);
    assert_int_equal(cuts_compute(ends, N, cuts, &steps, NULL), STATUS_OK);
    assert_int_equal(steps, 0);
}

static void cuts_of_very_many_vessels_take_few_comparisons_of_all_pairs(void **state)
{
    (void)state;
    enum { N = 2000 };
    static VesselEnd ends[N];
    static double cuts[N];
    uint64_t steps = (uint64_t)3 * N * N;
    Random random;
    random_seed(&random, 17);
    for (size_t i = 0; i < N; i++)
        ends[i] = throw_end(&random, false);
    assert_int_equal(cuts_compute(ends, N, cuts, &steps, NULL), STATUS_OK);
    assert_true(steps > 0 && defect(ends, N, cuts) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_equal_vessels_are_cut_to_where_their_inner_edges_meet),
        cmocka_unit_test(a_thin_vessel_leaving_backwards_does_not_cut_a_thick_one),
        cmocka_unit_test(a_straight_vessel_is_not_cut),
        cmocka_unit_test(the_longest_of_the_cuts_that_others_ask_for_is_made),
        cmocka_unit_test(any_star_gets_the_fixed_point),
        cmocka_unit_test(two_thousand_vessels_at_one_place_get_it_too),
        cmocka_unit_test(cuts_that_take_more_comparisons_than_allowed_are_given_up),
        cmocka_unit_test(cuts_of_very_many_vessels_take_few_comparisons_of_all_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
