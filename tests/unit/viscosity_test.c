/* The viscosity law of Pries, compared with the published formula in decimal arithmetic. */
#include "tree/tree.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g is not %.17g", value, expected);
}

/* The published formula in decimal arithmetic of 40 digits. */
static void the_law_of_pries_is_that_of_the_paper(void **state)
{
    (void)state;
    static const struct {
        double diameter_um, hematocrit, relative;
    } expected[] = {
        {4, 0.20, 8.921561572189681},    {4, 0.45, 17.69648197871242},
        {4, 0.60, 22.96221923713885},    {6, 0.20, 5.250769963090434},
        {6, 0.45, 10.0115605367648},     {8, 0.20, 3.5880577177797},
        {8, 0.45, 7.307300892073194},    {8, 0.60, 10.42118105505816},
        {10, 0.20, 2.651410273657742},   {10, 0.45, 5.872437674178901},
        {20, 0.45, 3.231083561724491},   {20, 0.60, 5.008320108143673},
        {40, 0.45, 2.313669532923821},   {100, 0.20, 1.503256737457667},
        {100, 0.45, 2.531539124845802},  {500, 0.45, 3.133416133702462},
        {3000, 0.20, 1.702838929988972}, {3000, 0.45, 3.203895594707551},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        double viscosity =
            viscosity_pries_pa_s(expected[i].diameter_um / 2000, expected[i].hematocrit, 1.0625e-3);
        assert_close(viscosity, 1.0625e-3 * expected[i].relative, 1e-12);
    }
}

/* In glass the viscosity at a hematocrit of 0.45 is 220 exp(-1.3 D) + 3.2 - 2.44 exp(-0.06 D^0.645)
 * [Pries, Neuhaus & Gaehtgens, Am. J. Physiol. 263 (1992) H1770-1778]; "flow resistance in 10-um
 * microvessels at normal hematocrit is found to exceed that of a corresponding glass tube by a
 * factor of ~4" [Pries et al. 1994, abstract], and the two agree in wide vessels. */
static void narrow_vessels_resist_four_times_as_much_as_glass(void **state)
{
    (void)state;
    double glass = 220 * exp(-13) + 3.2 - 2.44 * exp(-0.06 * pow(10, 0.645));
    double ratio = viscosity_pries_pa_s(0.005, 0.45, 1) / glass;
    assert_true(ratio > 3.5 && ratio < 4.5);
    double wide = 3.2 - 2.44 * exp(-0.06 * pow(2000, 0.645));
    assert_close(viscosity_pries_pa_s(1, 0.45, 1), wide, 3e-3);
}

static void plasma_alone_feels_only_the_wall_layer(void **state)
{
    (void)state;
    double narrowing = 7.3 / (7.3 - 1.1);
    assert_close(viscosity_pries_pa_s(0.00365, 0, 1.2e-3), 1.2e-3 * narrowing * narrowing, 1e-14);
}

/* The exponent C passes through zero between 8 and 9 micrometres. */
static void the_law_is_smooth_where_its_exponent_changes_sign(void **state)
{
    (void)state;
    double before = viscosity_pries_pa_s(0.004, 0.3125, 1);
    for (int i = 1; i <= 100000; i++) {
        double after = viscosity_pries_pa_s(0.004 + 5e-9 * i, 0.3125, 1);
        assert_true(after < before && before - after < 1e-4);
        before = after;
    }
}

static void more_cells_are_thicker_at_every_diameter(void **state)
{
    (void)state;
    for (double diameter_um = 2; diameter_um < 5000; diameter_um *= 1.0625) {
        double before = 0;
        for (int percent = 0; percent < 95; percent += 5) {
            double viscosity = viscosity_pries_pa_s(diameter_um / 2000, percent / 100.0, 1.2e-3);
            assert_true(viscosity > before && isfinite(viscosity));
            before = viscosity;
        }
    }
}

static void nothing_passes_where_the_wall_layers_meet(void **state)
{
    (void)state;
    assert_true(isinf(viscosity_pries_pa_s(0.00055, 0.45, 1.2e-3)));
    assert_true(isinf(viscosity_pries_pa_s(0, 0.45, 1.2e-3)));
    assert_true(isfinite(viscosity_pries_pa_s(0.00056, 0.45, 1.2e-3)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_law_of_pries_is_that_of_the_paper),
        cmocka_unit_test(narrow_vessels_resist_four_times_as_much_as_glass),
        cmocka_unit_test(plasma_alone_feels_only_the_wall_layer),
        cmocka_unit_test(the_law_is_smooth_where_its_exponent_changes_sign),
        cmocka_unit_test(more_cells_are_thicker_at_every_diameter),
        cmocka_unit_test(nothing_passes_where_the_wall_layers_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
