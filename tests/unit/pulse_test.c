/* Pulse waves, compared with Bessel functions, published spectra and conservation laws. Values of
 * Bessel functions are from arithmetic with 40 digits. */
#include "pulse/pulse.h"
#include "unit.h"

#include "derive/derive.h"
#include <complex.h>
#undef I /* a float */
#include <stdlib.h>
#include <string.h>

/* CMPLX is not in every C library. */
static double complex complex_of(double re, double im)
{
    const union {
        double part[2];
        double complex z;
    } made = {{re, im}};
    return made.z;
}

#define I complex_of(0, 1)

static double complex z_of(Phasor x)
{
    return complex_of(x.re, x.im);
}

static void assert_near(double complex value, double complex expected, double tolerance)
{
    if (!(cabs(value - expected) <= tolerance * cabs(expected)))
        fail_msg("%.17g %+.17gj is not %.17g %+.17gj", creal(value), cimag(value), creal(expected),
                 cimag(expected));
}

/* ---- friction and one vessel ----------------------------------------------------------------- */

static void friction_is_that_of_bessel_functions(void **state)
{
    (void)state;
    static const double expected[][3] = {
        {0, 1, 0},
        {0.001, 1.0000000000000009, 4.1666666666666638e-8},
        {0.1, 1.000000086805545, 4.1666663773148543e-4},
        {1, 1.0008670021142696, 0.041637770895304037},
        {3, 1.0641003121371718, 0.3559953716762031},
        {5, 1.3223559529149408, 0.79363036505774824},
        {10, 2.1757684368293093, 1.7297262145825391},
        {20, 3.9270860034462578, 3.5177654195407144},
        {100, 18.055983909900027, 17.674307905049149},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const Phasor h = pulse_friction(expected[i][0]);
        assert_near(h.re, expected[i][1], 2e-15);
        assert_near(h.im, expected[i][2], 4e-15);
    }
    /* For large alpha H is alpha sqrt(j) / 4 (1 + ...), and nothing overflows. */
    assert_near(z_of(pulse_friction(1e5)), 1e5 / 4 * csqrt(I), 0.01);
}

static PulseVessel vessel_of(const char *law, double radius, double length, double viscosity)
{
    PulseWall wall;
    assert_true(pulse_wall_parse(law, &wall));
    const double area = PI * radius * radius;
    return (PulseVessel){
        .resistance = 8 * viscosity * length / (area * radius * radius),
        .inertance = 1.05e-3 * length / area,
        .compliance = 3 * area / (2 * pulse_wall_stiffness(&wall, radius)) * length,
        .womersley_s = radius * radius * 1.05e-3 / viscosity,
    };
}

static double complex input_impedance(TwoPort port, double complex load)
{
    return (z_of(port.a) * load + z_of(port.b)) / (z_of(port.c) * load + z_of(port.a));
}

static void a_single_tube_is_that_of_bessel_functions(void **state)
{
    (void)state;
    const PulseVessel vessel = vessel_of("olufsen", 1.5, 100, 3.6e-3);
    const TwoPort port = pulse_twoport(&vessel, 0.8, 0, 1);
    const double complex a = z_of(port.a), b = z_of(port.b), c = z_of(port.c);
    assert_near(sqrt(FULL_TURN / 0.8 * vessel.womersley_s), 2.270281, 2e-7);
    assert_near(csqrt(b / c), 1.917981113 - 0.8961425558 * I, 1e-9);
    assert_near(cacosh(a) / 100, 4.8261385e-4 + 1.0329208e-3 * I, 1e-7);
    assert_near(input_impedance(port, 8), 6.9478997636 - 2.84294808131 * I, 1e-11);
    assert_near(a * a - b * c, 1, 1e-15);
}

static void two_tubes_reflect(void **state)
{
    (void)state;
    const PulseVessel first = vessel_of("olufsen", 1.5, 50, 3.6e-3);
    const PulseVessel second = vessel_of("olufsen", 1.0, 50, 3.6e-3);
    const TwoPort one = pulse_twoport(&first, 0.8, 0, 1), two = pulse_twoport(&second, 0.8, 0, 1);
    const double complex z1 = csqrt(z_of(one.b) / z_of(one.c)),
                         z2 = csqrt(z_of(two.b) / z_of(two.c));
    assert_near((z2 - z1) / (z2 + z1), 0.6178537728 - 0.0518366440 * I, 1e-9);
    assert_near(input_impedance(one, z2), 5.592812439 - 5.342987301 * I, 1e-9);
}

/* The series and its doublings against cosh, and tubes in which cosh overflows. */
static void long_tubes_do_not_overflow(void **state)
{
    (void)state;
    for (double length = 10; length < 1e5; length *= 3) {
        const PulseVessel vessel = vessel_of("adan", 0.35, length, 4e-3);
        const TwoPort port = pulse_twoport(&vessel, 0.9, 0, 7);
        const double complex h =
            z_of(pulse_friction(sqrt(FULL_TURN / 0.9 * 7 * vessel.womersley_s)));
        const double omega = FULL_TURN * 7 / 0.9;
        const double complex t = csqrt((vessel.resistance * h + I * omega * vessel.inertance) *
                                       (I * omega * vessel.compliance));
        if (creal(t) < 300)
            assert_near(z_of(port.a), ccosh(t), 1e-11 * fmax(1, cabs(t)));
    }
    const PulseVessel endless = vessel_of("adan", 0.005, 1e6, 4e-3);
    const TwoPort port = pulse_twoport(&endless, 0.9, 0, 1);
    assert_true(isinf(cabs(z_of(port.a))) || isnan(cabs(z_of(port.a))));
}

/* ---- structured trees ------------------------------------------------------------------------ */

/* Olufsen's tree of 2 mm: regression values of an independent program in Python. The density there
 * is 1.055e-3, so the radius-independent constants are scaled: rho enters as rho / mu and rho only
 * through Z, which is proportional to rho at fixed mu / rho and E / rho. */
static void a_structured_tree_has_its_spectrum(void **state)
{
    (void)state;
    static const struct {
        int k;
        double size, phase_deg;
    } expected[] = {{1, 1.5947409, -21.05}, {2, 1.2133281, -32.20}, {3, .91864705, -33.88},
                    {4, .7374982, -28.74},  {8, .71724348, -4.87},  {16, .76373574, -3.44}};
    const double scale = 1.05 / 1.055;
    const Waveform cycle = {.period_s = 1.1, .mean = 1};
    PulseParams params = {.drive = &cycle, .min_radius_mm = 0.1};
    params.wall = (PulseWall){{2.0e6 * scale, 8.65e4 * scale}, {-2.253, 0}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        Phasor y;
        Err err;
        must(pulse_structured(&params, 2, 4.9e-3 * scale, expected[i].k, &y, &err), &err);
        const double complex z = 1 / z_of(y) / scale;
        assert_near(cabs(z), expected[i].size, 5e-8);
        assert_true(fabs(carg(z) / DEGREE - expected[i].phase_deg) < 0.006);
    }
}

/* ---- trees ----------------------------------------------------------------------------------- */

/* A tree of n nodes with irregular lengths and radii; every outlet has flow of its own. */
static Tree make_tree(size_t n)
{
    Tree tree;
    Err err;
    must(tree_init(&tree, n, &err), &err);
    Random random;
    random_seed(&random, 7);
    for (size_t i = 0; i < n; i++) {
        tree.id[i] = (int32_t)i + 1;
        tree.parent[i] = i == 0 ? TREE_NO_PARENT : (int32_t)((i - 1) / 2);
        const Vec3 step = {0.6 + random_uniform(&random), random_uniform(&random), 0.3};
        tree.position[i] =
            i == 0 ? (Vec3){0, 0, 0} : vec3_add(tree.position[tree.parent[i]], vec3_scale(step, 7));
        tree.radius_mm[i] = 1.7 * pow(1 + (double)i, -0.36) * (0.8 + 0.4 * random_uniform(&random));
    }
    meta_set_number(&tree.meta, META_Q_PERF, 31);
    meta_set_number(&tree.meta, META_P_PERF, 96);
    meta_set_number(&tree.meta, META_VISCOSITY, 3.7);
    return tree;
}

static const TreeMeta no_options;

/* A cycle with all harmonics. */
static Waveform make_cycle(void)
{
    Waveform cycle = {.period_s = 0.83, .mean = 2.5, .harmonics = 16};
    for (int k = 1; k <= 16; k++) {
        cycle.re[k] = 0.7 / k;
        cycle.im[k] = (k % 3 - 1.2) / (k * k);
    }
    return cycle;
}

static PulseParams make_params(const Tree *tree, const Waveform *drive)
{
    PulseParams params = {.tree = tree,
                          .overrides = &no_options,
                          .harmonics = 16,
                          .drive = drive,
                          .outlet_time_s = 0.9,
                          .venous_pa = 700,
                          .wall_time_s = 0.01};
    assert_true(pulse_wall_parse("olufsen", &params.wall));
    return params;
}

/* 5-point Gauss rule for the power that a segment loses. */
static double power_lost(const Pulse *pulse, size_t i, int k)
{
    static const double x[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                               0.9061798459386640};
    static const double w[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                               0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    const double omega = FULL_TURN * k / pulse->period_s;
    const double alpha = sqrt(omega * pulse->vessel[i].womersley_s);
    for (int g = 0; g < 5; g++) {
        const double part = (1 - x[g]) / 2; /* of the segment, from its distal end */
        PulseVessel rest = pulse->vessel[i];
        rest.resistance *= part;
        rest.inertance *= part;
        rest.compliance *= part;
        const TwoPort port = pulse_twoport(&rest, pulse->period_s, pulse->params.wall_time_s, k);
        const double complex p_out = z_of(pulse_pressure(pulse, i, k)),
                             q_out = z_of(pulse_flow(pulse, i, k));
        const double complex q = z_of(port.c) * p_out + z_of(port.a) * q_out;
        const double complex p = z_of(port.a) * p_out + z_of(port.b) * q_out;
        const double delayed = omega * pulse->params.wall_time_s;
        const double viscous =
            pulse->vessel[i].compliance * omega * delayed / (1 + delayed * delayed);
        sum += w[g] / 4 *
               (pulse->vessel[i].resistance * pulse_friction(alpha).re * creal(q * conj(q)) +
                viscous * creal(p * conj(p)));
    }
    return sum;
}

static double power_of(double complex p, double complex q)
{
    return creal(p * conj(q)) / 2;
}

/* Pressure and flow agree at both ends of every vessel, flow is conserved at every bifurcation, and
 * the power that enters is lost in the vessels or leaves through the outlets. */
static void waves_conserve_flow_and_power(void **state)
{
    (void)state;
    Tree tree = make_tree(401);
    const Waveform cycle = make_cycle();
    const PulseParams params = make_params(&tree, &cycle);
    Pulse pulse;
    Err err;
    must(pulse_solve(&params, &pulse, &err), &err);
    for (int k = 1; k <= 16; k++) {
        double complex *flow = calloc(tree.n, sizeof *flow);
        double power = 0;
        for (size_t i = tree.n; i-- > 1;) {
            const TwoPort port =
                pulse_twoport(&pulse.vessel[i], pulse.period_s, params.wall_time_s, k);
            const double complex p = z_of(pulse_pressure(&pulse, i, k)),
                                 q = z_of(pulse_flow(&pulse, i, k));
            const double complex p_in = z_of(port.a) * p + z_of(port.b) * q;
            assert_near(p_in, z_of(pulse_pressure(&pulse, (size_t)tree.parent[i], k)), 3e-15);
            flow[tree.parent[i]] += z_of(port.c) * p + z_of(port.a) * q;
            power += power_lost(&pulse, i, k);
            if (2 * i + 1 >= tree.n)
                power += power_of(p, q);
            else
                assert_near(flow[i], q, 3e-15);
        }
        assert_near(flow[0], z_of(pulse_flow(&pulse, 0, k)), 3e-15);
        assert_near(power, power_of(z_of(pulse_pressure(&pulse, 0, k)), flow[0]), 5e-14);
        const double complex drive = pa_from_mmhg(96) / 2.5 * complex_of(cycle.re[k], cycle.im[k]);
        assert_near(z_of(pulse_pressure(&pulse, 0, k)), drive, 1e-15);
        free(flow);
    }
    pulse_release(&pulse);
    tree_release(&tree);
}

/* The mean over a cycle is the steady solution: exactly at the root of the sums, and to rounding
 * over the frames. */
static void the_mean_is_the_steady_solution(void **state)
{
    (void)state;
    enum { FRAMES = 40 };
    Tree tree = make_tree(55);
    const Waveform cycle = make_cycle();
    const PulseParams params = make_params(&tree, &cycle);
    Pulse pulse;
    Err err;
    must(pulse_solve(&params, &pulse, &err), &err);
    static const struct {
        PulseField field;
        const char *name;
    } fields[] = {{PULSE_PRESSURE, "pressure"},
                  {PULSE_FLOW, "flow"},
                  {PULSE_VELOCITY, "velocity"},
                  {PULSE_WSS, "wss"}};
    double *column[FRAMES];
    for (int m = 0; m < FRAMES; m++)
        column[m] = calloc(tree.n, sizeof **column);
    for (size_t f = 0; f < 4; f++) {
        Field steady;
        must(derive_field(&tree, &no_options, fields[f].name, &steady, &err), &err);
        must(pulse_field_over_time(&pulse, fields[f].field, FRAMES, column, 2, &err), &err);
        for (size_t i = 1; i < tree.n; i++) {
            double sum = 0;
            for (int m = 0; m < FRAMES; m++)
                sum += column[m][i];
            assert_near(sum / FRAMES, steady.value[i], 2e-14);
        }
        field_release(&steady);
    }
    for (int m = 0; m < FRAMES; m++)
        free(column[m]);
    pulse_release(&pulse);
    tree_release(&tree);
}

/* The summary against a computation from the frames of pulse_field_over_time. */
static void cycles_agree_with_the_frames(void **state)
{
    (void)state;
    Tree tree = make_tree(31);
    Waveform cycle = make_cycle();
    PulseParams params = make_params(&tree, &cycle);
    cycle.is_flow = true;
    cycle.mean = 0.6; /* flow that reverses */
    Pulse pulse;
    PulseMeasures *cycles;
    double *column[PULSE_SAMPLES];
    Err err;
    must(pulse_solve(&params, &pulse, &err), &err);
    must(pulse_measure(&pulse, 2, &cycles, &err), &err);
    for (int m = 0; m < PULSE_SAMPLES; m++)
        column[m] = calloc(tree.n, sizeof **column);
    must(pulse_field_over_time(&pulse, PULSE_WSS, PULSE_SAMPLES, column, 1, &err), &err);
    size_t oscillating = 0;
    for (size_t i = 1; i < tree.n; i++) {
        double sum = 0, size = 0;
        for (int m = 0; m < PULSE_SAMPLES; m++) {
            sum += column[m][i];
            size += fabs(column[m][i]);
        }
        assert_near(cycles[i].tawss, size / PULSE_SAMPLES, 1e-14);
        assert_true(fabs(cycles[i].osi - 0.5 * (1 - fabs(sum) / size)) < 1e-14);
        oscillating += cycles[i].osi > 0.01;
        assert_true(cycles[i].delay_ms > -50 && cycles[i].delay_ms < 200);
    }
    assert_true(oscillating > 0);
    for (int m = 0; m < PULSE_SAMPLES; m++)
        free(column[m]);
    free(cycles);
    pulse_release(&pulse);
    tree_release(&tree);
}

static void threads_do_not_change_the_bits(void **state)
{
    (void)state;
    Tree tree = make_tree(333);
    const Waveform cycle = make_cycle();
    PulseParams params = make_params(&tree, &cycle);
    params.outlet = PULSE_STRUCTURED;
    params.min_radius_mm = 0.05;
    Pulse one, two;
    Err err;
    params.threads = 1;
    must(pulse_solve(&params, &one, &err), &err);
    params.threads = 3;
    must(pulse_solve(&params, &two, &err), &err);
    assert_memory_equal(one.waves, two.waves, 8 * tree.n * sizeof *one.waves);
    pulse_release(&one);
    pulse_release(&two);
    tree_release(&tree);
}

/* The pressure of the tissue drives flow out of the outlets. With a rigid tree and no drive, the
 * flow of each outlet follows from its own network alone. */
static void tissue_pressure_moves_blood(void **state)
{
    (void)state;
    Tree tree = make_tree(3);
    const Waveform cycle = {.period_s = 0.83, .mean = 1, .harmonics = 16};
    Waveform tissue = make_cycle();
    tissue.re[3] = 4000;
    PulseParams params = make_params(&tree, &cycle);
    params.wall = (PulseWall){{0, 0}, {0, 0}};
    params.tissue = &tissue;
    Pulse pulse;
    Err err;
    must(pulse_solve(&params, &pulse, &err), &err);
    const int k = 3;
    const double omega = FULL_TURN * k / 0.83;
    const TwoPort port = pulse_twoport(&pulse.vessel[1], 0.83, 0, k);
    const double r = (pa_from_mmhg(pulse.pressure[1]) - 700) / mm3_s_from_ml_min(pulse.flow[1]);
    const double ra = 0.32 * r, ram = 0.52 * r, rv = 0.16 * r;
    const double cim = 0.287 * (1 / rv + 1 / (ra + ram)), ca = 0.124 * cim;
    /* Nodes m, between Ra and Ram, and n, behind Ram; the pressure at the root is 0. */
    const double complex pim = complex_of(tissue.re[k], tissue.im[k]), before = z_of(port.b) + ra;
    const double complex mm = 1 / before + 1 / ram + I * omega * ca, mn = -1 / ram,
                         nn = 1 / ram + 1 / rv + I * omega * cim, from = I * omega * cim * pim;
    const double complex m = -mn * from / (mm * nn - mn * mn);
    assert_near(z_of(pulse_flow(&pulse, 1, k)), -m / before, 1e-12);
    pulse_release(&pulse);
    tree_release(&tree);
}

/* ---- waveforms ------------------------------------------------------------------------------- */

/* A triangle has the coefficients 8 / (pi k)^2 cos for odd k. */
static void coarse_samples_have_exact_integrals(void **state)
{
    (void)state;
    static const double times[] = {2, 2.25, 2.5, 2.75, 3}, values[] = {5, 4, 3, 4, 5};
    Waveform cycle;
    Err err;
    must(waveform_sample(times, values, 5, 2, &cycle, &err), &err);
    assert_near(cycle.mean, 4, 1e-15);
    assert_near(cycle.period_s, 1, 1e-15);
    assert_near(cycle.re[1], 8 / (PI * PI), 1e-14);
    assert_true(fabs(cycle.im[1]) < 1e-15 && fabs(cycle.re[2]) < 1e-15);
    assert_int_equal(waveform_sample(times, values, 5, 3, &cycle, &err), STATUS_INPUT);
    static const double open[] = {5, 4, 3, 4, 4.9};
    assert_int_equal(waveform_sample(times, open, 5, 2, &cycle, &err), STATUS_INPUT);
    static const double zero[] = {1, 0, -1, 0, 1};
    assert_int_equal(waveform_sample(times, zero, 5, 2, &cycle, &err), STATUS_INPUT);
}

static void wall_laws_have_their_wave_speeds(void **state)
{
    (void)state;
    static const struct {
        const char *law;
        double radius, speed;
    } expected[] = {
        {"olufsen", 10, 7.4},   {"olufsen", 1.5, 9.9}, {"olufsen", 0.5, 21.6},
        {"olufsen", 0.1, 32.7}, {"adan", 10, 4.1},     {"adan", 1.5, 6.1},
        {"adan", 0.5, 7.1},     {"adan", 0.1, 7.55},   {"2.0e6,-2.253,8.65e4", 0.5, 21.6}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        PulseWall wall;
        assert_true(pulse_wall_parse(expected[i].law, &wall));
        const double speed =
            sqrt(pulse_wall_stiffness(&wall, expected[i].radius) / (1.5 * 1.05e-3)) / 1000;
        if (!(fabs(speed - expected[i].speed) <= 0.0501))
            fail_msg("%s at %g mm: %g m/s", expected[i].law, expected[i].radius, speed);
    }
    PulseWall wall;
    assert_false(pulse_wall_parse("soft", &wall));
    assert_false(pulse_wall_parse("1,2", &wall));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(friction_is_that_of_bessel_functions),
        cmocka_unit_test(a_single_tube_is_that_of_bessel_functions),
        cmocka_unit_test(two_tubes_reflect),
        cmocka_unit_test(long_tubes_do_not_overflow),
        cmocka_unit_test(a_structured_tree_has_its_spectrum),
        cmocka_unit_test(waves_conserve_flow_and_power),
        cmocka_unit_test(the_mean_is_the_steady_solution),
        cmocka_unit_test(cycles_agree_with_the_frames),
        cmocka_unit_test(threads_do_not_change_the_bits),
        cmocka_unit_test(tissue_pressure_moves_blood),
        cmocka_unit_test(coarse_samples_have_exact_integrals),
        cmocka_unit_test(wall_laws_have_their_wave_speeds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
