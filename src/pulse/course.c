/* Computes fields over time, and measures over a cycle, from the amplitudes of pressure and flow.
 *
 * Each field is linear in pressure or flow. So its amplitudes at a segment are the amplitudes of
 * pressure or flow times a complex factor per harmonic [make_spectrum]. Its value at a moment is
 * the sum over the harmonics. Segments are independent of each other, and each sum has a fixed
 * order, so results do not depend on threads. */
#include "pulse/solve.h"
#include "pulse/twoport.h"

#include <math.h>
#include <stdlib.h>

const struct PulseFieldRow pulse_fields[PULSE_FIELDS] = {
    [PULSE_PRESSURE] = {"pressure", "mmHg", "pressure"},
    [PULSE_FLOW] = {"flow", "ml/min", "flow"},
    [PULSE_VELOCITY] = {"velocity", "mm/s", "mean velocity over the cross-section"},
    [PULSE_WSS] = {"wss", "Pa", "wall shear stress"},
    [PULSE_DILATION] = {"dilation", "", "change of the radius / mean radius"},
};

/* Number of segments that a thread computes at a time. It affects time only. */
enum { CHUNK_SEGMENTS = 4096 };

static size_t chunks_of(const Pulse *pulse)
{
    return (pulse->n + CHUNK_SEGMENTS - 1) / CHUNK_SEGMENTS;
}

static size_t chunk_end(const Pulse *pulse, size_t chunk)
{
    const size_t end = (chunk + 1) * CHUNK_SEGMENTS;
    return end < pulse->n ? end : pulse->n;
}

/* Makes a table of cos and sin of 2 pi k m / n for the harmonics k and the moments m of n. The
 * entry of k and m is [m * harmonics + k - 1], so that all harmonics of one moment are together.
 * The caller frees *table. */
static Status make_table(const Pulse *pulse, size_t n, Phasor **table, Err *err)
{
    const size_t harmonics = (size_t)pulse->params.harmonics;
    TRY(mem_alloc(table, n * harmonics, sizeof **table, "moments", err));
    for (size_t m = 0; m < n; m++)
        for (size_t k = 1; k <= harmonics; k++) {
            const double angle = FULL_TURN * (double)(k * m % n) / (double)n;
            (*table)[m * harmonics + k - 1] =
                (Phasor){elementary_cos(angle), elementary_sin(angle)};
        }
    return STATUS_OK;
}

/* The amplitudes of a field at one segment. */
typedef struct Spectrum {
    double mean;
    int harmonics;
    Phasor at[WAVEFORM_MAX_HARMONICS + PAIR]; /* harmonic k is at[k - 1] */
} Spectrum;

/* Returns the value of a field at the moment whose table entries are turn[0] to turn[harmonics -
 * 1]. */
static double value_at(const Spectrum *spectrum, const Phasor *turn)
{
    double x = spectrum->mean;
    for (int k = 0; k < spectrum->harmonics; k++)
        x += spectrum->at[k].re * turn[k].re - spectrum->at[k].im * turn[k].im;
    return x;
}

/* Turns amplitudes of flow into amplitudes of the wall shear stress: multiplies them by `factor`,
 * which holds for steady flow, and by the friction factor. */
static void shear_spectrum(const Pulse *pulse, size_t i, double factor, Spectrum *out)
{
    for (int k = 0; k < out->harmonics; k += PAIR) {
        const PairFrequency at = pairfrequency(k + 1, pulse->period_s, 0);
        const PairC friction = pair_friction(at.omega * pulse->vessel[i].womersley_s);
        for (int lane = 0; lane < PAIR; lane++) {
            Phasor *x = &out->at[k + lane];
            const double re = friction.re[lane] * factor, im = friction.im[lane] * factor;
            *x = (Phasor){x->re * re - x->im * im, x->re * im + x->im * re};
        }
    }
}

/* Turns amplitudes of pressure into amplitudes of the relative change of the radius: multiplies
 * them by half the distensibility of the area, 1.5 / stiffness. A viscous wall with the time
 * constant t_w delays the change: it divides the factor by 1 + j w t_w. */
static void dilation_spectrum(const Pulse *pulse, double radius, Spectrum *out)
{
    const double stiffness = pulse_wall_stiffness(&pulse->params.wall, radius);
    const double half = stiffness > 0 ? 0.75 / stiffness : 0;
    for (int k = 1; k <= out->harmonics; k++) {
        const double delayed = FULL_TURN * k / pulse->period_s * pulse->params.wall_time_s;
        const double re = half / (1 + delayed * delayed), im = -delayed * re;
        Phasor *x = &out->at[k - 1];
        *x = (Phasor){x->re * re - x->im * im, x->re * im + x->im * re};
    }
    out->mean = 0;
}

static void scale_spectrum(Spectrum *out, double factor)
{
    for (int k = 0; k < out->harmonics; k++)
        out->at[k] = (Phasor){out->at[k].re * factor, out->at[k].im * factor};
}

/* Computes the spectrum of a field at segment i, in the unit of the field. The means are those of
 * the steady solution. One harmonic more than wanted is read if the number of harmonics is odd,
 * because shear_spectrum works on pairs. */
static void make_spectrum(const Pulse *pulse, PulseField field, size_t i, Spectrum *out)
{
    const double radius = pulse->params.tree->radius_mm[i], area = PI * radius * radius;
    const bool of_pressure = field == PULSE_PRESSURE || field == PULSE_DILATION;
    const double q = mm3_s_from_ml_min(pulse->flow[i]);
    out->harmonics = pulse->params.harmonics;
    for (int k = 1; k <= out->harmonics + out->harmonics % PAIR; k++)
        out->at[k - 1] = of_pressure ? pulse_pressure(pulse, i, k) : pulse_flow(pulse, i, k);
    if (field == PULSE_PRESSURE) {
        out->mean = pulse->pressure[i];
        scale_spectrum(out, mmhg_from_pa(1));
    } else if (field == PULSE_FLOW) {
        out->mean = pulse->flow[i];
        scale_spectrum(out, ml_min_from_mm3_s(1));
    } else if (field == PULSE_VELOCITY) {
        out->mean = q / area;
        scale_spectrum(out, 1 / area);
    } else if (field == PULSE_WSS) {
        const double viscosity = pulse->viscosity[i];
        out->mean = 4 * viscosity * q / (PI * radius * radius * radius);
        shear_spectrum(pulse, i, 4 * viscosity / (area * radius), out);
    } else {
        dilation_spectrum(pulse, radius, out);
    }
}

/* ---- frames ---------------------------------------------------------------------------------- */

typedef struct Course {
    const Pulse *pulse;
    PulseField field;
    size_t frames;
    double *const *column;
    const Phasor *table;
} Course;

/* Computes the field of a chunk of segments at all moments. */
static void fill_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const Course *course = context;
    const Pulse *pulse = course->pulse;
    for (size_t i = chunk * CHUNK_SEGMENTS; i < chunk_end(pulse, chunk); i++) {
        const bool is_segment = tree_is_segment(pulse->params.tree, i);
        Spectrum spectrum;
        if (is_segment)
            make_spectrum(pulse, course->field, i, &spectrum);
        for (size_t m = 0; m < course->frames; m++)
            course->column[m][i] =
                is_segment ? value_at(&spectrum, course->table + m * (size_t)spectrum.harmonics)
                           : (double)NAN;
    }
}

Status pulse_field_over_time(const Pulse *pulse, PulseField field, size_t frames,
                             double *const *column, int threads, Err *err)
{
    Phasor *table;
    TRY(make_table(pulse, frames, &table, err));
    Course course = {pulse, field, frames, column, table};
    threads_for(chunks_of(pulse), threads, fill_chunk, &course);
    free(table);
    return STATUS_OK;
}

/* ---- cycles ---------------------------------------------------------------------------------- */

enum { HALF_CYCLE = PULSE_SAMPLES / 2 };

/* cos and sin of 2 pi k m / PULSE_SAMPLES for one harmonic k and all moments m up to half a cycle.
 */
typedef struct Turns {
    double cos[HALF_CYCLE + 1], sin[HALF_CYCLE + 1];
} Turns;

typedef struct CycleJob {
    const Pulse *pulse;
    const Turns *turns; /* per harmonic; owned by pulse_measure */
    PulseMeasures *cycle;
} CycleJob;

/* Computes the samples of a field. The moments m and PULSE_SAMPLES - m have equal cosines and
 * opposite sines, so half of the products suffice. */
static void find_samples(const Spectrum *spectrum, const Turns *turns, double x[PULSE_SAMPLES])
{
    double even[HALF_CYCLE + 1] = {0}, odd[HALF_CYCLE + 1] = {0};
    for (int k = 0; k < spectrum->harmonics; k++)
        for (int m = 0; m <= HALF_CYCLE; m++) {
            even[m] += spectrum->at[k].re * turns[k].cos[m];
            odd[m] += spectrum->at[k].im * turns[k].sin[m];
        }
    for (int m = 0; m <= HALF_CYCLE; m++) {
        x[m] = spectrum->mean + (even[m] - odd[m]);
        x[(PULSE_SAMPLES - m) % PULSE_SAMPLES] = spectrum->mean + (even[m] + odd[m]);
    }
}

/* Finds the minimum and the maximum of a field over a cycle. */
static void find_range(const Spectrum *spectrum, const Turns *turns, double range[2])
{
    double x[PULSE_SAMPLES];
    find_samples(spectrum, turns, x);
    range[0] = range[1] = x[0];
    for (int m = 1; m < PULSE_SAMPLES; m++) {
        range[0] = x[m] < range[0] ? x[m] : range[0];
        range[1] = x[m] > range[1] ? x[m] : range[1];
    }
}

/* Computes the measures of the wall shear stress from its samples. */
static void find_shear(const Spectrum *spectrum, const Turns *turns, PulseMeasures *cycle)
{
    double x[PULSE_SAMPLES], sum = 0, sizes = 0;
    find_samples(spectrum, turns, x);
    for (int m = 0; m < PULSE_SAMPLES; m++) {
        sum += x[m];
        sizes += fabs(x[m]);
    }
    cycle->wss_mean = spectrum->mean;
    cycle->tawss = sizes / PULSE_SAMPLES;
    cycle->osi = sizes > 0 ? fmax(0.5 * (1 - fabs(sum) / sizes), 0) : 0;
}

/* Returns the strain of the area: its maximum less its minimum, divided by its mean. In an elastic
 * wall it follows from the range of pressure; a viscous wall needs the range of the dilation. */
static double find_strain(const CycleJob *cycles, size_t i, double stiffness)
{
    const double *pressure = cycles->cycle[i].pressure;
    Spectrum spectrum;
    double dilation[2];
    if (!(cycles->pulse->params.wall_time_s > 0))
        return stiffness > 0 ? 1.5 * pa_from_mmhg(pressure[1] - pressure[0]) / stiffness : 0;
    make_spectrum(cycles->pulse, PULSE_DILATION, i, &spectrum);
    find_range(&spectrum, cycles->turns, dilation);
    return 2 * (dilation[1] - dilation[0]);
}

/* Computes the measures of segment i. The wave speed is Moens and Korteweg's for the stiffness E h
 * / r and a Poisson's ratio of 0.5: c^2 = (E h / r) / (1.5 rho), in mm/s, and 1e-3 converts to m/s.
 */
static void find_cycle(const CycleJob *cycles, size_t i)
{
    const Pulse *pulse = cycles->pulse;
    PulseMeasures *cycle = &cycles->cycle[i];
    const double radius = pulse->params.tree->radius_mm[i];
    const double stiffness = pulse_wall_stiffness(&pulse->params.wall, radius);
    Spectrum spectrum;
    make_spectrum(pulse, PULSE_PRESSURE, i, &spectrum);
    find_range(&spectrum, cycles->turns, cycle->pressure);
    make_spectrum(pulse, PULSE_FLOW, i, &spectrum);
    find_range(&spectrum, cycles->turns, cycle->flow);
    make_spectrum(pulse, PULSE_WSS, i, &spectrum);
    find_shear(&spectrum, cycles->turns, cycle);
    cycle->area_strain = find_strain(cycles, i, stiffness);
    cycle->alpha = sqrt(FULL_TURN / pulse->period_s * pulse->vessel[i].womersley_s);
    cycle->wave_speed =
        stiffness > 0 ? sqrt(stiffness / (1.5 * BLOOD_DENSITY_G_MM3)) * 1e-3 : HUGE_VAL;
    const double most = mm3_s_from_ml_min(fmax(fabs(cycle->flow[0]), fabs(cycle->flow[1])));
    cycle->mach = most / (PI * radius * radius) * 1e-3 / cycle->wave_speed;
}

static void cycles_chunk(size_t chunk, int worker, void *context)
{
    (void)worker;
    const CycleJob *cycles = context;
    for (size_t i = chunk * CHUNK_SEGMENTS; i < chunk_end(cycles->pulse, chunk); i++)
        if (tree_is_segment(cycles->pulse->params.tree, i))
            find_cycle(cycles, i);
}

/* Finds the phase delays. The delay of a segment is that of its parent plus the delay from the
 * parent's pressure to its own, which is far below half a period. So the sum does not wrap. Parents
 * come before their children in a tree. */
static void find_delays(const Pulse *pulse, PulseMeasures *cycle)
{
    const Tree *tree = pulse->params.tree;
    const PulseMeasures none = {{NAN, NAN}, {NAN, NAN}, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i)) {
            cycle[i] = none;
            cycle[i].delay_ms = 0;
            continue;
        }
        const size_t before = (size_t)tree->parent[i];
        const Phasor p = pulse_pressure(pulse, i, 1), from = pulse_pressure(pulse, before, 1);
        const double turn =
            elementary_atan2(p.im * from.re - p.re * from.im, p.re * from.re + p.im * from.im);
        cycle[i].delay_ms = cycle[before].delay_ms - turn / FULL_TURN * pulse->period_s * 1e3;
    }
    for (size_t i = 0; i < tree->n; i++)
        if (!tree_is_segment(tree, i))
            cycle[i].delay_ms = NAN;
}

static void make_turns(int harmonics, Turns *turns)
{
    for (int k = 0; k < harmonics; k++)
        for (int m = 0; m <= HALF_CYCLE; m++) {
            const double angle = FULL_TURN * ((k + 1) * m % PULSE_SAMPLES) / PULSE_SAMPLES;
            turns[k].cos[m] = elementary_cos(angle);
            turns[k].sin[m] = elementary_sin(angle);
        }
}

Status pulse_measure(const Pulse *pulse, int threads, PulseMeasures **out, Err *err)
{
    Turns *turns = NULL;
    PulseMeasures *cycle = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(mem_calloc(&turns, (size_t)pulse->params.harmonics, sizeof *turns, "moments", err));
    TRY_GOTO(mem_calloc(&cycle, pulse->n, sizeof *cycle, "cycles", err));
    make_turns(pulse->params.harmonics, turns);
    CycleJob cycles = {pulse, turns, cycle};
    threads_for(chunks_of(pulse), threads, cycles_chunk, &cycles);
    find_delays(pulse, cycle);
    *out = cycle;
done:
    free(turns);
    return status;
}
