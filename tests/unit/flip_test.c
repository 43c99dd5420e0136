/* FLIP. The pairs and the values of NVIDIA's FLIP 1.6 are in the shared data; without it these
 * tests are skipped. */
#include "compare/compare.h"
#include "compare/measures/perception.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Err err;

static void make(Picture *picture, int width, int height, int channels, int bits, uint64_t seed)
{
    assert_int_equal(picture_init(picture, width, height, channels, bits, &err), STATUS_OK);
    Random random;
    random_seed(&random, seed);
    size_t n = (size_t)width * (size_t)height * (size_t)channels;
    for (size_t i = 0; i < n; i++)
        picture_set(picture, i, (uint16_t)(random_bits(&random) & (bits == 8 ? 255 : 65535)));
}

/* False, with a word about it, where the shared data is missing. */
static bool shared_path(const char *name, char *path, size_t size)
{
    const char *root = getenv("CORCAST_SHARED");
    snprintf(path, size, "%s/data/flip/%s", root ? root : "../shared", name);
    if (access(path, R_OK) == 0)
        return true;
    print_message("SKIPPED: %s is not there\n", path);
    return false;
}

static bool read_shared(const char *name, Picture *picture)
{
    char path[512];
    if (!shared_path(name, path, sizeof path))
        return false;
    assert_int_equal(picture_read(picture, path, ALPHA_REFUSED, &err), STATUS_OK);
    return true;
}

typedef struct Expected {
    const char *pair;
    double flip, flip_max; /* FLIP 1.6, no fused operations */
    double ssim, psnr_db;  /* scikit-image; NAN: not known */
    double de2000;         /* mean, scikit-image */
    size_t pixelmatch;     /* 7.2.0, threshold 0.1 */
} Expected;

#define UNKNOWN ((double)NAN)
static const Expected expected[] = {
    {"p1", 0.102207, 0.146054, 0.998876, 36.1229, 1.1796, 0},
    {"p2", 0.321397, 0.993284, 0.619735, 9.0309, 12.5, 3072},
    {"p3", 1.000000, 1.000000, 0.372909, 1.7609, 83.1868, 24576},
    {"p4", 0.000175, 0.378678, 0.998021, 49.9598, UNKNOWN, 1},
    {"p5", 0.136329, 0.359060, 0.975625, 24.0484, UNKNOWN, 0},
    {"p6", 0.019466, 0.466271, 0.967053, 30.4378, 0.2776, 144},
    {"tree", 0.133276, 0.983034, UNKNOWN, UNKNOWN, UNKNOWN, SIZE_MAX},
};

static void assert_near(double value, double wanted, double tolerance)
{
    if (!isnan(wanted) && !(fabs(value - wanted) <= tolerance))
        fail_msg("%.9g is not %.9g to %g", value, wanted, tolerance);
}

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
        const Rendering of_a = {.picture = &a}, of_b = {.picture = &b};
        Tolerance tolerance = tolerance_identity(0);
        CompareResult result;
        assert_int_equal(compare_pictures(&of_a, &of_b, &tolerance, &result, NULL, &err),
                         STATUS_OK);
        assert_int_equal(compare_perception(&a, &b, &result, &err), STATUS_OK);
        assert_near(result.values[MEASURE_FLIP_MEAN], e->flip, 2e-5);
        assert_near(result.values[MEASURE_FLIP_MAX], e->flip_max, 1e-3);
        assert_near(result.values[MEASURE_SSIM], e->ssim, 1e-5);
        assert_near(result.values[MEASURE_PSNR_DB], e->psnr_db, 1e-4);
        assert_near(result.values[MEASURE_DE2000_MEAN], e->de2000, 1e-4);
        if (e->pixelmatch != SIZE_MAX)
            assert_int_equal(pixelmatch_count(&a, &b, 0.1), e->pixelmatch);
        picture_release(&a);
        picture_release(&b);
    }
}

static void reproduces_hdr_flip(void **state)
{
    (void)state;
    Plane planes[2], map;
    static const char *const names[] = {"h1_ref.pfm", "h1_test.pfm"};
    for (int i = 0; i < 2; i++) {
        char path[512];
        if (!shared_path(names[i], path, sizeof path))
            skip();
        assert_int_equal(plane_read(&planes[i], path, ALPHA_REFUSED, &err), STATUS_OK);
    }
    FlipSummary summary;
    assert_int_equal(hdr_flip_compute(&planes[0], &planes[1], &map, &summary, &err), STATUS_OK);
    assert_near(summary.mean, 0.077869, 2e-5);
    assert_near(summary.max, 0.094178, 1e-3);
    double sum = 0;
    for (size_t i = 0; i < (size_t)map.width * (size_t)map.height; i++)
        sum += (double)map.values[i];
    assert_near(summary.mean, sum / ((double)map.width * map.height), 1e-12);
    plane_release(&map);
    plane_release(&planes[0]);
    plane_release(&planes[1]);
}

/* The 34 pairs of Sharma, Wu and Dalal. */
static void reproduces_the_table_of_ciede2000(void **state)
{
    (void)state;
    char path[512], line[256];
    if (!shared_path("ciede2000_sharma.txt", path, sizeof path))
        skip();
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        double a[3], b[3], wanted;
        /* pair, 1, L a b, ten intermediate values, the difference, 2, L a b */
        if (sscanf(line,
                   "%*d %*d %lf %lf %lf %*f %*f %*f %*f %*f %*f %*f %*f %*f %*f %lf %*d %lf %lf "
                   "%lf",
                   &a[0], &a[1], &a[2], &wanted, &b[0], &b[1], &b[2]) != 7)
            continue;
        assert_near(de2000(a, b), wanted, 1e-4);
        assert_near(de2000(b, a), wanted, 1e-4);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 34);
}

/* A square of 5 x 5 pixels that differ by so much from a grey ground counts up to the threshold at
 * which 0.5053 y^2 + 0.299 i^2 + 0.1957 q^2 of the difference is 35215 times its square, worked out
 * in decimals. */
static void counts_what_pixelmatch_counts_up_to_the_threshold(void **state)
{
    (void)state;
    const struct {
        int difference[3];
        double threshold;
    } cases[] = {{{60, 0, 0}, 0.127931572},
                 {{0, 60, 0}, 0.159807218},
                 {{0, 0, 60}, 0.076021259},
                 {{40, -25, 10}, 0.099083890}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Picture a, b;
        assert_int_equal(picture_init(&a, 12, 9, 3, 8, &err), STATUS_OK);
        assert_int_equal(picture_init(&b, 12, 9, 3, 8, &err), STATUS_OK);
        for (int i = 0; i < 12 * 9 * 3; i++) {
            int x = i / 3 % 12, y = i / 3 / 12;
            bool inside = x >= 4 && x < 9 && y >= 2 && y < 7;
            a.codes8[i] = 100;
            b.codes8[i] = (uint8_t)(100 + (inside ? cases[k].difference[i % 3] : 0));
        }
        assert_int_equal(pixelmatch_count(&a, &b, cases[k].threshold * 0.9999), 25);
        assert_int_equal(pixelmatch_count(&a, &b, cases[k].threshold * 1.0001), 0);
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
        FlipSummary summary;
        double values[MEASURES];
        make(&a, shapes[i][0], shapes[i][1], shapes[i][2], shapes[i][3], 7);
        assert_int_equal(flip_compute(&a, &a, &map, &summary, &err), STATUS_OK);
        assert_float_equal(summary.mean, 0, 0);
        assert_near(summary.p95 + summary.max, 0, 0);
        assert_near(summary.weighted_mean + summary.weighted_median, 0, 0);
        assert_int_equal(ssim_find(&a, &a, values, &err), STATUS_OK);
        if (a.width >= 11 && a.height >= 11)
            assert_float_equal(values[MEASURE_SSIM], 1, 1e-12);
        else
            assert_true(isnan(values[MEASURE_SSIM]));
        plane_release(&map);
        picture_release(&a);
    }
}

static void is_symmetric_and_zero_beyond_the_reach_of_a_difference(void **state)
{
    (void)state;
    Picture a, b;
    Plane ab, ba;
    FlipSummary summary;
    make(&a, 90, 211, 3, 8, 11);
    make(&b, 90, 211, 3, 8, 11);
    b.codes8[(100 * 90 + 41) * 3 + 1] ^= 255;
    assert_int_equal(flip_compute(&a, &b, &ab, &summary, &err), STATUS_OK);
    assert_int_equal(flip_compute(&b, &a, &ba, &summary, &err), STATUS_OK);
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

/* Sums over a map of errors, made without counting: the percentile by nearest rank, of weights. */
static double percentile_of_map(const float *errors, size_t n, double fraction, bool weighted)
{
    double *sorted, all = 0, sum = 0, found = 1;
    assert_int_equal(mem_calloc(&sorted, n, sizeof *sorted, "errors", &err), STATUS_OK);
    for (size_t i = 0; i < n; i++) {
        sorted[i] = (double)errors[i];
        all += weighted ? sorted[i] : 1;
    }
    for (size_t i = 0; i < n && sum < fraction * all; i++) {
        found = select_number(sorted, n, i);
        sum += weighted ? found : 1;
    }
    free(sorted);
    return found;
}

static void sums_up_errors_with_and_without_weights(void **state)
{
    (void)state;
    enum { WIDTH = 103, HEIGHT = 61, N = WIDTH * HEIGHT };
    Picture a, b;
    Plane map;
    FlipSummary summary;
    double sum = 0, squares = 0, values[MEASURES];
    make(&a, WIDTH, HEIGHT, 3, 8, 11);
    make(&b, WIDTH, HEIGHT, 3, 8, 11);
    for (int i = 0; i < 300; i++) /* a few rows; the other tiles are equal */
        b.codes8[i] = (uint8_t)(255 - b.codes8[i]);
    assert_int_equal(flip_compute(&a, &b, &map, &summary, &err), STATUS_OK);
    for (int i = 0; i < N; i++) {
        sum += (double)map.values[i];
        squares += (double)(map.values[i] * map.values[i]);
    }
    assert_near(summary.mean, sum / N, 1e-9);
    assert_near(summary.weighted_mean, squares / sum, 1e-6);
    assert_near(summary.p95, percentile_of_map(map.values, N, 0.95, false), 1e-5);
    assert_near(summary.weighted_median, percentile_of_map(map.values, N, 0.5, true), 1e-5);
    assert_near(summary.weighted_p95, percentile_of_map(map.values, N, 0.95, true), 1e-5);
    assert_true(summary.weighted_mean > 2 * summary.mean && summary.weighted_p95 < summary.max);
    assert_int_equal(flip_find(&a, &b, values, &err), STATUS_OK);
    assert_near(values[MEASURE_FLIP_P95], summary.p95, 0);
    assert_near(values[MEASURE_FLIP_WEIGHTED_MEAN], summary.weighted_mean, 0);
    plane_release(&map);
    picture_release(&a);
    picture_release(&b);
}

static void sees_the_same_in_eight_and_sixteen_bits(void **state)
{
    (void)state;
    Picture a[2], b[2];
    FlipSummary summary[2];
    double values[2][MEASURES];
    for (int i = 0; i < 2; i++) {
        make(&a[i], 40, 30, 3, i ? 16 : 8, 3);
        make(&b[i], 40, 30, 3, i ? 16 : 8, 4);
    }
    for (size_t p = 0; p < 40 * 30 * 3; p++) {
        a[1].codes16[p] = (uint16_t)(a[0].codes8[p] * 257);
        b[1].codes16[p] = (uint16_t)(b[0].codes8[p] * 257);
    }
    for (int i = 0; i < 2; i++) {
        assert_int_equal(flip_compute(&a[i], &b[i], NULL, &summary[i], &err), STATUS_OK);
        assert_int_equal(ssim_find(&a[i], &b[i], values[i], &err), STATUS_OK);
        picture_release(&a[i]);
        picture_release(&b[i]);
    }
    assert_float_equal(summary[0].mean, summary[1].mean, 1e-6);
    assert_float_equal(values[0][MEASURE_SSIM], values[1][MEASURE_SSIM],
                       1e-4); /* luma is rounded to whole codes */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reproduces_the_values_of_reference_tools),
        cmocka_unit_test(reproduces_hdr_flip),
        cmocka_unit_test(reproduces_the_table_of_ciede2000),
        cmocka_unit_test(counts_what_pixelmatch_counts_up_to_the_threshold),
        cmocka_unit_test(finds_nothing_between_a_picture_and_itself),
        cmocka_unit_test(is_symmetric_and_zero_beyond_the_reach_of_a_difference),
        cmocka_unit_test(sums_up_errors_with_and_without_weights),
        cmocka_unit_test(sees_the_same_in_eight_and_sixteen_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
