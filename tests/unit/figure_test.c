/* Pages: round numbers, legends, letters, and pixels that do not depend on the part that is
 * drawn. */
#include "figure/figure.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static FigureFonts *fonts;

static int load_fonts(void **state)
{
    Err err;
    (void)state;
    return figurefonts_load("templates", &fonts, &err) != STATUS_OK;
}

static int free_fonts(void **state)
{
    (void)state;
    figurefonts_free(fonts);
    return 0;
}

/* ---- ticks ----------------------------------------------------------------------------------- */

static void expect_ticks(double low, double high, bool log, bool whole, int most,
                         const double *expected, int n)
{
    const ColorScale scale = {.range = {low, high}, .log = log};
    double ticks[FIGURE_TICKS];
    assert_int_equal(figure_ticks(&scale, most, whole, ticks), n);
    for (int i = 0; i < n; i++)
        assert_true(fabs(ticks[i] - expected[i]) <= 1e-12 * fabs(expected[i]));
}

#define EXPECT_TICKS(low, high, log, whole, most, ...)                                             \
    expect_ticks(low, high, log, whole, most, (const double[]){__VA_ARGS__},                       \
                 (int)(sizeof(double[]){__VA_ARGS__} / sizeof(double)))

static void ticks_are_round_numbers_within_the_range(void **state)
{
    (void)state;
    EXPECT_TICKS(7.55, 49.8, false, false, 5, 10, 20, 30, 40);
    EXPECT_TICKS(-0.31, 0.47, false, false, 4, -0.2, 0, 0.2, 0.4);
    EXPECT_TICKS(0, 1, false, false, 5, 0, 0.2, 0.4, 0.6, 0.8, 1);
    EXPECT_TICKS(60.02, 98.8, false, false, 3, 70, 80, 90);
    EXPECT_TICKS(201, 993, false, false, 3, 400, 600, 800);
    EXPECT_TICKS(201, 993, false, false, 1, 500);
    EXPECT_TICKS(2.5e7, 9.9e7, false, false, 4, 4e7, 6e7, 8e7);
    EXPECT_TICKS(0, 27, false, false, 6, 0, 5, 10, 15, 20, 25);
    EXPECT_TICKS(-0.06, 0.11, false, false, 4, -0.05, 0, 0.05, 0.1);
    EXPECT_TICKS(0, 13, false, false, 7, 0, 2, 4, 6, 8, 10, 12);
    EXPECT_TICKS(300, 1500, false, true, 3, 500, 1000, 1500);
}

static void ticks_of_a_logarithm_are_powers_of_ten_where_there_are_two(void **state)
{
    (void)state;
    EXPECT_TICKS(0.5, 500, true, false, 6, 1, 10, 100);
    EXPECT_TICKS(3e-9, 2e6, true, false, 5, 1e-6, 1e-3, 1, 1e3, 1e6);
    EXPECT_TICKS(4.3, 38, true, false, 6, 5, 10, 20);
    EXPECT_TICKS(21, 29, true, false, 4, 22, 24, 26, 28);
    EXPECT_TICKS(0.7, 300, true, false, 6, 1, 10, 100);
    EXPECT_TICKS(0.9, 60, true, false, 6, 1, 2, 5, 10, 20, 50);
    EXPECT_TICKS(2, 90, true, false, 5, 2, 5, 10, 20, 50);
    EXPECT_TICKS(0.05, 2.5, true, false, 5, 0.05, 0.1, 0.2, 0.5, 1, 2);
    EXPECT_TICKS(1e-2, 1e7, true, false, 5, 1e-2, 1, 1e2, 1e4, 1e6);
    EXPECT_TICKS(1, 1e4, true, false, 5, 1, 10, 100, 1e3, 1e4);
}

static void ticks_of_whole_numbers_are_whole(void **state)
{
    (void)state;
    EXPECT_TICKS(1, 4, false, true, 8, 1, 2, 3, 4);
    EXPECT_TICKS(1, 2, false, false, 8, 1, 1.2, 1.4, 1.6, 1.8, 2);
    EXPECT_TICKS(5.5, 5.5, false, false, 8, 5.5);
}

/* ---- text ------------------------------------------------------------------------------------ */

static void a_line_is_as_wide_as_its_letters_moved_together(void **state)
{
    (void)state;
    double a = figure_text_width(fonts, "A", 12, false),
           v = figure_text_width(fonts, "V", 12, false);
    double both = figure_text_width(fonts, "AV", 12, false);
    /* Arial's A and V are 0.667 of the size wide, and a pair of them 0.074 narrower. */
    assert_true(fabs(a - 0.667 * 12 * MM_PER_POINT) < 0.002);
    assert_true(fabs(a + v - both - 0.074 * 12 * MM_PER_POINT) < 0.002);
    assert_true(figure_text_width(fonts, "AV", 12, true) > both);
}

/* U+221D is in DejaVu Sans alone, U+65E5 in no font; each letter is listed once. */
static void a_letter_that_liberation_sans_lacks_is_listed(void **state)
{
    FigurePage page;
    Err err;
    (void)state;
    figure_init(&page, 30, 20, 300, fonts);
    figure_add_text(&page, &(FigureText){.text = "\xC2\xB5m \xE2\x88\x92\xC2\xB2\xE2\x82\x84"
                                                 "\xE2\x81\xBB\xE2\x81\xB0",
                                         .size_pt = 7});
    assert_int_equal(page.missing.n_boxed + page.missing.n_fallback, 0);
    for (int i = 0; i < 2; i++)
        figure_add_text(
            &page, &(FigureText){.text = "m\xE2\x88\x9D\xC2\xB2 a\xE6\x97\xA5z", .size_pt = 7});
    assert_int_equal(figure_check(&page, &err), STATUS_OK);
    assert_int_equal(page.missing.n_boxed, 1);
    assert_int_equal(page.missing.boxed[0], 0x65e5);
    assert_int_equal(page.missing.n_fallback, 1);
    assert_int_equal(page.missing.fallback[0], 0x221d);
    figure_release(&page);
}

/* The rows of a page of 300 dpi that a text of 20 points, whose line is at 10 mm, has ink in. */
static void rows_with_ink(const char *text, int *top, int *bottom)
{
    FigurePage page;
    Picture picture;
    Err err;
    figure_init(&page, 20, 16, 300, fonts);
    figure_add_text(&page, &(FigureText){.text = text, .x = 5, .y = 10, .size_pt = 20});
    assert_int_equal(picture_init(&picture, 236, 189, 3, 8, &err), STATUS_OK);
    memset(picture.codes8, 255, (size_t)picture.height * picture_stride(&picture));
    assert_int_equal(figure_draw(&page, 0, &picture, &err), STATUS_OK);
    *top = picture.height;
    *bottom = -1;
    for (int y = 0; y < picture.height; y++)
        for (size_t i = 0; i < picture_stride(&picture); i++)
            if (picture.codes8[(size_t)y * picture_stride(&picture) + i] < 128) {
                *top = *top < y ? *top : y;
                *bottom = y;
            }
    picture_release(&picture);
    figure_release(&page);
}

static double width_of(const char *text)
{
    return figure_text_width(fonts, text, 10, false);
}

/* Draws a text into a new picture of 236 x 189 pixels. Release it with picture_release. */
static void draw_line(const char *text, Picture *picture)
{
    FigurePage page;
    Err err;
    figure_init(&page, 20, 16, 300, fonts);
    figure_add_text(&page, &(FigureText){.text = text, .x = 1, .y = 10, .size_pt = 20});
    assert_int_equal(picture_init(picture, 236, 189, 3, 8, &err), STATUS_OK);
    memset(picture->codes8, 255, (size_t)picture->height * picture_stride(picture));
    assert_int_equal(figure_draw(&page, 0, picture, &err), STATUS_OK);
    figure_release(&page);
}

static void expect_same_drawing(const char *a, const char *b)
{
    Picture one, other;
    draw_line(a, &one);
    draw_line(b, &other);
    assert_memory_equal(one.codes8, other.codes8, (size_t)one.height * picture_stride(&one));
    picture_release(&one);
    picture_release(&other);
}

static void superscripts_of_unicode_are_drawn_as_groups(void **state)
{
    (void)state;
    expect_same_drawing("m\xE2\x81\xBB\xC2\xB2 4\xE2\x81\xB0", "m^{-2} 4^{0}");
    expect_same_drawing("O^{2-}_{a-b}", "O^{2\xE2\x88\x92}_{a-b}");
    expect_same_drawing("H\xE2\x82\x82\xE2\x82\x99", "H_{2n}");
    assert_true(fabs(width_of("^{44}") - 0.7 * width_of("44")) < 1e-9);
    assert_true(fabs(width_of("x_{i_{j}}") - width_of("x") - 0.7 * width_of("i") -
                     0.5 * width_of("j")) < 1e-9);
}

/* A superscript's digits begin above half of a capital's height and end above the capital. */
static void groups_are_raised_and_lowered(void **state)
{
    int top[3], bottom[3];
    (void)state;
    rows_with_ink("4", &top[0], &bottom[0]);
    rows_with_ink("^{4}", &top[1], &bottom[1]);
    rows_with_ink("_{4}", &top[2], &bottom[2]);
    assert_true(top[1] < top[0] && bottom[1] < bottom[0] - (bottom[0] - top[0]) / 3);
    assert_true(bottom[2] > bottom[0] && top[2] > top[0] + (bottom[0] - top[0]) / 3);
}

static void a_star_is_a_star_where_none_matches_it(void **state)
{
    static const char *const literal[][2] = {{"P*", "P\\*"},
                                             {"2 * 3 * x", "2 \\* 3 \\* x"},
                                             {"a *b", "a \\*b"},
                                             {"_ ^ } {x} \\", "\\_ \\^ \\} \\{x\\} \\\\"},
                                             {"_{}^{}a", "a"}};
    (void)state;
    for (size_t i = 0; i < sizeof literal / sizeof *literal; i++)
        expect_same_drawing(literal[i][0], literal[i][1]);
    assert_true(width_of("*ab*") == width_of("*a**b*"));
    assert_true(width_of("*r*") < width_of("r**"));
}

/* Unclosed, nested without end, with bytes that are not UTF-8: each is drawn, and takes linear
 * time. */
static void broken_markup_is_drawn_and_noted(void **state)
{
    enum { LONG = 200000 };
    static const char *const parts[] = {"_{", "*a ", "^{x", "}", "\xC2", "\\", "a*"};
    FigurePage page;
    Err err;
    (void)state;
    figure_init(&page, 30, 20, 300, fonts);
    figure_add_text(&page, &(FigureText){.text = "\xCF\x84_{w} \\_{", .size_pt = 7});
    assert_null(page.unclosed);
    figure_add_text(&page, &(FigureText){.text = "\xCF\x84_{w", .size_pt = 7});
    assert_string_equal(page.unclosed, "\xCF\x84_{w");
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        char *text = calloc(LONG, 4);
        assert_non_null(text);
        for (size_t i = 0; i < LONG; i++)
            memcpy(text + i * strlen(parts[k]), parts[k], strlen(parts[k]));
        figure_add_text(&page, &(FigureText){.text = text, .size_pt = 7});
        free(text);
    }
    assert_int_equal(figure_check(&page, &err), STATUS_OK);
    figure_release(&page);
}

static void text_stands_where_its_alignment_says(void **state)
{
    static const FigureAlign aligns[] = {ALIGN_LEFT, ALIGN_CENTER, ALIGN_RIGHT};
    FigurePage page;
    (void)state;
    figure_init(&page, 30, 20, 300, fonts);
    double width = figure_text_width(fonts, "12.5", 9, false);
    for (int i = 0; i < 3; i++) {
        figure_add_text(
            &page,
            &(FigureText){.text = "12.5", .x = 11.5, .y = 7, .size_pt = 9, .align = aligns[i]});
        FigureBox box = figure_bounds(&page, (size_t)i);
        assert_true(fabs(box.left - (11.5 - i * width / 2)) < 1e-9);
        assert_true(box.bottom > 7 && box.top < 7);
    }
    figure_release(&page);
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* A page of all kinds of items, 61 x 47 pixels. */
static void fill(FigurePage *page, const Picture *picture)
{
    FigureColor stops[FIGURE_STOPS];
    const double pixel = MM_PER_INCH / 127;
    const FigurePoint tie[] = {{1.3, 8.1}, {9.7, 2.2}};
    const FigurePoint frame[] = {{0.4, 0.4}, {11, 0.4}, {11, 8.9}, {0.4, 8.9}};
    const FigurePoint arrow[] = {{6.1, 6}, {7.3, 6}, {6.7, 7.9}};
    for (int i = 0; i < FIGURE_STOPS; i++)
        stops[i] = (FigureColor){{(uint8_t)(3 * i), 77, (uint8_t)(255 - 2 * i)}};
    figure_init(page, 61 * pixel, 47 * pixel, 127, fonts);
    figure_add_picture(page, picture, 3, 5);
    figure_add_ramp(page, (FigureBox){2, 1, 3, 7.5}, true, stops);
    figure_add_shape(page, arrow, 3, (FigureColor){{200, 20, 10}});
    figure_add_line(page, frame, 4, true, 0.18, (FigureColor){{0, 0, 0}});
    figure_add_line(page, tie, 2, false, 0.31, (FigureColor){{0, 0, 0}});
    figure_add_text(
        page,
        &(FigureText){.text = "\xC3\x85g\xC2\xB5_{*f*^{2}}", .x = 4, .y = 5.15, .size_pt = 14});
}

static void init_picture(Picture *picture, int width, int height, int bits)
{
    Err err;
    assert_int_equal(picture_init(picture, width, height, 3, bits, &err), STATUS_OK);
    for (size_t i = 0; i < picture_stride(picture) * (size_t)height; i++)
        picture_set(picture, i, (uint16_t)((i * 7919 % 256) * (bits == 8 ? 1 : 257)));
}

static void rows_are_the_same_whatever_parts_the_page_is_drawn_in(void **state)
{
    Picture photo, whole;
    FigurePage page;
    Err err;
    (void)state;
    init_picture(&photo, 40, 30, 8);
    init_picture(&whole, 61, 47, 8);
    fill(&page, &photo);
    for (size_t i = page.n - 2; i < page.n; i++)
        figure_set_halo(&page, i, 0.3, (FigureColor){{250, 240, 30}});
    Picture parts = whole;
    size_t bytes = picture_stride(&whole) * 47;
    uint8_t *copy = malloc(bytes);
    assert_non_null(copy);
    memcpy(copy, whole.codes8, bytes);
    assert_int_equal(figure_draw(&page, 0, &whole, &err), STATUS_OK);
    for (int first = 0; first < 47; first += 5) {
        parts.height = first + 5 < 47 ? 5 : 47 - first;
        parts.codes8 = copy + (size_t)first * picture_stride(&whole);
        assert_int_equal(figure_draw(&page, first, &parts, &err), STATUS_OK);
    }
    assert_memory_equal(copy, whole.codes8, bytes);
    free(copy);
    figure_release(&page);
    picture_release(&whole);
    picture_release(&photo);
}

static void sixteen_bits_are_the_eight_to_rounding(void **state)
{
    Picture photo, eight, sixteen;
    FigurePage page;
    Err err;
    (void)state;
    init_picture(&photo, 40, 30, 8);
    init_picture(&eight, 61, 47, 8);
    init_picture(&sixteen, 61, 47, 16);
    fill(&page, &photo);
    assert_int_equal(figure_draw(&page, 0, &eight, &err), STATUS_OK);
    assert_int_equal(figure_draw(&page, 0, &sixteen, &err), STATUS_OK);
    for (size_t i = 0; i < picture_stride(&eight) * 47; i++)
        assert_true(abs(picture_code(&sixteen, i) - 257 * picture_code(&eight, i)) <= 257);
    figure_release(&page);
    picture_release(&sixteen);
    picture_release(&eight);
    picture_release(&photo);
}

static void boxes_and_ramps_cover_whole_pixels_in_their_own_colors(void **state)
{
    const double pixel = MM_PER_INCH / 300;
    FigureColor stops[FIGURE_STOPS];
    Picture rows;
    FigurePage page;
    Err err;
    (void)state;
    for (int i = 0; i < FIGURE_STOPS; i++)
        stops[i] = (FigureColor){{(uint8_t)(255 - 3 * i), (uint8_t)(2 * i), 31}};
    init_picture(&rows, 80, 10, 8);
    memset(rows.codes8, 255, picture_stride(&rows) * 10);
    figure_init(&page, 80 * pixel, 10 * pixel, 300, fonts);
    figure_add_ramp(&page, (FigureBox){5.3 * pixel, 2 * pixel, 69.6 * pixel, 6 * pixel}, false,
                    stops);
    figure_add_box(&page, (FigureBox){1.2 * pixel, 0.6 * pixel, 2.7 * pixel, 3.4 * pixel},
                   (FigureColor){{9, 8, 7}});
    assert_int_equal(figure_draw(&page, 0, &rows, &err), STATUS_OK);
    for (int x = 0; x < 80; x++)
        for (int y = 0; y < 10; y++) {
            const uint8_t *rgb = rows.codes8 + 3 * ((size_t)y * 80 + (size_t)x);
            if (x >= 5 && x < 70 && y >= 2 && y < 6) {
                assert_int_equal(rgb[0], lround(255 - 3 * (x - 4.5) * 64 / 65));
                assert_int_equal(rgb[2], 31);
            } else if (x >= 1 && x < 3 && y >= 1 && y < 3) {
                assert_memory_equal(rgb, ((uint8_t[]){9, 8, 7}), 3);
            } else {
                assert_memory_equal(rgb, ((uint8_t[]){255, 255, 255}), 3);
            }
        }
    figure_release(&page);
    picture_release(&rows);
}

/* ---- legends --------------------------------------------------------------------------------- */

/* How many items of a kind a legend of this scale has. */
static size_t count_items(const FigureLegend *legend, FigureKind kind)
{
    FigurePage page;
    Err err;
    size_t n = 0;
    figure_init(&page, 80, 60, 300, fonts);
    figure_add_legend(&page, legend);
    assert_int_equal(figure_check(&page, &err), STATUS_OK);
    for (size_t i = 0; i < page.n; i++)
        n += page.items[i].kind == kind;
    figure_release(&page);
    return n;
}

static float two_colors[2][3] = {{0, 0, 1}, {1, 1, 0}};

static void a_legend_has_points_and_a_swatch_only_for_values_that_need_them(void **state)
{
    const ColorScale scale = {
        .name = "wss", .unit = "Pa", .range = {3, 41}, .map = {two_colors, 2, false}};
    FigureLegend legend = {.scale = &scale, .title = "wss (Pa)", .length_mm = 30, .size_pt = 7};
    (void)state;
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 0);
    assert_int_equal(count_items(&legend, FIGURE_RAMP), 1);
    assert_int_equal(count_items(&legend, FIGURE_LINE), 4); /* 10, 20, 30, 40 */
    legend.outside = (ScaleOutside){.below = 2};
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 1);
    legend.outside = (ScaleOutside){.below = 2, .above = 1, .none = 7};
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 3);
    legend.horizontal = true;
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 3);
}

static void a_legend_of_classes_has_a_box_each(void **state)
{
    ColorScale scale = {.name = "q", .unit = "", .range = {1, 100}, .map = {two_colors, 2, false}};
    const FigureLegend legend = {.scale = &scale, .title = "q", .length_mm = 30, .size_pt = 7};
    (void)state;
    scale.classes = 5;
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 5);
    assert_int_equal(count_items(&legend, FIGURE_LINE), 6);
    scale.classes = 60; /* of half a millimetre each, and 3 mm from number to number */
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 60);
    assert_int_equal(count_items(&legend, FIGURE_LINE), 11);
    scale.classes = 1;
    scale.n_bounds = 3;
    scale.bounds[0] = 5;
    scale.bounds[1] = 10;
    scale.bounds[2] = 50;
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 4);
    assert_int_equal(count_items(&legend, FIGURE_LINE), 3);
    scale.n_bounds = 0;
    scale.map.separate = true;
    scale.range[1] = 2;
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 2);
}

/* A number of a legend and how far along the bar, which is 30 mm long, its tick stands. */
typedef struct Tick {
    const char *label;
    double along_mm;
} Tick;

/* Each tick is a line followed by its label. Minor ticks have none; the title is q. */
static void expect_labels(const ColorScale *scale, bool across, const Tick *expected, size_t n)
{
    const FigureLegend legend = {
        .scale = scale, .title = "q", .horizontal = across, .length_mm = 30, .size_pt = 7};
    FigurePage page;
    size_t found = 0;
    figure_init(&page, 80, 60, 300, fonts);
    figure_add_legend(&page, &legend);
    for (size_t i = 0; i + 1 < page.n; i++) {
        if (page.items[i].kind != FIGURE_LINE || page.items[i + 1].kind != FIGURE_TEXT ||
            page.items[i + 1].text[0] == 'q')
            continue;
        const FigurePoint *at = page.items[i].at;
        assert_true(found < n);
        assert_string_equal(page.items[i + 1].text, expected[found].label);
        assert_true(fabs((across ? at->x : -at->y) - expected[found].along_mm) < 1e-9);
        found++;
    }
    assert_int_equal(found, n);
    figure_release(&page);
}

#define EXPECT_LABELS(scale, ...)                                                                  \
    for (int across = 0; across < 2; across++)                                                     \
    expect_labels(&(scale), across, (const Tick[]){__VA_ARGS__},                                   \
                  sizeof((const Tick[]){__VA_ARGS__}) / sizeof(Tick))

static ColorScale plain_scale(double low, double high, bool log, int classes)
{
    return (ColorScale){.name = "q",
                        .unit = "",
                        .range = {low, high},
                        .log = log,
                        .classes = classes,
                        .map = {two_colors, 2, false}};
}

static void a_bar_has_the_right_numbers_at_the_right_places(void **state)
{
    (void)state;
    const ColorScale linear = plain_scale(-1, 2, false, 1), log = plain_scale(1, 1000, true, 1),
                     near = plain_scale(2, 50, true, 1), ends = plain_scale(1.667, 500, true, 1),
                     wide = plain_scale(1e-8, 1e8, true, 1),
                     large = plain_scale(-2e9, 6e9, false, 1),
                     small = plain_scale(0, 4e-6, false, 1);
    const double decade = 30 / log10(25), decades = 30 / log10(500 / 1.667);
    EXPECT_LABELS(linear,
                  {"\xE2\x88\x92"
                   "1",
                   0},
                  {"0", 10}, {"1", 20}, {"2", 30});
    EXPECT_LABELS(log, {"1", 0}, {"10", 10}, {"100", 20}, {"1000", 30});
    EXPECT_LABELS(near, {"2", 0}, {"5", decade * log10(2.5)}, {"10", decade * log10(5)},
                  {"20", decade}, {"50", 30});
    EXPECT_LABELS(ends, {"1.67", 0}, {"10", decades * log10(10 / 1.667)},
                  {"100", decades * log10(100 / 1.667)}, {"500", 30});
    EXPECT_LABELS(wide, {"10⁻⁸", 0}, {"10⁻⁴", 7.5}, {"1", 15}, {"10⁴", 22.5}, {"10⁸", 30});
    EXPECT_LABELS(large, {"\u22122", 0}, {"0", 7.5}, {"2", 15}, {"4", 22.5}, {"6", 30});
    EXPECT_LABELS(small, {"0", 0}, {"1", 7.5}, {"2", 15}, {"3", 22.5}, {"4", 30});
}

/* A legend of a scale has so many ticks, and one text `text`. */
static void expect_items(const ColorScale *scale, size_t lines, const char *text)
{
    FigureLegend legend = {.scale = scale, .title = "q", .length_mm = 30, .size_pt = 7};
    FigurePage page;
    size_t found = 0;
    figure_init(&page, 80, 60, 300, fonts);
    figure_add_legend(&page, &legend);
    for (size_t i = 0; i < page.n; i++)
        found += page.items[i].kind == FIGURE_TEXT && strcmp(page.items[i].text, text) == 0;
    assert_int_equal(found, 1);
    figure_release(&page);
    assert_int_equal(count_items(&legend, FIGURE_LINE), lines);
}

static void bars_have_minor_ticks_and_a_common_power_of_ten(void **state)
{
    (void)state;
    const ColorScale log = plain_scale(1.667, 500, true, 1),
                     large = plain_scale(-2e9, 6e9, false, 1),
                     small = plain_scale(0, 4e-6, false, 1);
    expect_items(&log, 4 + 8 + 9 + 4, "500"); /* minor ticks: 2 .. 9, 10 .. 90, 100 .. 400 */
    expect_items(&large, 5, "\u00d710\u2079");
    expect_items(&small, 5, "\u00d710\u207b\u2076");
}

static void listed_values_have_a_swatch_each(void **state)
{
    static const double values[] = {1, 2, 5};
    const ColorScale scale = plain_scale(1, 5, false, 1);
    const FigureLegend legend = {.scale = &scale,
                                 .swatches = values,
                                 .n_swatches = 3,
                                 .title = "q",
                                 .length_mm = 30,
                                 .size_pt = 7};
    (void)state;
    assert_int_equal(count_items(&legend, FIGURE_RAMP), 0);
    assert_int_equal(count_items(&legend, FIGURE_SHAPE), 3);
    assert_int_equal(count_items(&legend, FIGURE_TEXT), 4);
}

static void classes_have_the_right_numbers_between_them(void **state)
{
    (void)state;
    const ColorScale linear = plain_scale(0, 10, false, 4), decades = plain_scale(1, 1000, true, 3),
                     halves = plain_scale(1, 100, true, 4);
    ColorScale bounds = plain_scale(1, 100, false, 1);
    bounds.n_bounds = 3;
    bounds.bounds[0] = 5;
    bounds.bounds[1] = 10;
    bounds.bounds[2] = 50;
    EXPECT_LABELS(linear, {"0.0", 0}, {"2.5", 7.5}, {"5.0", 15}, {"7.5", 22.5}, {"10.0", 30});
    EXPECT_LABELS(decades, {"1", 0}, {"10", 10}, {"100", 20}, {"1000", 30});
    EXPECT_LABELS(halves, {"1", 0}, {"3.162", 7.5}, {"10", 15}, {"31.62", 22.5}, {"100", 30});
    EXPECT_LABELS(bounds, {"5", 7.5}, {"10", 15}, {"50", 22.5});
}

/* The boxes of a legend have the colors of values just below and just above the numbers between
 * them. */
static void expect_boxes(const ColorScale *scale, const double *inner, int n)
{
    const FigureLegend legend = {.scale = scale, .title = "q", .length_mm = 30, .size_pt = 7};
    FigurePage page;
    figure_init(&page, 80, 60, 300, fonts);
    figure_add_legend(&page, &legend);
    for (int i = 0; i < n; i++)
        for (int above = 0; above < 2; above++) {
            float linear[3];
            colorscale_linear(scale, inner[i] * (above ? 1.01 : 0.99), linear);
            const FigureItem *box = &page.items[i + above];
            assert_int_equal(box->kind, FIGURE_SHAPE);
            for (int c = 0; c < 3; c++)
                assert_int_equal(box->color.rgb[c], image_code(linear[c], ENCODING_SRGB, 8));
        }
    assert_int_not_equal(page.items[0].color.rgb[0], page.items[1].color.rgb[0]);
    figure_release(&page);
}

static void expect_color(const FigureItem *item, const float linear[3])
{
    for (int c = 0; c < 3; c++)
        assert_int_equal(item->color.rgb[c], image_code(linear[c], ENCODING_SRGB, 8));
}

/* Values below, above and none have colors of their own, in this order. */
static void what_is_outside_has_its_color_at_its_end(void **state)
{
    ColorScale scale = plain_scale(3, 41, false, 1);
    const float *colors[3] = {scale.under.rgb, scale.over.rgb, scale.none.rgb};
    (void)state;
    scale.under = (ScaleColor){.given = true, .rgb = {1, 0, 0}};
    scale.over = (ScaleColor){.given = true, .rgb = {0, 1, 0}};
    scale.none = (ScaleColor){.given = true, .rgb = {0, 1, 1}};
    for (int across = 0; across < 2; across++) {
        const FigureLegend legend = {.scale = &scale,
                                     .title = "q",
                                     .horizontal = across,
                                     .length_mm = 30,
                                     .size_pt = 7,
                                     .outside = {.below = 1, .above = 1, .none = 1}};
        FigurePage page;
        int found = 0;
        figure_init(&page, 80, 60, 300, fonts);
        figure_add_legend(&page, &legend);
        for (size_t i = 0; i < page.n; i++) {
            const FigureItem *item = &page.items[i];
            double along = across ? item->at->x : -item->at->y;
            if (item->kind != FIGURE_SHAPE)
                continue;
            assert_in_range(found, 0, 2);
            expect_color(item, colors[found]);
            if (found < 2)
                assert_true(found == 0 ? along < 0 : along > 30);
            found++;
        }
        assert_int_equal(found, 3);
        figure_release(&page);
    }
}

/* A swatch is followed by its number. */
static void swatches_have_the_colors_of_their_numbers(void **state)
{
    static float colors[4][3] = {{0, 0, 1}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    const ColorScale scale = {
        .name = "order", .unit = "", .range = {2, 4}, .map = {colors, 4, true}};
    (void)state;
    for (int across = 0; across < 2; across++) {
        const FigureLegend legend = {
            .scale = &scale, .title = "order", .horizontal = across, .length_mm = 30, .size_pt = 7};
        FigurePage page;
        int found = 0;
        figure_init(&page, 80, 60, 300, fonts);
        figure_add_legend(&page, &legend);
        for (size_t i = 0; i + 1 < page.n; i++) {
            float linear[3];
            if (page.items[i].kind != FIGURE_SHAPE)
                continue;
            int value = atoi(page.items[i + 1].text);
            assert_int_equal(value, 2 + found++);
            colorscale_linear(&scale, value, linear);
            expect_color(&page.items[i], linear);
            expect_color(&page.items[i], colors[value - 1]);
        }
        assert_int_equal(found, 3);
        figure_release(&page);
    }
}

static void classes_have_the_colors_of_their_values(void **state)
{
    static const double linear[] = {2.5, 5, 7.5}, decades[] = {10, 100},
                        halves[] = {3.1622776601683795, 10, 31.622776601683793},
                        own[] = {5, 10, 50};
    const ColorScale of_range = plain_scale(0, 10, false, 4),
                     of_decades = plain_scale(1, 1000, true, 3),
                     of_halves = plain_scale(1, 100, true, 4);
    ColorScale of_bounds = plain_scale(1, 100, false, 1);
    (void)state;
    of_bounds.n_bounds = 3;
    memcpy(of_bounds.bounds, own, sizeof own);
    expect_boxes(&of_range, linear, 3);
    expect_boxes(&of_decades, decades, 2);
    expect_boxes(&of_halves, halves, 3);
    expect_boxes(&of_bounds, own, 3);
}

static void a_legend_can_be_measured_and_moved(void **state)
{
    const ColorScale scale = {
        .name = "wss", .unit = "Pa", .range = {3, 41}, .map = {two_colors, 2, false}};
    const FigureLegend legend = {
        .scale = &scale, .title = "wss (Pa)", .length_mm = 30, .size_pt = 7};
    FigurePage page;
    (void)state;
    figure_init(&page, 80, 60, 300, fonts);
    figure_add_legend(&page, &legend);
    FigureBox before = figure_bounds(&page, 0);
    assert_true(before.bottom - before.top > 30 && before.bottom - before.top < 37);
    figure_move(&page, 0, 3.5, -2.25);
    FigureBox after = figure_bounds(&page, 0);
    assert_true(fabs(after.left - before.left - 3.5) < 1e-9);
    assert_true(fabs(after.bottom - before.bottom + 2.25) < 1e-9);
    figure_release(&page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ticks_are_round_numbers_within_the_range),
        cmocka_unit_test(ticks_of_a_logarithm_are_powers_of_ten_where_there_are_two),
        cmocka_unit_test(ticks_of_whole_numbers_are_whole),
        cmocka_unit_test(a_line_is_as_wide_as_its_letters_moved_together),
        cmocka_unit_test(a_letter_that_liberation_sans_lacks_is_listed),
        cmocka_unit_test(superscripts_of_unicode_are_drawn_as_groups),
        cmocka_unit_test(groups_are_raised_and_lowered),
        cmocka_unit_test(a_star_is_a_star_where_none_matches_it),
        cmocka_unit_test(broken_markup_is_drawn_and_noted),
        cmocka_unit_test(text_stands_where_its_alignment_says),
        cmocka_unit_test(rows_are_the_same_whatever_parts_the_page_is_drawn_in),
        cmocka_unit_test(sixteen_bits_are_the_eight_to_rounding),
        cmocka_unit_test(boxes_and_ramps_cover_whole_pixels_in_their_own_colors),
        cmocka_unit_test(a_legend_has_points_and_a_swatch_only_for_values_that_need_them),
        cmocka_unit_test(a_legend_of_classes_has_a_box_each),
        cmocka_unit_test(a_bar_has_the_right_numbers_at_the_right_places),
        cmocka_unit_test(bars_have_minor_ticks_and_a_common_power_of_ten),
        cmocka_unit_test(listed_values_have_a_swatch_each),
        cmocka_unit_test(classes_have_the_right_numbers_between_them),
        cmocka_unit_test(what_is_outside_has_its_color_at_its_end),
        cmocka_unit_test(swatches_have_the_colors_of_their_numbers),
        cmocka_unit_test(classes_have_the_colors_of_their_values),
        cmocka_unit_test(a_legend_can_be_measured_and_moved),
    };
    return cmocka_run_group_tests(tests, load_fonts, free_fonts);
}
