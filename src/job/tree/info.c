/* What the options say of the blood takes precedence over what the tree's file says. */
#include "job/tree/info.h"

#include "job/tree/blood.h"
#include "job/tree/certify.h"
#include "options/reading.h"
#include "options/templates.h"
#include <stdlib.h>

typedef struct InfoOptions {
    bool json, stats, bound;
    const char *morphometry; /* NULL: beside none */
    BloodOptions blood;
} InfoOptions;

static const Option own[] = {
    {.name = "json",
     SETS(FLAG, InfoOptions, json),
     .help = "print the result as JSON on standard output"},
    {.name = "stats",
     SETS(FLAG, InfoOptions, stats),
     .help = "also print radius and length by level and by Strahler order, and branching ratios"},
    {.name = "bound",
     SETS(FLAG, InfoOptions, bound),
     .group = GROUP_OPTIMUM,
     .needs = "json",
     .help = "with --json: also prove a lower bound on the target, as `corcast certify` does"},
    {.name = "morphometry",
     SETS(LOOKUP, InfoOptions, morphometry),
     .list = "morphometries",
     .help = "compare the tree with a published data set: its name, or the path of a file of your "
             "own (with a '/')"},
    {.name = "lambda",
     SETS_KEY(InfoOptions, blood.said.number[META_LAMBDA], blood.said.known, LAMBDA),
     .group = GROUP_OPTIMUM,
     .otherwise = "from the tree; without one, no target is computed",
     .help = "exponent of the target, the cost of the tree: sum of length * radius^lambda"},
};

static const OptionTable own_table = OPTION_TABLE(own);

/* Reads the table of --morphometry and compares the tree with it. */
static Status compare(const char *name, InfoReport *report, Err *err)
{
    char *path = NULL;
    TRY(template_file("morphometry", "morphometry", name, ".txt", &path, err));
    Status status = morphometry_read(&report->table, path, err);
    free(path);
    TRY(status);
    report->has_morphometry = true;
    return morphometry_compare(&report->statistics, &report->table, &report->comparison, err);
}

static Status measure(const InfoOptions *options, InfoReport *report, Err *err)
{
    const Tree *tree = &report->tree;
    const TreeMeta said = blood_said(&options->blood);
    TRY(derive_summary(tree, &said, &report->summary, err));
    if (options->bound)
        TRY(bound_json(tree, &said, &report->bound, err));
    if (options->stats || options->morphometry)
        TRY(derive_statistics(tree, &report->statistics, err));
    report->has_statistics = options->stats;
    return options->morphometry ? compare(options->morphometry, report, err) : STATUS_OK;
}

Status info_make(void *options, Parsed *parsed, InfoReport *report, Err *err)
{
    const InfoOptions *own_options = options;
    *report = (InfoReport){.name = parsed->operands[0]};
    TRY(reading_tree(parsed, report->name, &report->tree, &report->reading, err));
    TRY(blood_settle(&own_options->blood, parsed, &report->tree, err));
    return measure(own_options, report, err);
}

void inforeport_release(InfoReport *report)
{
    reading_release(&report->reading);
    statistics_release(&report->statistics);
    morphometry_release(&report->table);
    free(report->comparison.pair);
    json_decref(report->bound);
    tree_release(&report->tree);
}

const Command command_info = {
    .name = "info",
    .summary = "count, measure and check a tree",
    .operands = "T.swc [--stats] [--json]",
    .examples = "  corcast info tree.swc\n"
                "  corcast info tree.swc --json | jq .volume_mm3\n"
                "  corcast info tree.swc --stats --json | jq .stats.by_strahler\n"
                "  corcast info coronary.swc --morphometry kassab-lad\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .size = sizeof(InfoOptions),
    .tables = {{&own_table, 0}, {&blood_table, offsetof(InfoOptions, blood)}},
};
