/* One summary, and the statistics on request, as text or as JSON of the same numbers. What options
 * say of the blood is laid over what the tree's file says. */
#include "cli/commands.h"
#include "derive/derive.h"
#include "job/tree/blood.h"
#include "job/tree/certifying.h"
#include "job/tree/info_morphometry.h"
#include "job/tree/info_statistics.h"
#include "job/tree/summary_json.h"
#include "options/options.h"
#include "options/output.h"
#include "options/reading.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>

static void print_gamma(const LogCurve *gamma)
{
    if (gamma->n == 1)
        printf("  gamma         %g\n", gamma->value[0]);
    for (size_t k = 0; gamma->n > 1 && k < gamma->n; k++)
        printf("  %-13s %g at a radius of %g mm of the parent\n", k == 0 ? "gamma" : "",
               gamma->value[k], gamma->place[k]);
}

static void print_summary(const char *path, const TreeSummary *summary)
{
    const Box *box = &summary->bounds;
    printf("%s\n", path);
    printf("  segments      %zu (%zu terminal%s, %zu bifurcation%s, %zu root%s)\n",
           summary->segments, summary->terminals, summary->terminals == 1 ? "" : "s",
           summary->bifurcations, summary->bifurcations == 1 ? "" : "s", summary->roots,
           summary->roots == 1 ? "" : "s");
    printf("  total length  %.6g mm\n", summary->total_length_mm);
    printf("  volume        %.6g mm^3\n", summary->volume_mm3);
    if (summary->has.target)
        printf("  target        %.6g (sum of length * radius^%g)\n", summary->target,
               summary->lambda);
    print_gamma(&summary->gamma);
    printf("  radius        %.6g mm at the root", summary->root_radius_mm);
    if (summary->segments > 0)
        printf(", %.6g mm at the thinnest", summary->min_radius_mm);
    printf("\n");
    printf("  orders        bifurcation level %d, Strahler %d\n", summary->max_level,
           summary->max_strahler);
    if (summary->has.terminal_pressure)
        printf("  terminals at  %.9g to %.9g mmHg\n", summary->terminal_pressure_min_mmhg,
               summary->terminal_pressure_max_mmhg);
    printf("  extent        x %.4g to %.4g, y %.4g to %.4g, z %.4g to %.4g mm\n", box->low.x,
           box->high.x, box->low.y, box->high.y, box->low.z, box->high.z);
}

static json_t *columns_json(const Tree *tree)
{
    json_t *rows = json_array();
    for (size_t k = 0; k < tree->n_columns; k++) {
        json_t *row = json_with(json_object(), "name", json_text(tree->column[k].name));
        rows = json_with_item(rows, json_with(row, "unit", json_text(tree->column[k].unit)));
    }
    return rows;
}

/* The series that column `k` is of, as one: "pressure (mmHg): 24 frames, 0 to 0.8", its columns
 * marked; the column itself where there is none. */
static Status print_column(const Tree *tree, size_t k, bool *printed, Err *err)
{
    const TreeColumn *column = &tree->column[k];
    size_t length = 0;
    double time;
    char *name = NULL;
    Series series = {0};
    if (series_parse(column->name, &length, &time)) {
        TRY(mem_strdup(&name, column->name, err));
        name[length] = '\0';
        Status status = tree_series(tree, name, &series, NULL);
        free(name);
        if (status == STATUS_MEMORY)
            return err_set(err, status, "out of memory: no room for a series");
    }
    printf("%.*s", series.n ? (int)(length < 40 ? length : 40) : 40, column->name);
    if (*column->unit)
        printf(" (%.40s)", column->unit);
    if (series.n)
        printf(": %zu frames, %g to %g", series.n, series.frame[0].time,
               series.frame[series.n - 1].time);
    for (size_t i = 0; i < series.n; i++)
        printed[series.frame[i].column] = true;
    series_release(&series);
    return STATUS_OK;
}

static Status print_columns(const Tree *tree, Err *err)
{
    bool *printed = NULL;
    Status status = mem_calloc(&printed, tree->n_columns, sizeof *printed, "columns", err);
    for (size_t k = 0; k < tree->n_columns && status == STATUS_OK; k++) {
        if (printed[k])
            continue;
        printf("%s", k ? ", " : "  columns       ");
        status = print_column(tree, k, printed, err);
    }
    if (tree->n_columns > 0)
        printf("\n");
    free(printed);
    return status;
}

typedef struct InfoOptions {
    bool json, stats, bound;
    const char *morphometry; /* NULL: beside none */
    BloodOptions blood;
} InfoOptions;

/* What is said of the tree, as far as it is asked for; owned. */
typedef struct Findings {
    TreeReading reading;
    TreeSummary summary;
    TreeStatistics statistics;
    Morphometry table;
    MorphometryComparison comparison;
} Findings;

static const Option own[] = {
    {.name = "json", SETS(FLAG, InfoOptions, json), .help = "as JSON"},
    {.name = "stats",
     SETS(FLAG, InfoOptions, stats),
     .help = "radius and length by level and order, branching ratios"},
    {.name = "bound",
     SETS(FLAG, InfoOptions, bound),
     .group = GROUP_OPTIMUM,
     .needs = "json",
     .help = "with --json, how low the target of this topology can get, as certify proves"},
    {.name = "morphometry",
     SETS(LOOKUP, InfoOptions, morphometry),
     .list = "morphometries",
     .help = "a published table to stand beside: a file of templates/morphometry, or a path"},
    {.name = "lambda",
     SETS_KEY(InfoOptions, blood.said.number[META_LAMBDA], blood.said.known, LAMBDA),
     .group = GROUP_OPTIMUM,
     .otherwise = "the tree's",
     .help = "exponent of the target"},
};

static const OptionTable own_table = OPTION_TABLE(own);

static Status show(const InfoOptions *options, const char *path, const Tree *tree,
                   const Findings *found, Err *err)
{
    json_t *bound = NULL;
    const TreeMeta said = blood_said(&options->blood);
    if (options->bound)
        TRY(certified_json(tree, &said, &bound, err));
    if (options->json) {
        json_t *json = summary_json(&found->summary);
        if (tree_column(tree, tree_pairs_name))
            json = json_with(json, "terminal_pairs", pairs_json(tree));
        if (tree->n_columns > 0)
            json = json_with(json, "columns", columns_json(tree));
        if (options->stats)
            json = json_with(json, "stats", statistics_json(&found->statistics));
        if (options->morphometry)
            json =
                json_with(json, "morphometry", morphometry_json(&found->table, &found->comparison));
        json = json_with(json, "reading", reading_json(&found->reading));
        if (options->bound)
            json = json_with(json, "bound", bound);
        return json_write(json, "-", err);
    }
    print_summary(path, &found->summary);
    TRY(print_columns(tree, err));
    reading_print(&found->reading);
    if (options->stats)
        statistics_print(&found->statistics);
    if (options->morphometry)
        morphometry_print(&found->table, &found->comparison);
    return STATUS_OK;
}

static Status find_out(const InfoOptions *options, const Tree *tree, Findings *found, Err *err)
{
    const TreeMeta said = blood_said(&options->blood);
    TRY(derive_summary(tree, &said, &found->summary, err));
    if (options->stats || options->morphometry)
        TRY(derive_statistics(tree, &found->statistics, err));
    if (!options->morphometry)
        return STATUS_OK;
    return morphometry_beside(&found->statistics, options->morphometry, &found->table,
                              &found->comparison, err);
}

Status run_info(void *options, Parsed *parsed, Err *err)
{
    const InfoOptions *own_options = options;
    Status status = STATUS_OK;
    Tree tree = {0};
    Findings found = {0};
    TRY(reading_tree(parsed, parsed->operands[0], &tree, &found.reading, err));
    TRY_GOTO(blood_settle(&own_options->blood, parsed, &tree, err));
    TRY_GOTO(find_out(own_options, &tree, &found, err));
    status = show(own_options, parsed->operands[0], &tree, &found, err);
done:
    reading_release(&found.reading);
    statistics_release(&found.statistics);
    morphometry_release(&found.table);
    free(found.comparison.pair);
    tree_release(&tree);
    return status;
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
