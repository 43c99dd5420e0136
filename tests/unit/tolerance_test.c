/* Tiers, the ledger of segments, float colors, and files of tolerances. */
#include "compare/compare.h"
#include "compare/pixels.h"
#include "compare/rules/judge.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static Err err;

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.12g is not %.12g to %g", value, wanted, tolerance);
}

enum { W = 96, H = 64, LEFT = 20, RIGHT = 60, TOP = 16, BOTTOM = 48 };

typedef struct Side {
    Picture picture;
    IdPlane ids;
    Plane depth, normal;
} Side;

/* Segment 23 beside segment 85, two rectangles of 20 x 32 pixels, on a dark ground. */
static uint32_t id_at(int x, int y, int shift)
{
    if (y < TOP || y >= BOTTOM || x < LEFT + shift || x >= RIGHT + shift)
        return 0;
    return x < 40 + shift ? 23 : 85;
}

static void side_init(Side *side, int shift)
{
    assert_int_equal(picture_init(&side->picture, W, H, 3, 8, &err), STATUS_OK);
    assert_int_equal(idplane_init(&side->ids, W, H, &err), STATUS_OK);
    assert_int_equal(plane_init(&side->depth, W, H, 1, &err), STATUS_OK);
    assert_int_equal(plane_init(&side->normal, W, H, 3, &err), STATUS_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            int i = y * W + x;
            side->ids.ids[i] = id_at(x, y, shift);
            side->depth.values[i] = side->ids.ids[i] ? 31.5f : INFINITY;
            side->normal.values[3 * i + 2] = side->ids.ids[i] ? 1 : 0;
            for (int c = 0; c < 3; c++)
                side->picture.codes8[3 * i + c] =
                    (uint8_t)(side->ids.ids[i] ? 60 + 2 * (x - shift) + c : 10);
        }
}

static void side_release(Side *side)
{
    picture_release(&side->picture);
    idplane_release(&side->ids);
    plane_release(&side->depth);
    plane_release(&side->normal);
}

static Rendering rendering(const Side *side)
{
    return (Rendering){.picture = &side->picture,
                       .ids = &side->ids,
                       .depth = &side->depth,
                       .normal = &side->normal};
}

static CompareResult compare(const Side *a, const Side *b, Tolerance tolerance, Ledger *ledger)
{
    CompareResult result;
    Rendering of_a = rendering(a), of_b = rendering(b);
    assert_int_equal(compare_pictures(&of_a, &of_b, &tolerance, &result, ledger, &err), STATUS_OK);
    return result;
}

static const Rule *rule_named(const CompareResult *result, const char *part)
{
    for (int i = 0; i < result->n_rules; i++)
        if (strstr(result->rules[i].name, part))
            return &result->rules[i];
    fail_msg("there is no rule about \"%s\"", part);
    return NULL;
}

static void tier_b_agrees_with_what_single_precision_does(void **state)
{
    (void)state;
    Side a, b;
    side_init(&a, 0);
    side_init(&b, 0);
    /* One code up in one place, down in another. */
    b.picture.codes8[3 * (20 * W + 30)] += 1;
    b.picture.codes8[3 * (30 * W + 50) + 1] -= 1;
    CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
    assert_true(r.agrees);
    assert_string_equal(r.tolerance.tier, "B");
    assert_false(compare(&a, &b, tolerance_identity(0), NULL).agrees);
    side_release(&a);
    side_release(&b);
}

static void tier_b_finds_one_segment_a_little_brighter(void **state)
{
    (void)state;
    Side a, b;
    Ledger ledger;
    side_init(&a, 0);
    side_init(&b, 0);
    /* A quarter of segment 85's pixels one level brighter: no pixel is off by more than a code. */
    for (int y = TOP; y < BOTTOM; y += 2)
        for (int x = 40; x < RIGHT; x += 2)
            b.picture.codes8[3 * (y * W + x)] += 1;
    CompareResult r = compare(&a, &b, tolerance_tolerant(0), &ledger);
    assert_false(r.agrees);
    const Rule *rule = rule_named(&r, "mean difference of a segment");
    assert_false(rule->met);
    assert_near(rule->measured, 0.25, 1e-12);
    assert_int_equal(rule->at.id_a, 85);
    assert_int_equal(ledger.n, 2);
    assert_int_equal(ledger.entries[0].id, 23);
    assert_int_equal(ledger.entries[0].differing, 0);
    assert_near(ledger.entries[0].gain, 1, 0);
    const LedgerEntry *entry = &ledger.entries[1];
    assert_int_equal(entry->area_a, 20 * 32);
    assert_int_equal(entry->common, 20 * 32);
    assert_int_equal(entry->differing, 160);
    assert_near(entry->signed_levels[0], 0.25, 1e-12);
    assert_near(entry->signed_levels[1], 0, 0);
    assert_true(entry->gain > 1 && entry->gain < 1.001);
    assert_near(entry->outline_px, 104 * 0.78539816339744831, 1e-9);
    assert_int_equal(entry->left, 40);
    assert_int_equal(entry->bottom, BOTTOM - 1);
    assert_int_equal(r.n_worst_segments, 1);
    assert_int_equal(r.worst_segments[0].id, 85);
    ledger_release(&ledger);
    side_release(&a);
    side_release(&b);
}

static void measures_by_how_much_an_outline_has_moved(void **state)
{
    (void)state;
    Side a, b;
    Ledger ledger;
    side_init(&a, 0);
    side_init(&b, 0);
    /* Segment 85 one column wider. */
    for (int y = TOP; y < BOTTOM; y++) {
        b.ids.ids[y * W + RIGHT] = 85;
        memset(&b.picture.codes8[3 * (y * W + RIGHT)], 99, 3);
    }
    CompareResult r = compare(&a, &b, tolerance_tolerant(0), &ledger);
    double outline = 2 * (40 + 32) * 0.78539816339744831;
    assert_near(r.values[MEASURE_SILHOUETTE_PX], 32 / outline, 1e-12);
    assert_near(ledger.entries[1].moved_px, 32 / (104 * 0.78539816339744831), 1e-12);
    assert_int_equal(r.values[MEASURE_EXTRA_PIXELS], 32);
    assert_false(rule_named(&r, "shift of the silhouette")->met);
    assert_false(rule_named(&r, "outline of a segment")->met);
    ledger_release(&ledger);
    side_release(&a);
    side_release(&b);
}

static void names_a_segment_that_is_gone(void **state)
{
    (void)state;
    Side a, b;
    side_init(&a, 0);
    side_init(&b, 0);
    for (int i = 0; i < W * H; i++)
        if (b.ids.ids[i] == 23)
            b.ids.ids[i] = 85;
    CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
    assert_int_equal(r.values[MEASURE_SEGMENTS], 2);
    assert_int_equal(r.values[MEASURE_SEGMENTS_MISSING], 1);
    assert_int_equal(r.places[PLACE_SEGMENT_MISSING].id_a, 23);
    assert_int_equal(r.places[PLACE_SEGMENT_MISSING].id_b, 0);
    assert_int_equal(r.classes[PIXEL_WRONG_SEGMENT] + r.classes[PIXEL_EDGE], 640);
    assert_non_null(strstr(r.reason, "segments seen in only one image"));
    side_release(&a);
    side_release(&b);
}

static void fits_gain_and_offset(void **state)
{
    (void)state;
    Side a, b;
    side_init(&a, 0);
    side_init(&b, 0);
    for (int i = 0; i < W * H * 3; i++)
        if (a.ids.ids[i / 3])
            b.picture.codes8[i] = (uint8_t)((a.picture.codes8[i] * 5) / 4 + 7);
    CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
    assert_true(fabs(r.values[MEASURE_GAIN] - 1.25) < 2e-3);
    assert_true(fabs(r.values[MEASURE_OFFSET_LEVELS] - 6.6) <
                0.3); /* the quotient is rounded down */
    assert_false(rule_named(&r, "gain")->met);
    assert_false(rule_named(&r, "offset")->met);
    side_release(&a);
    side_release(&b);
}

static void tells_geometry_from_shading_and_shadow(void **state)
{
    (void)state;
    Side a, b;
    side_init(&a, 0);
    side_init(&b, 0);
    int geometry = 20 * W + 30, tilt = 21 * W + 30, shading = 22 * W + 30, shadow = 23 * W + 30;
    b.depth.values[geometry] += 0.5f;
    b.normal.values[3 * tilt] = 0.01f;
    const int changed[] = {geometry, tilt, shading};
    for (int i = 0; i < 3; i++)
        b.picture.codes8[3 * changed[i]] += 9;
    memset(&b.picture.codes8[3 * shadow], 20, 3);
    b.picture.codes8[3 * (24 * W + 30)] += 1;
    CompareResult r = compare(&a, &b, tolerance_identity(0.01), NULL);
    assert_int_equal(r.classes[PIXEL_GEOMETRY], 2);
    assert_int_equal(r.classes[PIXEL_SHADING], 1);
    assert_int_equal(r.classes[PIXEL_SHADOW], 1);
    assert_int_equal(r.classes[PIXEL_ROUNDING], 1);
    assert_int_equal(r.classes[PIXEL_IDENTICAL], W * H - 5);
    side_release(&a);
    side_release(&b);
}

/* One side over one and a half times as bright. */
static void a_shadow_is_more_than_half_as_dark_again(void **state)
{
    (void)state;
    for (int dark = 0; dark < 2; dark++) {
        Side a, b;
        side_init(&a, 0);
        side_init(&b, 0);
        int pixel = 3 * (22 * W + 30); /* of codes 120, 121 and 122 */
        memcpy(&a.picture.codes8[pixel], (const uint8_t[]){90, 90, 90}, 3);
        memcpy(&b.picture.codes8[pixel], (const uint8_t[]){60, 60, dark ? 59 : 60}, 3);
        CompareResult r = compare(&a, &b, tolerance_identity(0.01), NULL);
        assert_int_equal(r.classes[dark ? PIXEL_SHADOW : PIXEL_SHADING], 1);
        side_release(&a);
        side_release(&b);
    }
}

/* Makes the pixels of a segment's first `n` in reading order one of another id. */
static void put_small(Side *side, int n, uint32_t id)
{
    for (int i = 0; i < n; i++)
        side->ids.ids[(TOP + 4 + i / 8) * W + LEFT + 4 + i % 8] = id;
}

/* What few pixels say is noise: a mean needs 64 pixels, an outline 8 of length, an absence 3
 * pixels. */
static void segments_too_small_to_judge_are_not_judged(void **state)
{
    (void)state;
    for (int n = 63; n <= 64; n++) {
        Side a, b;
        side_init(&a, 0);
        side_init(&b, 0);
        put_small(&a, n, 7);
        put_small(&b, n, 7);
        for (int i = 0; i < W * H; i++)
            if (b.ids.ids[i] == 7)
                b.picture.codes8[3 * i] += 5;
        CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
        assert_near(r.values[MEASURE_SEGMENT_LEVELS], n < 64 ? 0 : 5, 1e-12);
        side_release(&a);
        side_release(&b);
    }
    for (int n = 2; n <= 3; n++) {
        Side a, b;
        side_init(&a, 0);
        side_init(&b, 0);
        put_small(&a, n, 7);
        CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
        assert_int_equal(r.values[MEASURE_SEGMENTS_MISSING], n == 3);
        side_release(&a);
        side_release(&b);
    }
    /* Of 1 x 4 pixels the outline is 10 pi / 4 = 7.85 long, of 1 x 5 it is 9.42; another pixel
     * moves it. */
    for (int n = 4; n <= 5; n++) {
        Side a, b;
        side_init(&a, 0);
        side_init(&b, 0);
        put_small(&a, n, 7);
        put_small(&b, n + 1, 7);
        CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
        assert_int_equal(r.values[MEASURE_SEGMENT_PX] > 0.1, n == 5);
        side_release(&a);
        side_release(&b);
    }
}

static void sums_do_not_depend_on_where_the_bands_lie(void **state)
{
    (void)state;
    /* The same rows, once as they are and once five rows further down. */
    Side a[2], b[2];
    CompareResult r[2];
    for (int i = 0; i < 2; i++) {
        side_init(&a[i], 0);
        side_init(&b[i], 3);
        if (i == 0)
            continue;
        Side *sides[] = {&a[1], &b[1]};
        for (int k = 0; k < 2; k++) {
            memmove(sides[k]->picture.codes8 + 5 * 3 * W, sides[k]->picture.codes8,
                    (H - 5) * 3 * W);
            memmove(sides[k]->ids.ids + 5 * W, sides[k]->ids.ids, (H - 5) * W * 4);
            for (int p = 0; p < W * H; p++)
                sides[k]->depth.values[p] = sides[k]->ids.ids[p] ? 31.5f : INFINITY;
        }
    }
    for (int i = 0; i < 2; i++)
        r[i] = compare(&a[i], &b[i], tolerance_tolerant(0), NULL);
    assert_int_equal(r[0].values[MEASURE_DIFFERING_PIXELS], r[1].values[MEASURE_DIFFERING_PIXELS]);
    assert_int_equal(r[0].values[MEASURE_BAND_PIXELS], r[1].values[MEASURE_BAND_PIXELS]);
    assert_int_equal(r[0].places[PLACE_WORST].y + 5, r[1].places[PLACE_WORST].y);
    assert_near(r[0].values[MEASURE_RMSE], r[1].values[MEASURE_RMSE], 0);
    assert_near(r[0].values[MEASURE_GAIN], r[1].values[MEASURE_GAIN], 1e-15);
    assert_near(r[0].values[MEASURE_SILHOUETTE_PX], r[1].values[MEASURE_SILHOUETTE_PX], 0);
    for (int i = 0; i < 2; i++) {
        side_release(&a[i]);
        side_release(&b[i]);
    }
}

/* -------------------------------------------------------------------------------------- floats */

static void never_averages_in_what_is_not_finite(void **state)
{
    (void)state;
    Plane a, b;
    assert_int_equal(plane_init(&a, 20, 15, 3, &err), STATUS_OK);
    assert_int_equal(plane_init(&b, 20, 15, 3, &err), STATUS_OK);
    for (int i = 0; i < 900; i++)
        a.values[i] = b.values[i] = 0.001f * (float)i;
    b.values[3 * 7 + 1] = NAN;
    a.values[3 * 100] = INFINITY;
    b.values[3 * 100] = INFINITY;
    Tolerance tolerance = tolerance_none();
    CompareResult r;
    assert_int_equal(compare_colors(&(Rendering){.color = &a}, &(Rendering){.color = &b},
                                    &tolerance, true, &r, &err),
                     STATUS_OK);
    assert_int_equal(r.values[MEASURE_NAN_PIXELS], 3);
    assert_int_equal(r.places[PLACE_NAN].x, 7);
    assert_int_equal(r.values[MEASURE_JUDGED_PIXELS], 298);
    assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], 0);
    assert_near(r.values[MEASURE_RMSE], 0, 0);
    assert_near(r.values[MEASURE_HDR_FLIP_MEAN], 0, 0);
    assert_false(r.agrees);
    assert_non_null(strstr(r.reason, "colors that are not finite: 3 pixels"));
    plane_release(&a);
    plane_release(&b);
}

static void sees_differences_beyond_white_and_below_a_code(void **state)
{
    (void)state;
    Plane a, b;
    Tolerance tolerance = tolerance_identity(0);
    CompareResult r;
    assert_int_equal(plane_init(&a, 12, 12, 3, &err), STATUS_OK);
    assert_int_equal(plane_init(&b, 12, 12, 3, &err), STATUS_OK);
    for (int i = 0; i < 12 * 12 * 3; i++)
        a.values[i] = b.values[i] = 0.5f;
    a.values[30] = 5;
    b.values[30] = 5.5f;
    b.values[60] = nextafterf(0.5f, 1);
    assert_int_equal(compare_colors(&(Rendering){.color = &a}, &(Rendering){.color = &b},
                                    &tolerance, true, &r, &err),
                     STATUS_OK);
    assert_int_equal(r.values[MEASURE_DIFFERING_PIXELS], 2);
    assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], 1);
    assert_int_equal(r.places[PLACE_WORST].x, 10);
    assert_near(r.values[MEASURE_MAX_ABS], 255 * 1.055 * (pow(5.5, 1 / 2.4) - pow(5, 1 / 2.4)),
                1e-9);
    assert_true(r.values[MEASURE_HDR_FLIP_MEAN] > 0);
    tolerance.limits[LIMIT_COLOR_LEVELS] = 0;
    assert_int_equal(compare_colors(&(Rendering){.color = &a}, &(Rendering){.color = &b},
                                    &tolerance, false, &r, &err),
                     STATUS_OK);
    assert_int_equal(r.values[MEASURE_BEYOND_PIXELS], 2);
    plane_release(&a);
    plane_release(&b);
}

/* ---------------------------------------------------------------------------------- tolerances */

static Status read_text(Tolerance *tolerance, char **name, const char *text)
{
    assert_int_equal(file_write("build/tolerance_test.ini", text, strlen(text), &err), STATUS_OK);
    Status status = tolerance_read(tolerance, name, "build/tolerance_test.ini", &err);
    unlink("build/tolerance_test.ini");
    return status;
}

static void reads_limits_of_all_kinds(void **state)
{
    (void)state;
    Tolerance read = tolerance_tolerant(0.00251);
    char *name;
    assert_int_equal(read_text(&read, &name,
                               "tier = ours\ncolor_levels = 2.385\nband_ppm = inf\n"
                               "color_common_only = on\nregion_pixels = 17\n"
                               "segments_missing = inf\npixelmatch = 0.2\n"),
                     STATUS_OK);
    assert_string_equal(read.tier, "ours");
    assert_true(read.limits[LIMIT_COLOR_LEVELS] == 2.385 && isinf(read.limits[LIMIT_BAND_PPM]) &&
                read.limits[LIMIT_COLOR_COMMON_ONLY] == 1);
    assert_true(read.limits[LIMIT_REGION_PIXELS] == 17 &&
                isinf(read.limits[LIMIT_SEGMENTS_MISSING]));
    assert_true(read.limits[LIMIT_PIXELMATCH] == 0.2 && read.limits[LIMIT_DEPTH_P99_MM] == 0.00251);
    free(name);
}

static void names_of_tolerances_read_back_whatever_controls_they_hold(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"\x7f ours\x01", "ours"},
                                           {"our\ts of 7", "our s of 7"},
                                           {"ours\x1b;not", "ours"},
                                           {"\x02;not", ""},
                                           {"\xc2\x85our;s", "our;s"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Tolerance read = tolerance_none();
        Text text = TEXT_INIT;
        char *name;
        text_printf(&text, "tier = %s\n", cases[i][0]);
        for (int time = 0; time < 2; time++) {
            assert_int_equal(read_text(&read, &name, text.chars), STATUS_OK);
            assert_string_equal(name, cases[i][1]);
            text_release(&text);
            text_printf(&text, "tier = %s\n", name);
            free(name);
        }
        text_release(&text);
    }
}

static void says_which_line_of_a_tolerance_is_wrong(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence;
    } cases[] = {{"tier = mine\ncolor_pmm = 3\n", ":2: unknown limit 'color_pmm'"},
                 {"gain = -0.1\n", ":1: gain is '-0.1'; it must be a number of at least 0"},
                 {"\nregion_pixels = 2.5\n", ":2: region_pixels is '2.5'"},
                 {"color_common_only = yes\n", "it must be on or off"},
                 {"gain = nan\n", "gain is 'nan'"},
                 {"[color]\ngain = 1\n", "has no sections"},
                 {"gain\n", ":1: 'gain' is neither name = value"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Tolerance tolerance = tolerance_identity(0);
        char *name = NULL;
        assert_int_equal(read_text(&tolerance, &name, cases[i].text), STATUS_INPUT);
        if (!strstr(err.text, cases[i].sentence))
            fail_msg("\"%s\" lacks \"%s\"", err.text, cases[i].sentence);
        assert_null(name);
        assert_string_equal(tolerance.tier, "A");
    }
}

/* ------------------------------------------------------------------------------------ pictures */

static void shows_signed_differences_about_grey(void **state)
{
    (void)state;
    Picture a, b, shown;
    assert_int_equal(picture_init(&a, 5, 1, 1, 8, &err), STATUS_OK);
    assert_int_equal(picture_init(&b, 5, 1, 1, 8, &err), STATUS_OK);
    const uint8_t in_a[] = {50, 50, 50, 50, 50}, in_b[] = {50, 53, 48, 90, 10};
    const uint8_t wanted[] = {128, 152, 112, 255, 0};
    memcpy(a.codes8, in_a, 5);
    memcpy(b.codes8, in_b, 5);
    assert_int_equal(difference_picture(&shown, &a, &b, &err), STATUS_OK);
    assert_memory_equal(shown.codes8, wanted, 5);
    picture_release(&a);
    picture_release(&b);
    picture_release(&shown);
}

/* Counts the chunks of this type. */
static int count_chunks(const Text *png, const char *type)
{
    int count = 0;
    for (size_t at = 8; at + 12 <= png->length;) {
        const uint8_t *chunk = (const uint8_t *)png->chars + at;
        count += memcmp(chunk + 4, type, 4) == 0;
        at += 12 +
              ((size_t)chunk[0] << 24 | (size_t)chunk[1] << 16 | (size_t)chunk[2] << 8 | chunk[3]);
    }
    return count;
}

static void animates_two_pictures_in_one_png(void **state)
{
    (void)state;
    Side a, b;
    Text png = TEXT_INIT;
    Picture first;
    side_init(&a, 0);
    side_init(&b, 3);
    assert_int_equal(flicker_png(&a.picture, &b.picture, &png, &err), STATUS_OK);
    assert_int_equal(count_chunks(&png, "acTL"), 1);
    assert_int_equal(count_chunks(&png, "fcTL"), 2);
    assert_true(count_chunks(&png, "fdAT") >= 1);
    assert_int_equal(count_chunks(&png, "IEND"), 1);
    /* What readers that know no animations see is a test of compare's. */
    assert_int_equal(file_write("build/flicker.png", png.chars, png.length, &err), STATUS_OK);
    assert_int_equal(picture_read(&first, "build/flicker.png", ALPHA_REFUSED, &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "is an animation of 2 pictures"));
    unlink("build/flicker.png");
    text_release(&png);
    side_release(&a);
    side_release(&b);
}

static void writes_a_junit_case_for_each_rule(void **state)
{
    (void)state;
    Side a, b;
    Text xml = TEXT_INIT;
    side_init(&a, 0);
    side_init(&b, 1);
    CompareResult r = compare(&a, &b, tolerance_tolerant(0), NULL);
    compare_junit(&r, "a<b>.png", 0.25, &xml);
    int cases = 0, failures = 0;
    for (const char *at = xml.chars; (at = strstr(at, "<testcase ")); at++)
        cases++;
    for (const char *at = xml.chars; (at = strstr(at, "<failure ")); at++)
        failures++;
    assert_int_equal(cases, r.n_rules);
    assert_true(failures > 0 && failures <= cases);
    assert_non_null(strstr(xml.chars, "name=\"a&lt;b&gt;.png\""));
    text_release(&xml);
    side_release(&a);
    side_release(&b);
}

/* Pixel (30, 20) of B is of another segment, nearer, turned and darker. */
static void spoil_pixel(Side *side)
{
    int i = 20 * W + 30;
    side->ids.ids[i] = 85;
    side->depth.values[i] = 29;
    side->normal.values[3 * i] = 1;
    memset(&side->picture.codes8[3 * i], 3, 3);
}

static void no_limit_counts_a_settled_pixel(void **state)
{
    (void)state;
    for (int settled = 0; settled < 2; settled++) {
        Side a, b;
        CompareResult depth, normal, ids;
        uint8_t *marks = calloc(W * H, 1);
        assert_non_null(marks);
        side_init(&a, 0);
        side_init(&b, 0);
        spoil_pixel(&b);
        marks[20 * W + 30] = settled ? SETTLED_ROOT : SETTLED_NOT;
        Tolerance identity = tolerance_identity(1e-3);
        identity.settled = marks;
        CompareResult color = compare(&a, &b, identity, NULL);
        assert_int_equal(compare_planes(PLANE_DEPTH, &(Rendering){.depth = &a.depth, .ids = &a.ids},
                                        &(Rendering){.depth = &b.depth, .ids = &b.ids}, &identity,
                                        &depth, &err),
                         STATUS_OK);
        assert_int_equal(compare_planes(PLANE_NORMAL,
                                        &(Rendering){.normal = &a.normal, .ids = &a.ids},
                                        &(Rendering){.normal = &b.normal, .ids = &b.ids}, &identity,
                                        &normal, &err),
                         STATUS_OK);
        assert_int_equal(compare_ids(&a.ids, &b.ids, &identity, &ids, &err), STATUS_OK);
        assert_true(color.agrees == settled && depth.agrees == settled &&
                    normal.agrees == settled && ids.agrees == settled);
        assert_int_equal(color.values[MEASURE_DIFFERING_PIXELS], 1);
        assert_int_equal(ids.values[MEASURE_DIFFERING_PIXELS], 1);
        assert_int_equal(color.classes[PIXEL_SETTLED], settled);
        assert_int_equal(color.values[MEASURE_SETTLED_PIXELS], settled);
        free(marks);
        side_release(&a);
        side_release(&b);
    }
}

/* Marks tell one pixel from the next. */
static void a_settled_pixel_hides_no_other(void **state)
{
    (void)state;
    Side a, b;
    uint8_t *marks = calloc(W * H, 1);
    assert_non_null(marks);
    side_init(&a, 0);
    side_init(&b, 0);
    spoil_pixel(&b);
    marks[20 * W + 31] = SETTLED_ROOT;
    Tolerance identity = tolerance_identity(1e-3);
    identity.settled = marks;
    assert_false(compare(&a, &b, identity, NULL).agrees);
    free(marks);
    side_release(&a);
    side_release(&b);
}

static void tells_what_is_beyond_at_a_pixel(void **state)
{
    (void)state;
    Side a, b;
    side_init(&a, 0);
    side_init(&b, 0);
    size_t colored = 18 * W + 33, deeper = 19 * W + 33, turned = 21 * W + 33, gone = 22 * W + 33;
    b.picture.codes8[3 * colored + 1]++;
    b.depth.values[deeper] += 0.0013f;
    b.normal.values[3 * turned] = 0.0007f;
    b.ids.ids[gone] = 0;
    Tolerance identity = tolerance_identity(1e-3);
    Rendering of_a = rendering(&a), of_b = rendering(&b);
    assert_int_equal(pixel_beyond(&of_a, &of_b, colored, &identity), BEYOND_COLOR);
    assert_int_equal(pixel_beyond(&of_a, &of_b, deeper, &identity), BEYOND_GEOMETRY);
    assert_int_equal(pixel_beyond(&of_a, &of_b, turned, &identity), BEYOND_GEOMETRY);
    assert_int_equal(pixel_beyond(&of_a, &of_b, gone, &identity), BEYOND_GEOMETRY);
    assert_int_equal(pixel_beyond(&of_a, &of_b, 0, &identity), 0);
    side_release(&a);
    side_release(&b);
}

static void a_flood_of_settled_pixels_is_a_difference(void **state)
{
    (void)state;
    Settled settled;
    size_t pixels = 1000 * 1000;
    assert_int_equal(settled_init(&settled, pixels, SETTLED_ROOT, SETTLED_SHADOW_ROOT, &err),
                     STATUS_OK);
    size_t allowed = settled_allowed(&settled, SETTLED_ROOT);
    assert_int_equal(allowed, 40);
    for (size_t i = 0; i < allowed; i++) {
        const SettledPixel pixel = {.x = (int)i, .cause = SETTLED_ROOT};
        settled_note(&settled, i, &pixel);
    }
    settled_judge(&settled);
    assert_true(settled.agrees);
    const SettledPixel last = {.x = (int)allowed, .cause = SETTLED_ROOT};
    settled_note(&settled, allowed, &last);
    settled_judge(&settled);
    assert_false(settled.agrees);
    assert_string_equal(settled.reason, "settled: pixels at which POV-Ray missed a root: 41, at "
                                        "most 40 allowed");
    assert_int_equal(settled.n_first, SETTLED_LISTED);
    assert_int_equal(settled.marks[allowed], SETTLED_ROOT);
    settled_release(&settled);
}

/* Each cause that was looked for has its own limit, the first and the last one too. */
static void every_cause_of_settled_pixels_is_limited(void **state)
{
    (void)state;
    static const struct {
        SettledCause from, to, cause;
        size_t allowed;
    } cases[] = {{SETTLED_ROOT, SETTLED_SHADOW_ROOT, SETTLED_ROOT, 40},
                 {SETTLED_ROOT, SETTLED_SHADOW_ROOT, SETTLED_INEXACT_ROOT, 40},
                 {SETTLED_ROOT, SETTLED_SHADOW_ROOT, SETTLED_SHADOW_ROOT, 200},
                 {SETTLED_SHADOW_CACHE, SETTLED_SHADOW_CACHE, SETTLED_SHADOW_CACHE, 1000}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Settled settled;
        assert_int_equal(settled_init(&settled, 1000 * 1000, cases[i].from, cases[i].to, &err),
                         STATUS_OK);
        assert_int_equal(settled_allowed(&settled, cases[i].cause), cases[i].allowed);
        settled.count[SETTLED_NOT] = 5000; /* judged by the limits of the tolerance */
        settled.count[cases[i].cause] = cases[i].allowed;
        settled_judge(&settled);
        assert_true(settled.agrees);
        settled.count[cases[i].cause]++;
        settled_judge(&settled);
        assert_false(settled.agrees);
        assert_non_null(strstr(settled.reason, settled_cause_sentence(cases[i].cause)));
        settled_release(&settled);
    }
    Settled small;
    assert_int_equal(settled_init(&small, 100, SETTLED_ROOT, SETTLED_SHADOW_ROOT, &err), STATUS_OK);
    assert_int_equal(settled_allowed(&small, SETTLED_ROOT), 6);
    assert_int_equal(settled_allowed(&small, SETTLED_SHADOW_ROOT), 12);
    settled_release(&small);
}

/* What a comparison found that every limit of 10 allows. */
static CompareResult found_nothing(PlaneKind kind)
{
    static const IdPlane ids = {.width = 1000, .height = 1000};
    Tolerance tolerance = tolerance_none();
    for (Limit i = LIMIT_NAN + 1; i < LIMIT_COLOR_LEVELS; i++)
        tolerance.limits[i] = 10;
    tolerance.limits[LIMIT_COLOR_LEVELS] = 1;
    tolerance.limits[LIMIT_PIXELMATCH] = 0.1;
    CompareResult result = result_start(kind, 1000, 1000, &ids, &tolerance);
    for (MeasureId i = 0; i < MEASURES; i++)
        result.values[i] = isnan(result.values[i]) ? 0 : result.values[i];
    result.has_mask = true;
    result.values[MEASURE_BITS] = kind == PLANE_COLOR ? 8 : 32;
    result.values[MEASURE_BAND_PIXELS] = result.values[MEASURE_INTERIOR_PIXELS] = 500 * 1000;
    return result;
}

/* Each rule is broken by one finding that all other rules allow, upwards and downwards. */
static void each_rule_of_a_tolerance_refuses_what_no_other_does(void **state)
{
    (void)state;
    static const struct {
        PlaneKind kind;
        MeasureId id;
        double within, beyond;
    } cases[] = {
        {PLANE_COLOR, MEASURE_NOT_FINITE, 0, 1},
        {PLANE_COLOR, MEASURE_LARGEST_REGION, 10, 11},
        {PLANE_COLOR, MEASURE_SEGMENTS_MISSING, 10, 11},
        {PLANE_COLOR, MEASURE_SILHOUETTE_PX, 10, 10.1},
        {PLANE_COLOR, MEASURE_SILHOUETTE_PX, -10, -10.1},
        {PLANE_COLOR, MEASURE_BEYOND_PIXELS, 10, 11},
        {PLANE_COLOR, MEASURE_INTERIOR_MAX_ABS, 10, 10.1},
        {PLANE_COLOR, MEASURE_INTERIOR_BEYOND, 5, 6},
        {PLANE_COLOR, MEASURE_BAND_BEYOND, 5, 6},
        {PLANE_COLOR, MEASURE_SEGMENT_PX, 10, 10.1},
        {PLANE_COLOR, MEASURE_SEGMENT_LEVELS, 10, 10.1},
        {PLANE_COLOR, MEASURE_GAIN_EXCESS, 10, 10.1},
        {PLANE_COLOR, MEASURE_OFFSET_EXCESS, 10, 10.1},
        {PLANE_COLOR, MEASURE_BIAS_LEVELS, 10, 10.1},
        {PLANE_COLOR, MEASURE_BIAS_LEVELS, -10, -10.1},
        {PLANE_COLOR, MEASURE_SIGN_SIGMA, 10, 10.1},
        {PLANE_COLOR, MEASURE_SIGN_SIGMA, -10, -10.1},
        {PLANE_COLOR, MEASURE_PIXELMATCH_PIXELS, 10, 11},
        {PLANE_DEPTH, MEASURE_NAN_PIXELS, 0, 1},
        {PLANE_DEPTH, MEASURE_LARGEST_REGION, 10, 11},
        {PLANE_DEPTH, MEASURE_UNCOMMON_PIXELS, 10, 11},
        {PLANE_DEPTH, MEASURE_BEYOND_PIXELS, 10, 11},
        {PLANE_DEPTH, MEASURE_P99, 10, 10.1},
        {PLANE_DEPTH, MEASURE_P99_PART, 10, 10.1},
        {PLANE_NORMAL, MEASURE_NAN_PIXELS, 0, 1},
        {PLANE_NORMAL, MEASURE_UNCOMMON_PIXELS, 10, 11},
        {PLANE_NORMAL, MEASURE_BEYOND_PIXELS, 10, 11},
        {PLANE_NORMAL, MEASURE_MEDIAN, 10, 10.1},
        {PLANE_ID, MEASURE_BEYOND_PIXELS, 10, 11},
        {PLANE_ID, MEASURE_INTERIOR_BEYOND, 5, 6},
        {PLANE_ID, MEASURE_BAND_BEYOND, 5, 6},
        {PLANE_ID, MEASURE_LARGEST_REGION, 10, 11},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int beyond = 0; beyond < 2; beyond++) {
            CompareResult result = found_nothing(cases[i].kind);
            double value = beyond ? cases[i].beyond : cases[i].within;
            int broken = 0;
            result.values[cases[i].id] = value;
            result_finish(&result, NULL, NULL);
            for (int k = 0; k < result.n_rules; k++)
                broken += !result.rules[k].met;
            if (result.agrees == (beyond == 1) || broken != beyond)
                fail_msg("case %zu, %g: %d rules are broken: %s", i, value, broken, result.reason);
        }
}

int main(void)
{
    if (file_make_folder("build", &err) != STATUS_OK)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tier_b_agrees_with_what_single_precision_does),
        cmocka_unit_test(tier_b_finds_one_segment_a_little_brighter),
        cmocka_unit_test(measures_by_how_much_an_outline_has_moved),
        cmocka_unit_test(names_a_segment_that_is_gone),
        cmocka_unit_test(fits_gain_and_offset),
        cmocka_unit_test(tells_geometry_from_shading_and_shadow),
        cmocka_unit_test(a_shadow_is_more_than_half_as_dark_again),
        cmocka_unit_test(segments_too_small_to_judge_are_not_judged),
        cmocka_unit_test(sums_do_not_depend_on_where_the_bands_lie),
        cmocka_unit_test(never_averages_in_what_is_not_finite),
        cmocka_unit_test(sees_differences_beyond_white_and_below_a_code),
        cmocka_unit_test(reads_limits_of_all_kinds),
        cmocka_unit_test(names_of_tolerances_read_back_whatever_controls_they_hold),
        cmocka_unit_test(says_which_line_of_a_tolerance_is_wrong),
        cmocka_unit_test(shows_signed_differences_about_grey),
        cmocka_unit_test(animates_two_pictures_in_one_png),
        cmocka_unit_test(writes_a_junit_case_for_each_rule),
        cmocka_unit_test(no_limit_counts_a_settled_pixel),
        cmocka_unit_test(a_settled_pixel_hides_no_other),
        cmocka_unit_test(tells_what_is_beyond_at_a_pixel),
        cmocka_unit_test(a_flood_of_settled_pixels_is_a_difference),
        cmocka_unit_test(every_cause_of_settled_pixels_is_limited),
        cmocka_unit_test(each_rule_of_a_tolerance_refuses_what_no_other_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
