/* The search for the first crossing of a level against crossings that are known exactly. A term is
 * a parabola height - bend (z - middle)^2 on an interval, so that crossings are roots in closed
 * form. */
#include "unit.h"

#include "answer/levelray.h"

enum { TERMS = 3, REPETITIONS = 4000 / SHARE };

static uint64_t state = 77;

/* Returns a number in [0, 1). */
static double unit_number(void)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return ldexp((double)(state >> 20), -44);
}

/* The parabola is stored in `peak` (height) and `ends` (bend). */
static LevelSample sample_parabola(const LevelTerm *term, double z)
{
    const double x = z - term->distance.middle;
    return (LevelSample){term->peak - term->ends * x * x, -2 * term->ends * x, 1e-15, 1e-15};
}

static const LevelKind parabola = {.sample = sample_parabola};

/* Returns a hump that ends where it is 0, at a random distance. */
static LevelTerm make_hump(double height)
{
    const double bend = 0.1 + unit_number(), half = sqrt(height / bend);
    const double middle = 5 + 100 * unit_number();
    return (LevelTerm){.kind = &parabola,
                       .peak = height,
                       .ends = bend,
                       .distance.middle = middle,
                       .from = middle - half,
                       .to = middle + half,
                       .window_from = middle - half,
                       .window_to = middle + half,
                       .concave = 2 * bend};
}

/* Returns the first crossing of level 1 by a single hump; infinite if there is none. */
static double first_of_humps(const LevelTerm *humps, int n)
{
    double first = (double)INFINITY;
    for (int i = 0; i < n; i++)
        if (humps[i].peak > 1)
            first =
                fmin(first, humps[i].distance.middle - sqrt((humps[i].peak - 1) / humps[i].ends));
    return first;
}

static bool humps_overlap(const LevelTerm *humps, int n)
{
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            if (humps[i].from < humps[k].to && humps[k].from < humps[i].to)
                return true;
    return false;
}

static void first_crossings_are_enclosed(void **unused)
{
    (void)unused;
    int found = 0, missed = 0;
    for (int i = 0; i < REPETITIONS; i++) {
        LevelTerm humps[TERMS];
        const LevelTerm *terms[TERMS];
        for (int k = 0; k < TERMS; k++) {
            humps[k] = make_hump(0.5 + 0.8 * unit_number());
            terms[k] = &humps[k];
        }
        if (humps_overlap(humps, TERMS))
            continue;
        const LevelRay ray = {.terms = terms, .n = TERMS, .level = 1};
        const LevelCrossing at = levelray_first(&ray, 0, (double)INFINITY, true);
        const double expected = first_of_humps(humps, TERMS);
        if (at.state == LEVEL_FOUND) {
            if (!(fabs(at.z - expected) <= at.error + 1e-13) || !(at.error < 1e-9))
                fail_msg("%.17g is not in %.17g +- %g", expected, at.z, at.error);
            found++;
        } else {
            assert_int_equal(at.state, LEVEL_MISSED);
            assert_true(isinf(expected));
            missed++;
        }
    }
    assert_true(found > REPETITIONS / 3);
    assert_true(missed > REPETITIONS / 20);
}

/* A ray that touches the level, to rounding errors, is undecided. A ray from a point of the surface
 * does not find this point. */
static void special_rays_are_not_guessed(void **unused)
{
    (void)unused;
    LevelTerm hump = make_hump(1);
    const LevelTerm *terms[] = {&hump};
    LevelRay ray = {.terms = terms, .n = 1, .level = 1};
    assert_int_equal(levelray_first(&ray, 0, (double)INFINITY, true).state, LEVEL_UNDECIDED);
    hump = make_hump(1.25);
    const double leaves = hump.distance.middle + sqrt(0.25 / hump.ends);
    assert_int_equal(levelray_first(&ray, leaves, (double)INFINITY, false).state, LEVEL_MISSED);
    assert_int_equal(levelray_first(&ray, leaves - 0.01, (double)INFINITY, false).state,
                     LEVEL_UNDECIDED);
    assert_int_equal(levelray_first(&ray, 0, hump.from, true).state, LEVEL_MISSED);
    ray.dropped = 0.5; /* the sum may be larger by this */
    hump = make_hump(0.75);
    assert_int_equal(levelray_first(&ray, 0, (double)INFINITY, true).state, LEVEL_UNDECIDED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_crossings_are_enclosed),
        cmocka_unit_test(special_rays_are_not_guessed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
