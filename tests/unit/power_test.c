/* Faults planted in pictures, and three programs of which one may stand alone. */
#include "compare/compare.h"
#include "unit.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { W = 61, H = 43, N = W * H };

static Err err;

/* ---- faults ---------------------------------------------------------------------------------- */

/* A gradient with a bright spot of 5 x 5 pixels, which begins at (40, 9). */
static Picture picture(int bits)
{
    Picture made;
    assert_int_equal(picture_init(&made, W, H, 3, bits, &err), STATUS_OK);
    for (int i = 0; i < 3 * N; i++) {
        int x = i / 3 % W, y = i / 3 / W, code = 31 + 2 * x + y + 7 * (i % 3);
        bool spot = x >= 40 && x < 45 && y >= 9 && y < 14;
        code = spot ? 251 : code;
        picture_set(&made, (size_t)i, (uint16_t)(bits == 8 ? code : 257 * code));
    }
    return made;
}

static Picture planted(const Picture *from, const char *name, double size)
{
    Picture made;
    assert_int_equal(picture_fault_plant(picture_fault_named(name), size, from, &made, &err),
                     STATUS_OK);
    return made;
}

static int code(const Picture *of, int x, int y, int c)
{
    return picture_code(of, (size_t)(3 * (y * W + x) + c));
}

static void moves_tones_and_rows_by_the_size_asked_for(void **state)
{
    (void)state;
    Picture clean = picture(8);
    Picture shifted = planted(&clean, "picture shifted", 3);
    Picture lower = planted(&clean, "codes lower", 10);
    Picture swapped = planted(&clean, "red and blue swapped", 0);
    Picture lost = planted(&clean, "a square lost", 3);
    assert_int_equal(code(&shifted, 23, 17, 1), code(&clean, 20, 17, 1));
    assert_int_equal(code(&lower, 23, 17, 1), code(&clean, 23, 17, 1) - 10);
    assert_int_equal(code(&swapped, 23, 17, 2), code(&clean, 23, 17, 0));
    int black = 0;
    for (int i = 0; i < N; i++)
        black += code(&lost, i % W, i / W, 0) == 0;
    assert_int_equal(black, 9);
    picture_release(&lost);
    picture_release(&swapped);
    picture_release(&lower);
    picture_release(&shifted);
    picture_release(&clean);
}

static void changes_light_where_renderers_do(void **state)
{
    (void)state;
    Picture clean = picture(16);
    Picture brighter = planted(&clean, "brighter", 10);
    float before = srgb_decode((float)code(&clean, 23, 17, 1) / 65535);
    float after = srgb_decode((float)code(&brighter, 23, 17, 1) / 65535);
    assert_true(fabs((double)(after / before) - 1.1) < 1e-3);
    picture_release(&brighter);
    picture_release(&clean);
}

/* ---- three programs -------------------------------------------------------------------------- */

typedef struct View {
    IdPlane ids;
    Plane depth;
} View;

/* A square of one segment, `off_mm` farther away than at 7 mm. */
static View view(double off_mm)
{
    View made;
    assert_int_equal(idplane_init(&made.ids, W, H, &err), STATUS_OK);
    assert_int_equal(plane_init(&made.depth, W, H, 1, &err), STATUS_OK);
    for (int i = 0; i < N; i++) {
        bool seen = i % W > 11 && i % W < 39 && i / W > 5 && i / W < 31;
        made.ids.ids[i] = seen ? 23 : 0;
        made.depth.values[i] = seen ? (float)(7 + off_mm) : HUGE_VALF;
    }
    return made;
}

/* What is said of three views that are so far off. */
static void expect_said(double a_mm, double b_mm, double c_mm, bool agrees, const char *sentence)
{
    View views[3] = {view(a_mm), view(b_mm), view(c_mm)};
    const Testimony three[3] = {{"One", &views[0].ids, &views[0].depth},
                                {"Two", &views[1].ids, &views[1].depth},
                                {"Three", &views[2].ids, &views[2].depth}};
    Witness witness = {0};
    assert_int_equal(witness_compare(three, 0.01, &witness, &err), STATUS_OK);
    assert_string_equal(witness.sentence, sentence);
    assert_int_equal(witness.agrees, agrees);
    witness_release(&witness);
    for (int i = 0; i < 3; i++) {
        idplane_release(&views[i].ids);
        plane_release(&views[i].depth);
    }
}

static void names_the_program_that_stands_alone(void **state)
{
    (void)state;
    expect_said(0, 0.004, -0.003, true,
                "One, Two and Three agree on what is visible at each pixel, and at what depth");
    expect_said(0.5, 0, 0, false, "Two and Three agree, and One stands alone");
    expect_said(0, 0.5, 0, false, "One and Three agree, and Two stands alone");
    expect_said(0, 0, 0.5, false, "One and Two agree, and Three stands alone");
    expect_said(0, 0.5, 1.2, false, "One, Two and Three: no two agree");
    expect_said(0, 0.008, 0.016, false,
                "One, Two and Three: two of the three pairs agree, and one does not");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moves_tones_and_rows_by_the_size_asked_for),
        cmocka_unit_test(changes_light_where_renderers_do),
        cmocka_unit_test(names_the_program_that_stands_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
