/* Measures, classes and verdicts of `compare` on small pictures. */
#include "compare/compare.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { W = 37, H = 23 };

static Err err;

/* A disc of segment 17 about (18, 11), radius 8, whose left half is segment 29, on black. */
static uint32_t disc_id(int x, int y, int radius)
{
    if ((x - 18) * (x - 18) + (y - 11) * (y - 11) > radius * radius)
        return 0;
    return x < 18 ? 29 : 17;
}

static void make_disc(Picture *picture, IdPlane *ids, int bits, int radius)
{
    assert_int_equal(picture_init(picture, W, H, 3, bits, &err), STATUS_OK);
    assert_int_equal(idplane_init(ids, W, H, &err), STATUS_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            uint32_t id = disc_id(x, y, radius);
            ids->ids[y * W + x] = id;
            for (int c = 0; c < 3 && id; c++)
                picture_set(picture, (size_t)((y * W + x) * 3 + c),
                            (uint16_t)((60 + 3 * x + 2 * y + 11 * c) << (bits - 8)));
        }
}

typedef struct Pair {
    Picture a, b;
    IdPlane id_a, id_b;
} Pair;

static Pair make_pair_of_radii(int bits, int radius_a, int radius_b)
{
    Pair pair;
    make_disc(&pair.a, &pair.id_a, bits, radius_a);
    make_disc(&pair.b, &pair.id_b, bits, radius_b);
    return pair;
}

static Pair make_pair(int bits)
{
    return make_pair_of_radii(bits, 8, 8);
}

static void pair_release(Pair *pair)
{
    picture_release(&pair->a);
    picture_release(&pair->b);
    idplane_release(&pair->id_a);
    idplane_release(&pair->id_b);
}

static CompareResult compare(const Pair *pair, bool with_ids, Tolerance tolerance)
{
    CompareResult result;
    const Rendering a = {.picture = &pair->a, .ids = with_ids ? &pair->id_a : NULL};
    const Rendering b = {.picture = &pair->b, .ids = with_ids ? &pair->id_b : NULL};
    assert_int_equal(compare_pictures(&a, &b, &tolerance, &result, NULL, &err), STATUS_OK);
    assert_int_equal(compare_perception(&pair->a, &pair->b, &result, &err), STATUS_OK);
    return result;
}

static Status compare_plain(const Picture *a, const Picture *b, const Tolerance *tolerance,
                            CompareResult *result)
{
    const Rendering of_a = {.picture = a}, of_b = {.picture = b};
    return compare_pictures(&of_a, &of_b, tolerance, result, NULL, &err);
}

/* Adds to one code. */
static void change(Picture *picture, int x, int y, int channel, int by)
{
    size_t i = (size_t)((y * picture->width + x) * picture->channels + channel);
    picture_set(picture, i, (uint16_t)(picture_code(picture, i) + by));
}

static void blacken(Picture *picture, int x, int y)
{
    for (int c = 0; c < picture->channels; c++)
        picture_set(picture, (size_t)((y * picture->width + x) * picture->channels + c), 0);
}

static void agrees_with_itself(void **state)
{
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8)
        for (int with_ids = 0; with_ids < 2; with_ids++) {
            Pair pair = make_pair(bits);
            CompareResult r = compare(&pair, with_ids, tolerance_identity(0));
            assert_true(r.agrees);
            assert_string_equal(r.reason, "");
            assert_int_equal(r.values[MEASURE_PIXELS], W * H);
            assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], 0);
            assert_int_equal(r.classes[PIXEL_IDENTICAL], W * H);
            assert_int_equal(r.values[MEASURE_MISSING_PIXELS] + r.values[MEASURE_EXTRA_PIXELS], 0);
            assert_float_equal(r.values[MEASURE_MAX_ABS], 0, 0);
            assert_float_equal(r.values[MEASURE_RMSE], 0, 0);
            assert_true(isinf(r.values[MEASURE_PSNR_DB]));
            assert_float_equal(r.values[MEASURE_FLIP_MEAN], 0, 0);
            assert_float_equal(r.values[MEASURE_SSIM], 1, 1e-12);
            assert_float_equal(r.values[MEASURE_EDGE_MISMATCH], 0, 0);
            pair_release(&pair);
        }
}

static void counts_exactly_the_pixels_that_were_edited(void **state)
{
    (void)state;
    for (int n = 0; n <= 60; n++) {
        Pair pair = make_pair(8);
        Random random;
        random_seed(&random, 2385 + (uint64_t)n);
        bool edited[W * H] = {false};
        double squares = 0, sum = 0;
        for (int done = 0; done < n;) {
            int p = (int)(random_uniform(&random) * W * H);
            int by = 1 + (int)(random_uniform(&random) * 40);
            if (edited[p])
                continue;
            edited[p] = true;
            uint8_t *code = &pair.b.codes8[3 * p + done % 3];
            *code = (uint8_t)(*code > 127 ? *code - by : *code + by);
            squares += by * by;
            sum += by;
            done++;
        }
        CompareResult r = compare(&pair, true, tolerance_identity(0));
        assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], n);
        assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], n);
        assert_int_equal(r.classes[PIXEL_IDENTICAL], W * H - n);
        assert_int_equal(r.classes[PIXEL_ROUNDING] + r.classes[PIXEL_SHADING], n);
        assert_float_equal(r.values[MEASURE_RMSE], sqrt(squares / (3 * W * H)), 1e-12);
        assert_float_equal(r.values[MEASURE_MEAN_ABS], sum / (3 * W * H), 1e-12);
        assert_int_equal(r.agrees, n == 0);
        pair_release(&pair);
    }
}

static void is_symmetric_but_for_missing_and_extra(void **state)
{
    (void)state;
    Pair pair = make_pair_of_radii(8, 8, 6);
    change(&pair.b, 18, 11, 1, 3);
    Pair back = {pair.b, pair.a, pair.id_b, pair.id_a};
    CompareResult r = compare(&pair, true, tolerance_identity(0));
    CompareResult s = compare(&back, true, tolerance_identity(0));
    assert_true(r.values[MEASURE_MISSING_PIXELS] > 0);
    assert_int_equal(r.values[MEASURE_MISSING_PIXELS], s.values[MEASURE_EXTRA_PIXELS]);
    assert_int_equal(r.values[MEASURE_EXTRA_PIXELS], s.values[MEASURE_MISSING_PIXELS]);
    assert_int_equal(r.values[MEASURE_LARGEST_REGION], s.values[MEASURE_LARGEST_REGION]);
    assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], s.values[MEASURE_DIFFERING_PIXELS]);
    assert_int_equal(r.classes[PIXEL_EDGE], s.classes[PIXEL_EDGE]);
    assert_float_equal(r.values[MEASURE_RMSE], s.values[MEASURE_RMSE], 0);
    assert_float_equal(r.values[MEASURE_FLIP_MEAN], s.values[MEASURE_FLIP_MEAN], 0);
    assert_float_equal(r.values[MEASURE_SSIM], s.values[MEASURE_SSIM], 1e-15);
    pair_release(&pair);
}

static void tells_surface_from_edge_from_missing(void **state)
{
    (void)state;
    Pair pair = make_pair(8);
    /* A hole of 3 x 2 pixels in the middle of segment 17, and one pixel gone from its rim. */
    for (int y = 8; y < 10; y++)
        for (int x = 20; x < 23; x++) {
            pair.id_b.ids[y * W + x] = 0;
            blacken(&pair.b, x, y);
        }
    pair.id_b.ids[11 * W + 26] = 0;
    blacken(&pair.b, 26, 11);
    /* Shading: one level, then five, well inside segment 29. */
    change(&pair.b, 14, 11, 0, 1);
    change(&pair.b, 13, 11, 2, 5);
    CompareResult r = compare(&pair, true, tolerance_identity(0));
    assert_int_equal(r.values[MEASURE_MISSING_PIXELS], 7);
    assert_int_equal(r.values[MEASURE_EXTRA_PIXELS], 0);
    assert_int_equal(r.values[MEASURE_LARGEST_REGION], 6);
    assert_int_equal(r.places[PLACE_REGION].x, 20);
    assert_int_equal(r.places[PLACE_REGION].y, 8);
    assert_int_equal(r.places[PLACE_REGION].id_a, 17);
    assert_int_equal(r.places[PLACE_REGION].id_b, 0);
    /* The hole's pixels touch its own boundary in B, so they are edge pixels. */
    assert_int_equal(r.classes[PIXEL_EDGE], 7);
    assert_int_equal(r.classes[PIXEL_ROUNDING], 1);
    assert_int_equal(r.classes[PIXEL_SHADING], 1);
    assert_float_equal(r.values[MEASURE_INTERIOR_MAX_ABS], 5, 0);
    assert_true(r.values[MEASURE_EDGE_MISMATCH] > 0);
    /* The background's color tells the same. */
    CompareResult s = compare(&pair, false, tolerance_identity(0));
    assert_true(s.has_mask && !s.has_ids);
    assert_int_equal(s.values[MEASURE_MISSING_PIXELS], 7);
    assert_int_equal(s.values[MEASURE_LARGEST_REGION], 6);
    pair_release(&pair);
}

static void finds_missing_interior_off_the_band(void **state)
{
    (void)state;
    Pair pair = make_pair(8);
    for (int i = 0; i < W * H; i++)
        pair.id_b.ids[i] = 0;
    CompareResult r;
    Tolerance tolerance = tolerance_identity(0);
    assert_int_equal(compare_ids(&pair.id_a, &pair.id_b, &tolerance, &r, &err), STATUS_OK);
    assert_int_equal(r.values[MEASURE_MISSING_PIXELS], r.values[MEASURE_DIFFERING_PIXELS]);
    assert_int_equal(r.values[MEASURE_LARGEST_REGION], r.values[MEASURE_MISSING_PIXELS]);
    assert_int_equal(r.classes[PIXEL_MISSING] + r.classes[PIXEL_EDGE],
                     r.values[MEASURE_MISSING_PIXELS]);
    assert_true(r.classes[PIXEL_MISSING] > 100);
    assert_int_equal(r.classes[PIXEL_MISSING] + r.classes[PIXEL_EDGE] + r.classes[PIXEL_IDENTICAL],
                     W * H);
    assert_false(r.agrees);
    pair_release(&pair);
}

static void paints_every_pixel_in_the_class_it_is_counted_in(void **state)
{
    (void)state;
    for (int with_ids = 0; with_ids < 2; with_ids++) {
        Pair pair = make_pair_of_radii(8, 8, 5);
        change(&pair.b, 20, 11, 1, 7);
        change(&pair.b, 17, 10, 2, -1);
        const Tolerance tolerance = tolerance_identity(0);
        const Rendering a = {.picture = &pair.a, .ids = with_ids ? &pair.id_a : NULL};
        const Rendering b = {.picture = &pair.b, .ids = with_ids ? &pair.id_b : NULL};
        CompareResult r = compare(&pair, with_ids, tolerance);
        Picture classes;
        size_t counts[PIXEL_CLASSES] = {0};
        assert_int_equal(class_picture(&classes, &a, &b, &tolerance, &err), STATUS_OK);
        for (size_t i = 0; i < W * H; i++)
            counts[picture_code(&classes, i)]++;
        for (int i = 0; i < PIXEL_CLASSES; i++)
            assert_int_equal(counts[i], r.classes[i]);
        assert_int_equal(picture_code(&classes, 11 * W + 20), PIXEL_SHADING);
        assert_true(r.classes[PIXEL_MISSING] > 0 && r.classes[PIXEL_EDGE] > 0);
        picture_release(&classes);
        pair_release(&pair);
    }
}

static void knows_no_mask_without_a_background(void **state)
{
    (void)state;
    Pair pair = make_pair(8);
    change(&pair.b, 0, 0, 0, 7);
    change(&pair.b, W - 1, H - 1, 0, 9);
    CompareResult r = compare(&pair, false, tolerance_identity(0));
    assert_false(r.has_mask);
    assert_true(isnan(r.values[MEASURE_INTERIOR_MAX_ABS]));
    assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], 2);
    json_t *json = compare_json(&r);
    assert_true(json_is_null(json_object_get(json, "missing_pixels")));
    assert_true(json_is_null(json_object_get(json, "interior_max_abs")));
    json_decref(json);
    pair_release(&pair);
}

static void says_what_is_wrong_and_where(void **state)
{
    (void)state;
    Pair pair = make_pair(8);
    change(&pair.b, 22, 13, 1, 31);
    CompareResult r = compare(&pair, true, tolerance_identity(0));
    assert_string_equal(r.reason, "0.118 % of the pixels are off by more than 0 levels (allowed: "
                                  "0.0002 %, no pixel at this size); the worst, 31 levels, is at "
                                  "(22, 13), segment 17");
    CompareResult without = compare(&pair, false, tolerance_identity(0));
    assert_non_null(strstr(without.reason, "the worst, 31 levels, is at (22, 13)"));
    pair.id_b.ids[13 * W + 11] = 0;
    Tolerance tolerance = tolerance_identity(0);
    assert_int_equal(compare_ids(&pair.id_a, &pair.id_b, &tolerance, &r, &err), STATUS_OK);
    assert_string_equal(
        r.reason,
        "id: 0.118 % of the pixels have different ids (allowed: 0.0002 %, "
        "no pixel at this size); the first is at (11, 13), segment 29 in A and nothing in B");
    pair_release(&pair);
}

static void allows_two_pixels_in_a_million(void **state)
{
    (void)state;
    Picture a, b;
    Tolerance tolerance = tolerance_identity(0);
    CompareResult r;
    assert_int_equal(picture_init(&a, 1000, 500, 1, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&b, 1000, 500, 1, 8, &err), STATUS_OK);
    b.codes8[777] = 200;
    assert_int_equal(compare_plain(&a, &b, &tolerance, &r), STATUS_OK);
    assert_true(r.agrees);
    b.codes8[12345] = 1;
    assert_int_equal(compare_plain(&a, &b, &tolerance, &r), STATUS_OK);
    assert_false(r.agrees);
    picture_release(&a);
    picture_release(&b);
}

static void allows_no_pixel_off_the_edges_more_than_a_level(void **state)
{
    (void)state;
    for (int levels = 1; levels <= 2; levels++) {
        Pair pair = make_pair(8);
        change(&pair.b, 14, 11, 1, levels);
        Tolerance tolerance = tolerance_identity(0);
        tolerance.limits[LIMIT_COLOR_PPM] = 5000;
        CompareResult r = compare(&pair, true, tolerance);
        assert_int_equal(r.agrees, levels == 1);
        if (!r.agrees)
            assert_non_null(strstr(r.reason, "largest difference away from edges: 2 levels"));
        pair_release(&pair);
    }
}

static void judges_surfaces_by_levels_off_the_edges(void **state)
{
    (void)state;
    for (int levels = 2; levels <= 3; levels++) {
        Pair pair = make_pair(8);
        change(&pair.b, 22, 11, 0, levels);
        change(&pair.b, 21, 12, 1, -levels);
        Tolerance surface = tolerance_surface(0);
        surface.limits[LIMIT_GAIN] = surface.limits[LIMIT_OFFSET_LEVELS] =
            (double)INFINITY; /* much depends on 197 pixels */
        CompareResult r = compare(&pair, true, surface);
        assert_int_equal(r.values[MEASURE_INTERIOR_BEYOND], levels == 2 ? 0 : 2);
        assert_int_equal(r.agrees, levels == 2);
        pair_release(&pair);
    }
}

/* A part in a hundred of all that is seen: few pixels are off by more than a level. */
static void judges_surfaces_by_their_gain(void **state)
{
    (void)state;
    Pair pair = make_pair(8);
    for (int y = 0; y < pair.a.height; y++)
        for (int x = 0; x < pair.a.width; x++)
            for (int c = 0; c < 3 && pair.id_a.ids[y * pair.a.width + x]; c++) {
                int code = picture_code(&pair.a, (size_t)((y * pair.a.width + x) * 3 + c));
                change(&pair.b, x, y, c, (int)(code * 0.01 + 0.5));
            }
    CompareResult r = compare(&pair, true, tolerance_surface(0));
    assert_false(r.agrees);
    int broken = 0;
    for (int i = 0; i < r.n_rules; i++)
        broken += !r.rules[i].met && strcmp(r.rules[i].name, "distance of the gain from 1") == 0;
    assert_int_equal(broken, 1);
    pair_release(&pair);
}

/* Runs of pixels in this direction, all alike, whose codes in B are A's but for `off`, which is +1
 * or -1 by the run. */
static Pair make_repeating_pair(int side, int dx, int dy, int bits)
{
    Pair pair;
    assert_int_equal(picture_init(&pair.a, side, side, 3, bits, &err), STATUS_OK);
    assert_int_equal(picture_init(&pair.b, side, side, 3, bits, &err), STATUS_OK);
    assert_int_equal(idplane_init(&pair.id_a, side, side, &err), STATUS_OK);
    assert_int_equal(idplane_init(&pair.id_b, side, side, &err), STATUS_OK);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            size_t pixel = (size_t)(y * side + x);
            int run = (x * dy - y * dx + 2 * side) % side;
            int off = run * run % 7 % 2 ? 1 : -1;
            pair.id_a.ids[pixel] = pair.id_b.ids[pixel] = 17;
            for (size_t c = 0; c < 3; c++) {
                int code = 60 + 3 * run + 11 * (int)c;
                picture_set(&pair.a, 3 * pixel + c, (uint16_t)(code << (bits - 8)));
                picture_set(&pair.b, 3 * pixel + c, (uint16_t)((code + off) << (bits - 8)));
            }
        }
    return pair;
}

/* The same run a hundred times says no more than once, in whatever direction it goes: the errors of
 * the line through a picture that repeats itself are those of one of its rows. */
static void repeated_pixels_are_one_measurement(void **state)
{
    (void)state;
    enum { SIDE = 40 };
    static const int directions[][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
    for (int bits = 8; bits <= 16; bits += 8)
        for (int i = 0; i < 4; i++) {
            Pair pair = make_repeating_pair(SIDE, directions[i][0], directions[i][1], bits);
            CompareResult r = compare(&pair, true, tolerance_surface(0));
            /* A residual of 1 code, and codes that are spread evenly over a range of 3 SIDE. */
            double alike = 1 / (3 * SIDE / sqrt(12) * sqrt(3 * SIDE));
            double lengths = i < 2 ? 1 : 2 / sqrt(3); /* diagonals are of all lengths to SIDE */
            assert_true(r.values[MEASURE_GAIN_ERROR] > 0.8 * alike / lengths &&
                        r.values[MEASURE_GAIN_ERROR] < 1.2 * alike * lengths);
            assert_true(r.values[MEASURE_OFFSET_ERROR] > r.values[MEASURE_GAIN_ERROR] * 100);
            pair_release(&pair);
        }
}

static void refuses_a_surface_with_a_hole_of_three_pixels(void **state)
{
    (void)state;
    for (int size = 2; size <= 3; size++) {
        Pair pair = make_pair(8);
        for (int x = 20; x < 20 + size; x++)
            pair.id_b.ids[11 * W + x] = 0;
        CompareResult r = compare(&pair, true, tolerance_surface(0));
        assert_int_equal(r.values[MEASURE_LARGEST_REGION], size);
        assert_int_equal(r.agrees, size == 2);
        pair_release(&pair);
    }
}

static void reports_sixteen_bit_pictures_in_eight_bit_levels(void **state)
{
    (void)state;
    Pair pair = make_pair(16);
    change(&pair.b, 18, 11, 0, 1);
    change(&pair.b, 19, 11, 0, 514);
    CompareResult r = compare(&pair, true, tolerance_identity(0));
    assert_float_equal(r.values[MEASURE_MAX_ABS], 2, 1e-12);
    assert_float_equal(r.values[MEASURE_MAX_CODE], 514, 0);
    assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], 2);
    assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], 1); /* one code is identity */
    assert_int_equal(r.classes[PIXEL_ROUNDING], 1);
    r = compare(&pair, true, tolerance_surface(0));
    assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], 0);
    pair_release(&pair);
}

static void compares_single_pixels(void **state)
{
    (void)state;
    Picture a, b;
    Tolerance tolerance = tolerance_identity(0);
    CompareResult r;
    assert_int_equal(picture_init(&a, 1, 1, 3, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&b, 1, 1, 3, 8, &err), STATUS_OK);
    assert_int_equal(compare_plain(&a, &b, &tolerance, &r), STATUS_OK);
    assert_true(r.agrees);
    b.codes8[2] = 255;
    assert_int_equal(compare_plain(&a, &b, &tolerance, &r), STATUS_OK);
    assert_false(r.agrees);
    assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], 1);
    assert_int_equal(compare_perception(&a, &b, &r, &err), STATUS_OK);
    assert_true(r.values[MEASURE_FLIP_MEAN] > 0.5);
    assert_true(isnan(r.values[MEASURE_SSIM]));
    picture_release(&a);
    picture_release(&b);
}

static void refuses_images_of_different_shape(void **state)
{
    (void)state;
    Picture a, wide, deep, grey;
    CompareResult r = {.values = {[MEASURE_PIXELS] = 7}};
    Tolerance tolerance = tolerance_identity(0);
    assert_int_equal(picture_init(&a, 4, 3, 3, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&wide, 5, 3, 3, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&deep, 4, 3, 3, 16, &err), STATUS_OK);
    assert_int_equal(picture_init(&grey, 4, 3, 1, 8, &err), STATUS_OK);
    assert_int_equal(compare_plain(&a, &wide, &tolerance, &r), STATUS_INPUT);
    assert_non_null(strstr(err.text, "4 x 3 and 5 x 3 pixels"));
    assert_int_equal(compare_plain(&a, &deep, &tolerance, &r), STATUS_INPUT);
    assert_non_null(strstr(err.text, "(3 x 8 and 3 x 16)"));
    assert_int_equal(compare_plain(&a, &grey, &tolerance, &r), STATUS_INPUT);
    IdPlane ids;
    assert_int_equal(idplane_init(&ids, 3, 3, &err), STATUS_OK);
    const Rendering with_ids = {.picture = &a, .ids = &ids}, without = {.picture = &a};
    assert_int_equal(compare_pictures(&with_ids, &with_ids, &tolerance, &r, NULL, &err),
                     STATUS_INPUT);
    assert_int_equal(compare_pictures(&with_ids, &without, &tolerance, &r, NULL, &err),
                     STATUS_INPUT);
    assert_int_equal(r.values[MEASURE_PIXELS], 7);
    idplane_release(&ids);
    picture_release(&a);
    picture_release(&wide);
    picture_release(&deep);
    picture_release(&grey);
}

static void fill_depth(Plane *depth, int radius, double slope)
{
    assert_int_equal(plane_init(depth, W, H, 1, &err), STATUS_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            depth->values[y * W + x] = disc_id(x, y, radius) ? 100 + (float)(slope * x) : INFINITY;
}

static CompareResult compare_depth(const Plane *a, const Plane *b, Tolerance tolerance)
{
    CompareResult result;
    assert_int_equal(compare_planes(PLANE_DEPTH, &(Rendering){.depth = a}, &(Rendering){.depth = b},
                                    &tolerance, &result, &err),
                     STATUS_OK);
    return result;
}

static void measures_depth_in_mm_over_common_pixels(void **state)
{
    (void)state;
    Plane a, b;
    fill_depth(&a, 8, 0.25);
    fill_depth(&b, 8, 0.25);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < 14; x++)
            b.values[y * W + x] += 0.5f;
    b.values[11 * W + 18] = INFINITY;
    a.values[0] = 3;
    CompareResult r = compare_depth(&a, &b, tolerance_identity(0.01));
    assert_int_equal(r.values[MEASURE_MISSING_PIXELS], 2);
    assert_int_equal(r.values[MEASURE_EXTRA_PIXELS], 0);
    assert_int_equal(r.values[MEASURE_COMMON_PIXELS], 196);
    assert_float_equal(r.values[MEASURE_MEDIAN], 0, 0);
    assert_float_equal(r.values[MEASURE_P99], 0.5, 0);
    assert_float_equal(r.values[MEASURE_MAX], 0.5, 0);
    assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], r.values[MEASURE_DIFFERING_PIXELS] - 2);
    assert_int_equal(r.places[PLACE_WORST].y, 5);
    assert_int_equal(r.places[PLACE_WORST].x, 13);
    assert_false(r.agrees);
    assert_non_null(strstr(r.reason, "pixels are seen in only one image"));
    plane_release(&a);
    plane_release(&b);
}

static void takes_percentiles_by_nearest_rank(void **state)
{
    (void)state;
    Plane a, b;
    assert_int_equal(plane_init(&a, 20, 10, 1, &err), STATUS_OK);
    assert_int_equal(plane_init(&b, 20, 10, 1, &err), STATUS_OK);
    for (int i = 0; i < 200; i++) {
        a.values[i] = 1000;
        b.values[i] = (float)(i * 77 % 200 + 1001); /* farther by 1 to 200 in another order */
    }
    CompareResult r = compare_depth(&a, &b, tolerance_surface(0.01));
    assert_float_equal(r.values[MEASURE_MEDIAN], 100, 0);
    assert_float_equal(r.values[MEASURE_P99], 198, 0);
    assert_float_equal(r.values[MEASURE_MAX], 200, 0);
    assert_string_equal(r.reason, "depth: 99th percentile of differences: 198 mm (allowed: "
                                  "0.01); the worst, 200 mm, is at (7, 9)");
    assert_float_equal(r.values[MEASURE_P99_PART], 0.198, 0);
    r = compare_depth(&a, &b, tolerance_surface(0));
    assert_string_equal(r.reason,
                        "depth: 99th percentile of differences: 0.198 of the depth (allowed: "
                        "0.0001); the worst, 200 mm, is at (7, 9)");
    plane_release(&a);
    plane_release(&b);
}

static void counts_nan_and_never_averages_it_in(void **state)
{
    (void)state;
    Plane a, b;
    fill_depth(&a, 8, 0.25);
    fill_depth(&b, 8, 0.25);
    b.values[11 * W + 18] = NAN;
    a.values[10 * W + 17] = -INFINITY;
    a.values[0] = b.values[0] = NAN;
    CompareResult r = compare_depth(&a, &b, tolerance_identity(0.01));
    assert_int_equal(r.values[MEASURE_NAN_PIXELS], 4);
    assert_int_equal(r.values[MEASURE_COMMON_PIXELS], 195);
    assert_int_equal(r.values[MEASURE_MISSING_PIXELS] + r.values[MEASURE_EXTRA_PIXELS], 0);
    assert_float_equal(r.values[MEASURE_MAX], 0, 0);
    assert_false(r.agrees);
    assert_string_equal(r.reason, "depth: values that are not a number: 4 pixels (allowed: 0); "
                                  "the first is at (0, 0)");
    assert_false(compare_depth(&a, &b, tolerance_surface(0)).agrees);
    plane_release(&a);
    plane_release(&b);
}

static void measures_normals_by_their_angle(void **state)
{
    (void)state;
    Plane a, b;
    CompareResult r;
    Tolerance tolerance = tolerance_identity(0);
    assert_int_equal(plane_init(&a, 3, 1, 3, &err), STATUS_OK);
    assert_int_equal(plane_init(&b, 3, 1, 3, &err), STATUS_OK);
    const float normals_a[] = {0, 0, 1, 1, 0, 0, 0, 0, 0};
    const float normals_b[] = {0, 0.6f, 0.8f, 1, 1e-4f, 0, 0, 0, 0};
    memcpy(a.values, normals_a, sizeof normals_a);
    memcpy(b.values, normals_b, sizeof normals_b);
    assert_int_equal(compare_planes(PLANE_NORMAL, &(Rendering){.normal = &a},
                                    &(Rendering){.normal = &b}, &tolerance, &r, &err),
                     STATUS_OK);
    assert_int_equal(r.values[MEASURE_COMMON_PIXELS], 2);
    assert_float_equal(r.values[MEASURE_MAX], 36.8698976, 1e-5);
    assert_float_equal(r.values[MEASURE_MEDIAN], 0.0057295780, 1e-9);
    assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], 1);
    b.values[0] = NAN;
    assert_int_equal(compare_planes(PLANE_NORMAL, &(Rendering){.normal = &a},
                                    &(Rendering){.normal = &b}, &tolerance, &r, &err),
                     STATUS_OK);
    assert_int_equal(r.values[MEASURE_NAN_PIXELS], 1);
    assert_int_equal(r.values[MEASURE_COMMON_PIXELS], 1);
    assert_int_equal(compare_planes(PLANE_DEPTH, &(Rendering){.depth = &a},
                                    &(Rendering){.depth = &b}, &tolerance, &r, &err),
                     STATUS_INPUT);
    plane_release(&a);
    plane_release(&b);
}

static void finds_nothing_in_common_with_an_empty_plane(void **state)
{
    (void)state;
    Plane a, b;
    fill_depth(&a, 8, 0.25);
    fill_depth(&b, -1, 0);
    for (int i = 0; i < W * H; i++)
        b.values[i] = INFINITY;
    CompareResult r = compare_depth(&a, &b, tolerance_surface(0));
    assert_int_equal(r.values[MEASURE_COMMON_PIXELS], 0);
    assert_true(isnan(r.values[MEASURE_MEDIAN]));
    assert_false(r.agrees);
    assert_non_null(strstr(r.reason, "largest missing or extra region: 197 pixels"));
    plane_release(&a);
    plane_release(&b);
}

static void keeps_the_keys_of_the_contract(void **state)
{
    (void)state;
    static const char *const keys[] = {
        "verdict",        "pixels",      "max_abs", "mean_abs",         "rmse",
        "psnr_db",        "flip_mean",   "ssim",    "interior_max_abs", "edge_mismatch_fraction",
        "missing_pixels", "extra_pixels"};
    Pair pair = make_pair(8);
    CompareResult r = compare(&pair, false, tolerance_identity(0));
    json_t *json = compare_json(&r);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        assert_non_null(json_object_get(json, keys[i]));
    assert_string_equal(json_string_value(json_object_get(json, "verdict")), "agree");
    assert_true(json_is_null(json_object_get(json, "psnr_db")));
    assert_int_equal(json_integer_value(json_object_get(json, "pixels")), W * H);
    json_decref(json);
    pair_release(&pair);
}

static void colors_differences_by_fixed_steps(void **state)
{
    (void)state;
    Picture a, b, heat;
    assert_int_equal(picture_init(&a, 8, 1, 1, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&b, 8, 1, 1, 8, &err), STATUS_OK);
    const uint8_t levels[] = {0, 1, 2, 3, 7, 15, 16, 255};
    const int steps[] = {0, 1, 2, 2, 3, 4, 5, 5};
    memcpy(b.codes8, levels, sizeof levels);
    assert_int_equal(heat_picture(&heat, &a, &b, &err), STATUS_OK);
    for (int i = 0; i < 8; i++) {
        assert_int_equal(heat.codes8[3 * i], heat_steps[steps[i]].red);
        assert_int_equal(heat.codes8[3 * i + 1], heat_steps[steps[i]].green);
        assert_int_equal(heat.codes8[3 * i + 2], heat_steps[steps[i]].blue);
    }
    picture_release(&a);
    picture_release(&b);
    picture_release(&heat);
}

/* B = 1.5 A + 7 without rounding, in 8 bits and in 16. */
static void measures_are_levels_of_255_to_the_last_digit(void **state)
{
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8) {
        const double n = W * H;
        const int per_level = bits == 8 ? 1 : 257;
        double sum = 0, squares = 0;
        Picture a, b;
        CompareResult r;
        IdPlane ids;
        const Tolerance tolerance = tolerance_none();
        const Rendering in_a = {.picture = &a, .ids = &ids}, in_b = {.picture = &b, .ids = &ids};
        assert_int_equal(idplane_init(&ids, W, H, &err), STATUS_OK);
        assert_int_equal(picture_init(&a, W, H, 1, bits, &err), STATUS_OK);
        assert_int_equal(picture_init(&b, W, H, 1, bits, &err), STATUS_OK);
        for (int i = 0; i < W * H; i++) {
            ids.ids[i] = 1;
            int k = 10 + 7 * i % 51, d = k + 7;
            picture_set(&a, (size_t)i, (uint16_t)(2 * k * per_level));
            picture_set(&b, (size_t)i, (uint16_t)((2 * k + d) * per_level));
            sum += d;
            squares += d * d;
        }
        assert_int_equal(compare_pictures(&in_a, &in_b, &tolerance, &r, NULL, &err), STATUS_OK);
        assert_true(fabs(r.values[MEASURE_GAIN] - 1.5) < 1e-9 &&
                    fabs(r.values[MEASURE_OFFSET_LEVELS] - 7) < 1e-7);
        assert_true(fabs(r.values[MEASURE_MEAN_ABS] - sum / n) < 1e-9 &&
                    fabs(r.values[MEASURE_BIAS_LEVELS] - sum / n) < 1e-9);
        assert_true(fabs(r.values[MEASURE_RMSE] - sqrt(squares / n)) < 1e-9 &&
                    r.values[MEASURE_MAX_ABS] == 67);
        assert_true(fabs(r.values[MEASURE_PSNR_DB] - 10 * log10(255 * 255 / (squares / n))) < 1e-9);
        idplane_release(&ids);
        picture_release(&a);
        picture_release(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_itself),
        cmocka_unit_test(counts_exactly_the_pixels_that_were_edited),
        cmocka_unit_test(is_symmetric_but_for_missing_and_extra),
        cmocka_unit_test(tells_surface_from_edge_from_missing),
        cmocka_unit_test(finds_missing_interior_off_the_band),
        cmocka_unit_test(paints_every_pixel_in_the_class_it_is_counted_in),
        cmocka_unit_test(knows_no_mask_without_a_background),
        cmocka_unit_test(says_what_is_wrong_and_where),
        cmocka_unit_test(allows_two_pixels_in_a_million),
        cmocka_unit_test(allows_no_pixel_off_the_edges_more_than_a_level),
        cmocka_unit_test(judges_surfaces_by_levels_off_the_edges),
        cmocka_unit_test(judges_surfaces_by_their_gain),
        cmocka_unit_test(repeated_pixels_are_one_measurement),
        cmocka_unit_test(refuses_a_surface_with_a_hole_of_three_pixels),
        cmocka_unit_test(reports_sixteen_bit_pictures_in_eight_bit_levels),
        cmocka_unit_test(compares_single_pixels),
        cmocka_unit_test(refuses_images_of_different_shape),
        cmocka_unit_test(measures_depth_in_mm_over_common_pixels),
        cmocka_unit_test(takes_percentiles_by_nearest_rank),
        cmocka_unit_test(counts_nan_and_never_averages_it_in),
        cmocka_unit_test(measures_normals_by_their_angle),
        cmocka_unit_test(finds_nothing_in_common_with_an_empty_plane),
        cmocka_unit_test(keeps_the_keys_of_the_contract),
        cmocka_unit_test(colors_differences_by_fixed_steps),
        cmocka_unit_test(measures_are_levels_of_255_to_the_last_digit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
