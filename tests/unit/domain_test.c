/* The domains: specs read and refused, what is inside, and sampling held to equal-volume cells. */
#include "domain/domain.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static Domain parsed(const char *spec)
{
    Domain domain;
    Err err;
    assert_int_equal(domain_parse(&domain, spec, &err), STATUS_OK);
    return domain;
}

static void reads_a_disc_and_a_ball(void **state)
{
    (void)state;
    Domain disc = parsed("disc:23.85"), ball = parsed("ball:1e6");
    assert_int_equal(domain_dimension(&disc), 2);
    assert_int_equal(domain_dimension(&ball), 3);
    assert_true(fabs(domain_volume(&disc) - pi * 23.85 * 23.85) < 1e-9);
    assert_true(fabs(domain_volume(&ball) / (4 * pi / 3 * 1e18) - 1) < 1e-12);
    Vec3 inlet = domain_default_inlet(&disc);
    assert_true(inlet.x == 0 && inlet.y == 23.85 && inlet.z == 0);
    assert_true(domain_inside(&disc, inlet, 0));
    Box flat = domain_bounds(&disc), cube = domain_bounds(&ball);
    assert_true(flat.low.x == -23.85 && flat.high.y == 23.85 && flat.low.z == 0 &&
                flat.high.z == 0);
    assert_true(cube.low.z == -1e6 && cube.high.z == 1e6);
}

static void writes_the_spec_it_reads(void **state)
{
    (void)state;
    const char *specs[] = {"disc:50", "ball:0.1", "disc:23.85", "ball:1000000"};
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        Domain domain = parsed(specs[i]);
        Text text = TEXT_INIT;
        domain_text(&domain, &text);
        assert_string_equal(text.chars, specs[i]);
        text_release(&text);
    }
}

static void refuses_what_is_no_domain_with_a_sentence(void **state)
{
    (void)state;
    const char *specs[] = {"",         "disc",     "disc:",      "disc:0",  "disc:-3",  "disc:nan",
                           "disc:inf", "disc:1e7", "ball:1e-7",  "disc:5 ", "ball:5,5", "sphere:50",
                           "dis:50",   "discs:50", "ball:fifty", ":50"};
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        Domain domain = {.radius_mm = 7.25};
        Err err = {""};
        assert_int_equal(domain_parse(&domain, specs[i], &err), STATUS_USAGE);
        assert_non_null(strstr(err.text, "--domain"));
        assert_non_null(strstr(err.text, specs[i]));
        assert_true(domain.radius_mm == 7.25);
    }
}

static void knows_inside_from_outside(void **state)
{
    (void)state;
    Domain disc = parsed("disc:5"), ball = parsed("ball:5");
    assert_true(domain_inside(&disc, vec3(3, -4, 0), 0));
    assert_false(domain_inside(&disc, vec3(3, -4.001, 0), 0));
    assert_true(domain_inside(&disc, vec3(3, -4.001, 0), 0.01));
    assert_false(domain_inside(&disc, vec3(1, 1, 0.5), 0.01));
    assert_true(domain_inside(&ball, vec3(2, -3, 3.46), 0));
    assert_false(domain_inside(&ball, vec3(2, -3, 3.47), 0));
    assert_false(domain_inside(&ball, vec3(NAN, 0, 0), 0));
}

enum { SAMPLES = 200000 };

/* Chi-square of samples in `shells` x `sectors` x `belts` cells of equal volume. */
static double chi_square(const Domain *domain, int shells, int sectors, int belts)
{
    int cells = shells * sectors * belts;
    int *count = calloc((size_t)cells, sizeof *count);
    assert_non_null(count);
    Random random;
    random_seed(&random, 2385);
    for (int i = 0; i < SAMPLES; i++) {
        Vec3 p = domain_sample(domain, &random);
        assert_true(domain_inside(domain, p, 0));
        double r = vec3_length(p);
        int shell = (int)(shells * pow(r / domain->radius_mm, domain_dimension(domain)));
        int sector = (int)(sectors * (atan2(p.y, p.x) + pi) / (2 * pi));
        int belt = (int)(belts * (p.z / r + 1) / 2);
        shell = shell < shells ? shell : shells - 1;
        sector = sector < sectors ? sector : sectors - 1;
        belt = belt < belts ? belt : belts - 1;
        count[(shell * sectors + sector) * belts + belt]++;
    }
    double expected = (double)SAMPLES / cells, sum = 0;
    for (int i = 0; i < cells; i++)
        sum += (count[i] - expected) * (count[i] - expected) / expected;
    free(count);
    return sum;
}

/* The bound is five standard deviations of chi-square with cells - 1 degrees of freedom. */
static void samples_are_uniform(void **state)
{
    (void)state;
    Domain disc = parsed("disc:23.85"), ball = parsed("ball:0.7");
    double freedom = 12 * 16 - 1;
    assert_true(chi_square(&disc, 12, 16, 1) < freedom + 5 * sqrt(2 * freedom));
    freedom = 7 * 8 * 6 - 1;
    assert_true(chi_square(&ball, 7, 8, 6) < freedom + 5 * sqrt(2 * freedom));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_a_disc_and_a_ball),
        cmocka_unit_test(writes_the_spec_it_reads),
        cmocka_unit_test(refuses_what_is_no_domain_with_a_sentence),
        cmocka_unit_test(knows_inside_from_outside),
        cmocka_unit_test(samples_are_uniform),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
