/* The distance is told in parts by targets between the tree's and the bound, each of a problem that
 * is freer than the one before: the tree; the tree refined within the rules of length and
 * clearance; the best geometry without them, with radii by Murray's law; the same with free radii;
 * the bound. Only the last two are minima, so where a freer problem was solved worse, its part is
 * 0. */
#include "job/tree/certifying.h"

#include "derive/derive.h"
#include "job/tree/tree_domain.h"

static const char of_tree[] = "the tree's";

static const Option rows[] = {
    {.name = "certificate",
     SETS(OUTPUT, Certifying, certificate),
     .argument = "FILE",
     .otherwise = "",
     .help = "the proof, for a checker that shares no code with corcast"},
    {.name = "parts",
     SETS(FLAG, Certifying, parts),
     .group = GROUP_OPTIMUM,
     .help = "also refine the tree's geometry, to tell what the search left from what rules cost"},
    {.name = "lambda",
     SETS(NUMBER, Certifying, lambda),
     GIVEN(Certifying, has_lambda),
     .range = &BOUND_LAMBDA_RANGE,
     .group = GROUP_OPTIMUM,
     .otherwise = of_tree,
     .help = "exponent of the target"},
    {.name = "terminal-flow",
     SETS(TEXT, Certifying, blood.terminal_flow),
     .group = GROUP_BLOOD,
     .argument = "equal|murray|FILE.csv",
     .otherwise = of_tree,
     .help = "how flow parts: the same for all terminals, as radius^gamma, or by id and flow"},
    {.name = "gamma",
     SETS_KEY(Certifying, blood.said.number[META_GAMMA], blood.said.known, GAMMA),
     .group = GROUP_BLOOD,
     .otherwise = "the tree's, or 3",
     .help = "exponent of the radius, for murray"},
    {.name = "viscosity-law",
     SETS(CHOICE, Certifying, blood.law),
     GIVEN(Certifying, blood.said.known[META_VISCOSITY_LAW]),
     .choices = viscosity_law_names,
     .group = GROUP_BLOOD,
     .otherwise = of_tree,
     .help = "a bound is proved for constant alone"},
};

const OptionTable certifying_table = OPTION_TABLE(rows);

const struct PartRow part_rows[PARTS] = {
    [PART_SEARCH] = {"search", "what refining its geometry gains, every rule kept"},
    [PART_RULES] = {"rules", "rules of length and clearance, and geometry"},
    [PART_RADII] = {"radii", "Murray's law"},
    [PART_UNPROVED] = {"unproved", "between the best geometry found and the bound"},
};

static Status find_lambda(const Certifying *certifying, const char *path, const Tree *tree,
                          double *lambda, Err *err)
{
    char range[RANGE_TEXT_SIZE];
    *lambda = certifying->has_lambda ? certifying->lambda : meta_number(&tree->meta, META_LAMBDA);
    if (certifying->has_lambda || range_has(BOUND_LAMBDA_RANGE, *lambda))
        return STATUS_OK;
    if (!tree->meta.known[META_LAMBDA])
        return err_set(err, STATUS_INPUT,
                       "%s does not say lambda, the exponent of the target; give --lambda", path);
    return err_set(err, STATUS_INPUT,
                   "%s: lambda is %g, and a bound is proved for lambda %s; give --lambda", path,
                   *lambda, range_text(BOUND_LAMBDA_RANGE, range));
}

static Status check_viscosity(const Certifying *certifying, const char *path, const Tree *tree,
                              Err *err)
{
    const TreeMeta said = blood_said(&certifying->blood);
    if (derive_viscosity_law(tree, &said) == VISCOSITY_CONSTANT)
        return STATUS_OK;
    return err_set(err, STATUS_INPUT,
                   "%s: its viscosity follows the radius by Pries's law, for which no bound is "
                   "proved; --viscosity-law constant bounds it with one viscosity",
                   path);
}

static Status refine_geometry(Tree *tree, double *refined, Err *err)
{
    const RefineParams params = {.level = GROW_REFINE_GEOMETRY, .seed = 1};
    RefineReport report;
    Domain domain = {0};
    bool has_domain;
    Status status = STATUS_OK;
    TRY_GOTO(tree_domain(tree, &domain, &has_domain, err));
    TRY_GOTO(refine_tree(&params, has_domain ? &domain : NULL, tree, &report, err));
    *refined = report.target_after;
done:
    domain_release(&domain);
    return status;
}

static void part_distance(Certified *found)
{
    const Bound *bound = &found->bound;
    const double level[PARTS] = {found->refined, bound->murray, bound->best, bound->bound};
    double above = bound->target;
    for (int k = 0; k < PARTS; k++) {
        found->part[k] = isnan(level[k]) ? (double)NAN : fmax(0, above - level[k]);
        above = isnan(level[k]) ? above : fmin(above, level[k]);
    }
}

/* Refines the tree's geometry, by the exponent of the bound. */
static Status refine(const char *path, Tree *tree, Certified *found, Err *err)
{
    meta_set_number(&tree->meta, META_LAMBDA, found->bound.lambda);
    Status status = refine_geometry(tree, &found->refined, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "--parts: %s: ", path);
    return status;
}

static Status bound(const Certifying *certifying, const char *path, const Tree *tree,
                    Certified *found, Err *err)
{
    double lambda, begun = clock_seconds();
    TRY(find_lambda(certifying, path, tree, &lambda, err));
    TRY(check_viscosity(certifying, path, tree, err));
    Status status = bound_tree(tree, lambda, &found->bound, err);
    if (status == STATUS_INPUT)
        err_prefix(err, "%s: ", path);
    TRY(status);
    found->seconds = clock_seconds() - begun;
    return STATUS_OK;
}

Status certifying_apply(const Certifying *certifying, const Parsed *parsed, Tree *tree,
                        Certified *found, Err *err)
{
    const char *path = parsed->operands[0];
    *found = (Certified){.certificate = TEXT_INIT, .refined = NAN};
    TRY(blood_settle(&certifying->blood, parsed, tree, err));
    TRY(bound(certifying, path, tree, found, err));
    if (certifying->certificate)
        bound_put_certificate(&found->bound, tree, &found->certificate);
    if (certifying->parts)
        TRY(refine(path, tree, found, err));
    part_distance(found);
    return STATUS_OK;
}

Status certified_json(const Tree *tree, const TreeMeta *said, json_t **out, Err *err)
{
    const TreeMeta *knows = said->known[META_LAMBDA] ? said : &tree->meta;
    double lambda = meta_number(knows, META_LAMBDA);
    *out = json_null();
    if (derive_viscosity_law(tree, said) != VISCOSITY_CONSTANT || !knows->known[META_LAMBDA] ||
        !range_has(BOUND_LAMBDA_RANGE, lambda))
        return STATUS_OK;
    Bound bound;
    TRY(bound_tree(tree, lambda, &bound, err));
    const JsonMember members[] = {{"target", json_number(bound.target)},
                                  {"bound", json_number(bound.bound)},
                                  {"above", json_number(bound.target / bound.bound - 1)}};
    *out = json_with_members(json_object(), members, sizeof members / sizeof *members);
    bound_release(&bound);
    return STATUS_OK;
}
