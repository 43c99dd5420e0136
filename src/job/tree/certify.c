/* Proves a lower bound of a tree's target, and divides the gap between target and bound into parts.
 *
 * The parts are differences between consecutive targets in this list. Each problem has fewer
 * constraints than the one before: the tree; the tree refined within the rules of length and
 * clearance; the best geometry without these rules, with radii by Murray's law; the same with free
 * radii; the bound. Only the last two are minima. If a problem with fewer constraints was
 * solved worse, its part is 0. */
#include "job/tree/certify.h"

#include "derive/derive.h"
#include "job/tree/blood.h"
#include "job/tree/tree_domain.h"
#include "options/output.h"
#include "options/reading.h"

typedef struct CertifyOptions {
    bool json, parts, has_lambda;
    const char *certificate; /* a file to write it to; NULL: it is not made */
    double lambda;
    BloodOptions blood; /* only law, flow of the terminals and gamma are set */
} CertifyOptions;

static const Option rows[] = {
    {.name = "json",
     SETS(FLAG, CertifyOptions, json),
     .help = "print the result as JSON on standard output"},
    {.name = "certificate",
     SETS(OUTPUT, CertifyOptions, certificate),
     .argument = "FILE",
     .otherwise = "",
     .help = "file to write: the proof, for an independent checker that shares no code with "
             "corcast"},
    {.name = "explain-gap",
     .former = "parts",
     SETS(FLAG, CertifyOptions, parts),
     .group = GROUP_OPTIMUM,
     .help = "also divide the gap between the target of the tree and the bound into four parts: "
             "search (the gain of better positions of bifurcations, which corcast searches for "
             "but does not store), rules (the cost of minimum lengths and distances of vessels), "
             "radii (the cost of Murray's law), unproved (the rest). The unit is percent of the "
             "bound; with --json, the unit of the target"},
    {.name = "lambda",
     SETS(NUMBER, CertifyOptions, lambda),
     GIVEN(CertifyOptions, has_lambda),
     .range = &BOUND_LAMBDA_RANGE,
     .group = GROUP_OPTIMUM,
     .otherwise = "from the tree; required if it has none",
     .help = "exponent lambda of the target, which growth minimizes: the target is the sum over "
             "all segments of length * radius^lambda"},
    {.name = "flow-split",
     .former = "terminal-flow",
     SETS(TEXT, CertifyOptions, blood.terminal_flow),
     .group = GROUP_BLOOD,
     .argument = "equal|murray|FILE.csv",
     .otherwise = "from the tree, else equal",
     .help = "how the total flow is divided among the terminals: equal (the same for all), murray "
             "(in proportion to radius^E, with the exponent E of --flow-exponent), or a CSV file "
             "with the columns id (of a terminal segment) and flow, of which only the proportions "
             "matter. A terminal without a row has no flow"},
    {.name = "flow-exponent",
     .former = "gamma",
     SETS_KEY(CertifyOptions, blood.said.number[META_GAMMA], blood.said.known, GAMMA),
     .group = GROUP_BLOOD,
     .otherwise = "the tree's gamma (Murray exponent), else 3",
     .help = "exponent E of --flow-split murray: the flow of a terminal is in proportion to the "
             "E-th power of its radius. The option changes no radius"},
    {.name = "viscosity-law",
     SETS(CHOICE, CertifyOptions, blood.law),
     GIVEN(CertifyOptions, blood.said.known[META_VISCOSITY_LAW]),
     .choices = viscosity_law_names,
     .group = GROUP_BLOOD,
     .otherwise = "from the tree, else constant",
     .help = "viscosity of the blood: constant (the same in all vessels), pries (from the "
             "vessel's diameter; an error, because no bound can be proved for it)"},
};

static const OptionTable table = OPTION_TABLE(rows);

const struct GapPartRow gap_part_rows[GAP_PARTS] = {
    [GAP_SEARCH] = {"search", "gain of refining the geometry under all rules"},
    [GAP_RULES] =
        {"rules",
         "cost of the rules of length and clearance, and of a geometry that is not optimal"},
    [GAP_RADII] = {"radii", "cost of Murray's law"},
    [GAP_UNPROVED] = {"unproved", "between the best geometry found and the bound"},
};

static Status find_lambda(const CertifyOptions *options, const char *path, const Tree *tree,
                          double *lambda, Err *err)
{
    char range[RANGE_TEXT_SIZE];
    *lambda = options->has_lambda ? options->lambda : meta_number(&tree->meta, META_LAMBDA);
    if (options->has_lambda || range_has(BOUND_LAMBDA_RANGE, *lambda))
        return STATUS_OK;
    if (!tree->meta.known[META_LAMBDA])
        return err_set(
            err, STATUS_INPUT,
            "%s does not state lambda, the exponent of the target; give it with --lambda", path);
    return err_set(err, STATUS_INPUT,
                   "%s: lambda is %g, but a bound can be proved only for lambda %s; give --lambda",
                   path, *lambda, range_text(BOUND_LAMBDA_RANGE, range));
}

static Status check_viscosity(const CertifyOptions *options, const char *path, const Tree *tree,
                              Err *err)
{
    const TreeMeta said = blood_specified(&options->blood);
    if (derive_viscosity_law(tree, &said) == VISCOSITY_CONSTANT)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s: no bound can be proved for the viscosity law pries; use --viscosity-law "
                   "constant to assume one viscosity",
                   path);
}

/* Refines the geometry of the tree, with the exponent of the bound. The seed is fixed, so that the
 * same tree always has the same parts. */
static Status refine(const char *path, Tree *tree, Certified *found, Err *err)
{
    const RefineParams params = {.level = GROW_REFINE_GEOMETRY, .seed = 1};
    RefineReport report;
    Domain domain = {0};
    bool has_domain;
    Status status;
    meta_set_number(&tree->meta, META_LAMBDA, found->bound.lambda);
    TRY_GOTO(tree_domain(tree, &domain, &has_domain, err));
    TRY_GOTO(refine_tree(&params, has_domain ? &domain : NULL, tree, &report, err));
    found->refined = report.target_after;
done:
    if (status == STATUS_INPUT)
        err_prefix(err, "--explain-gap: %s: ", path);
    domain_release(&domain);
    return status;
}

/* Divides the gap between target and bound into parts. A target that was not computed is NaN; its
 * part is NaN, and the next part begins where the one before ended. */
static void divide_gap(Certified *found)
{
    const Bound *bound = &found->bound;
    const double level[GAP_PARTS] = {found->refined, bound->murray, bound->best, bound->bound};
    double above = bound->target;
    for (int k = 0; k < GAP_PARTS; k++) {
        found->part[k] = isnan(level[k]) ? (double)NAN : fmax(0, above - level[k]);
        above = isnan(level[k]) ? above : fmin(above, level[k]);
    }
}

/* Proves the bound, and measures the time that it takes. */
static Status prove_bound(const CertifyOptions *options, const char *path, const Tree *tree,
                          Certified *found, Err *err)
{
    double lambda, begun = clock_seconds();
    TRY(find_lambda(options, path, tree, &lambda, err));
    TRY(check_viscosity(options, path, tree, err));
    Status status = bound_tree(tree, lambda, &found->bound, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", path);
    TRY(status);
    found->seconds = clock_seconds() - begun;
    return STATUS_OK;
}

/* Bounds the target of `tree`, and with --explain-gap refines the tree's geometry. */
static Status prove(const CertifyOptions *options, const Parsed *parsed, Tree *tree,
                    Certified *found, Err *err)
{
    const char *path = parsed->operands[0];
    TRY(reading_tree(parsed, path, tree, NULL, err));
    TRY(blood_apply(&options->blood, parsed, tree, err));
    TRY(prove_bound(options, path, tree, found, err));
    if (options->certificate)
        bound_put_certificate(&found->bound, tree, &found->certificate);
    if (options->parts)
        TRY(refine(path, tree, found, err));
    divide_gap(found);
    return text_check(&found->certificate, err);
}

Status certify_make(void *options, Parsed *parsed, Certified *found, Err *err)
{
    Tree tree = {0};
    *found = (Certified){.certificate = TEXT_INIT, .refined = NAN};
    Status status = prove(options, parsed, &tree, found, err);
    tree_release(&tree);
    return status;
}

void certified_release(Certified *found)
{
    bound_release(&found->bound);
    text_release(&found->certificate);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

/* The key `gap` compares the best geometry found with the bound, not the tree. */
json_t *certified_json(const Certified *found)
{
    const Bound *bound = &found->bound;
    json_t *parts = json_object();
    for (int k = 0; k < GAP_PARTS; k++)
        parts = json_with(parts, gap_part_rows[k].key, json_number(found->part[k]));
    return JSON_OBJECT(
        {"target", json_number(bound->target)}, {"lambda", json_number(bound->lambda)},
        {"bound", json_number(bound->bound)}, {"gap", json_number(bound->best / bound->bound - 1)},
        {"best_geometry", json_number(bound->best)}, {"best_murray", json_number(bound->murray)},
        {"refined", json_number(found->refined)}, {"parts", parts},
        {"terminals", json_count(bound->outlets)}, {"seconds", json_number(found->seconds)});
}

Status bound_json(const Tree *tree, const TreeMeta *said, json_t **out, Err *err)
{
    const TreeMeta *source = said->known[META_LAMBDA] ? said : &tree->meta;
    double lambda = meta_number(source, META_LAMBDA);
    *out = json_null();
    if (derive_viscosity_law(tree, said) != VISCOSITY_CONSTANT || !source->known[META_LAMBDA] ||
        !range_has(BOUND_LAMBDA_RANGE, lambda))
        return STATUS_OK;
    Bound bound;
    TRY(bound_tree(tree, lambda, &bound, err));
    *out = JSON_OBJECT({"target", json_number(bound.target)}, {"bound", json_number(bound.bound)},
                       {"above", json_number(bound.target / bound.bound - 1)});
    bound_release(&bound);
    return STATUS_OK;
}

const Command command_certify = {
    .name = "certify",
    .summary = "prove a lower bound of the target of a tree, the sum that growth minimizes",
    .operands = "T.swc [--certificate FILE] [--json]",
    .examples = "  corcast certify tree.swc\n"
                "  corcast certify tree.swc --explain-gap\n"
                "  corcast certify tree.swc --certificate tree.cert --json | jq .gap\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .trees_only = true,
    .size = sizeof(CertifyOptions),
    .tables = {{&table, 0}},
};
