/* Runs the operation `refine`: moves and reconnects the bifurcations of a tree to lower its target,
 * within a domain. The domain is that of the option --domain, or that of the tree's metadata. */
#include "job/tree/certify.h"
#include "job/tree/makers.h"
#include "job/tree/refining.h"
#include "job/tree/tree_domain.h"
#include "options/output.h"
#include "options/reading.h"
#include <string.h>

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
     .help = "refined tree file to write"},
    {.name = "json",
     SETS(OUTPUT, RefineOptions, json),
     .otherwise = "",
     .help =
         "write a summary of the run, with a proved lower bound on the target, as JSON to FILE"},
    {.name = "domain",
     SETS(TEXT, RefineOptions, domain),
     .group = GROUP_TREE,
     .argument = "SHAPE",
     .otherwise = "from the tree, else none",
     .help = "tissue shape that vessels must stay in, such as ball:R; `corcast domains` describes "
             "all shapes. Without a shape, vessels may leave the tissue"},
    {.name = "clearance",
     SETS(NUMBER, RefineOptions, clearance_mm),
     GIVEN(RefineOptions, has_clearance),
     .meta = &meta_rows[META_CLEARANCE],
     .group = GROUP_TREE,
     .otherwise = "from the tree, else 0",
     .help = "minimum distance between the walls of vessels of different trees; every move keeps "
             "it"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static void set_defaults(void *options)
{
    ((RefineOptions *)options)->refining.level = GROW_REFINE_TOPOLOGY;
}

/* Sends a note about the columns that refinement removes. */
static Status note_columns(const Tree *tree, const Talk *talk, Err *err)
{
    Text names = TEXT_INIT;
    for (size_t k = 0, n = 0; k < tree->n_columns; k++)
        if (strcmp(tree->column[k].name, tree_pairs_name) != 0)
            text_printf(&names, "%s%.40s", n++ ? ", " : "", tree->column[k].name);
    Status status = text_check(&names, err);
    if (status == STATUS_OK && *text_chars(&names))
        talk_note(talk, "the columns %s are left out, because their segments move",
                  text_chars(&names));
    text_release(&names);
    return status;
}

static Status make_report(const RefineReport *report, MadeTree *made, Err *err)
{
    json_t *bound;
    TRY(bound_json(&made->tree, &made->tree.meta, &bound, err));
    return madetree_report(
        made,
        JSON_OBJECT({"generator", json_text(GENERATOR)}, {"seconds", json_number(report->seconds)},
                    {"target_before", json_number(report->target_before)},
                    {"target", json_number(report->target_after)},
                    {"moves_tried", json_count(report->moves_tried)},
                    {"moves_kept", json_count(report->moves_kept)},
                    {"thickness", json_number(report->thickness)},
                    {"broken", json_count(report->broken)},
                    {"apart_mm", json_number(report->apart_mm)},
                    {"stopped", json_boolean(report->stopped)}, {"bound", bound}),
        err);
}

/* Reads the tree, and the domain of the option or of the tree. *found is false if neither states
 * one. */
static Status read_inputs(const RefineOptions *options, Parsed *parsed, Tree *tree, Domain *domain,
                          bool *found, Err *err)
{
    TRY(reading_tree(parsed, parsed->operands[0], tree, NULL, err));
    *found = true;
    TRY(options->domain ? tree_domain_parse(options->domain, NULL, NULL, domain, err)
                        : tree_domain(tree, domain, found, err));
    if (domain->file)
        TRY(files_add_input(&parsed->files, "--domain", domain->file, err));
    if (options->has_clearance) {
        meta_set_number(&tree->meta, META_CLEARANCE, options->clearance_mm);
        tree->meta.known[META_CLEARANCE] = options->clearance_mm > 0;
    }
    return note_columns(tree, parsed->common.talk, err);
}

Status refine_make(void *options, Parsed *parsed, MadeTree *made, Err *err)
{
    const RefineOptions *own_options = options;
    const Refining *refining = &own_options->refining;
    Domain domain = {0};
    bool has_domain = false;
    RefineReport report;
    Status status = STATUS_OK;
    TRY_GOTO(tree_output_check(own_options->output, err));
    TRY_GOTO(read_inputs(own_options, parsed, &made->tree, &domain, &has_domain, err));
    TRY_GOTO(
        refining_apply(refining, parsed, has_domain ? &domain : NULL, &made->tree, &report, err));
    refining_warn_broken(parsed->common.talk, report.broken);
    if (own_options->json)
        status = make_report(&report, made, err);
done:
    domain_release(&domain);
    return status;
}

const Command command_refine = {
    .name = "refine",
    .summary = "lower the target of a tree, the sum that growth minimizes, by moving and "
               "reconnecting branches",
    .operands = "T.swc -o R.swc",
    .examples = "  corcast refine tree.swc --refine topology -o better.swc\n"
                "  corcast refine tree.swc --refine anneal --refine-seconds 30 -o best.swc\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
    .reads_tree = true,
    .trees_only = true,
    .size = sizeof(RefineOptions),
    .set_defaults = set_defaults,
    .tables = {{&own_table, 0}, {&refining_table, offsetof(RefineOptions, refining)}},
};
