/* Computes the admittance of what is behind each outlet: a lumped model, with or without the
 * pressure of the tissue, or a structured tree.
 *
 * The total resistance of a lumped outlet follows from the steady solution, so the mean flow stays
 * as it is. The structured tree is that of Olufsen [Am. J. Physiol. 276 (1999) H257]. A vessel
 * of radius r has the length 50 r and two daughters of the radii 0.91 r and 0.58 r (tree_alpha and
 * tree_beta). A vessel below the minimum radius still exists, but has no daughters: the pressure at
 * its end is constant. A vessel whose path from the root takes i alpha branches and j beta branches
 * has the radius alpha^i beta^j times that of the root, in any order of the branches. So a tree
 * needs one two-port for each pair (i, j), not one per vessel. */
#include "pulse/solve.h"
#include "pulse/twoport.h"

#include <math.h>
#include <stdlib.h>

static const double tree_alpha = 0.91, tree_beta = 0.58, tree_length = 50;

/* The coronary model [PulseCoronary]: fractions of the total resistance before, within and behind
 * the vessels that the tissue presses; the time constant of these vessels, s; and the compliance of
 * the arteries before them, divided by the compliance of these vessels. All are from a deck of a
 * left coronary tree in the tests of svOneDSolver. */
static const double part_before = 0.32, part_within = 0.52, part_behind = 0.16;
static const double tissue_time_s = 0.287, part_compliance = 0.124;

/* ---- lumped models --------------------------------------------------------------------------- */

double pulse_outlet_resistance(const Pulse *pulse, size_t i)
{
    return (pa_from_mmhg(pulse->pressure[i]) - pulse->params.venous_pa) /
           mm3_s_from_ml_min(pulse->outflow[i]);
}

PulseWindkessel pulse_windkessel(const Pulse *pulse, size_t i)
{
    const PulseParams *params = &pulse->params;
    const double total = pulse_outlet_resistance(pulse, i), radius = params->tree->radius_mm[i];
    const double stiffness = pulse_wall_stiffness(&params->wall, radius);
    const double speed = stiffness > 0 ? sqrt(stiffness / (1.5 * BLOOD_DENSITY_G_MM3)) : HUGE_VAL;
    if (params->node_outlets && !isnan(params->node_outlets[i].rp))
        return params->node_outlets[i];
    double rp = fmin(BLOOD_DENSITY_G_MM3 * speed / (PI * radius * radius), 0.99 * total);
    return (PulseWindkessel){.rp = rp, .rd = total - rp, .c = params->outlet_time_s / total};
}

/* Returns the admittance of a Windkessel. */
static PairC lumped_admittance(const PulseWindkessel *lumped, PairR omega)
{
    PairC z = pairc_inverse((PairC){(PairR){0} + 1 / lumped->rd, omega * lumped->c});
    z.re += lumped->rp;
    return pairc_inverse(z);
}

PulseCoronary pulse_coronary(double total)
{
    PulseCoronary made = {part_before * total, part_within * total, part_behind * total, 0, 0};
    const double parallel = made.r_downstream * (made.r_upstream + made.r_tissue) / total;
    made.compliance = tissue_time_s / parallel;
    made.arterial = part_compliance * made.compliance;
    return made;
}

/* Returns the admittance Y of a coronary model, and stores its source J in *source, so that q = Y p
 * - J. `tissue` is the amplitude of the pressure of the tissue.
 *
 * The model is followed from the veins to the inlet. y2 is the admittance at the pressed vessels,
 * with their compliance, and j2 their source. y1 is the admittance before the resistance `within`,
 * with the arterial compliance. z is the impedance at the inlet. A resistance R in series leaves
 * the flow unchanged: it divides the source by 1 + Y R [the factors j1 and j]. */
static PairC pressed_admittance(const PulseCoronary *at, PairR omega, PairC tissue, PairC *source)
{
    const PairR none = {0};
    PairC y2 = {none + 1 / at->r_downstream, omega * at->compliance};
    PairC j2 = pairc_mul((PairC){none, omega * at->compliance}, tissue);
    PairC z1 = pairc_inverse(y2), j1 = pairc_scale(y2, none + at->r_tissue);
    z1.re += at->r_tissue;
    j1.re += 1;
    PairC y1 = pairc_inverse(z1);
    y1.im += omega * at->arterial;
    PairC z = pairc_inverse(y1), j = pairc_scale(y1, none + at->r_upstream);
    z.re += at->r_upstream;
    j.re += 1;
    *source = pairc_mul(j2, pairc_inverse(pairc_mul(j1, j)));
    return pairc_inverse(z);
}

/* ---- structured trees ------------------------------------------------------------------------ */

/* The computation of structured trees for one pair of harmonics. */
typedef struct Structured {
    const PulseParams *params;
    PairFrequency at;
    /* Admittances of the vessels with one power of alpha, by the power of beta; owned. */
    PairC *row;
} Structured;

/* Returns the smallest power of `factor` that brings a radius below the minimum. */
static size_t count_powers(double radius, double factor, double minimum)
{
    size_t n = 0;
    for (; radius >= minimum; n++)
        radius *= factor;
    return n;
}

static double power_of(double factor, size_t n)
{
    double x = 1;
    while (n-- > 0)
        x *= factor;
    return x;
}

/* Returns the admittance of a tree whose root has this radius. The row of one power of alpha is
 * computed from the row of the next power, and replaces it: when row[j] is computed, it still holds
 * the alpha daughter, and row[j + 1] already holds the beta daughter. */
static PairC structured_admittance(const Structured *tree, double radius_mm, double viscosity)
{
    const PulseParams *params = tree->params;
    const double minimum = params->min_radius_mm;
    const size_t n_beta = count_powers(radius_mm, tree_beta, minimum);
    for (size_t i = count_powers(radius_mm, tree_alpha, minimum) + 1; i-- > 0;)
        for (size_t j = n_beta + 1; j-- > 0;) {
            double r = radius_mm * power_of(tree_alpha, i) * power_of(tree_beta, j);
            const PulseVessel vessel = pulse_vessel(&params->wall, r, tree_length * r, viscosity);
            const PairPort port = pair_port(&vessel, &tree->at);
            PairC inverse;
            tree->row[j] =
                r < minimum
                    ? pairc_mul(port.a, pairc_inverse(port.b))
                    : pairport_load(&port, pairc_add(tree->row[j], tree->row[j + 1]), &inverse);
        }
    return tree->row[0];
}

static Status structured_init(Structured *tree, const PulseParams *params, double radius_mm,
                              int first, Err *err)
{
    *tree = (Structured){.params = params};
    tree->at = pairfrequency(first, params->drive->period_s, params->wall_time_s);
    return mem_calloc(&tree->row, count_powers(radius_mm, tree_beta, params->min_radius_mm) + 2,
                      sizeof *tree->row, "structured trees", err);
}

Status pulse_structured(const PulseParams *params, double radius_mm, double viscosity, int k,
                        Phasor *out, Err *err)
{
    Structured tree;
    TRY(structured_init(&tree, params, radius_mm, k, err));
    const PairC y = structured_admittance(&tree, radius_mm, viscosity);
    free(tree.row);
    *out = (Phasor){y.re[0], y.im[0]};
    return STATUS_OK;
}

/* ---- all outlets ----------------------------------------------------------------------------- */

typedef struct Outlets {
    Pulse *pulse;
    size_t *node, n; /* the outlets, by rising radius and viscosity; owned */
    double largest_radius;
} Outlets;

static Status check_outlet(const Pulse *pulse, size_t i, Err *err)
{
    const PulseParams *params = &pulse->params;
    if (pulse_outlet_resistance(pulse, i) > 0)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "the outlet at node %d has a mean pressure of %g mmHg, which is not above the "
                   "venous pressure, %g mmHg; raise `p_perf` or lower `venous_pressure`",
                   params->tree->id[i], pulse->pressure[i], mmhg_from_pa(params->venous_pa));
}

/* Lists the nodes at which blood leaves the tree. */
static Status list_outlets(Outlets *outlets, Err *err)
{
    const Pulse *pulse = outlets->pulse;
    TRY(mem_calloc(&outlets->node, pulse->n, sizeof *outlets->node, "outlets", err));
    for (size_t i = 0; i < pulse->n; i++) {
        if (!(pulse->outflow[i] > 0))
            continue;
        TRY(check_outlet(pulse, i, err));
        outlets->node[outlets->n++] = i;
        outlets->largest_radius = fmax(outlets->largest_radius, pulse->params.tree->radius_mm[i]);
    }
    return STATUS_OK;
}

/* Orders outlets by radius, so that outlets with equal structured trees are neighbours, and each
 * tree is computed once. Outlets of one radius have equal trees if the viscosity depends on the
 * radius alone. */
static int compare_outlets(const void *a, const void *b, void *radii)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    const double *radius = radii;
    int order = compare_numbers(radius[x], radius[y]);
    return order ? order : (x > y) - (x < y);
}

static PulseWaves *waves_at(const Outlets *outlets, size_t block, size_t i)
{
    return &outlets->pulse->waves[block * outlets->pulse->n + i];
}

/* Stores the admittance and the source of an outlet where sweep_up expects them. */
static void store_outlet(PulseWaves *waves, PairC admittance, PairC source)
{
    for (int lane = 0; lane < PAIR; lane++) {
        waves->q_re[lane] = admittance.re[lane];
        waves->q_im[lane] = admittance.im[lane];
        waves->p_re[lane] = source.re[lane];
        waves->p_im[lane] = source.im[lane];
    }
}

/* Stores the structured trees of all outlets for one pair of harmonics. Consecutive outlets that
 * are equal share one computation. */
static Status set_structured(const Outlets *outlets, size_t block, Err *err)
{
    const Pulse *pulse = outlets->pulse;
    const double *radius = pulse->params.tree->radius_mm, *viscosity = pulse->viscosity;
    Structured tree;
    PairC y = {0};
    TRY(structured_init(&tree, &pulse->params, outlets->largest_radius, 1 + (int)block * PAIR,
                        err));
    for (size_t k = 0; k < outlets->n; k++) {
        const size_t i = outlets->node[k], last = outlets->node[k > 0 ? k - 1 : 0];
        if (k == 0 || radius[i] != radius[last] || viscosity[i] != viscosity[last])
            y = structured_admittance(&tree, radius[i], viscosity[i]);
        store_outlet(waves_at(outlets, block, i), y, pairc(0, 0));
    }
    free(tree.row);
    return STATUS_OK;
}

/* Returns the amplitudes of the tissue's pressure for a pair of harmonics; 0 beyond the last one.
 */
static PairC tissue_of(const PulseParams *params, int first)
{
    PairC x = pairc(0, 0);
    for (int lane = 0; lane < PAIR && first + lane <= params->harmonics; lane++) {
        x.re[lane] = params->tissue->re[first + lane];
        x.im[lane] = params->tissue->im[first + lane];
    }
    return x;
}

/* Stores the lumped models of all outlets for one pair of harmonics. */
static void set_lumped(const Outlets *outlets, size_t block)
{
    const Pulse *pulse = outlets->pulse;
    const PulseParams *params = &pulse->params;
    const int first = 1 + (int)block * PAIR;
    const PairFrequency at = pairfrequency(first, pulse->period_s, 0);
    for (size_t k = 0; k < outlets->n; k++) {
        const size_t i = outlets->node[k];
        const PulseWindkessel lumped = pulse_windkessel(pulse, i);
        const PulseCoronary pressed = pulse_coronary(pulse_outlet_resistance(pulse, i));
        PairC source = pairc(0, 0);
        PairC y = params->tissue
                      ? pressed_admittance(&pressed, at.omega, tissue_of(params, first), &source)
                      : lumped_admittance(&lumped, at.omega);
        store_outlet(waves_at(outlets, block, i), y, source);
    }
}

static Status set_block(size_t block, int worker, void *context, Err *err)
{
    (void)worker;
    const Outlets *outlets = context;
    if (outlets->pulse->params.outlet == PULSE_STRUCTURED)
        return set_structured(outlets, block, err);
    set_lumped(outlets, block);
    return STATUS_OK;
}

Status pulse_set_outlets(Pulse *pulse, Err *err)
{
    const PulseParams *params = &pulse->params;
    const size_t blocks = ((size_t)params->harmonics + PAIR - 1) / PAIR;
    Outlets outlets = {.pulse = pulse};
    Status status = list_outlets(&outlets, err);
    if (status == STATUS_OK && params->outlet == PULSE_STRUCTURED)
        qsort_r(outlets.node, outlets.n, sizeof *outlets.node, compare_outlets,
                params->tree->radius_mm);
    if (status == STATUS_OK)
        status = threads_try(blocks, params->threads, set_block, &outlets, err);
    free(outlets.node);
    return status;
}
