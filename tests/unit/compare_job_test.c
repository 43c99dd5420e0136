/* The operation `compare` on images in memory. */
#include "job/verify/compare.h"

#include "unit.h"
#include <stdlib.h>

enum { SIDE = 12 };

/* A grey picture in which pixel (5, 5) has another code. */
static Image make_image(uint8_t code)
{
    Image image = {0};
    Err err;
    assert_int_equal(picture_init(&image.picture, SIDE, SIDE, 3, 8, &err), STATUS_OK);
    for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
        image.picture.codes8[i] = 128;
    image.picture.codes8[3 * (5 * SIDE + 5)] = code;
    return image;
}

static Comparison compare_codes(uint8_t code_a, uint8_t code_b, bool json)
{
    Parsed parsed;
    Comparison comparison;
    Err err;
    Image a = make_image(code_a), b = make_image(code_b);
    assert_int_equal(parsed_init(&parsed, &command_compare, &err), STATUS_OK);
    CompareOptions *options = parsed.options;
    options->given[0].image = &a;
    options->given[1].image = &b;
    options->json = json;
    assert_int_equal(compare_make(options, &parsed, &comparison, &err), STATUS_OK);
    assert_int_equal(a.picture.codes8[3 * (5 * SIDE + 5)], code_a);
    image_release(&a);
    image_release(&b);
    parsed_release(&parsed);
    return comparison;
}

static void equal_images_agree(void **state)
{
    (void)state;
    Comparison comparison = compare_codes(7, 7, false);
    assert_int_equal(comparison.kind, COMPARED_PAIR);
    assert_true(comparison.agrees);
    assert_int_equal(result_count(&comparison.result, MEASURE_DIFFERING_PIXELS), 0);
    comparison_release(&comparison);
}

static void one_pixel_is_found(void **state)
{
    (void)state;
    Comparison comparison = compare_codes(7, 9, true);
    assert_false(comparison.agrees);
    assert_int_equal(result_count(&comparison.result, MEASURE_DIFFERING_PIXELS), 1);
    json_t *json = comparison_json(&comparison);
    assert_string_equal(json_string_value(json_object_get(json, "verdict")), "differ");
    json_decref(json);
    comparison_release(&comparison);
}

static void images_of_two_sizes_are_refused(void **state)
{
    (void)state;
    Parsed parsed;
    Comparison comparison;
    Err err;
    Image a = make_image(0), b = {0};
    assert_int_equal(picture_init(&b.picture, SIDE, 1, 3, 8, &err), STATUS_OK);
    assert_int_equal(parsed_init(&parsed, &command_compare, &err), STATUS_OK);
    CompareOptions *options = parsed.options;
    options->given[0].image = &a;
    options->given[1].image = &b;
    assert_int_equal(compare_make(options, &parsed, &comparison, &err), STATUS_INPUT);
    assert_true(err.text[0] != '\0');
    image_release(&a);
    image_release(&b);
    parsed_release(&parsed);
}

static void ids_tell_segments(void **state)
{
    (void)state;
    Parsed parsed;
    Comparison comparison;
    Err err;
    IdPlane ids[2];
    assert_int_equal(parsed_init(&parsed, &command_compare, &err), STATUS_OK);
    CompareOptions *options = parsed.options;
    for (int side = 0; side < 2; side++) {
        assert_int_equal(idplane_init(&ids[side], SIDE, SIDE, &err), STATUS_OK);
        ids[side].ids[3] = side ? 4 : 5;
        options->given[side].ids = &ids[side];
    }
    assert_int_equal(compare_make(options, &parsed, &comparison, &err), STATUS_OK);
    assert_int_equal(comparison.plane, PLANE_ID);
    assert_int_equal(result_count(&comparison.result, MEASURE_DIFFERING_PIXELS), 1);
    comparison_release(&comparison);
    idplane_release(&ids[0]);
    idplane_release(&ids[1]);
    parsed_release(&parsed);
}

/* One side is missing, or is not what is compared, or options ask for files. */
static void incomplete_images_are_refused(void **state)
{
    (void)state;
    enum { MISSING, NO_IDS, NOISE, CASES };
    for (int k = 0; k < CASES; k++) {
        Parsed parsed;
        Comparison comparison;
        Err err;
        Image a = make_image(0);
        assert_int_equal(parsed_init(&parsed, &command_compare, &err), STATUS_OK);
        CompareOptions *options = parsed.options;
        options->given[0].image = &a;
        options->given[1].image = k == MISSING ? NULL : &a;
        options->kind = k == NO_IDS ? PLANE_ID : PLANE_KINDS;
        options->noise = k == NOISE ? "a.png,b.png" : NULL;
        assert_int_equal(compare_make(options, &parsed, &comparison, &err), STATUS_USAGE);
        assert_true(err.text[0] != '\0');
        image_release(&a);
        parsed_release(&parsed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_images_agree),
        cmocka_unit_test(one_pixel_is_found),
        cmocka_unit_test(images_of_two_sizes_are_refused),
        cmocka_unit_test(ids_tell_segments),
        cmocka_unit_test(incomplete_images_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
