/* Grows, refines if asked, writes, and only then speaks: what a user has to know of a tree that is
 * not as it should be is said with --quiet, too. */
#include "cli/commands.h"
#include "job/tree/certifying.h"
#include "job/tree/growing.h"
#include "job/tree/refining.h"
#include "job/tree/staging.h"
#include "job/tree/summary_json.h"
#include "options/output.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>

/* What the report says of the tree once it is refined. */
static GrowReport after_refining(const GrowReport *grown, const RefineReport *refined,
                                 const Tree *tree)
{
    GrowReport report = *grown;
    report.seconds += refined->seconds;
    report.target = refined->target_after;
    report.thickness = refined->thickness;
    report.broken = refined->broken;
    report.apart_mm = refined->apart_mm;
    report.root_radius_mm = tree_root_radius(tree);
    return report;
}

/* The report as JSON; with the bound of the tree if it is asked for. */
static Status write_report(const char *path, const GrowReport *report, int threads,
                           const Tree *tree, bool bounded, Err *err)
{
    json_t *bound = json_null();
    if (bounded)
        TRY(certified_json(tree, &tree->meta, &bound, err));
    json_t *json =
        json_pack("{s:s, s:f, s:I, s:f, s:f, s:I, s:I, s:f, s:I, s:b, s:i}", "generator", GENERATOR,
                  "seconds", report->seconds, "terminals", (json_int_t)report->terminals, "target",
                  report->target, "root_radius_mm", report->root_radius_mm, "tosses",
                  (json_int_t)report->tosses, "rejected", (json_int_t)report->rejected, "thickness",
                  report->thickness, "broken", (json_int_t)report->broken, "complete",
                  report->complete, "threads", threads);
    json_t *change = json_null();
    if (report->median_change > 0)
        change = json_pack("{s:f, s:f, s:f}", "median", report->median_change, "min",
                           report->least_change, "max", report->greatest_change);
    json = json_with(json, "radius_change", change);
    json_t *apart = isfinite(report->apart_mm) ? json_number(report->apart_mm) : json_null();
    json = json_with(json, "apart_mm", apart);
    json = json_with(json, "terminal_pairs", pairs_json(tree));
    return json_write(json_with(json, "bound", bound), path, err);
}

static void print_report(const GrowReport *report, const GrowParams *params)
{
    fprintf(stderr, "grew %zu terminals in %.3g s: target %.6g, root radius %.4g mm\n",
            report->terminals, report->seconds, report->target, report->root_radius_mm);
    if (params->pair_mm > 0)
        fprintf(stderr,
                "%zu pairs of terminals %.4g mm apart; walls of the two trees at least %.4g mm\n",
                report->terminals / 2, params->pair_mm, report->apart_mm);
    if (report->median_change > 0 && !params->keep_radii)
        fprintf(stderr,
                "the radii of the tree of --from changed by a median factor of %.2g (%.2g to "
                "%.2g)\n",
                report->median_change, report->least_change, report->greatest_change);
}

/* The domain's size, and what may be wrong with it. */
static void print_size(const Domain *domain)
{
    Box box = domain->bounds;
    Vec3 size = vec3_sub(box.high, box.low);
    fprintf(stderr, "the domain, %.4g x %.4g", size.x, size.y);
    if (domain->dimension == 3)
        fprintf(stderr, " x %.4g", size.z);
    fprintf(stderr, " mm%s, ",
            domain->unit_is_guessed ? " if the file's unit is that (FILE,10 is a file in cm)" : "");
}

/* What a user has to know of a tree that is not as it should be. */
static void print_warnings(const GrowReport *report, const Domain *domain)
{
    Box box = domain->bounds;
    if (report->root_radius_mm > vec3_distance(box.low, box.high)) {
        fprintf(stderr, "corcast: ");
        print_size(domain);
        fprintf(stderr,
                "is smaller than the radius of the root, %.4g mm: such a tree is of numbers only; "
                "move --gamma towards 3 or lower --q-perf\n",
                report->root_radius_mm);
    } else if (report->thickness < 1) {
        fprintf(stderr, "corcast: ");
        print_size(domain);
        fprintf(stderr,
                "was too full for vessels of their real thickness: they keep clear of each other "
                "at %g of it only; ask for fewer terminals, a larger domain or a smaller "
                "--q-perf\n",
                report->thickness);
    }
    print_broken(report->broken);
}

typedef struct GrowOptions {
    const char *output, *json, *stages;
    bool bound;
    Growing growing;
    Refining refining;
} GrowOptions;

static const Option own[] = {
    {.name = "output", SETS(OUTPUT, GrowOptions, output), .argument = "T.swc", .help = "the tree"},
    {.name = "json", SETS(OUTPUT, GrowOptions, json), .help = "what was done, as JSON"},
    {.name = "bound",
     SETS(FLAG, GrowOptions, bound),
     .group = GROUP_OPTIMUM,
     .needs = "json",
     .help = "--json also says how low the target of this topology can get, as certify proves"},
    {.name = "stages",
     SETS(INPUT, GrowOptions, stages),
     .group = GROUP_TREE,
     .argument = "FILE.ini",
     .otherwise = "",
     .help = "grow in stages: sections of options, each on the tree of the one before"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    growing_set_defaults(&((GrowOptions *)options)->growing);
}

/* Writes the tree and the report, and says what was done. */
static Status finish(const GrowOptions *options, const Common *common, const Tree *tree,
                     const GrowReport *report, const RefineReport *refined, const Err *why,
                     Err *err)
{
    int threads = common->threads ? common->threads : threads_available();
    GrowReport written = *report;
    if (refined->target_before > 0)
        written = after_refining(report, refined, tree);
    TRY(output_tree("grow", tree, options->output, common->quiet, err));
    if (options->json)
        TRY(write_report(options->json, &written, threads, tree, options->bound, err));
    if (!report->complete)
        fprintf(stderr, "corcast grow: %s\n", why->text);
    if (!common->quiet)
        print_report(report, &options->growing.params);
    print_warnings(&written, &options->growing.domain);
    if (!common->quiet)
        refining_print(refined);
    return STATUS_OK;
}

Status run_grow(void *options, Parsed *parsed, Err *err)
{
    GrowOptions *own_options = options;
    Growing *growing = &own_options->growing;
    const Refining *refining = &own_options->refining;
    Tree tree = {0};
    GrowReport report;
    RefineReport refined;
    Err why;
    Status status = STATUS_OK;
    TRY(tree_format_check(own_options->output, err));
    if (own_options->stages && refining->level != GROW_REFINE_NONE)
        TRY_GOTO(err_set(err, STATUS_USAGE,
                         "--refine: would give --stages one law; use corcast refine afterwards"));
    TRY_GOTO(refining_check_growing(refining, growing, err));
    TRY_GOTO(growing_prepare(growing, parsed, err));
    if (own_options->stages)
        TRY_GOTO(staging_grow(own_options->stages, growing, parsed, &tree, &report, &why, err));
    else
        TRY_GOTO(growing_run(growing, parsed->common.talk, &tree, &report, &why, err));
    options_name_fields(parsed, &why);
    TRY_GOTO(refining_apply(refining, &parsed->common, &growing->domain, &tree, &refined, err));
    TRY_GOTO(command_describe(parsed, &tree.meta, err));
    TRY_GOTO(refining_describe(refining, &refined, &tree.meta, err));
    status = finish(own_options, &parsed->common, &tree, &report, &refined, &why, err);
done:
    growing_release(growing);
    tree_release(&tree);
    return status;
}

const Command command_grow = {
    .name = "grow",
    .summary = "grow an arterial tree by constrained constructive optimization",
    .operands = "-o T.swc",
    .examples = "  corcast grow --terminals 4000 --seed 7 -o tree.swc\n"
                "  corcast grow --domain ball:30 --gamma 2.55 --lambda 1 -o tree.swc\n"
                "  corcast grow --from tree.swc --terminals 8000 -o larger.swc\n"
                "  corcast grow --inlet 0,50 --inlet 30,-40 --inlet-shares 0.7,0.3 -o forest.swc\n",
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(GrowOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&growing_table, offsetof(GrowOptions, growing)},
               {&refining_table, offsetof(GrowOptions, refining)}},
};
