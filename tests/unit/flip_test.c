/* The pairs and the values of NVIDIA's FLIP 1.6 come with the shared data; without it those tests
 * are skipped. */
#include "verify/verify.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static Err err;

static void make(Picture *picture, int width, int height, int channels, int bits, uint64_t seed)
{
    assert_int_equal(picture_init(picture, width, height, channels, bits, &err), STATUS_OK);
    Random random;
    random_seed(&random, seed);
    size_t n = (size_t)width * (size_t)height * (size_t)channels;
    for (size_t i = 0; i < n; i++)
        picture->codes[i] = (uint16_t)(random_bits(&random) & (bits == 8 ? 255 : 65535));
}

/* False, with a word about it, where the shared data is missing. */
static bool read_shared(const char *name, Picture *picture)
{
    const char *root = getenv("CORCAST_SHARED");
    char path[512];
    snprintf(path, sizeof path, "%s/data/flip/%s", root ? root : "../shared", name);
    if (access(path, R_OK) != 0) {
        print_message("SKIPPED: %s is not there\n", path);
        return false;
    }
    assert_int_equal(picture_read(picture, path, &err), STATUS_OK);
    return true;
}

typedef struct Expected {
    const char *pair;
    double flip, flip_max; /* FLIP 1.6, no fused operations */
    double ssim, psnr_db;  /* scikit-image; NAN: not known */
} Expected;

static const Expected expected[] = {
    {"p1", 0.102207, 0.146054, 0.998876, 36.1229},
    {"p2", 0.321397, 0.993284, 0.619735, 9.0309},
    {"p3", 1.000000, 1.000000, 0.372909, 1.7609},
    {"p4", 0.000175, 0.378678, 0.998021, 49.9598},
    {"p5", 0.136329, 0.359060, 0.975625, 24.0484},
    {"p6", 0.019466, 0.466271, 0.967053, 30.4378},
    {"tree", 0.133276, 0.983034, (double)NAN, (double)NAN},
};

static void reproduces_the_values_of_reference_tools(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const Expected *e = &expected[i];
        char name[40];
        Picture a, b;
        snprintf(name, sizeof name, e->pair[0] == 't' ? "%s-ref.png" : "%s_ref.png", e->pair);
        if (!read_shared(name, &a))
            skip();
        snprintf(name, sizeof name, e->pair[0] == 't' ? "%s-test.png" : "%s_test.png", e->pair);
        assert_true(read_shared(name, &b));
        Tolerance tolerance = tolerance_identity(0);
        CompareResult result;
        assert_int_equal(compare_pictures(&a, &b, NULL, NULL, &tolerance, &result, &err),
                         STATUS_OK);
        print_message("%s FLIP %.6f SSIM %.6f PSNR %.4f\n", e->pair, result.flip_mean, result.ssim,
                      result.psnr_db);
        assert_true(fabs(result.flip_mean - e->flip) <= 2e-5);
        Plane map;
        assert_int_equal(flip_compute(&a, &b, &map, &err), STATUS_OK);
        double largest = 0;
        for (size_t p = 0; p < (size_t)map.width * (size_t)map.height; p++)
            largest = fmax(largest, (double)map.values[p]);
        assert_true(fabs(largest - e->flip_max) <= 1e-3);
        if (!isnan(e->ssim)) {
            assert_true(fabs(result.ssim - e->ssim) <= 1e-5);
            assert_true(fabs(result.psnr_db - e->psnr_db) <= 1e-4);
        }
        plane_release(&map);
        picture_release(&a);
        picture_release(&b);
    }
}

static void finds_nothing_between_a_picture_and_itself(void **state)
{
    (void)state;
    static const int shapes[][4] = {
        {1, 1, 3, 8}, {97, 131, 3, 8}, {131, 20, 1, 16}, {5, 200, 3, 16}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        Picture a;
        Plane map;
        double ssim;
        make(&a, shapes[i][0], shapes[i][1], shapes[i][2], shapes[i][3], 7);
        assert_int_equal(flip_compute(&a, &a, &map, &err), STATUS_OK);
        assert_float_equal(plane_mean(&map), 0, 0);
        assert_int_equal(ssim_compute(&a, &a, &ssim, &err), STATUS_OK);
        if (a.width >= 11 && a.height >= 11)
            assert_float_equal(ssim, 1, 1e-12);
        else
            assert_true(isnan(ssim));
        plane_release(&map);
        picture_release(&a);
    }
}

static void is_symmetric_and_zero_beyond_the_reach_of_a_difference(void **state)
{
    (void)state;
    Picture a, b;
    Plane ab, ba;
    make(&a, 90, 211, 3, 8, 11);
    make(&b, 90, 211, 3, 8, 11);
    b.codes[(100 * 90 + 41) * 3 + 1] ^= 255;
    assert_int_equal(flip_compute(&a, &b, &ab, &err), STATUS_OK);
    assert_int_equal(flip_compute(&b, &a, &ba, &err), STATUS_OK);
    assert_memory_equal(ab.values, ba.values, 90 * 211 * sizeof *ab.values);
    for (int y = 0; y < 211; y++)
        for (int x = 0; x < 90; x++) {
            bool near = abs(x - 41) <= 10 && abs(y - 100) <= 10;
            bool zero = ab.values[y * 90 + x] == 0;
            assert_true(near || zero);
        }
    assert_true(ab.values[100 * 90 + 41] > 0);
    plane_release(&ab);
    plane_release(&ba);
    picture_release(&a);
    picture_release(&b);
}

static void sees_the_same_in_eight_and_sixteen_bits(void **state)
{
    (void)state;
    Picture a[2], b[2];
    Plane map[2];
    double ssim[2];
    for (int i = 0; i < 2; i++) {
        make(&a[i], 40, 30, 3, i ? 16 : 8, 3);
        make(&b[i], 40, 30, 3, i ? 16 : 8, 4);
    }
    for (size_t p = 0; p < 40 * 30 * 3; p++) {
        a[1].codes[p] = (uint16_t)(a[0].codes[p] * 257);
        b[1].codes[p] = (uint16_t)(b[0].codes[p] * 257);
    }
    for (int i = 0; i < 2; i++) {
        assert_int_equal(flip_compute(&a[i], &b[i], &map[i], &err), STATUS_OK);
        assert_int_equal(ssim_compute(&a[i], &b[i], &ssim[i], &err), STATUS_OK);
        picture_release(&a[i]);
        picture_release(&b[i]);
    }
    assert_float_equal(plane_mean(&map[0]), plane_mean(&map[1]), 1e-6);
    assert_float_equal(ssim[0], ssim[1], 1e-4); /* luma is rounded to whole codes */
    plane_release(&map[0]);
    plane_release(&map[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reproduces_the_values_of_reference_tools),
        cmocka_unit_test(finds_nothing_between_a_picture_and_itself),
        cmocka_unit_test(is_symmetric_and_zero_beyond_the_reach_of_a_difference),
        cmocka_unit_test(sees_the_same_in_eight_and_sixteen_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
