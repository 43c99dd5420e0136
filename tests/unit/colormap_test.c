/* The color of a value, compared with the published tables (matplotlib's; Crameri's as GMT has
 * them, in 8 bits) and with the sRGB standard (IEC 61966-2-1), computed by hand. */
#include "image/image.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <unistd.h>

static Err err;

static void read_map(Colormap *map, const char *path)
{
    assert_int_equal(colormap_read(map, path, &err), STATUS_OK);
}

static void read_text(Colormap *map, const char *text)
{
    assert_int_equal(file_write("build/colormap_test.in", text, strlen(text), &err), STATUS_OK);
    read_map(map, "build/colormap_test.in");
    unlink("build/colormap_test.in");
}

static void assert_rgb(const float rgb[3], double r, double g, double b)
{
    assert_float_equal(rgb[0], r, 1e-6);
    assert_float_equal(rgb[1], g, 1e-6);
    assert_float_equal(rgb[2], b, 1e-6);
}

static void decodes_srgb_as_the_standard_says(void **state)
{
    (void)state;
    assert_float_equal(srgb_decode(0), 0, 0);
    assert_float_equal(srgb_decode(0.04f), 0.0030959752, 1e-9);
    assert_float_equal(srgb_decode(0.041f), 0.0031742787, 1e-9);
    assert_float_equal(srgb_decode(0.25f), 0.050876088, 1e-8);
    assert_float_equal(srgb_decode(0.5f), 0.21404114, 1e-7);
    assert_float_equal(srgb_decode(0.75f), 0.52252155, 1e-7);
    assert_float_equal(srgb_decode(1), 1, 0);
}

static void ships_the_published_tables(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        double low[3], quarter[3], middle[3], high[3]; /* entries 0, 64, 128 and 255 */
    } maps[] = {
        {"templates/colormaps/viridis.txt",
         {0.267004, 0.004874, 0.329415},
         {0.229739, 0.322361, 0.545706},
         {0.127568, 0.566949, 0.550556},
         {0.993248, 0.906157, 0.143936}},
        {"templates/colormaps/magma.txt",
         {0.001462, 0.000466, 0.013866},
         {0.316654, 0.071690, 0.485380},
         {0.716387, 0.214982, 0.475290},
         {0.987053, 0.991438, 0.749504}},
        {"templates/colormaps/inferno.txt",
         {0.001462, 0.000466, 0.013866},
         {0.341500, 0.062325, 0.429425},
         {0.735683, 0.215906, 0.330245},
         {0.988362, 0.998364, 0.644924}},
        {"templates/colormaps/plasma.txt",
         {0.050383, 0.029803, 0.527975},
         {0.494877, 0.011990, 0.657865},
         {0.798216, 0.280197, 0.469538},
         {0.940015, 0.975158, 0.131326}},
        {"templates/colormaps/cividis.txt",
         {0.000000, 0.135112, 0.304751},
         {0.263738, 0.307831, 0.422789},
         {0.488697, 0.485318, 0.471008},
         {0.995737, 0.909344, 0.217772}},
        {"templates/colormaps/batlow.txt",
         {1 / 255.0, 25 / 255.0, 89 / 255.0},
         {34 / 255.0, 96 / 255.0, 97 / 255.0},
         {130 / 255.0, 130 / 255.0, 49 / 255.0},
         {250 / 255.0, 204 / 255.0, 250 / 255.0}},
        {"templates/colormaps/vik.txt",
         {0, 18 / 255.0, 97 / 255.0},
         {48 / 255.0, 125 / 255.0, 166 / 255.0},
         {236 / 255.0, 229 / 255.0, 224 / 255.0},
         {89 / 255.0, 0, 8 / 255.0}},
        {"templates/colormaps/romaO.txt",
         {115 / 255.0, 57 / 255.0, 87 / 255.0},
         {170 / 255.0, 117 / 255.0, 47 / 255.0},
         {203 / 255.0, 225 / 255.0, 179 / 255.0},
         {114 / 255.0, 57 / 255.0, 89 / 255.0}},
    };
    for (size_t m = 0; m < sizeof maps / sizeof *maps; m++) {
        Colormap map;
        read_map(&map, maps[m].path);
        assert_int_equal(map.n, 256);
        assert_rgb(map.srgb[0], maps[m].low[0], maps[m].low[1], maps[m].low[2]);
        assert_rgb(map.srgb[64], maps[m].quarter[0], maps[m].quarter[1], maps[m].quarter[2]);
        assert_rgb(map.srgb[128], maps[m].middle[0], maps[m].middle[1], maps[m].middle[2]);
        assert_rgb(map.srgb[255], maps[m].high[0], maps[m].high[1], maps[m].high[2]);
        colormap_release(&map);
    }
}

/* A quarter of the way lies at 63.75 of the entries 63 (0.231674 0.318106 0.544834) and 64, the
 * middle at 127.5 of 127 (0.128729 0.563265 0.551229) and 128. */
static void takes_a_fraction_to_its_place_in_the_table(void **state)
{
    (void)state;
    Colormap map;
    read_map(&map, "templates/colormaps/viridis.txt");
    float rgb[3];
    colormap_linear(&map, 0, rgb);
    assert_rgb(rgb, 0.05795103, 0.0003772446, 0.08865738);
    colormap_linear(&map, 0.25, rgb);
    assert_rgb(rgb, 0.043314777, 0.08423035, 0.2585857);
    colormap_linear(&map, 0.5, rgb);
    assert_rgb(rgb, 0.014959676, 0.27932771, 0.26420649);
    colormap_linear(&map, 1, rgb);
    assert_rgb(rgb, 0.9847088, 0.799651, 0.01824342);
    colormap_release(&map);
}

static void mixes_neighbours_as_they_are_encoded(void **state)
{
    (void)state;
    Colormap map;
    read_text(&map, "# three\n0.1 0.2 0\n0.4 1 0\n0.9 0 1\n");
    float rgb[3];
    colormap_linear(&map, 0.75, rgb); /* 0.65 0.5 0.5 */
    assert_rgb(rgb, 0.38005634, 0.21404114, 0.21404114);
    colormap_linear(&map, 0.125, rgb); /* 0.175 0.4 0 */
    assert_rgb(rgb, 0.02584288, 0.13286832, 0);
    colormap_release(&map);
}

static void stays_at_the_ends_and_takes_what_is_no_number_for_middle_grey(void **state)
{
    (void)state;
    Colormap map;
    read_text(&map, "0.25 0.5 0.75\n0.75 0.25 0.5\n");
    float rgb[3];
    colormap_linear(&map, -2.385, rgb);
    assert_rgb(rgb, 0.050876088, 0.21404114, 0.52252155);
    colormap_linear(&map, INFINITY, rgb);
    assert_rgb(rgb, 0.52252155, 0.050876088, 0.21404114);
    colormap_linear(&map, NAN, rgb);
    assert_rgb(rgb, 0.21404114, 0.21404114, 0.21404114);
    colormap_release(&map);
}

/* From black to white in codes, so that the code is the place on the map. */
static ColorScale ramp(bool log, int classes, double low, double high)
{
    ColorScale scale = {.range = {low, high}, .log = log, .classes = classes};
    read_text(&scale.map, "0 0 0\n1 1 1\n");
    return scale;
}

static void assert_place(const ColorScale *scale, double value, double place)
{
    float rgb[3];
    colorscale_linear(scale, value, rgb);
    double linear = (double)srgb_decode((float)place);
    assert_rgb(rgb, linear, linear, linear);
}

static void a_scale_is_linear_in_values_or_in_their_logarithms(void **state)
{
    (void)state;
    ColorScale scale = ramp(false, 0, -2.5, 7.5), log = ramp(true, 0, 0.25, 64);
    assert_place(&scale, 0, 0.25);
    assert_place(&scale, 7.5, 1);
    assert_place(&scale, -99, 0);
    assert_place(&log, 0.25, 0);
    assert_place(&log, 4, 0.5);
    assert_place(&log, 16, 0.75);
    assert_place(&log, 0, 0.5); /* cannot be shown: grey */
    assert_place(&log, NAN, 0.5);
    colormap_release(&scale.map);
    colormap_release(&log.map);
}

static void classes_are_equal_steps_that_use_the_whole_map(void **state)
{
    (void)state;
    ColorScale scale = ramp(false, 5, 0, 10);
    const struct {
        double value, place;
    } cases[] = {{-1, 0}, {0, 0}, {1.99, 0}, {2, 0.25}, {5, 0.5}, {7.99, 0.75}, {8, 1}, {99, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_place(&scale, cases[i].value, cases[i].place);
    assert_place(&scale, NAN, 0.5);
    colormap_release(&scale.map);
}

static void a_scale_is_fitted_to_what_it_can_show(void **state)
{
    (void)state;
    const double values[] = {(double)NAN, -3, 0, 2.385, (double)INFINITY, 0.5};
    ColorScale scale = {.range = {7, 8}};
    assert_true(colorscale_fit(&scale, values, 6));
    assert_true(scale.range[0] == -3 && scale.range[1] == 2.385);
    scale.log = true;
    assert_true(colorscale_fit(&scale, values, 6));
    assert_true(scale.range[0] == 0.5 && scale.range[1] == 2.385);
    assert_false(colorscale_fit(&scale, values, 3));
    assert_true(scale.range[0] == 0.5 && scale.range[1] == 2.385);
}

static void ships_colors_that_are_separate(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        size_t n;
        int first[3], last[3]; /* 8-bit codes */
    } maps[] = {
        {"templates/colormaps/Set1.txt", 9, {228, 26, 28}, {153, 153, 153}},
        {"templates/colormaps/Set2.txt", 8, {102, 194, 165}, {179, 179, 179}},
        {"templates/colormaps/Dark2.txt", 8, {27, 158, 119}, {102, 102, 102}},
        {"templates/colormaps/Paired.txt", 12, {166, 206, 227}, {177, 89, 40}},
    };
    for (size_t m = 0; m < sizeof maps / sizeof *maps; m++) {
        Colormap map;
        read_map(&map, maps[m].path);
        assert_true(map.separate);
        assert_int_equal(map.n, maps[m].n);
        const int *first = maps[m].first, *last = maps[m].last;
        assert_rgb(map.srgb[0], first[0] / 255.0, first[1] / 255.0, first[2] / 255.0);
        assert_rgb(map.srgb[map.n - 1], last[0] / 255.0, last[1] / 255.0, last[2] / 255.0);
        colormap_release(&map);
    }
}

static void a_map_is_separate_by_a_line_before_its_colors(void **state)
{
    (void)state;
    Colormap map;
    read_text(&map, "# three\nseparate \n0.25 0.5 0.75\n1 0 0\n0 0 1\n");
    assert_true(map.separate);
    float rgb[3];
    colormap_color(&map, 3, rgb);
    assert_rgb(rgb, 0.050876088, 0.21404114, 0.52252155);
    colormap_release(&map);
    const char *late = "0.25 0.5 0.75\nseparate\n1 0 0\n";
    assert_int_equal(file_write("build/colormap_test.in", late, strlen(late), &err), STATUS_OK);
    assert_int_equal(colormap_read(&map, "build/colormap_test.in", &err), STATUS_INPUT);
    assert_non_null(strstr(err.text, "colormap_test.in:2: "));
    unlink("build/colormap_test.in");
}

static void bounds_part_classes_that_are_open_at_both_ends(void **state)
{
    (void)state;
    ColorScale scale = ramp(false, 0, 0.1, 54.1);
    scale.bounds[0] = 0.4;
    scale.bounds[1] = 1;
    scale.bounds[2] = 2.5;
    scale.n_bounds = 3;
    assert_int_equal(colorscale_steps(&scale), 4);
    const struct {
        double value, place;
    } cases[] = {{-7, 0},      {0.39, 0},       {0.4, 1 / 3.0}, {0.99, 1 / 3.0},
                 {1, 2 / 3.0}, {2.49, 2 / 3.0}, {2.5, 1},       {99, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_place(&scale, cases[i].value, cases[i].place);
    colormap_release(&scale.map);
}

/* A mean of places that are all on a bound is rounded to either side of the bound. */
static void a_value_on_a_bound_may_be_rounded_to_either_side(void **state)
{
    (void)state;
    const double rounded = 1e-15, too_low = 1e-4;
    ColorScale ranges[] = {ramp(false, 3, 2, 5), ramp(true, 3, 2, 16)};
    ColorScale bounds = ramp(false, 0, 2, 5), one = ramp(false, 0, 3e-9, 3e-9);
    for (int i = 0; i < 2; i++) {
        assert_place(&ranges[i], ranges[i].log ? 4 - rounded : 3 - rounded, 0.5);
        assert_place(&ranges[i], ranges[i].log ? 4 - too_low : 3 - too_low, 0);
        ranges[i].over = ranges[i].under = (ScaleColor){true, {0.25f, 0.25f, 0.25f}};
        assert_place(&ranges[i], ranges[i].range[0] - rounded, 0);
        assert_place(&ranges[i], ranges[i].range[1] * (1 + rounded), 1);
        const double outside[] = {2 - too_low, 2 - rounded, 16 * (1 + rounded), 16 + too_low};
        assert_int_equal(colorscale_outside(&ranges[i], outside, 4).below, 1);
        assert_int_equal(colorscale_outside(&ranges[i], outside, 4).above, ranges[i].log ? 1 : 2);
        colormap_release(&ranges[i].map);
    }
    bounds.bounds[0] = 2.1;
    bounds.bounds[1] = 4.7;
    one.bounds[0] = 3e-9;
    one.bounds[1] = 4e-9;
    bounds.n_bounds = one.n_bounds = 2;
    assert_place(&bounds, 2.1 - rounded, 0.5);
    assert_place(&bounds, 2.1 - too_low, 0);
    assert_place(&bounds, 4.7 - rounded, 1);
    assert_place(&bounds, 4.7 - too_low, 0.5);
    assert_place(&one, 2.9e-9, 0);
    assert_place(&one, 3e-9, 0.5);
    assert_place(&one, 3.9e-9, 0.5);
    colormap_release(&bounds.map);
    colormap_release(&one.map);
}

/* A ramp of 256 entries, between which the mixture is linear and not of codes. */
static void a_ramp_has_the_colors_of_the_map(void **state)
{
    (void)state;
    ColorScale scale = ramp(false, 0, 2, 4);
    ColorRamp on;
    colorramp_init(&on, &scale.map);
    float rgb[3];
    for (int i = 0; i <= 51; i++) {
        colorscale_on_ramp(&scale, &on, i / 51.0, rgb);
        double linear = (double)srgb_decode((float)(i / 51.0));
        assert_rgb(rgb, linear, linear, linear);
    }
    colorscale_on_ramp(&scale, &on, 127.5 / 255, rgb);
    double middle = ((double)srgb_decode(127 / 255.0f) + (double)srgb_decode(128 / 255.0f)) / 2;
    assert_rgb(rgb, middle, middle, middle);
    colorscale_on_ramp(&scale, &on, -2.385, rgb);
    assert_rgb(rgb, 0, 0, 0);
    colorscale_on_ramp(&scale, &on, (double)NAN, rgb);
    assert_rgb(rgb, 0.21404114, 0.21404114, 0.21404114);
    scale.over = (ScaleColor){true, {0, 1, 0.5f}};
    colorscale_on_ramp(&scale, &on, 1.001, rgb);
    assert_rgb(rgb, 0, 1, 0.5);
    scale.classes = 3;
    colorscale_on_ramp(&scale, &on, 0.6, rgb);
    assert_rgb(rgb, 0.21404114, 0.21404114, 0.21404114);
    colormap_release(&scale.map);
}

static void whole_numbers_count_separate_colors_round_and_round(void **state)
{
    (void)state;
    ColorScale scale = ramp(false, 0, 1, 7);
    scale.map.separate = true;
    assert_true(colorscale_selects_by_integer(&scale));
    assert_place(&scale, 1, 0);
    assert_place(&scale, 2, 1);
    assert_place(&scale, 7, 0);
    assert_place(&scale, 0, 1);
    assert_place(&scale, -1, 0);
    assert_place(&scale, NAN, 0.5);
    scale.classes = 7; /* of which the third has the first color again */
    assert_false(colorscale_selects_by_integer(&scale));
    assert_place(&scale, 3.2, 0);
    colormap_release(&scale.map);
}

static void values_outside_may_have_colors_of_their_own(void **state)
{
    (void)state;
    ColorScale scale = ramp(false, 0, 2.5, 7.5);
    scale.under = (ScaleColor){true, {1, 0, 0.25f}};
    scale.over = (ScaleColor){true, {0, 1, 0.5f}};
    scale.none = (ScaleColor){true, {0.125f, 0, 1}};
    float rgb[3];
    colorscale_linear(&scale, 2.49, rgb);
    assert_rgb(rgb, 1, 0, 0.25);
    colorscale_linear(&scale, 7.51, rgb);
    assert_rgb(rgb, 0, 1, 0.5);
    colorscale_linear(&scale, (double)NAN, rgb);
    assert_rgb(rgb, 0.125, 0, 1);
    assert_place(&scale, 2.5, 0);
    assert_place(&scale, 7.5, 1);
    const double values[] = {2.49, 2.5, 7.5, 8, 9, (double)NAN};
    ScaleOutside outside = colorscale_outside(&scale, values, 6);
    assert_int_equal(outside.below, 1);
    assert_int_equal(outside.above, 2);
    assert_int_equal(outside.none, 1);
    colormap_release(&scale.map);
}

static void percentiles_lie_between_neighbours_in_order(void **state)
{
    (void)state;
    const double values[] = {9, (double)NAN, 1, 4, -3, 16};
    ColorScale scale = {.range = {0, 1}};
    double out[2];
    const double ends[] = {0, 100}, between[] = {12.5, 90};
    assert_int_equal(colorscale_percentiles(&scale, values, 6, ends, out, &err), STATUS_OK);
    assert_true(out[0] == -3 && out[1] == 16);
    assert_int_equal(colorscale_percentiles(&scale, values, 6, between, out, &err), STATUS_OK);
    assert_float_equal(out[0], -1, 1e-12);
    assert_float_equal(out[1], 13.2, 1e-12);
    scale.log = true;
    assert_int_equal(colorscale_percentiles(&scale, values, 6, ends, out, &err), STATUS_OK);
    assert_true(out[0] == 1 && out[1] == 16);
    assert_int_equal(colorscale_percentiles(&scale, values + 1, 1, ends, out, &err), STATUS_OK);
    assert_true(isnan(out[0]) && isnan(out[1]));
}

static void a_range_is_said_in_three_digits(void **state)
{
    (void)state;
    static const struct {
        double low, high;
        const char *unit, *said;
    } cases[] = {{3.7002, 54.13, "Pa", "wss 3.70 to 54.1 Pa"},
                 {0.25, 267.69, "Pa", "wss 0.250 to 268 Pa"},
                 {0, 57, "", "wss 0 to 57"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const ColorScale scale = {
            .name = "wss", .unit = cases[i].unit, .range = {cases[i].low, cases[i].high}};
        Text text = TEXT_INIT;
        colorscale_put_range(&scale, &text);
        assert_string_equal(text_chars(&text), cases[i].said);
        text_release(&text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decodes_srgb_as_the_standard_says),
        cmocka_unit_test(ships_the_published_tables),
        cmocka_unit_test(ships_colors_that_are_separate),
        cmocka_unit_test(a_map_is_separate_by_a_line_before_its_colors),
        cmocka_unit_test(takes_a_fraction_to_its_place_in_the_table),
        cmocka_unit_test(mixes_neighbours_as_they_are_encoded),
        cmocka_unit_test(stays_at_the_ends_and_takes_what_is_no_number_for_middle_grey),
        cmocka_unit_test(a_scale_is_linear_in_values_or_in_their_logarithms),
        cmocka_unit_test(classes_are_equal_steps_that_use_the_whole_map),
        cmocka_unit_test(bounds_part_classes_that_are_open_at_both_ends),
        cmocka_unit_test(a_value_on_a_bound_may_be_rounded_to_either_side),
        cmocka_unit_test(a_ramp_has_the_colors_of_the_map),
        cmocka_unit_test(whole_numbers_count_separate_colors_round_and_round),
        cmocka_unit_test(values_outside_may_have_colors_of_their_own),
        cmocka_unit_test(percentiles_lie_between_neighbours_in_order),
        cmocka_unit_test(a_range_is_said_in_three_digits),
        cmocka_unit_test(a_scale_is_fitted_to_what_it_can_show),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
