/* A tree from a file, refined within its domain: that of the option, or that of its header. */
#include "cli/commands.h"
#include "job/tree/certifying.h"
#include "job/tree/refining.h"
#include "job/tree/tree_domain.h"
#include "options/output.h"
#include "options/reading.h"
#include "treeio/treeio.h"
#include <math.h>
#include <stdio.h>

typedef struct RefineOptions {
    const char *output, *domain, *json;
    double clearance_mm;
    bool has_clearance;
    Refining refining;
} RefineOptions;

static const Option own[] = {
    {.name = "output",
     SETS(OUTPUT, RefineOptions, output),
     .argument = "R.swc",
     .help = "the refined tree"},
    {.name = "json",
     SETS(OUTPUT, RefineOptions, json),
     .otherwise = "",
     .help = "what was done, and how low the target of this topology can get, as JSON"},
    {.name = "domain",
     SETS(TEXT, RefineOptions, domain),
     .group = GROUP_TREE,
     .argument = "SHAPE",
     .otherwise = "the tree's",
     .help = "tissue to stay in; a tree without one may go anywhere"},
    {.name = "clearance",
     SETS(NUMBER, RefineOptions, clearance_mm),
     GIVEN(RefineOptions, has_clearance),
     .meta = &meta_rows[META_CLEARANCE],
     .group = GROUP_TREE,
     .otherwise = "the tree's",
     .help = "least distance of the walls of vessels of different trees, kept and proved"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    ((RefineOptions *)options)->refining.level = GROW_REFINE_TOPOLOGY;
}

/* The domain of the option, or of the tree; *found says whether there is one. */
static Status find_domain(const char *spec, const Tree *tree, Domain *domain, bool *found, Err *err)
{
    if (!spec)
        return tree_domain(tree, domain, found, err);
    *found = true;
    return tree_domain_parse(spec, NULL, NULL, domain, err);
}

static void set_clearance(double mm, TreeMeta *meta)
{
    meta_set_number(meta, META_CLEARANCE, mm);
    meta->known[META_CLEARANCE] = mm > 0;
}

static Status write_report(const char *path, const RefineReport *report, const Tree *tree, Err *err)
{
    json_t *bound;
    TRY(certified_json(tree, &tree->meta, &bound, err));
    const JsonMember members[] = {
        {"generator", json_text(GENERATOR)},
        {"seconds", json_number(report->seconds)},
        {"target_before", json_number(report->target_before)},
        {"target", json_number(report->target_after)},
        {"moves_tried", json_count(report->moves_tried)},
        {"moves_kept", json_count(report->moves_kept)},
        {"thickness", json_number(report->thickness)},
        {"broken", json_integer((json_int_t)report->broken)},
        {"apart_mm", isfinite(report->apart_mm) ? json_number(report->apart_mm) : json_null()},
        {"stopped", json_boolean(report->stopped)},
        {"bound", bound},
    };
    return json_write(json_with_members(json_object(), members, sizeof members / sizeof *members),
                      path, err);
}

Status run_refine(void *options, Parsed *parsed, Err *err)
{
    const RefineOptions *own_options = options;
    const Refining *refining = &own_options->refining;
    TRY(tree_format_check(own_options->output, err));
    Tree tree = {0};
    Domain domain = {0};
    bool has_domain;
    RefineReport report;
    Status status = STATUS_OK;
    TRY_GOTO(reading_tree(parsed, parsed->operands[0], &tree, NULL, err));
    TRY_GOTO(find_domain(own_options->domain, &tree, &domain, &has_domain, err));
    if (domain.file)
        TRY_GOTO(files_read(&parsed->files, "--domain", domain.file, err));
    if (own_options->has_clearance)
        set_clearance(own_options->clearance_mm, &tree.meta);
    if (!parsed->common.quiet)
        print_columns_left_out("refine", &tree, "their segments move");
    TRY_GOTO(refining_apply(refining, &parsed->common, has_domain ? &domain : NULL, &tree, &report,
                            err));
    TRY_GOTO(command_describe(parsed, &tree.meta, err));
    TRY_GOTO(refining_describe(refining, &report, &tree.meta, err));
    TRY_GOTO(output_tree("refine", &tree, own_options->output, parsed->common.quiet, err));
    if (own_options->json)
        TRY_GOTO(write_report(own_options->json, &report, &tree, err));
    print_broken(report.broken);
    if (!parsed->common.quiet)
        refining_print(&report);
done:
    domain_release(&domain);
    tree_release(&tree);
    return status;
}

const Command command_refine = {
    .name = "refine",
    .summary = "lower the target of a grown or measured tree",
    .operands = "T.swc -o R.swc",
    .examples = "  corcast refine tree.swc --refine topology -o better.swc\n"
                "  corcast refine tree.swc --refine anneal --refine-seconds 30 -o best.swc\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .size = sizeof(RefineOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, {&refining_table, offsetof(RefineOptions, refining)}},
};
