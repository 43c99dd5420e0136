#include "app/growing.h"

#include "app/tree_domain.h"
#include "treeio/treeio.h"
#include <assert.h>
#include <string.h>

void growing_init(Growing *growing)
{
    static const char *const tosses[] = {
        [GROW_TOSS_SEGMENT] = "segment", [GROW_TOSS_TERMINAL] = "terminal", NULL};
    static const char *const laws[] = {
        [VISCOSITY_CONSTANT] = "constant", [VISCOSITY_PRIES] = "pries", NULL};
    static const char *const flows[] = {
        [TERMINAL_FLOW_EQUAL] = "equal", [TERMINAL_FLOW_TERRITORY] = "territory", NULL};
    *growing = (Growing){.params = grow_defaults()};
    GrowParams *params = &growing->params;
    growing->toss = (int)params->toss;
    const double huge = 1e300;
    const Option table[] = {
        {"terminals", OPTION_COUNT, &params->terminals, NULL, 1, 8000000, NULL, NULL,
         "in the whole tree (1000)"},
        {"domain", OPTION_TEXT, &growing->domain_spec, NULL, 0, 0, NULL, "SHAPE",
         "tissue, mm: disc:R, ball:R, rect:W,H, box:A,B,C, ellipsoid:A,B,C, "
         "shell:A,B,C,THICKNESS,\n"
         "                                 polygon:FILE, mask:FILE, mesh:FILE (disc:50)"},
        {"inlet", OPTION_VECTORS, &growing->inlets, NULL, 0, 0, NULL, NULL,
         "where the tree starts, mm (top of the rim); given several times: one tree from each"},
        {"inlet-shares", OPTION_NUMBERS, &growing->shares, NULL, 0, 0, NULL, NULL,
         "of the terminals for the trees, in the order of the inlets, any sum (equal)"},
        {"from", OPTION_INPUT, &growing->from_path, NULL, 0, 0, NULL, "T.swc",
         "grow on from this tree: its nodes keep places, ids and types, its segments stay\n"
         "                                 straight; all radii follow anew. What its header says "
         "holds unless options\n"
         "                                 say otherwise"},
        {"gamma", OPTION_NUMBER, &params->gamma, &growing->given.gamma, -huge, huge, NULL, NULL,
         "Murray exponent (3)"},
        {"lambda", OPTION_NUMBER, &params->lambda, &growing->given.lambda, -huge, huge, NULL, NULL,
         "target: sum of length * radius^lambda (2)"},
        {"p-perf", OPTION_NUMBER, &params->p_perf_mmhg, &growing->given.p_perf, -huge, huge, NULL,
         "MMHG", "pressure at the inlet (100)"},
        {"p-term", OPTION_NUMBER, &params->p_term_mmhg, &growing->given.p_term, -huge, huge, NULL,
         "MMHG", "pressure at every terminal (60)"},
        {"q-perf", OPTION_NUMBER, &params->q_perf_ml_min, &growing->given.q_perf, -huge, huge, NULL,
         "ML/MIN", "flow through all inlets (500)"},
        {"viscosity", OPTION_NUMBER, &params->viscosity_cp, &growing->given.viscosity, -huge, huge,
         NULL, "CP", "of the blood (3.6)"},
        {"viscosity-law", OPTION_CHOICE, &growing->viscosity_law, &growing->given.viscosity_law, 0,
         0, laws, NULL, "the same in all vessels, or by their diameter, Pries 1994 (constant)"},
        {"hematocrit", OPTION_NUMBER, &params->hematocrit, &growing->given.hematocrit, 0,
         MAX_HEMATOCRIT, NULL, "H", "for pries (0.45)"},
        {"plasma-viscosity", OPTION_NUMBER, &params->plasma_viscosity_cp,
         &growing->given.plasma_viscosity, -huge, huge, NULL, "CP", "for pries (1.2)"},
        {"terminal-flow", OPTION_CHOICE, &growing->terminal_flow, &growing->given.terminal_flow, 0,
         0, flows, NULL,
         "the same through all terminals, or as large as the tissue nearest to each (equal)"},
        {"candidates", OPTION_WHOLE, &params->candidates, NULL, 1, 1000, NULL, "K",
         "nearest segments tried for each terminal (8)"},
        {"toss", OPTION_CHOICE, &growing->toss, NULL, 0, 0, tosses, NULL,
         "new terminals keep their distance to (segment)"},
        {"partial", OPTION_FLAG, &params->partial, NULL, 0, 0, NULL, NULL,
         "write the tree so far when no more terminals find room"},
        {0},
    };
    static_assert(sizeof table <= sizeof growing->table, "GROWING_OPTIONS is too small");
    memcpy(growing->table, table, sizeof table);
}

static void take(double *value, bool given, const TreeMeta *meta, MetaKey key)
{
    if (!given && meta->known[key])
        *value = meta->number[key];
}

/* What is known of the tree and no option says. */
static Status take_meta(Growing *growing, Err *err)
{
    const TreeMeta *meta = &growing->from.meta;
    GrowParams *params = &growing->params;
    take(&params->gamma, growing->given.gamma, meta, META_GAMMA);
    take(&params->lambda, growing->given.lambda, meta, META_LAMBDA);
    take(&params->p_perf_mmhg, growing->given.p_perf, meta, META_P_PERF);
    take(&params->p_term_mmhg, growing->given.p_term, meta, META_P_TERM);
    take(&params->q_perf_ml_min, growing->given.q_perf, meta, META_Q_PERF);
    take(&params->viscosity_cp, growing->given.viscosity, meta, META_VISCOSITY);
    take(&params->hematocrit, growing->given.hematocrit, meta, META_HEMATOCRIT);
    take(&params->plasma_viscosity_cp, growing->given.plasma_viscosity, meta,
         META_PLASMA_VISCOSITY);
    if (!growing->given.viscosity_law && !growing->given.viscosity)
        params->viscosity_law = (ViscosityLaw)meta_number(meta, META_VISCOSITY_LAW);
    if (growing->given.terminal_flow)
        return STATUS_OK;
    if (meta->known[META_TERMINAL_FLOW])
        params->terminal_flow = (TerminalFlow)meta->number[META_TERMINAL_FLOW];
    else if (growing->from.flow_share)
        return err_set(
            err, STATUS_USAGE,
            "--from: the tree has flow shares, and does not say after what new terminals "
            "are to get theirs; give --terminal-flow equal or territory");
    return STATUS_OK;
}

static Status read_from(Growing *growing, bool *has_domain, Err *err)
{
    TRY(tree_read(&growing->from, growing->from_path, err));
    growing->params.from = &growing->from;
    TRY(take_meta(growing, err));
    if (growing->domain_spec)
        return STATUS_OK;
    TRY(tree_domain(&growing->from, &growing->domain, has_domain, err));
    if (*has_domain)
        return STATUS_OK;
    return err_set(err, STATUS_USAGE,
                   "--from: the header of the tree names no domain; give --domain");
}

/* Takes note of the domain's file, and refuses what the law of viscosity, settled by now, does not
 * take. */
static Status check(const Growing *growing, Parsed *parsed, Err *err)
{
    bool pries = growing->params.viscosity_law == VISCOSITY_PRIES;
    const OptionNeed needs[] = {{"viscosity", !pries, "is for --viscosity-law constant"},
                                {"hematocrit", pries, "is for --viscosity-law pries"},
                                {"plasma-viscosity", pries, "is for --viscosity-law pries"},
                                {0}};
    TRY(options_check_needs(parsed, needs, err));
    if (!growing->domain.file)
        return STATUS_OK;
    return files_read(&parsed->files, "--domain", growing->domain.file, err);
}

Status growing_prepare(Growing *growing, Parsed *parsed, Err *err)
{
    GrowParams *params = &growing->params;
    params->seed = parsed->common.seed;
    params->threads = parsed->common.threads;
    params->inlets = growing->inlets.n;
    params->inlet = growing->inlets.at;
    params->inlet_shares = growing->shares.n;
    params->inlet_share = growing->shares.at;
    params->toss = (GrowToss)growing->toss;
    params->viscosity_law = (ViscosityLaw)growing->viscosity_law;
    params->terminal_flow = (TerminalFlow)growing->terminal_flow;
    bool has_domain = false;
    if (growing->from_path)
        TRY(read_from(growing, &has_domain, err));
    if (!has_domain)
        TRY(domain_parse(&growing->domain, growing->domain_spec ? growing->domain_spec : "disc:50",
                         err));
    return check(growing, parsed, err);
}

void growing_release(Growing *growing)
{
    domain_release(&growing->domain);
    tree_release(&growing->from);
}
