/* The test for noisy pictures: its rate of false alarms, and the differences that it finds. */
#include "compare/compare.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { W = 97, H = 61, N = W * H * 3 };

static Err err;

static double normal(Random *random)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += random_uniform(random);
    return sum;
}

/* Waves with a noise of 7 % of the light and a little more, times `gain` from column `from` on. */
static Plane render(uint64_t seed, double gain, int from)
{
    Plane plane;
    Random random;
    random_seed(&random, seed);
    assert_int_equal(plane_init(&plane, W, H, 3, &err), STATUS_OK);
    for (int i = 0; i < N; i++) {
        double light = 0.53 + 0.39 * sin(i / 3 % W * 0.11 + i % 3) * cos(i / 3 / W * 0.17);
        double factor = i / 3 % W >= from ? gain : 1;
        plane.values[i] = (float)(factor * light + (0.01 + 0.07 * light) * normal(&random));
    }
    return plane;
}

static Plane known_variance(void)
{
    Plane plane;
    assert_int_equal(plane_init(&plane, W, H, 3, &err), STATUS_OK);
    for (int i = 0; i < N; i++) {
        double light = 0.53 + 0.39 * sin(i / 3 % W * 0.11 + i % 3) * cos(i / 3 / W * 0.17);
        plane.values[i] = (float)pow(0.01 + 0.07 * light, 2);
    }
    return plane;
}

static Plane estimated_variance(size_t n)
{
    Plane renderings[16], variance;
    for (size_t i = 0; i < n; i++)
        renderings[i] = render(90001 + i, 1, 0);
    assert_int_equal(noise_of_renderings(renderings, n, &variance, &err), STATUS_OK);
    for (size_t i = 0; i < n; i++)
        plane_release(&renderings[i]);
    return variance;
}

/* How many of `n` pairs are called different at a rate of 0.05. */
static int count_alarms(const Plane *variance, int n, double gain, int from)
{
    int alarms = 0;
    for (int i = 0; i < n; i++) {
        NoiseResult result;
        Plane a = render(2 * (uint64_t)i + 11, 1, 0), b = render(2 * (uint64_t)i + 12, gain, from);
        assert_int_equal(compare_noise(&a, &b, variance, 0.05, &result, &err), STATUS_OK);
        alarms += !result.agrees;
        plane_release(&a);
        plane_release(&b);
    }
    return alarms;
}

/* Of 200 pairs 10 are expected at most; 23 or more come once in 10,000 times. */
static void raises_false_alarms_no_oftener_than_it_says(void **state)
{
    (void)state;
    Plane known = known_variance(), estimated = estimated_variance(4);
    int of_known = count_alarms(&known, 200, 1, 0),
        of_estimated = count_alarms(&estimated, 200, 1, 0);
    printf("# false alarms of 200 at 0.05: %d, with the variance of 4 renderings %d\n", of_known,
           of_estimated);
    assert_in_range(of_known, 1, 22);
    assert_in_range(of_estimated, 1, 22);
    plane_release(&known);
    plane_release(&estimated);
}

static void finds_a_bias_of_half_a_percent_under_noise(void **state)
{
    (void)state;
    Plane variance = known_variance();
    assert_in_range(count_alarms(&variance, 20, 1.005, 0), 19, 20);
    assert_in_range(count_alarms(&variance, 20, 0.995, 0), 19, 20);
    plane_release(&variance);
}

/* The picture takes half of the rate, its 4 x 2 tiles the other half; each is shared by three
 * channels and all of them. */
static void limits_share_the_rate(void **state)
{
    (void)state;
    NoiseResult result;
    Plane variance = known_variance(), a = render(3, 1, 0);
    for (double rate = 0.3; rate > 1e-6; rate /= 7) {
        assert_int_equal(compare_noise(&a, &a, &variance, rate, &result, &err), STATUS_OK);
        assert_true(fabs(erfc(result.limit / sqrt(2)) / (rate / 8) - 1) < 1e-9);
        assert_true(fabs(erfc(result.tile_limit / sqrt(2)) / (rate / 64) - 1) < 1e-9);
    }
    plane_release(&a);
    plane_release(&variance);
}

static void names_the_gain_and_the_tile(void **state)
{
    (void)state;
    NoiseResult result;
    Plane variance = known_variance(), a = render(3, 1, 0), b = render(4, 1.03, 64);
    assert_int_equal(compare_noise(&a, &b, &variance, 0.01, &result, &err), STATUS_OK);
    assert_false(result.agrees);
    assert_true(fabs(result.tile_sigmas) > result.tile_limit);
    assert_true(result.tile.x >= 64);
    plane_release(&b);
    b = render(4, 1.021, 0);
    assert_int_equal(compare_noise(&a, &b, &variance, 0.01, &result, &err), STATUS_OK);
    assert_true(fabs(result.gain - 1.021) < 0.003);
    plane_release(&a);
    plane_release(&b);
    plane_release(&variance);
}

static void refuses_what_is_no_variance(void **state)
{
    (void)state;
    NoiseResult result;
    Plane variance = known_variance(), a = render(3, 1, 0);
    variance.values[7] = -0.25F;
    assert_int_equal(compare_noise(&a, &a, &variance, 0.01, &result, &err), STATUS_INPUT);
    variance.values[7] = (float)NAN;
    assert_int_equal(compare_noise(&a, &a, &variance, 0.01, &result, &err), STATUS_INPUT);
    plane_release(&a);
    plane_release(&variance);
}

/* A plane of one channel without noise, whose pixels in a box differ from the others by `more`. */
static Plane boxed(int side, int left, int top, int box, double more)
{
    Plane plane;
    assert_int_equal(plane_init(&plane, side, side, 1, &err), STATUS_OK);
    for (int i = 0; i < side * side; i++) {
        bool inside =
            i % side >= left && i % side < left + box && i / side >= top && i / side < top + box;
        plane.values[i] = (float)(0.5 + (inside ? more : 0));
    }
    return plane;
}

/* 6 sigmas in a tile of 32 are 3 in one of 64, and 12 in one of 16. */
static void tiles_have_32_pixels_a_side(void **state)
{
    (void)state;
    enum { SIDE = 192 };
    const double v = 1e-4, one_sigma = sqrt(2 * v) / 32;
    NoiseResult result;
    Plane a = boxed(SIDE, 0, 0, 0, 0), b = boxed(SIDE, 96, 32, 32, 6 * one_sigma);
    Plane variance = boxed(SIDE, 0, 0, 0, 0);
    for (int i = 0; i < SIDE * SIDE; i++)
        variance.values[i] = (float)v;
    assert_int_equal(compare_noise(&a, &b, &variance, 0.01, &result, &err), STATUS_OK);
    assert_false(result.agrees);
    assert_true(fabs(result.tile_sigmas - 6) < 0.05);
    assert_true(fabs(result.sigmas - 1) < 0.02);
    assert_int_equal(result.tile.x, 96);
    assert_int_equal(result.tile.y, 32);
    plane_release(&b);
    b = boxed(SIDE, 96, 32, 32, 3.5 * one_sigma);
    assert_int_equal(compare_noise(&a, &b, &variance, 0.01, &result, &err), STATUS_OK);
    assert_true(result.agrees);
    plane_release(&a);
    plane_release(&b);
    plane_release(&variance);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(raises_false_alarms_no_oftener_than_it_says),
        cmocka_unit_test(finds_a_bias_of_half_a_percent_under_noise),
        cmocka_unit_test(limits_share_the_rate),
        cmocka_unit_test(names_the_gain_and_the_tile),
        cmocka_unit_test(refuses_what_is_no_variance),
        cmocka_unit_test(tiles_have_32_pixels_a_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
