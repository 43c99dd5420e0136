/* Grows a tree and, if an option asks for it, refines the tree. Notes and warnings about the tree
 * are sent before the tree is written, so that a caller who keeps the tree in memory gets them,
 * too. */
#include "job/tree/certify.h"
#include "job/tree/growing.h"
#include "job/tree/makers.h"
#include "job/tree/refining.h"
#include "job/tree/staging.h"
#include "job/tree/summary_json.h"
#include "options/output.h"
#include <stdio.h>

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, GrowOptions, output),
     .argument = "T.swc",
     .help = "tree file to write; its extension selects the format, which `corcast formats` lists"},
    {.name = "json",
     SETS(OUTPUT, GrowOptions, json),
     .help = "also write a summary of the run as JSON to FILE"},
    {.name = "bound",
     SETS(FLAG, GrowOptions, bound),
     .group = GROUP_OPTIMUM,
     .needs = "json",
     .help = "also prove a lower bound of the target of --lambda, as `corcast certify` does, and "
             "write the bound to the --json file"},
    {.name = "stages",
     SETS(INPUT, GrowOptions, stages),
     .group = GROUP_TREE,
     .argument = "FILE.ini",
     .otherwise = "",
     .help = "grow the tree in stages, one after the other, each of which continues the tree of "
             "the stage before. FILE.ini has one section per stage, whose lines are options of "
             "growth, such as `domain = ball:20`"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    growing_set_defaults(&((GrowOptions *)options)->growing);
}

/* ---- sentences ------------------------------------------------------------------------------- */

static void note_grown(const Talk *talk, const GrowReport *report, const GrowParams *params)
{
    const FillReport *fill = &report->fill;
    if (fill->elements > 0) {
        talk_note(talk,
                  "filled with %zu elements in %.3g s: %zu terminals, %.4g ml/min; the "
                  "standard deviation of the terminals' flows is %.0f %% of their mean",
                  fill->elements, report->seconds, report->terminals, fill->flow_ml_min,
                  100 * fill->flow_spread);
        if (fill->left_out > 0)
            talk_warn(talk, "%zu elements do not fit in the tissue shape and were left out",
                      fill->left_out);
        return;
    }
    talk_note(talk, "grew %zu terminals in %.3g s: target %.6g, root radius %.4g mm",
              report->terminals, report->seconds, report->target, report->root_radius_mm);
    if (params->pair_mm > 0)
        talk_note(
            talk,
            "%zu pairs of terminals are %.4g mm apart; the walls of the two trees are at least "
            "%.4g mm apart",
            report->terminals / 2, params->pair_mm, report->apart_mm);
    if (report->median_change > 0 && !params->keep_radii)
        talk_note(talk,
                  "the radii of the --from tree changed by factors of %.2g to %.2g, median %.2g",
                  report->min_change, report->max_change, report->median_change);
}

/* Warns of a tree that does not fit its domain. */
static void warn_of_size(const Talk *talk, const GrowReport *report, const Domain *domain)
{
    const Vec3 size = vec3_sub(domain->bounds.high, domain->bounds.low);
    const char *unit =
        domain->unit_is_guessed ? " if the file's unit is that (FILE,10 is a file in cm)" : "";
    char depth[32] = "";
    if (domain->dimension == 3)
        snprintf(depth, sizeof depth, " x %.4g", size.z);
    if (report->root_radius_mm > vec3_length(size))
        talk_warn(talk,
                  "the domain, %.4g x %.4g%s mm%s, is smaller than the root radius, %.4g mm, so "
                  "the vessels overlap everywhere; move --gamma towards 3 or lower --q-perf",
                  size.x, size.y, depth, unit, report->root_radius_mm);
    else if (report->thickness < 1)
        talk_warn(
            talk,
            "the domain, %.4g x %.4g%s mm%s, is too small: vessels were kept apart with only %g of "
            "their true radii; use fewer terminals, a larger domain or a smaller --q-perf",
            size.x, size.y, depth, unit, report->thickness);
}

/* ---- the report ------------------------------------------------------------------------------ */

/* Returns the factors by which the radii of the tree of --from changed; JSON null if they did not.
 */
static json_t *change_json(const GrowReport *report)
{
    if (!(report->median_change > 0))
        return json_null();
    return json_pack("{s:f, s:f, s:f}", "median", report->median_change, "min", report->min_change,
                     "max", report->max_change);
}

/* Returns JSON null if the tree was not filled. */
static json_t *fill_json(const FillReport *fill)
{
    if (fill->elements == 0)
        return json_null();
    return JSON_OBJECT({"elements", json_count(fill->elements)},
                       {"left_out", json_count(fill->left_out)},
                       {"flow_ml_min", json_number(fill->flow_ml_min)},
                       {"flow_spread", json_number(fill->flow_spread)});
}

static Status make_report(const GrowOptions *options, int threads, const GrowReport *report,
                          MadeTree *made, Err *err)
{
    json_t *bound = json_null();
    if (options->bound)
        TRY(bound_json(&made->tree, &made->tree.meta, &bound, err));
    return madetree_report(
        made,
        JSON_OBJECT(
            {"generator", json_text(GENERATOR)}, {"seconds", json_number(report->seconds)},
            {"terminals", json_count(report->terminals)}, {"target", json_number(report->target)},
            {"root_radius_mm", json_number(report->root_radius_mm)},
            {"tosses", json_count(report->tosses)}, {"rejected", json_count(report->rejected)},
            {"thickness", json_number(report->thickness)}, {"broken", json_count(report->broken)},
            {"complete", json_boolean(report->complete)},
            {"threads", json_integer(threads ? threads : threads_available())},
            {"radius_change", change_json(report)}, {"apart_mm", json_number(report->apart_mm)},
            {"terminal_pairs", pairs_json(&made->tree)}, {"fill", fill_json(&report->fill)},
            {"bound", bound}),
        err);
}

/* ---- the operation --------------------------------------------------------------------------- */

static Status check(const GrowOptions *options, Err *err)
{
    const Refining *refining = &options->refining;
    TRY(tree_output_check(options->output, err));
    if (options->stages && refining->level != GROW_REFINE_NONE)
        return err_set(err, STATUS_USAGE,
                       "--refine cannot be used with --stages, whose stages have laws of their "
                       "own; run `corcast refine` afterwards");
    return refining_check_growing(refining, &options->growing, err);
}

/* Refines the tree if asked, and updates the report of its growth. */
static Status refine(const GrowOptions *options, const Parsed *parsed, Tree *tree,
                     GrowReport *report, Err *err)
{
    RefineReport refined;
    TRY(refining_apply(&options->refining, parsed, &options->growing.domain, tree, &refined, err));
    if (options->refining.level == GROW_REFINE_NONE)
        return STATUS_OK;
    report->seconds += refined.seconds;
    report->target = refined.target_after;
    report->thickness = refined.thickness;
    report->broken = refined.broken;
    report->apart_mm = refined.apart_mm;
    report->root_radius_mm = tree_root_radius(tree);
    return STATUS_OK;
}

Status grow_make(void *options, Parsed *parsed, MadeTree *made, Err *err)
{
    GrowOptions *own_options = options;
    Growing *growing = &own_options->growing;
    const Talk *talk = parsed->common.talk;
    GrowReport report;
    Status status = STATUS_OK;
    TRY_GOTO(check(own_options, err));
    TRY_GOTO(growing_prepare(growing, parsed, err));
    if (own_options->stages)
        TRY_GOTO(staging_grow(own_options->stages, growing, parsed, &made->tree, &report, err));
    else
        TRY_GOTO(growing_run(growing, parsed, &made->tree, &report, err));
    note_grown(talk, &report, &growing->params);
    TRY_GOTO(refine(own_options, parsed, &made->tree, &report, err));
    warn_of_size(talk, &report, &growing->domain);
    refining_warn_broken(talk, report.broken);
    if (own_options->json)
        status = make_report(own_options, parsed->common.threads, &report, made, err);
done:
    growing_release(growing);
    return status;
}

const Command command_grow = {
    .name = "grow",
    .summary = "grow an arterial tree (constrained constructive optimization)",
    .operands = "-o T.swc",
    .examples = "  # 4000 terminals in the default tissue shape\n"
                "  corcast grow --terminals 4000 --seed 7 -o tree.swc\n"
                "  # a tree in a ball of radius 30 mm\n"
                "  corcast grow --domain ball:30 --gamma 2.55 --lambda 1 -o tree.swc\n"
                "  # continue a tree up to 8000 terminals\n"
                "  corcast grow --from tree.swc --terminals 8000 -o larger.swc\n"
                "  # two trees that supply 70 and 30 % of the terminals\n"
                "  corcast grow --inlet 0,50 --inlet 30,-40 --inlet-shares 0.7,0.3 -o forest.swc\n",
    .needs_output = true,
    .reads_tree = true,
    .trees_only = true,
    .size = sizeof(GrowOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0},
               {&growing_table, offsetof(GrowOptions, growing)},
               {&refining_table, offsetof(GrowOptions, refining)}},
};
