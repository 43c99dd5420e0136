/* Runs the operation `flow`: computes steady flow from the resistances of the segments and the
 * boundary conditions. The boundary conditions come from a table, from the columns of a network's
 * file, or from the metadata of a tree. With Pries's law, the resistance depends on the hematocrit.
 * With phase separation, flow and hematocrit depend on each other and are computed alternately
 * (flownetwork_solve_with_cells). */
#include "job/flow/flowing.h"

#include "options/output.h"
#include "options/reading.h"
#include "treeio/treeio.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char *const ends_names[] = {"refuse", "closed", "estimate", NULL};

static const Option rows[] = {
    {.name = "output",
     SETS(OUTPUT, FlowingOptions, output),
     .argument = "F.vtp",
     .otherwise = "",
     .help = "network to write, in the format of the extension. Fields per segment: flow, "
             "velocity and wss (wall shear stress), all 0 or more; pressure; direction (1 if the "
             "blood flows along the segment, -1 if against the segment, 0 if the flow is 0 or "
             "below the rounding error); with --viscosity-law pries also hematocrit"},
    {.name = "summary",
     SETS(OUTPUT, FlowingOptions, summary),
     .argument = "S.csv",
     .otherwise = "",
     .help = "table to write, as CSV: the report (inflow, largest flow, lowest and highest "
             "pressure, imbalance of mass and others), with the columns quantity, value and unit"},
    {.name = "json",
     SETS(FLAG, FlowingOptions, json),
     .help = "print the report as JSON on "
             "standard output"},
    {.name = "boundary",
     SETS(TEXT, FlowingOptions, boundary),
     .group = GROUP_BLOOD,
     .argument = "B.csv|file|terminals",
     .otherwise = "from the file, else terminals",
     .help = "source of the boundary conditions, the known pressures and flows at nodes. B.csv is "
             "a table with the columns id (of a node), pressure (mmHg), flow (ml/min, above 0 "
             "where blood enters) and hematocrit (of blood that enters); each row has a pressure "
             "or a flow, and both are an error. `file` takes the conditions that a network file "
             "of Secomb's format (.dat) states. `terminals` sets --p-perf at the roots, and a "
             "share of --q-perf at each terminal"},
    {.name = "ends",
     SETS(CHOICE, FlowingOptions, ends),
     .choices = ends_names,
     .group = GROUP_BLOOD,
     .help =
         "for --boundary B.csv or file only: how an end of a vessel without a boundary "
         "condition is treated: refuse (stop with an error), closed (no flow through the "
         "end), estimate (choose pressures at these ends that bring the pressure and wall "
         "shear stress of all vessels nearest to --target-pressure and --target-wss; Fry 2012)"},
    {.name = "separation",
     SETS(FLAG, FlowingOptions, separation),
     .group = GROUP_BLOOD,
     .when = WHEN(PRIES),
     .help = "for --viscosity-law pries only: compute the hematocrit of each vessel by the law of "
             "phase separation at bifurcations (Pries 1989). Without this option, --hematocrit "
             "applies to all vessels"},
    {.name = "cell-volume",
     SETS(NUMBER, FlowingOptions, cell_fl),
     FROM_TO(5, 500),
     .unit = "fl",
     .group = GROUP_BLOOD,
     .when = WHEN(PRIES),
     .help = "mean volume of a red cell, for --viscosity-law pries only; about 92 in human blood, "
             "55 in rats"},
    {.name = "target-pressure",
     SETS(NUMBER, FlowingOptions, target_mmhg),
     FROM_TO(0, 1000),
     .unit = "mmHg",
     .group = GROUP_BLOOD,
     .when = WHEN(ESTIMATED),
     .help = "for --ends estimate only: pressure to which the estimate brings all vessels as near "
             "as possible"},
    {.name = "target-wss",
     SETS(NUMBER, FlowingOptions, target_pa),
     FROM_TO(0, 1000),
     .unit = "Pa",
     .group = GROUP_BLOOD,
     .when = WHEN(ESTIMATED),
     .help = "for --ends estimate only: wall shear stress to which the estimate brings all "
             "vessels as near as possible"},
    {.name = "starts",
     SETS(COUNT, FlowingOptions, starts),
     FROM_TO(1, 100),
     .group = GROUP_BLOOD,
     .when = WHEN(ESTIMATED),
     .help = "for --ends estimate only: number of estimates. The first begins without flow "
             "directions and is the result. The others begin with random directions, from --seed, "
             "and the report states how far they differ from the result"},
};

/* The targets are a pressure and a wall shear stress of microvessels, for whose networks Fry (2012)
 * made the estimate; where these two numbers come from is not recorded. A larger target pressure or
 * stress draws the estimated pressures of open ends up or apart. `starts` gives three random starts
 * besides the result: enough to show a spread, at four times the cost of one. */
static void set_defaults(void *options)
{
    *(FlowingOptions *)options =
        (FlowingOptions){.cell_fl = RED_CELL_FL, .target_mmhg = 31, .target_pa = 6.35, .starts = 4};
}

static Status check_output(const FlowingOptions *options, Err *err)
{
    const TreeColumn column = {.name = (char[]){"flow"}, .unit = (char[]){"ml/min"}};
    const char *path = options->output;
    if (!path)
        return STATUS_OK;
    TRY(tree_format_check(path, err));
    return tree_format_stores(path, &column)
               ? STATUS_OK
               : err_set(err, STATUS_USAGE, "-o: the format of '%.80s' cannot store fields", path);
}

/* ---- boundary conditions --------------------------------------------------------------------- */

/* The names of columns in Secomb's networks, the types of a boundary node, and the unit of its
 * flows, nl/min. */
static const char type_column[] = "boundary type", value_column[] = "boundary value",
                  hematocrit_column[] = "boundary hematocrit";
enum { TYPE_PRESSURE = 0, TYPE_FLOW = 2 };
#define ML_PER_NL 1e-6

typedef enum BoundaryKind { BOUNDARY_TABLE, BOUNDARY_FILE, BOUNDARY_TERMINALS } BoundaryKind;

/* Finds where the boundary conditions come from. */
static Status find_kind(const Flowing *made, BoundaryKind *kind, Err *err)
{
    const char *given = made->options->boundary;
    bool has_columns =
        tree_column(&made->tree, type_column) && tree_column(&made->tree, value_column);
    *kind = has_columns ? BOUNDARY_FILE : BOUNDARY_TERMINALS;
    if (!given)
        return STATUS_OK;
    if (strcmp(given, "file") == 0)
        return has_columns
                   ? STATUS_OK
                   : err_set(err, STATUS_USAGE, "--boundary file: %s states no boundary conditions",
                             made->parsed->operands[0]);
    *kind = strcmp(given, "terminals") == 0 ? BOUNDARY_TERMINALS : BOUNDARY_TABLE;
    if (*kind == BOUNDARY_TERMINALS || strcasecmp(file_extension(given), "csv") == 0)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "--boundary: '%.60s' is not a FILE.csv, file or terminals",
                   given);
}

/* Refuses options that have no effect on the chosen kind of boundary conditions. */
static Status refuse_options(const Flowing *made, BoundaryKind kind, Err *err)
{
    static const char *const of_terminals[] = {"q-perf", "p-perf", "flow-split"};
    if (kind == BOUNDARY_TERMINALS)
        return options_typed(made->parsed, "ends")
                   ? err_set(err, STATUS_USAGE, "--ends has no effect on --boundary terminals")
                   : STATUS_OK;
    for (size_t i = 0; i < sizeof of_terminals / sizeof *of_terminals; i++)
        if (options_typed(made->parsed, of_terminals[i]))
            return err_set(err, STATUS_USAGE, "--%s is for --boundary terminals", of_terminals[i]);
    return STATUS_OK;
}

/* Sets the boundary condition of node i. NAN means: not given. Sets is_known of the node to true if
 * a pressure or a flow is given. */
static Status set_condition(Flowing *made, size_t i, double mmhg, double ml_min, double hematocrit,
                            bool *is_known, Err *err)
{
    const int id = made->tree.id[i];
    size_t place = tree_linked_node(&made->tree, i);
    if (!isnan(mmhg) && !isnan(ml_min))
        return err_set(err, STATUS_INPUT,
                       "node %d has a pressure and a flow; give one of them, the other follows",
                       id);
    if (hematocrit < 0 || hematocrit > MAX_HEMATOCRIT)
        return err_set(err, STATUS_INPUT, "node %d has the hematocrit %g; it must be from 0 to %g",
                       id, hematocrit, MAX_HEMATOCRIT);
    if (!isnan(mmhg))
        made->network.pressure[place] = pa_from_mmhg(mmhg);
    if (!isnan(ml_min))
        made->network.inflow[place] = mm3_s_from_ml_min(ml_min);
    if (!isnan(hematocrit))
        made->inflow_hematocrit[place] = hematocrit;
    is_known[place] = is_known[place] || !isnan(mmhg) || !isnan(ml_min);
    return STATUS_OK;
}

/* Sets the conditions from the columns of a table. A column without a unit has the usual unit. */
static Status set_from_table(Flowing *made, const Tree *values, bool *is_known, Err *err)
{
    static const struct {
        const char *name, *unit;
    } usual[3] = {{"pressure", "mmHg"}, {"flow", "ml/min"}, {"hematocrit", ""}};
    const TreeColumn *column[3];
    double factor[3], given[3];
    for (int k = 0; k < 3; k++) {
        column[k] = tree_column(values, usual[k].name);
        bool has_unit = column[k] && *column[k]->unit && *usual[k].unit;
        factor[k] = has_unit ? unit_ratio(column[k]->unit, usual[k].unit) : 1;
        if (factor[k] == 0)
            return err_set(err, STATUS_INPUT,
                           "the unit of the column %s is %s; it must be convertible to %s",
                           usual[k].name, column[k]->unit, usual[k].unit);
    }
    if (!column[0] && !column[1])
        return err_set(err, STATUS_INPUT,
                       "the table must have the columns id and pressure or flow");
    for (size_t i = 0; i < made->tree.n; i++) {
        for (int k = 0; k < 3; k++)
            given[k] = column[k] ? column[k]->value[i] * factor[k] : (double)NAN;
        TRY(set_condition(made, i, given[0], given[1], given[2], is_known, err));
    }
    return STATUS_OK;
}

static Status read_table(Flowing *made, bool *is_known, Err *err)
{
    const char *path = made->options->boundary;
    Tree values = {.n = made->tree.n, .id = made->tree.id};
    Status status = STATUS_OK;
    TRY_GOTO(files_add_input(&made->parsed->files, "--boundary", path, err));
    TRY_GOTO(tree_read_values(&values, path, NULL, NULL, err));
    status = set_from_table(made, &values, is_known, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", path);
done:
    values.id = NULL; /* the tree's */
    tree_release(&values);
    return status;
}

/* Sets the conditions from the columns of a network of Secomb: pressures in mmHg, flows in nl/min.
 */
static Status set_from_file(Flowing *made, bool *is_known, Err *err)
{
    const Tree *tree = &made->tree;
    const double *type = tree_column(tree, type_column)->value,
                 *value = tree_column(tree, value_column)->value;
    const TreeColumn *hematocrit = tree_column(tree, hematocrit_column);
    for (size_t i = 0; i < tree->n; i++) {
        if (isnan(type[i]) || tree_has_link(tree, i))
            continue;
        bool is_flow = type[i] == TYPE_FLOW;
        if (!is_flow && type[i] != TYPE_PRESSURE)
            return err_set(
                err, STATUS_INPUT,
                "node %d has the boundary type %g; it must be %d (pressure) or %d (flow)",
                tree->id[i], type[i], TYPE_PRESSURE, TYPE_FLOW);
        TRY(set_condition(made, i, is_flow ? (double)NAN : value[i],
                          is_flow ? value[i] * ML_PER_NL : (double)NAN,
                          hematocrit ? hematocrit->value[i] : (double)NAN, is_known, err));
    }
    return STATUS_OK;
}

/* Marks the ends without a condition: nodes where one segment ends. */
static Status find_open(const Flowing *made, const bool *is_known, bool *is_open, Err *err)
{
    uint32_t *degree = NULL;
    Status status = STATUS_OK;
    size_t n = made->tree.n;
    TRY(mem_calloc(&degree, n, sizeof *degree, "nodes", err));
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 2 && tree_is_segment(&made->tree, i); k++)
            degree[made->network.ends[i][k]]++;
    for (size_t i = 0; status == STATUS_OK && i < n; i++) {
        is_open[i] = degree[i] == 1 && !is_known[i];
        if (is_open[i] && made->options->ends == ENDS_REFUSED)
            status = err_set(err, STATUS_INPUT,
                             "node %d is an end without a boundary condition; state its pressure "
                             "or flow, or set `ends` to closed or estimate",
                             made->tree.id[i]);
    }
    free(degree);
    return status;
}

/* Estimates the pressures of open ends. */
static Status estimate(Flowing *made, const bool *is_open, Err *err)
{
    const FlowingOptions *options = made->options;
    const NetworkEstimate estimate = {.is_open = is_open,
                                      .radius_mm = made->tree.radius_mm,
                                      .length_mm = made->network.length_mm,
                                      .pressure_pa = pa_from_mmhg(options->target_mmhg),
                                      .stress_pa = options->target_pa,
                                      .starts = options->starts,
                                      .seed = made->parsed->common.seed,
                                      .threads = made->parsed->common.threads};
    return flownetwork_estimate(&made->network.network, &estimate, made->network.pressure,
                                &made->spread, err);
}

/* Sets the pressures and flows that are known at nodes, and estimates those of open ends if the
 * options ask for it. */
static Status set_boundary(Flowing *made, const TreeMeta *options_meta, Err *err)
{
    BoundaryKind kind;
    bool *is_known = NULL, *is_open = NULL;
    Status status = STATUS_OK;
    TRY(find_kind(made, &kind, err));
    TRY(refuse_options(made, kind, err));
    if (kind == BOUNDARY_TERMINALS)
        return treenetwork_set_terminals(&made->network, &made->tree, options_meta, err);
    TRY_GOTO(mem_calloc(&is_known, made->tree.n, sizeof *is_known, "nodes", err));
    TRY_GOTO(mem_calloc(&is_open, made->tree.n, sizeof *is_open, "nodes", err));
    TRY_GOTO(kind == BOUNDARY_FILE ? set_from_file(made, is_known, err)
                                   : read_table(made, is_known, err));
    TRY_GOTO(find_open(made, is_known, is_open, err));
    if (made->options->ends == ENDS_ESTIMATED)
        TRY_GOTO(estimate(made, is_open, err));
done:
    free(is_known);
    free(is_open);
    return status;
}

/* ---- the flow -------------------------------------------------------------------------------- */

/* Returns a number that the user gave by an option, else that of the tree. */
static double value_of(const Flowing *made, const TreeMeta *options_meta, MetaKey key)
{
    return options_meta->known[key] ? options_meta->number[key]
                                    : meta_number(&made->tree.meta, key);
}

/* Sets the parameters of Pries's viscosity law, and the resistances computed by it. */
static Status set_blood(Flowing *made, const TreeMeta *options_meta, Err *err)
{
    const Tree *tree = &made->tree;
    TRY(mem_alloc(&made->inflow_hematocrit, tree->n, sizeof(double), "hematocrits", err));
    for (size_t i = 0; i < tree->n; i++)
        made->inflow_hematocrit[i] = (double)NAN;
    if (derive_viscosity_law(tree, options_meta) != VISCOSITY_PRIES)
        return STATUS_OK;
    made->blood = (NetworkBlood){
        .radius_mm = tree->radius_mm,
        .length_mm = made->network.length_mm,
        .inflow_hematocrit = made->inflow_hematocrit,
        .hematocrit = value_of(made, options_meta, META_HEMATOCRIT),
        .plasma_pa_s = pa_s_from_cp(value_of(made, options_meta, META_PLASMA_VISCOSITY)),
        .cell_fl = made->options->cell_fl};
    for (size_t i = 0; i < tree->n; i++)
        if (tree_is_segment(tree, i))
            made->network.resistance[i] =
                flownetwork_resistance(&made->blood, i, made->blood.hematocrit);
    return STATUS_OK;
}

/* Counts the segments without flow, whose resistance is infinite. */
static size_t count_closed(const Flowing *made)
{
    size_t closed = 0;
    for (size_t i = 0; i < made->tree.n; i++)
        closed += tree_is_segment(&made->tree, i) && !(made->network.resistance[i] < HUGE_VAL);
    return closed;
}

/* Computes the flow; with phase separation also the hematocrits, from which the final resistances
 * follow. */
static Status solve(Flowing *made, Err *err)
{
    const FlowNetwork *network = &made->network.network;
    const NetworkCells *cells = &made->cells;
    if (!made->options->separation)
        TRY(flownetwork_solve(network, &made->flow, err));
    else
        TRY(flownetwork_solve_with_cells(network, &made->blood, &made->flow, &made->cells, err));
    for (size_t i = 0; cells->hematocrit && i < made->tree.n; i++)
        if (tree_is_segment(&made->tree, i))
            made->network.resistance[i] =
                flownetwork_resistance(&made->blood, i, cells->hematocrit[i]);
    if (made->options->separation && !cells->converged)
        talk_warn(made->parsed->common.talk,
                  "the hematocrit has not converged: in the last of %zu iterations it changed by "
                  "up to %.2g and the flow by up to %.2g ml/min; the fields are those of the last "
                  "iteration",
                  cells->rounds, cells->hematocrit_change, ml_min_from_mm3_s(cells->flow_change));
    if (made->flow.no_flow > 0 && made->options->ends == ENDS_REFUSED)
        return err_set(
            err, STATUS_INPUT,
            "the component of node %d has no boundary condition; state a pressure or a flow "
            "there, or use --ends closed",
            made->tree.id[made->flow.no_flow_node]);
    return STATUS_OK;
}

/* ---- fields ---------------------------------------------------------------------------------- */

typedef enum FlowField {
    FIELD_FLOW,
    FIELD_PRESSURE,
    FIELD_VELOCITY,
    FIELD_WSS,
    FIELD_DIRECTION,
    FIELD_HEMATOCRIT,
    FLOW_FIELDS
} FlowField;

/* Fills the values of node i, by FlowField. */
static void fill_values(const Flowing *made, size_t i, double value[FLOW_FIELDS])
{
    const double radius = made->tree.radius_mm[i], q = fabs(made->flow.flow[i]);
    const bool is_segment = tree_is_segment(&made->tree, i);
    const double drop = made->network.resistance[i] * q;
    value[FIELD_FLOW] = is_segment ? ml_min_from_mm3_s(q) : (double)NAN;
    value[FIELD_PRESSURE] = mmhg_from_pa(made->flow.pressure[tree_linked_node(&made->tree, i)]);
    value[FIELD_VELOCITY] = is_segment && radius > 0 ? q / (PI * radius * radius) : (double)NAN;
    value[FIELD_WSS] = drop * radius / (2 * made->network.length_mm[i]);
    value[FIELD_DIRECTION] = made->flow.direction_unknown[i] ? 0 : made->flow.flow[i] < 0 ? -1 : 1;
    value[FIELD_HEMATOCRIT] =
        made->cells.hematocrit ? made->cells.hematocrit[i] : made->blood.hematocrit;
    for (int f = 0; f < FLOW_FIELDS; f++)
        if (!isfinite(value[f]) || (!is_segment && f != FIELD_PRESSURE))
            value[f] = (double)NAN;
}

static Status add_fields(Flowing *made, Err *err)
{
    static const struct {
        const char *name, *unit;
    } field[FLOW_FIELDS] = {{"flow", "ml/min"}, {"pressure", "mmHg"}, {"velocity", "mm/s"},
                            {"wss", "Pa"},      {"direction", ""},    {"hematocrit", ""}};
    double *column[FLOW_FIELDS], value[FLOW_FIELDS];
    const int n = made->blood.plasma_pa_s > 0 ? FLOW_FIELDS : FIELD_HEMATOCRIT;
    for (int f = 0; f < n; f++)
        TRY(tree_set_column(&made->tree, field[f].name, field[f].unit, &column[f], err));
    for (size_t i = 0; i < made->tree.n; i++) {
        fill_values(made, i, value);
        for (int f = 0; f < n; f++)
            column[f][i] = value[f];
    }
    return STATUS_OK;
}

/* ---- the report ------------------------------------------------------------------------------ */

static void add_row(Flowing *made, const char *key, const char *title, double value,
                    const char *unit)
{
    made->row[made->n_rows++] = (FlowingRow){key, title, unit, value};
}

/* Adds the rows of the report about the flow, and warns of negative pressures. */
static void report_flow(Flowing *made, size_t loops)
{
    const NetworkFlow *flow = &made->flow;
    double segments = 0, closed = 0, lost = 0, inflow = 0, pressure[2] = {HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < made->tree.n; i++) {
        bool is_segment = tree_is_segment(&made->tree, i),
             is_closed = is_segment && !(made->network.resistance[i] < HUGE_VAL);
        segments += is_segment;
        closed += is_closed;
        lost += is_segment && !is_closed && flow->direction_unknown[i];
        inflow += ml_min_from_mm3_s(fmax(flow->inflow[i], 0));
        if (!isnan(flow->pressure[i])) {
            pressure[0] = fmin(pressure[0], mmhg_from_pa(flow->pressure[i]));
            pressure[1] = fmax(pressure[1], mmhg_from_pa(flow->pressure[i]));
        }
    }
    if (pressure[0] < 0 && flow->floating == 0)
        talk_warn(made->parsed->common.talk,
                  "the lowest pressure is %.4g mmHg: the flow is too large for these radii, or the "
                  "pressure at the inlets too low",
                  pressure[0]);
    add_row(made, "segments", "segments", segments, "");
    add_row(made, "loops", "independent loops", (double)loops, "");
    add_row(made, "components", "connected components", (double)flow->components, "");
    add_row(made, "floating_components", "components without a boundary pressure",
            (double)flow->floating, "");
    add_row(made, "inflow", "inflow", inflow, "ml/min");
    add_row(made, "largest_flow", "largest flow", ml_min_from_mm3_s(flow->largest), "ml/min");
    add_row(made, "pressure_min", "lowest pressure", pressure[0], "mmHg");
    add_row(made, "pressure_max", "highest pressure", pressure[1], "mmHg");
    add_row(made, "closed_segments", "segments too narrow for flow", closed, "");
    add_row(made, "lost_segments", "segments whose flow is within rounding error", lost, "");
    add_row(made, "unknowns", "unknown pressures after reduction", (double)flow->unknowns, "");
    add_row(made, "steps", "conjugate gradient iterations", (double)flow->steps, "");
    add_row(made, "mass_imbalance", "mass imbalance / largest flow", flow->imbalance, "");
    add_row(made, "own_mass_imbalance", "mass imbalance / flow through the node",
            flow->node_imbalance, "");
}

static void report_cells(Flowing *made)
{
    const NetworkCells *cells = &made->cells;
    add_row(made, "converged", "hematocrit converged (1: yes)", cells->converged, "");
    add_row(made, "rounds", "hematocrit iterations", (double)cells->rounds, "");
    add_row(made, "flow_change", "change of flow in the last iteration",
            ml_min_from_mm3_s(cells->flow_change), "ml/min");
    add_row(made, "hematocrit_change", "change of hematocrit in the last iteration",
            cells->hematocrit_change, "");
    add_row(made, "cell_imbalance", "red cell imbalance / largest red cell flow", cells->imbalance,
            "");
    add_row(made, "capped_segments", "segments limited to the maximum hematocrit",
            (double)cells->capped, "");
}

/* Adds the rows about other starts of the estimate of unknown pressures. */
static void report_spread(Flowing *made)
{
    const NetworkSpread *spread = &made->spread;
    add_row(made, "estimated_ends", "ends with estimated pressure", (double)spread->open, "");
    add_row(made, "estimate_solves", "solutions of the first start", (double)spread->minimizations,
            "");
    if (made->options->starts < 2)
        return;
    add_row(made, "turned_min", "other starts: least share of reversed segments",
            spread->reversed[0], "");
    add_row(made, "turned_max", "other starts: largest share of reversed segments",
            spread->reversed[1], "");
    add_row(made, "change_min", "other starts: least median change of flow", spread->change[0], "");
    add_row(made, "change_max", "other starts: largest median change", spread->change[1], "");
}

json_t *flowing_json(const Flowing *made)
{
    json_t *object = json_object();
    for (size_t i = 0; i < made->n_rows; i++)
        object = json_with(object, made->row[i].key, json_number(made->row[i].value));
    return object;
}

static Status put_summary(const void *context, Text *text, Err *err)
{
    const Flowing *made = context;
    text_puts(text, "quantity,value,unit\n");
    for (size_t i = 0; i < made->n_rows; i++)
        text_printf(text, "%s,%.9g,%s\n", made->row[i].key, made->row[i].value, made->row[i].unit);
    return text_check(text, err);
}

/* ---- the operation --------------------------------------------------------------------------- */

/* Computes viscosities, resistances and boundary conditions, and solves the network. */
static Status compute(Flowing *made, const TreeMeta *options_meta, Err *err)
{
    size_t loops;
    TRY(derive_viscosity(&made->tree, options_meta, &made->viscosity, err));
    TRY(treenetwork_make(&made->tree, made->viscosity, &made->network, err));
    TRY(set_blood(made, options_meta, err));
    size_t closed = count_closed(made);
    Status status = set_boundary(made, options_meta, err);
    if (status == STATUS_OK)
        status = solve(made, err);
    if (status == STATUS_INPUT && closed > 0)
        err_prefix(err,
                   "%zu segments carry no flow, because their radius is 0 or, by Pries's law, "
                   "their diameter at most 1.1 um; ",
                   closed);
    TRY(status);
    TRY(add_fields(made, err));
    TRY(tree_loop_count(&made->tree, &loops, err));
    report_flow(made, loops);
    if (made->options->separation)
        report_cells(made);
    if (made->spread.open > 0)
        report_spread(made);
    return STATUS_OK;
}

Status flowing_make(void *options, Parsed *parsed, Flowing *made, Err *err)
{
    *made = (Flowing){.options = options, .parsed = parsed};
    const TreeMeta options_meta = blood_specified(&made->options->blood);
    TRY(check_output(made->options, err));
    TRY(reading_tree(parsed, parsed->operands[0], &made->tree, NULL, err));
    TRY(blood_apply(&made->options->blood, parsed, &made->tree, err));
    Status status = compute(made, &options_meta, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", parsed->operands[0]);
    return status;
}

Status flowing_write(const Flowing *made, Err *err)
{
    const FlowingOptions *options = made->options;
    if (options->summary)
        TRY(file_write_parts(options->summary, put_summary, made, err));
    return options->output ? tree_write(&made->tree, options->output, err) : STATUS_OK;
}

void flowing_release(Flowing *made)
{
    tree_release(&made->tree);
    treenetwork_release(&made->network);
    networkflow_release(&made->flow);
    free(made->inflow_hematocrit);
    free(made->viscosity);
    free(made->cells.hematocrit);
}

static ConditionSet unmet(const void *set, const Parsed *parsed)
{
    (void)parsed;
    return UNLESS(((const FlowingOptions *)set)->ends == ENDS_ESTIMATED, ESTIMATED);
}

static const OptionTable table = {OPTION_ROWS(rows), .unmet = unmet};

const Command command_flow = {
    .name = "flow",
    .summary = "compute steady flow in a network of vessels, also with loops",
    .operands = "T.vtp [-o F.vtp] [--summary S.csv] [--json]",
    .examples =
        "  # flow and pressures of a grown tree, as fields of a VTP file\n"
        "  corcast flow tree.swc -o flow.vtp\n"
        "  # a network whose file states its boundary conditions\n"
        "  corcast flow network.dat --viscosity 3 -o flow.vtp --summary flow.csv\n"
        "  # boundary conditions from a table; red cells separate at bifurcations\n"
        "  corcast flow network.vtp --boundary ends.csv --viscosity-law pries --hematocrit 0.4 \\\n"
        "      --plasma-viscosity 1.05 --separation -o flow.vtp\n"
        "  # ends without a boundary condition get an estimated pressure\n"
        "  corcast flow network.vtp --boundary some.csv --ends estimate --viscosity 3 --json\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .size = sizeof(FlowingOptions),
    .set_defaults = set_defaults,
    .tables = {{&table, 0}, {&blood_table, offsetof(FlowingOptions, blood)}},
};
