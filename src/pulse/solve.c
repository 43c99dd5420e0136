/* Solves a tree for all harmonics: the steady solution, the constants of the vessels, and two
 * sweeps per pair of harmonics.
 *
 * The sweep from the terminals to the roots computes, at each node, the admittance Y and the source
 * J of everything behind it: q = Y p - J. The sweep back replaces them by pressure and flow. Both
 * use the memory of the result, so nothing else grows with the number of harmonics. The two-ports
 * are computed again on the way back, which is faster than to store them. Pairs of harmonics are
 * independent, so threads share nothing. */
#include "pulse/solve.h"

#include "pulse/twoport.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the steady solution --------------------------------------------------------------------- */

static Status derive(const PulseParams *params, const char *name, double **value, Err *err)
{
    Field field;
    TRY(derive_computed_field(params->tree, params->overrides, name, &field, err));
    *value = field.value;
    return STATUS_OK;
}

/* Sets the flow of each root to the sum of the flows that leave it, and its pressure to that of the
 * inlet. */
static void fill_roots(Pulse *pulse)
{
    const PulseParams *params = &pulse->params;
    const Tree *tree = params->tree;
    const TreeMeta *source =
        params->overrides->known[META_P_PERF] ? params->overrides : &tree->meta;
    for (size_t i = 0; i < tree->n; i++) {
        if (tree_is_segment(tree, i))
            continue;
        pulse->flow[i] = pulse->outflow[i];
        pulse->pressure[i] = source->number[META_P_PERF];
    }
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i) && !tree_is_segment(tree, (size_t)tree->parent[i]))
            pulse->flow[tree->parent[i]] += pulse->flow[i];
}

/* Computes the flow that leaves the tree at each node, ml/min. */
static Status find_outflow(Pulse *pulse, Err *err)
{
    const PulseParams *params = &pulse->params;
    const TreeMeta *source =
        params->overrides->known[META_Q_PERF] ? params->overrides : &params->tree->meta;
    double total = 0;
    TRY(tree_flow_shares(params->tree, &pulse->outflow, err));
    for (size_t i = 0; i < pulse->n; i++)
        total += pulse->outflow[i];
    for (size_t i = 0; i < pulse->n; i++)
        pulse->outflow[i] = total > 0 ? pulse->outflow[i] * source->number[META_Q_PERF] / total : 0;
    return STATUS_OK;
}

/* ---- vessels --------------------------------------------------------------------------------- */

PulseVessel pulse_vessel(const PulseWall *wall, double radius_mm, double length_mm,
                         double viscosity)
{
    const double r2 = radius_mm * radius_mm, area = PI * r2;
    const double stiffness = pulse_wall_stiffness(wall, radius_mm);
    return (PulseVessel){
        .resistance = poiseuille_resistance(viscosity, length_mm, radius_mm),
        .inertance = BLOOD_DENSITY_G_MM3 * length_mm / area,
        .compliance = stiffness > 0 ? 1.5 * area / stiffness * length_mm : 0,
        .womersley_s = r2 * BLOOD_DENSITY_G_MM3 / viscosity,
    };
}

/* Refuses segments for which no wave can be computed: of radius or length 0, or of a stiffness that
 * is not above 0. */
static Status check_segment(const PulseParams *params, size_t i, Err *err)
{
    const Tree *tree = params->tree;
    const double radius = tree->radius_mm[i], length = tree_segment_length(tree, i);
    if (!(radius > 0 && length > 0))
        return err_set(err, STATUS_INPUT,
                       "segment %d has the %s 0; pulse waves need radii and lengths above 0",
                       tree->id[i], radius > 0 ? "length" : "radius");
    const double stiffness = pulse_wall_stiffness(&params->wall, radius);
    const bool rigid = pulse_wall_is_rigid(&params->wall);
    if (!rigid && !(stiffness > 0 && isfinite(stiffness)))
        return err_set(err, STATUS_INPUT,
                       "`wall`: E h / r of segment %d, radius %g mm, is %g Pa; it must be above 0",
                       tree->id[i], radius, stiffness);
    return STATUS_OK;
}

static Status make_vessels(Pulse *pulse, Err *err)
{
    const PulseParams *params = &pulse->params;
    const Tree *tree = params->tree;
    TRY(mem_calloc(&pulse->vessel, tree->n, sizeof *pulse->vessel, "vessels", err));
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        TRY(check_segment(params, i, err));
        pulse->vessel[i] = pulse_vessel(&params->wall, tree->radius_mm[i],
                                        tree_segment_length(tree, i), pulse->viscosity[i]);
    }
    return STATUS_OK;
}

/* ---- sweeps ---------------------------------------------------------------------------------- */

static PairC load(const double re[PAIR], const double im[PAIR])
{
    PairC x;
    memcpy(&x.re, re, sizeof x.re);
    memcpy(&x.im, im, sizeof x.im);
    return x;
}

static void store(double re[PAIR], double im[PAIR], PairC x)
{
    memcpy(re, &x.re, sizeof x.re);
    memcpy(im, &x.im, sizeof x.im);
}

/* Computes the admittance and the source at each node, from the terminals to the roots. A segment
 * adds the admittance and the source at its inlet to those of its parent. In this sweep, the
 * members q of a node hold the admittance and the members p the source. */
static void sweep_up(const Pulse *pulse, const PairFrequency *at, PulseWaves *waves)
{
    const Tree *tree = pulse->params.tree;
    for (size_t i = tree->n; i-- > 0;) {
        if (!tree_is_segment(tree, i))
            continue;
        const PairPort port = pair_port(&pulse->vessel[i], at);
        PulseWaves *end = &waves[i], *start = &waves[tree->parent[i]];
        PairC inverse;
        PairC admittance = pairport_load(&port, load(end->q_re, end->q_im), &inverse);
        PairC source = pairc_mul(pairc_scale(load(end->p_re, end->p_im), port.scale), inverse);
        store(start->q_re, start->q_im, pairc_add(load(start->q_re, start->q_im), admittance));
        store(start->p_re, start->p_im, pairc_add(load(start->p_re, start->p_im), source));
    }
}

/* Returns the amplitudes of the drive, divided by its mean; amplitudes of pressure are in Pa
 * instead if the pulse pressure is specified. */
static PairC drive_of(const PulseParams *params, int first)
{
    const Waveform *drive = params->drive;
    double factor = 1 / drive->mean;
    if (!params->drive->is_flow && params->pulse_pressure_pa > 0)
        factor = params->pulse_pressure_pa / waveform_range(drive);
    PairC x = pairc(0, 0);
    for (int lane = 0; lane < PAIR && first + lane <= params->harmonics; lane++) {
        x.re[lane] = drive->re[first + lane] * factor;
        x.im[lane] = drive->im[first + lane] * factor;
    }
    return x;
}

/* Sets pressure and flow at a root. */
static void drive_root(const Pulse *pulse, size_t root, int first, PulseWaves *at)
{
    const PulseParams *params = &pulse->params;
    PairC admittance = load(at->q_re, at->q_im), source = load(at->p_re, at->p_im);
    PairC drive = drive_of(params, first), p, q;
    if (params->drive->is_flow) {
        q = pairc_scale(drive, (PairR){0} + mm3_s_from_ml_min(pulse->flow[root]));
        p = pairc_mul(pairc_add(q, source), pairc_inverse(admittance));
    } else {
        double mean = params->pulse_pressure_pa > 0 ? 1 : pa_from_mmhg(pulse->pressure[root]);
        p = pairc_scale(drive, (PairR){0} + mean);
        q = pairc_add(pairc_mul(admittance, p), pairc_scale(source, (PairR){0} - 1));
    }
    store(at->p_re, at->p_im, p);
    store(at->q_re, at->q_im, q);
}

/* Replaces the admittance and the source of each node by pressure and flow, from the roots to the
 * terminals. */
static void sweep_down(const Pulse *pulse, int first, const PairFrequency *at, PulseWaves *waves)
{
    const Tree *tree = pulse->params.tree;
    for (size_t i = 0; i < tree->n; i++) {
        PulseWaves *end = &waves[i];
        if (!tree_is_segment(tree, i)) {
            drive_root(pulse, i, first, end);
            continue;
        }
        const PairPort port = pair_port(&pulse->vessel[i], at);
        const PulseWaves *start = &waves[tree->parent[i]];
        PairC admittance = load(end->q_re, end->q_im), source = load(end->p_re, end->p_im);
        PairC inverse = pairc_inverse(pairc_add(port.a, pairc_mul(port.b, admittance)));
        PairC p = pairc_scale(load(start->p_re, start->p_im), port.scale);
        p = pairc_mul(pairc_add(p, pairc_mul(port.b, source)), inverse);
        PairC q = pairc_mul(admittance, p);
        store(end->p_re, end->p_im, p);
        store(end->q_re, end->q_im, (PairC){q.re - source.re, q.im - source.im});
    }
}

/* Solves one pair of harmonics, as the body of a parallel loop. */
static void solve_pair(size_t block, int worker, void *context)
{
    (void)worker;
    const Pulse *pulse = context;
    PulseWaves *waves = pulse->waves + block * pulse->n;
    const int first = 1 + (int)block * PAIR;
    const PairFrequency at = pairfrequency(first, pulse->period_s, pulse->params.wall_time_s);
    sweep_up(pulse, &at, waves);
    sweep_down(pulse, first, &at, waves);
}

/* Checks the amplitudes of all roots and terminals, through which any number that is not finite
 * spreads. */
static Status check_finite(const Pulse *pulse, Err *err)
{
    const Tree *tree = pulse->params.tree;
    for (size_t i = 0; i < tree->n; i++)
        for (int k = 1; k <= pulse->params.harmonics; k++) {
            const Phasor p = pulse_pressure(pulse, i, k), q = pulse_flow(pulse, i, k);
            if (!isfinite(p.re + p.im + q.re + q.im))
                return err_set(err, STATUS_INPUT,
                               "the waves at node %d, harmonic %d, exceed the range of numbers; "
                               "check the units of the tree",
                               tree->id[i], k);
        }
    return STATUS_OK;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static Status solve(Pulse *pulse, Err *err)
{
    const PulseParams *params = &pulse->params;
    const Tree *tree = params->tree;
    const size_t blocks = ((size_t)params->harmonics + PAIR - 1) / PAIR;
    TRY(derive(params, "flow", &pulse->flow, err));
    TRY(derive(params, "pressure", &pulse->pressure, err));
    TRY(derive_viscosity(tree, params->overrides, &pulse->viscosity, err));
    TRY(find_outflow(pulse, err));
    fill_roots(pulse);
    TRY(make_vessels(pulse, err));
    TRY(mem_check((double)blocks * (double)tree->n * sizeof *pulse->waves, "the waves", err));
    TRY(mem_calloc(&pulse->waves, blocks * tree->n, sizeof *pulse->waves, "waves", err));
    TRY(pulse_set_outlets(pulse, err));
    threads_for(blocks, params->threads, solve_pair, pulse);
    return check_finite(pulse, err);
}

Status pulse_solve(const PulseParams *params, Pulse *pulse, Err *err)
{
    *pulse = (Pulse){.params = *params, .n = params->tree->n, .period_s = params->drive->period_s};
    Status status = solve(pulse, err);
    if (status != STATUS_OK)
        pulse_release(pulse);
    return status;
}

void pulse_release(Pulse *pulse)
{
    free(pulse->flow);
    free(pulse->pressure);
    free(pulse->outflow);
    free(pulse->viscosity);
    free(pulse->vessel);
    free(pulse->waves);
    *pulse = (Pulse){0};
}

/* ---- reading the solution -------------------------------------------------------------------- */

Phasor pulse_pressure(const Pulse *pulse, size_t i, int k)
{
    const PulseWaves *at = &pulse->waves[(size_t)(k - 1) / PAIR * pulse->n + i];
    return (Phasor){at->p_re[(k - 1) % PAIR], at->p_im[(k - 1) % PAIR]};
}

Phasor pulse_flow(const Pulse *pulse, size_t i, int k)
{
    const PulseWaves *at = &pulse->waves[(size_t)(k - 1) / PAIR * pulse->n + i];
    return (Phasor){at->q_re[(k - 1) % PAIR], at->q_im[(k - 1) % PAIR]};
}

static Phasor first_of(PairC x, double scale)
{
    return (Phasor){x.re[0] / scale, x.im[0] / scale};
}

TwoPort pulse_twoport(const PulseVessel *vessel, double period_s, double wall_time_s, int k)
{
    const PairFrequency at = pairfrequency(k, period_s, wall_time_s);
    const PairPort port = pair_port(vessel, &at);
    return (TwoPort){first_of(port.a, port.scale[0]), first_of(port.b, port.scale[0]),
                     first_of(port.c, port.scale[0])};
}

Phasor pulse_friction(double alpha)
{
    return first_of(pair_friction((PairR){0} + alpha * alpha), 1);
}
