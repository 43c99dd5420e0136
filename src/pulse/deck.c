/* Writes a deck, the input file of svZeroDSolver [github.com/SimVascular/svZeroDSolver]. Every
 * segment is a vessel of the solver: a resistance, then a compliance to ground, then an inertance.
 * The solver compares the periods of all tables without a tolerance, so the times of each table end
 * with the same number. */
#include "pulse/solve.h"

#include <math.h>

/* 1 Pa s/mm^3 in dyn s/cm^5, 1 Pa in dyn/cm^2 and 1 mm^3/s in cm^3/s. */
static const double resistance_cgs = 1e4, pressure_cgs = 10, flow_cgs = 1e-3;

typedef struct Deck {
    const Pulse *pulse;
    const int32_t *children; /* per node: their number */
    size_t points;
    Text *out;
} Deck;

static void put_member(Text *out, const char *before, const char *key, double value)
{
    text_printf(out, "%s\"%s\": ", before, key);
    text_number(out, value);
}

/* Appends samples of a cycle and their times. Requires that the first harmonics of `at` are set. */
static void put_cycle(const Deck *deck, const char *key, const Waveform *at)
{
    const double period = deck->pulse->period_s;
    const size_t last = deck->points - 1;
    text_printf(deck->out, "\"%s\": [", key);
    for (size_t m = 0; m <= last; m++) {
        text_puts(deck->out, m ? ", " : "");
        text_number(deck->out, waveform_at(at, period * (double)(m % last) / (double)last));
    }
    text_puts(deck->out, "], \"t\": [");
    for (size_t m = 0; m <= last; m++) {
        text_puts(deck->out, m ? ", " : "");
        text_number(deck->out, m == last ? period : period * (double)m / (double)last);
    }
    text_puts(deck->out, "]");
}

/* Appends the boundary condition at a root: its flow or pressure over a cycle. */
static void put_inlet(const Deck *deck, size_t root)
{
    const Pulse *pulse = deck->pulse;
    const bool is_flow = pulse->params.drive->is_flow;
    const double unit = is_flow ? flow_cgs : pressure_cgs;
    Waveform at = {.period_s = pulse->period_s, .harmonics = pulse->params.harmonics};
    at.mean = unit * (is_flow ? mm3_s_from_ml_min(pulse->flow[root])
                              : pa_from_mmhg(pulse->pressure[root]));
    for (int k = 1; k <= at.harmonics; k++) {
        const Phasor x = is_flow ? pulse_flow(pulse, root, k) : pulse_pressure(pulse, root, k);
        at.re[k] = unit * x.re;
        at.im[k] = unit * x.im;
    }
    text_printf(deck->out, "{\"bc_name\": \"IN%d\", \"bc_type\": \"%s\", \"bc_values\": {",
                pulse->params.tree->id[root], is_flow ? "FLOW" : "PRESSURE");
    put_cycle(deck, is_flow ? "Q" : "P", &at);
    text_puts(deck->out, "}}");
}

/* Appends the values of a coronary outlet. Only the oscillation of the tissue's pressure is used
 * [PulseParams.tissue]. */
static void put_coronary(const Deck *deck, size_t i)
{
    const PulseCoronary at = pulse_coronary(pulse_outlet_resistance(deck->pulse, i));
    Waveform tissue = *deck->pulse->params.tissue;
    tissue.mean = 0;
    tissue.period_s = deck->pulse->period_s;
    for (int k = 1; k <= tissue.harmonics; k++) {
        tissue.re[k] *= pressure_cgs;
        tissue.im[k] *= pressure_cgs;
    }
    put_member(deck->out, "", "Ra1", at.r_upstream * resistance_cgs);
    put_member(deck->out, ", ", "Ra2", at.r_tissue * resistance_cgs);
    put_member(deck->out, ", ", "Rv1", at.r_downstream * resistance_cgs);
    put_member(deck->out, ", ", "Ca", at.arterial / resistance_cgs);
    put_member(deck->out, ", ", "Cc", at.compliance / resistance_cgs);
    put_member(deck->out, ", ", "P_v", deck->pulse->params.venous_pa * pressure_cgs);
    text_puts(deck->out, ", ");
    put_cycle(deck, "Pim", &tissue);
}

/* Appends the boundary condition at a terminal. */
static void put_outlet(const Deck *deck, size_t i)
{
    const PulseParams *params = &deck->pulse->params;
    const PulseWindkessel lumped = pulse_windkessel(deck->pulse, i);
    const char *type = params->tissue ? "CORONARY" : lumped.c > 0 ? "RCR" : "RESISTANCE";
    text_printf(deck->out, "{\"bc_name\": \"OUT%d\", \"bc_type\": \"%s\", \"bc_values\": {",
                params->tree->id[i], type);
    if (params->tissue) {
        put_coronary(deck, i);
    } else if (lumped.c > 0) {
        put_member(deck->out, "", "Rp", lumped.rp * resistance_cgs);
        put_member(deck->out, ", ", "C", lumped.c / resistance_cgs);
        put_member(deck->out, ", ", "Rd", lumped.rd * resistance_cgs);
    } else {
        put_member(deck->out, "", "R", (lumped.rp + lumped.rd) * resistance_cgs);
    }
    if (!params->tissue)
        put_member(deck->out, ", ", "Pd", params->venous_pa * pressure_cgs);
    text_puts(deck->out, "}}");
}

/* Appends a segment as a vessel of the solver, with the boundary conditions at its ends. */
static void put_vessel(const Deck *deck, size_t i)
{
    const Tree *tree = deck->pulse->params.tree;
    const PulseVessel *vessel = &deck->pulse->vessel[i];
    const size_t start = (size_t)tree->parent[i];
    Text *out = deck->out;
    text_printf(out, "{\"vessel_id\": %d, \"vessel_name\": \"branch%d_seg0\"", tree->id[i],
                tree->id[i]);
    put_member(out, ", ", "vessel_length", tree_segment_length(tree, i) / 10);
    text_puts(out, ", \"zero_d_element_type\": \"BloodVessel\", \"zero_d_element_values\": {");
    put_member(out, "", "R_poiseuille", vessel->resistance * resistance_cgs);
    put_member(out, ", ", "C", vessel->compliance / resistance_cgs);
    put_member(out, ", ", "L", vessel->inertance * resistance_cgs);
    text_puts(out, "}");
    const bool first = !tree_is_segment(tree, start), last = deck->children[i] == 0;
    if (first || last)
        text_puts(out, ", \"boundary_conditions\": {");
    if (first)
        text_printf(out, "\"inlet\": \"IN%d\"", tree->id[start]);
    if (last)
        text_printf(out, "%s\"outlet\": \"OUT%d\"", first ? ", " : "", tree->id[i]);
    text_puts(out, first || last ? "}}" : "}");
}

/* Appends the junctions. A node's daughters are its children in the order of the nodes. */
static Status put_junctions(const Deck *deck, Err *err)
{
    const Tree *tree = deck->pulse->params.tree;
    IndexLists daughters = {0};
    Status status = STATUS_OK;
    const char *before = "\n  ";
    TRY_GOTO(indexlists_begin(&daughters, tree->n, "daughters", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            indexlists_count(&daughters, (size_t)tree->parent[i]);
    TRY_GOTO(indexlists_allot(&daughters, "daughters", err));
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            indexlists_put(&daughters, (size_t)tree->parent[i], (uint32_t)i);
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i) || deck->children[i] == 0)
            continue;
        text_printf(deck->out,
                    "%s{\"junction_name\": \"J%d\", \"junction_type\": \"NORMAL_JUNCTION\", "
                    "\"inlet_vessels\": [%d], \"outlet_vessels\": [",
                    before, tree->id[i], tree->id[i]);
        for (uint32_t k = daughters.first[i]; k < daughters.first[i + 1]; k++)
            text_printf(deck->out, "%s%d", k > daughters.first[i] ? ", " : "",
                        tree->id[daughters.items[k]]);
        text_puts(deck->out, "]}");
        before = ",\n  ";
    }
done:
    indexlists_release(&daughters);
    return status;
}

/* Refuses what a deck cannot hold. */
static Status check(const Deck *deck, Err *err)
{
    const Pulse *pulse = deck->pulse;
    const Tree *tree = pulse->params.tree;
    if (pulse->params.outlet == PULSE_STRUCTURED)
        return err_set(
            err, STATUS_INPUT,
            "an input file of svZeroDSolver cannot hold structured trees; use `outlets` rcr");
    for (size_t i = 0; i < tree->n; i++) {
        const bool is_end = deck->children[i] == 0, flows = pulse->outflow[i] > 0;
        if (!tree_is_segment(tree, i) && deck->children[i] > 1 && pulse->params.drive->is_flow)
            return err_set(err, STATUS_INPUT,
                           "root %d has %d segments; with a `drive` of flow, an input file of "
                           "svZeroDSolver allows only one; "
                           "use a `drive` of pressure",
                           tree->id[i], deck->children[i]);
        if (is_end != flows && (tree_is_segment(tree, i) || flows))
            return err_set(err, STATUS_INPUT,
                           "%s node %d; in an input file of svZeroDSolver, flow must leave the "
                           "tree at each terminal and at no other node",
                           flows ? "flow leaves the tree at the inner"
                                 : "no flow leaves at the terminal",
                           tree->id[i]);
    }
    return STATUS_OK;
}

/* Appends the deck, a JSON document. */
static Status put_deck(const Deck *deck, Err *err)
{
    /* Cycles that the solver computes, so that the start has died away in the last one. Slow
     * outlets with a time constant of several cycles need as many. The solver's time grows with the
     * number. */
    enum { CYCLES = 30 };
    const Tree *tree = deck->pulse->params.tree;
    const char *before = "\n  ";
    TRY(check(deck, err));
    text_printf(deck->out,
                "{\"simulation_parameters\": {\"number_of_cardiac_cycles\": %d, "
                "\"number_of_time_pts_per_cardiac_cycle\": %zu, \"cardiac_period\": ",
                CYCLES, deck->points);
    text_number(deck->out, deck->pulse->period_s);
    text_puts(deck->out, "},\n\"boundary_conditions\": [");
    for (size_t i = 0; i < tree->n; i++) {
        if (deck->children[i] > 0 && tree_is_segment(tree, i))
            continue;
        text_puts(deck->out, before);
        (tree_is_segment(tree, i) ? put_outlet : put_inlet)(deck, i);
        before = ",\n  ";
    }
    text_puts(deck->out, "],\n\"junctions\": [");
    TRY(put_junctions(deck, err));
    text_puts(deck->out, "],\n\"vessels\": [");
    before = "\n  ";
    for (size_t i = 0; i < tree->n; i++) {
        if (!tree_is_segment(tree, i))
            continue;
        text_puts(deck->out, before);
        put_vessel(deck, i);
        before = ",\n  ";
    }
    text_puts(deck->out, "]}\n");
    return text_check(deck->out, err);
}

Status pulse_put_deck(const Pulse *pulse, size_t points, Text *out, Err *err)
{
    int32_t *children;
    TRY(tree_child_counts(pulse->params.tree, &children, err));
    const Deck deck = {pulse, children, points, out};
    Status status = put_deck(&deck, err);
    free(children);
    return status;
}
