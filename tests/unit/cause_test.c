/* The cause that `compare` names for faults planted in a picture of seven shaded balls on a
 * background of one color, drawn by a formula for any camera. Each fault must get the right
 * words. Faults without a name, two faults at once, and chance must get none. */
#include "compare/compare.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { W = 173, H = 139, BALLS = 7 };

static Err err;
static Picture reference; /* the plain shot */

/* How a picture is drawn, and what is done to its codes. */
typedef struct Shot {
    double dx, dy, radii, highlight, diffuse; /* factors of 1 and pixels */
    double angle, pale;   /* pale: of 0 to 1, how near all colors are to that of resin */
    int samples, without; /* a side; the ball left out, from 1 on */
    double sigma;
    void (*spoil)(Picture *picture, double by);
    double by;
} Shot;

static const Shot plain = {.radii = 1, .highlight = 0.23, .diffuse = 1, .samples = 4};

static const struct {
    double x, y, radius, color[3];
} balls[BALLS] = {
    {31.3, 28.9, 17.2, {0.56, 0.06, 0.05}},  {82.7, 35.1, 21.4, {0.08, 0.37, 0.11}},
    {139.2, 31.8, 15.9, {0.07, 0.13, 0.61}}, {36.4, 88.2, 23.1, {0.48, 0.36, 0.04}},
    {93.6, 97.7, 18.3, {0.41, 0.05, 0.38}},  {142.9, 86.3, 24.6, {0.55, 0.17, 0.04}},
    {97.1, 68.8, 7.3, {0.05, 0.33, 0.36}},
};

static double color_of(const Shot *shot, int ball, int c)
{
    static const double resin[3] = {0.62, 0.53, 0.4};
    return balls[ball].color[c] + shot->pale * (resin[c] - balls[ball].color[c]);
}

static void light_at(const Shot *shot, double x, double y, double out[3])
{
    double turned_x = cos(shot->angle) * (x - W / 2.0) - sin(shot->angle) * (y - H / 2.0);
    double turned_y = sin(shot->angle) * (x - W / 2.0) + cos(shot->angle) * (y - H / 2.0);
    for (int c = 0; c < 3; c++)
        out[c] = 0.83;
    for (int i = 0; i < BALLS; i++) {
        double radius = balls[i].radius * shot->radii;
        double u = (turned_x + W / 2.0 - shot->dx - balls[i].x) / radius;
        double v = (turned_y + H / 2.0 - shot->dy - balls[i].y) / radius;
        double square = 1 - u * u - v * v;
        if (square < 0 || i + 1 == shot->without)
            continue;
        double lit = fmax(0, -0.38 * u - 0.45 * v + 0.81 * sqrt(square));
        for (int c = 0; c < 3; c++)
            out[c] = color_of(shot, i, c) * (0.12 + 0.72 * shot->diffuse * lit) +
                     shot->highlight * pow(lit, 23);
    }
}

static Plane draw_light(const Shot *shot)
{
    Plane plane;
    assert_int_equal(plane_init(&plane, W, H, 3, &err), STATUS_OK);
    for (int i = 0; i < W * H; i++) {
        double sum[3] = {0}, light[3];
        int n = shot->samples;
        for (int k = 0; k < n * n; k++) {
            light_at(shot, i % W + (k % n + 0.5) / n, i / W + (k / n + 0.5) / n, light);
            for (int c = 0; c < 3; c++)
                sum[c] += light[c];
        }
        for (int c = 0; c < 3; c++)
            plane.values[3 * i + c] = (float)(sum[c] / (n * n));
    }
    return plane;
}

/* Blurs the codes along rows, or columns. */
static void blur(Picture *picture, double sigma, bool down)
{
    enum { REACH = 9 };
    uint8_t line[W > H ? W : H];
    int length = down ? H : W, step = down ? 3 * W : 3;
    for (int l = 0; l < 3 * (down ? W : H); l++) {
        uint8_t *first = picture->codes8 + (down ? l : l / 3 * 3 * W + l % 3);
        for (int i = 0; i < length; i++)
            line[i] = first[i * step];
        for (int i = 0; i < length; i++) {
            double sum = 0, weights = 0;
            for (int k = -REACH; k <= REACH; k++) {
                int at = i + k < 0 ? 0 : i + k < length ? i + k : length - 1;
                double weight = exp(-k * k / (2 * sigma * sigma));
                sum += weight * line[at];
                weights += weight;
            }
            first[i * step] = (uint8_t)lround(sum / weights);
        }
    }
}

static Picture shoot(const Shot *shot)
{
    Picture picture;
    Plane plane = draw_light(shot);
    assert_int_equal(picture_from_plane(&picture, &plane, ENCODING_SRGB, 8, &err), STATUS_OK);
    plane_release(&plane);
    if (shot->sigma > 0) {
        blur(&picture, shot->sigma, false);
        blur(&picture, shot->sigma, true);
    }
    if (shot->spoil)
        shot->spoil(&picture, shot->by);
    return picture;
}

/* ---- what is done to codes ------------------------------------------------------------------- */

static uint8_t clipped(double value)
{
    return (uint8_t)lround(fmin(fmax(value, 0), 255));
}

static void gain_of_codes(Picture *picture, double by)
{
    for (int i = 0; i < 3 * W * H; i++)
        picture->codes8[i] = clipped(by * picture->codes8[i]);
}

static void offset(Picture *picture, double by)
{
    for (int i = 0; i < 3 * W * H; i++)
        picture->codes8[i] = clipped(by + picture->codes8[i]);
}

static void gamma_curve(Picture *picture, double by)
{
    for (int i = 0; i < 3 * W * H; i++)
        picture->codes8[i] = clipped(255 * pow(picture->codes8[i] / 255.0, by));
}

static void gain_of_light(Picture *picture, double by)
{
    for (int i = 0; i < 3 * W * H; i++)
        picture->codes8[i] = clipped(
            255.0 * (double)srgb_encode((float)by * srgb_decode((float)picture->codes8[i] / 255)));
}

static void drop_encoding(Picture *picture, double by)
{
    (void)by;
    for (int i = 0; i < 3 * W * H; i++)
        picture->codes8[i] = clipped(255.0 * (double)srgb_decode((float)picture->codes8[i] / 255));
}

static void encode_again(Picture *picture, double by)
{
    (void)by;
    for (int i = 0; i < 3 * W * H; i++)
        picture->codes8[i] = clipped(255.0 * (double)srgb_encode((float)picture->codes8[i] / 255));
}

static void flip_rows(Picture *picture, double by)
{
    (void)by;
    for (int y = 0; y < H / 2; y++)
        for (int i = 0; i < 3 * W; i++) {
            uint8_t *top = picture->codes8 + 3 * W * y + i;
            uint8_t *bottom = picture->codes8 + 3 * W * (H - 1 - y) + i;
            uint8_t kept = *top;
            *top = *bottom;
            *bottom = kept;
        }
}

static void exchange_channels(Picture *picture, double by)
{
    int one = (int)by / 10, other = (int)by % 10;
    for (int i = 0; i < W * H; i++) {
        uint8_t kept = picture->codes8[3 * i + one];
        picture->codes8[3 * i + one] = picture->codes8[3 * i + other];
        picture->codes8[3 * i + other] = kept;
    }
}

static void flip_and_darken(Picture *picture, double by)
{
    flip_rows(picture, by);
    gain_of_codes(picture, by);
}

static bool is_background(const uint8_t pixel[3])
{
    return pixel[0] == 235 && pixel[1] == 235 && pixel[2] == 235;
}

/* Of what is seen in the upper half. */
static void gamma_of_half(Picture *picture, double by)
{
    for (int i = 0; i < W * (H / 2); i++)
        for (int c = 0; c < 3 && !is_background(picture->codes8 + 3 * i); c++)
            picture->codes8[3 * i + c] = clipped(255 * pow(picture->codes8[3 * i + c] / 255.0, by));
}

static void desaturate(Picture *picture, double by)
{
    for (uint8_t *at = picture->codes8; at < picture->codes8 + 3 * W * H; at += 3) {
        const double luma = 0.299 * at[0] + 0.587 * at[1] + 0.114 * at[2];
        for (int c = 0; c < 3; c++)
            at[c] = clipped(at[c] + by * (luma - at[c]));
    }
}

/* From `by` on, a seed: normal noise, some pixels of any color, a block, a darker band. */
static void add_noise(Picture *picture, double by)
{
    Random random;
    random_seed(&random, (uint64_t)by);
    for (int i = 0; i < 3 * W * H; i++) {
        double sum = -6;
        for (int k = 0; k < 12; k++)
            sum += random_uniform(&random);
        picture->codes8[i] = clipped(picture->codes8[i] + 5.3 * sum);
    }
}

static void spoil_pixels(Picture *picture, double by)
{
    Random random;
    random_seed(&random, (uint64_t)by);
    for (int i = 0; i < 97; i++) {
        size_t at = 3 * (size_t)(random_uniform(&random) * W * H);
        for (size_t c = 0; c < 3; c++)
            picture->codes8[at + c] = (uint8_t)(255 * random_uniform(&random));
    }
}

static void spoil_block(Picture *picture, double by)
{
    Random random;
    random_seed(&random, (uint64_t)by);
    int left = (int)(random_uniform(&random) * 120), top = (int)(random_uniform(&random) * 90);
    for (int y = top; y < top + 33; y++)
        for (int i = 3 * left; i < 3 * left + 120; i++)
            picture->codes8[3 * W * y + i] = (uint8_t)(255 * random_uniform(&random));
}

static void darken_band(Picture *picture, double by)
{
    Random random;
    random_seed(&random, (uint64_t)by);
    int top = (int)(random_uniform(&random) * 80);
    for (int i = 3 * W * top; i < 3 * W * (top + 41); i++)
        picture->codes8[i] = clipped(0.9 * picture->codes8[i]);
}

/* ---- tests ----------------------------------------------------------------------------------- */

static CompareResult judge(const Picture *a, const Picture *b)
{
    CompareResult result;
    const Rendering in_a = {.picture = a}, in_b = {.picture = b};
    const Tolerance tolerance = tolerance_identity(0);
    assert_int_equal(compare_pictures(&in_a, &in_b, &tolerance, &result, NULL, &err), STATUS_OK);
    assert_int_equal(compare_cause(a, b, &result, &err), STATUS_OK);
    return result;
}

/* Of the plain shot and another; `words` are part of the sentence, NULL is none. */
static void expect_cause(const Shot *shot, const char *words)
{
    Picture b = shoot(shot);
    const CompareResult result = judge(&reference, &b);
    bool right = words ? strstr(result.cause, words) != NULL : !*result.cause;
    if (!right)
        fail_msg("expected '%s', got '%s'", words ? words : "", result.cause);
    picture_release(&b);
}

static Shot spoilt(void (*spoil)(Picture *picture, double by), double by)
{
    Shot shot = plain;
    shot.spoil = spoil;
    shot.by = by;
    return shot;
}

static void names_a_move_to_a_tenth_of_a_pixel(void **state)
{
    (void)state;
    static const struct {
        double dx, dy;
        const char *words;
    } moves[] = {
        {3, -2, "moved by (3, -2) pixels"},         {0.3, -1.7, "moved by (0.3, -1.7) pixels"},
        {-0.5, 0.5, "moved by (-0.5, 0.5) pixels"}, {11.4, 7.2, "moved by (11.4, 7.2) pixels"},
        {0.7, 0, "moved by (0.7, 0.0) pixels"},     {-4.9, -0.2, "moved by (-4.9, -0.2)"}};
    for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
        Shot shot = plain;
        shot.dx = moves[i].dx;
        shot.dy = moves[i].dy;
        expect_cause(&shot, moves[i].words);
    }
}

static void names_a_blur_and_its_width(void **state)
{
    (void)state;
    Shot shot = plain;
    shot.sigma = 1.3;
    expect_cause(&shot, "B is nearly A blurred (Gaussian, standard deviation 1.3");
    shot.sigma = 0.6;
    expect_cause(&shot, "B is nearly A blurred (Gaussian, standard deviation 0.6");
    Picture b = shoot(&shot);
    const CompareResult result = judge(&b, &reference);
    assert_non_null(strstr(result.cause, "A is nearly B blurred"));
    picture_release(&b);
}

static void names_gain_offset_gamma_and_encoding(void **state)
{
    (void)state;
    static const struct {
        void (*spoil)(Picture *picture, double by);
        double by;
        const char *words;
    } tones[] = {
        {gain_of_codes, 0.93, "darker: its sRGB codes are 0.93"},
        {gain_of_codes, 1.052, "brighter: its sRGB codes are 1.05"},
        {gain_of_light, 0.731, "darker: its linear colors are 0.73"},
        {gain_of_light, 1.104, "brighter: its linear colors are 1.1"},
        {offset, 7, "brighter: its sRGB codes, from 0 to 255, are those of A changed by 7"},
        {offset, -5, "darker: its sRGB codes, from 0 to 255, are those of A changed by -5"},
        {gamma_curve, 1.25,
         "darker: its sRGB codes, from 0 to 1, are those of A to the power of 1.2"},
        {gamma_curve, 0.934,
         "brighter: its sRGB codes, from 0 to 1, are those of A to the power of 0.93"},
        {drop_encoding, 0, "B is A not encoded as sRGB"},
        {encode_again, 0, "B is A encoded as sRGB twice"},
    };
    for (size_t i = 0; i < sizeof tones / sizeof *tones; i++) {
        const Shot shot = spoilt(tones[i].spoil, tones[i].by);
        expect_cause(&shot, tones[i].words);
    }
}

/* A number in parts of 256 for 255, or of a percent too few, has other digits at its end. */
static void says_the_number_of_a_tone_to_its_last_digit(void **state)
{
    (void)state;
    static const struct {
        void (*spoil)(Picture *picture, double by);
        double by, least, most;
        const char *before;
    } tones[] = {{offset, 40, 39.99, 40.01, "changed by "},
                 {offset, -60, -60.01, -59.99, "changed by "},
                 {gain_of_codes, 0.9, 0.897, 0.903, "sRGB codes are "},
                 {gain_of_light, 0.75, 0.749, 0.751, "linear colors are "},
                 {gamma_curve, 1.25, 1.248, 1.252, "power of "}};
    for (size_t i = 0; i < sizeof tones / sizeof *tones; i++) {
        const Shot shot = spoilt(tones[i].spoil, tones[i].by);
        Picture b = shoot(&shot);
        const CompareResult result = judge(&reference, &b);
        const char *at = strstr(result.cause, tones[i].before);
        double number = at ? strtod(at + strlen(tones[i].before), NULL) : 0;
        if (!(number >= tones[i].least && number <= tones[i].most))
            fail_msg("expected a number from %g to %g, got '%s'", tones[i].least, tones[i].most,
                     result.cause);
        picture_release(&b);
    }
}

static void names_rows_and_channels_that_are_exchanged(void **state)
{
    (void)state;
    Shot shot = spoilt(flip_rows, 0);
    expect_cause(&shot, "B is A flipped top to bottom");
    shot = spoilt(exchange_channels, 2);
    expect_cause(&shot, "B is A with red and blue exchanged");
    shot = spoilt(exchange_channels, 12);
    expect_cause(&shot, "B is A with green and blue exchanged");
    shot = spoilt(exchange_channels, 1);
    expect_cause(&shot, "B is A with red and green exchanged");
}

static void tells_highlights_from_other_shading(void **state)
{
    (void)state;
    Shot shot = plain;
    shot.highlight = 0.31;
    expect_cause(&shot, "only highlights differ");
    shot.highlight = 0.17;
    expect_cause(&shot, "B is darker");
    shot = plain;
    shot.diffuse = 1.14;
    expect_cause(&shot, "only shading differs");
}

/* Of the shot `from` and another. */
static void expect_cause_from(const Shot *from, const Shot *shot, const char *words)
{
    Picture kept = reference;
    reference = shoot(from);
    expect_cause(shot, words);
    picture_release(&reference);
    reference = kept;
}

/* Of nearly grey surfaces every curve of tones makes light that is nearly white, or nearly of their
 * own color: both are the same. */
static void names_no_light_of_surfaces_that_are_nearly_grey(void **state)
{
    (void)state;
    for (int step = 0; step < 4; step++) {
        Shot resin = spoilt(gamma_of_half, 1), other;
        resin.pale = 0.7 + 0.1 * step;
        other = resin;
        other.by = 1.2;
        expect_cause_from(&resin, &other, NULL);
    }
}

/* Another saturation of nearly grey surfaces is a small part of what a move changes. */
static void tells_a_move_from_one_that_is_desaturated(void **state)
{
    (void)state;
    static const double moves[] = {1, 0.5, 2.3};
    for (int i = 0; i < 3; i++) {
        Shot pale = spoilt(desaturate, 0.7), other = pale;
        other.dx = moves[i];
        expect_cause_from(&pale, &other, "moved by");
        other.by = 0.76;
        expect_cause_from(&pale, &other, NULL);
    }
}

/* Leaves the rows from `first` on as they are in the plain shot. */
static void restore_rows(Picture *picture, double first)
{
    size_t from = (size_t)first * W * 3;
    memcpy(picture->codes8 + from, reference.codes8 + from, (size_t)W * H * 3 - from);
}

/* However little the part shows. */
static void names_no_move_where_a_part_was_not_moved(void **state)
{
    (void)state;
    int named = 0;
    for (int first = H / 2; first < H; first += 2 * SHARE) {
        Shot shot = spoilt(restore_rows, first);
        shot.dx = 3;
        shot.dy = -2;
        Picture b = shoot(&shot);
        const CompareResult result = judge(&reference, &b);
        if (strstr(result.cause, "nearly A moved"))
            fail_msg("rows from %d on were not moved: '%s'", first, result.cause);
        named += strstr(result.cause, "A moved") != NULL;
        picture_release(&b);
    }
    assert_true(named < H / 4);
}

static void names_outlines_that_are_sampled_otherwise(void **state)
{
    (void)state;
    Shot shot = plain;
    shot.samples = 1;
    expect_cause(&shot, "only at outlines");
}

static void names_the_side_that_lacks_a_thing_and_its_place(void **state)
{
    (void)state;
    Shot shot = plain;
    shot.without = 3;
    expect_cause(&shot, "an object, or a part of one, is in A only");
    expect_cause(&shot, "from (123, 16) to (154, 47)); 0 other pixels differ");
    Picture b = shoot(&shot);
    const CompareResult result = judge(&b, &reference);
    assert_non_null(strstr(result.cause, "is in B only"));
    picture_release(&b);
}

/* The picture but for its background, which has other codes. */
static void recolor_background(Picture *picture, double by)
{
    const uint8_t code = picture->codes8[0];
    for (int i = 0; i < 3 * W * H; i += 3)
        if (picture->codes8[i] == code && picture->codes8[i + 1] == code &&
            picture->codes8[i + 2] == code) {
            picture->codes8[i] = 17;
            picture->codes8[i + 1] = (uint8_t)by;
            picture->codes8[i + 2] = 43;
        }
}

static void names_another_background(void **state)
{
    (void)state;
    Shot shot = spoilt(recolor_background, 29);
    expect_cause(&shot,
                 "only the background color differs (and pixels that blend with it at outlines): "
                 "(235, 235, 235) in A, (17, 29, 43) in B");
    shot.diffuse = 1.2;
    expect_cause(&shot, NULL);
}

static void names_nothing_where_two_faults_meet(void **state)
{
    (void)state;
    Shot shot = spoilt(flip_and_darken, 0.9);
    expect_cause(&shot, NULL);
    shot = spoilt(gain_of_codes, 0.9);
    shot.dx = 1.3;
    expect_cause(&shot, NULL);
    shot.dx = 0;
    shot.sigma = 1.2;
    expect_cause(&shot, NULL);
    shot = spoilt(gamma_curve, 1.2);
    shot.without = 3;
    expect_cause(&shot, NULL);
}

static void names_nothing_that_no_sentence_is_about(void **state)
{
    (void)state;
    Shot shot = plain;
    shot.radii = 1.04;
    expect_cause(&shot, NULL);
}

/* 0.04 radians. */
static void names_a_rotation_and_its_angle(void **state)
{
    (void)state;
    Shot shot = plain;
    shot.angle = 0.04;
    expect_cause(&shot, "B is A rotated by 2.3 degrees counterclockwise");
    shot.angle = -0.04;
    expect_cause(&shot, "B is A rotated by 2.3 degrees clockwise");
}

static void names_noise_and_its_size(void **state)
{
    (void)state;
    const Shot shot = spoilt(add_noise, 100);
    expect_cause(&shot, "B is A with noise that is independent in each pixel (standard deviation "
                        "about 5.3 levels)");
}

static void names_nothing_where_chance_was_at_work(void **state)
{
    (void)state;
    void (*const kinds[])(Picture * picture, double by) = {spoil_pixels, spoil_block, darken_band};
    for (int i = 0; i<18; i += SHARE> 1 ? 5 : 1) {
        const Shot shot = spoilt(kinds[i % 3], 101 + i);
        expect_cause(&shot, NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_a_move_to_a_tenth_of_a_pixel),
        cmocka_unit_test(names_a_blur_and_its_width),
        cmocka_unit_test(names_gain_offset_gamma_and_encoding),
        cmocka_unit_test(says_the_number_of_a_tone_to_its_last_digit),
        cmocka_unit_test(names_rows_and_channels_that_are_exchanged),
        cmocka_unit_test(tells_highlights_from_other_shading),
        cmocka_unit_test(names_no_light_of_surfaces_that_are_nearly_grey),
        cmocka_unit_test(tells_a_move_from_one_that_is_desaturated),
        cmocka_unit_test(names_no_move_where_a_part_was_not_moved),
        cmocka_unit_test(names_outlines_that_are_sampled_otherwise),
        cmocka_unit_test(names_another_background),
        cmocka_unit_test(names_the_side_that_lacks_a_thing_and_its_place),
        cmocka_unit_test(names_nothing_where_two_faults_meet),
        cmocka_unit_test(names_nothing_that_no_sentence_is_about),
        cmocka_unit_test(names_a_rotation_and_its_angle),
        cmocka_unit_test(names_noise_and_its_size),
        cmocka_unit_test(names_nothing_where_chance_was_at_work),
    };
    reference = shoot(&plain);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    picture_release(&reference);
    return failed;
}
