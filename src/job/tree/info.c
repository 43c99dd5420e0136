/* Runs the operation `info`: measures a tree, compares it with published morphometry, and writes
 * its statistics as CSV. Values of the blood that options state take precedence over those of the
 * tree's file. */
#include "job/tree/info.h"

#include "job/tree/blood.h"
#include "job/tree/certify.h"
#include "options/reading.h"
#include "options/templates.h"
#include <stdlib.h>

typedef struct InfoOptions {
    bool json, stats, bound;
    const char *morphometry; /* NULL: beside none */
    MorphometryOrders orders;
    const char *output; /* CSV file for the statistics; NULL: none */
    BloodOptions blood;
} InfoOptions;

static const Option own[] = {
    {.name = "json",
     SETS(FLAG, InfoOptions, json),
     .help = "print the result as JSON on standard output"},
    {.name = "stats",
     SETS(FLAG, InfoOptions, stats),
     .help = "also print the radius and length of segments per level and per Strahler order, and "
             "branching ratios. The level is the number of bifurcations from the inlet"},
    {.name = "output",
     SETS(OUTPUT, InfoOptions, output),
     .argument = "S.csv",
     .otherwise = "",
     .needs = "stats",
     .help = "with --stats: also write the statistics as a CSV table. Each row is one quantity of "
             "one group of segments or nodes. The columns are table (kind of the group: tree, "
             "degree, level, strahler, diameter-strahler, vessel, branch-point or end), number "
             "(which group of this kind, such as the number of the level), quantity, mean and sd "
             "(standard deviation)"},
    {.name = "bound",
     SETS(FLAG, InfoOptions, bound),
     .group = GROUP_OPTIMUM,
     .needs = "json",
     .help = "also prove a lower bound of the target of --lambda, as `corcast certify` does; the "
             "bound is a part of the --json result, so --json is required"},
    {.name = "morphometry",
     SETS(LOOKUP, InfoOptions, morphometry),
     .list = "morphometries",
     .help = "compare the tree with a published data set. NAME is the name of a data set; a value "
             "with a '/', such as ./my.txt, is the path of a file of your own"},
    {.name = "orders",
     SETS(CHOICE, InfoOptions, orders),
     .choices = morphometry_orders_names,
     .needs = "morphometry",
     .help = "with --morphometry: how the vessels are assigned to orders (classes of diameter, "
             "numbered "
             "from the smallest): published (by the diameters that the data set states for its "
             "orders), found (by diameter-defined Strahler ordering of this tree)"},
    {.name = "lambda",
     SETS_KEY(InfoOptions, blood.said.number[META_LAMBDA], blood.said.known, LAMBDA),
     .group = GROUP_OPTIMUM,
     .otherwise = "from the tree; without one, no target is computed",
     .help = "exponent lambda of the target, which growth minimizes: the target is the sum over "
             "all segments of length * radius^lambda"},
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
    return morphometry_compare(&report->tree, &report->statistics, &report->table,
                               report->comparison, err);
}

static Status measure(const InfoOptions *options, InfoReport *report, Err *err)
{
    const Tree *tree = &report->tree;
    const TreeMeta said = blood_specified(&options->blood);
    if (options->morphometry || options->bound)
        TRY(reading_refuse_loops(tree, report->name, options->bound ? "--bound" : "--morphometry",
                                 err));
    TRY(derive_summary(tree, &said, &report->summary, err));
    if (options->bound)
        TRY(bound_json(tree, &said, &report->bound, err));
    if (options->stats || options->morphometry)
        TRY(derive_statistics(tree, &report->statistics, err));
    report->has_statistics = options->stats;
    report->orders = options->orders;
    return options->morphometry ? compare(options->morphometry, report, err) : STATUS_OK;
}

/* ---- statistics as CSV ----------------------------------------------------------------------- */

/* Appends a row of the CSV file. number < 0, or a mean or sd that is NaN, leaves its column
 * empty. */
static void put_row(Text *text, const char *table, int number, const char *quantity, Spread spread)
{
    text_printf(text, "%s,", table);
    if (number >= 0)
        text_printf(text, "%d", number);
    text_printf(text, ",%s,", quantity);
    if (!isnan(spread.mean))
        text_printf(text, "%.9g", spread.mean);
    text_puts(text, ",");
    if (!isnan(spread.sd))
        text_printf(text, "%.9g", spread.sd);
    text_puts(text, "\n");
}

/* Appends a row of a single number, which has no standard deviation. */
static void put_count(Text *text, const char *table, int number, const char *quantity, double count)
{
    put_row(text, table, number, quantity, (Spread){count, NAN});
}

/* Appends a table. The standard deviation of a single value is unknown, and becomes NaN. */
static void put_table(Text *text, const char *name, const StatisticsTable *table)
{
    for (size_t i = 0; i < table->n; i++) {
        const StatisticsRow *row = &table->row[i];
        double known = row->elements > 1 ? 1 : (double)NAN;
        put_count(text, name, row->number, "vessels", (double)row->vessels);
        put_count(text, name, row->number, "elements", (double)row->elements);
        put_row(text, name, row->number, "radius_mm",
                (Spread){row->radius_mm.mean, known * row->radius_mm.sd});
        put_row(text, name, row->number, "length_mm",
                (Spread){row->length_mm.mean, known * row->length_mm.sd});
    }
}

static void put_ratios(Text *text, const char *name, const OrderRatios *ratios)
{
    put_count(text, name, -1, "number_ratio", ratios->number);
    put_count(text, name, -1, "diameter_ratio", ratios->diameter);
    put_count(text, name, -1, "length_ratio", ratios->length);
}

/* Appends the tables by Strahler order. Entry i of statistics->daughters is the mean number of
 * elements of order i % n + 1 that branch off an element of order i / n + 1. Higher orders do not
 * branch off lower ones, so these entries are left out. */
static void put_orders(Text *text, const TreeStatistics *statistics)
{
    const size_t n = statistics->by_diameter_strahler.n;
    char name[40];
    put_table(text, "strahler", &statistics->by_strahler);
    put_ratios(text, "strahler", &statistics->strahler_ratios);
    put_table(text, "diameter-strahler", &statistics->by_diameter_strahler);
    put_ratios(text, "diameter-strahler", &statistics->diameter_strahler_ratios);
    for (size_t i = 0; i < n * n; i++) {
        snprintf(name, sizeof name, "daughters_of_order_%zu", i % n + 1);
        if (i % n <= i / n)
            put_count(text, "diameter-strahler", (int)(i / n) + 1, name, statistics->daughters[i]);
    }
}

static void put_vessels(Text *text, const Tree *tree, const TreeStatistics *statistics)
{
    for (size_t v = 0; v < statistics->vessels; v++) {
        const VesselRow *vessel = &statistics->vessel[v];
        const int number = (int)v + 1;
        put_count(text, "vessel", number, "start_id", tree->id[vessel->start]);
        put_count(text, "vessel", number, "end_id", tree->id[vessel->end]);
        put_count(text, "vessel", number, "radius_mm", vessel->radius_mm);
        put_count(text, "vessel", number, "length_mm", vessel->length_mm);
        put_count(text, "vessel", number, "straightness", vessel->chord_mm / vessel->length_mm);
        if (vessel->chord_mm > 0)
            put_count(text, "vessel", number, "tortuosity", vessel->length_mm / vessel->chord_mm);
    }
}

/* Appends the ends and the branch points, which are numbered by their ids. */
static void put_points(Text *text, const Tree *tree, const TreeStatistics *statistics)
{
    for (size_t i = 0; i < tree->n; i++) {
        const int degree = statistics->degree[i];
        const char *table = degree == 1 ? "end" : "branch-point";
        if (degree != 1 && degree < 3)
            continue;
        put_count(text, table, tree->id[i], "x_mm", tree->position[i].x);
        put_count(text, table, tree->id[i], "y_mm", tree->position[i].y);
        put_count(text, table, tree->id[i], "z_mm", tree->position[i].z);
        put_count(text, table, tree->id[i], "degree", degree);
    }
}

static Status write_statistics(const InfoReport *report, const char *path, Err *err)
{
    const Tree *tree = &report->tree;
    const TreeStatistics *statistics = &report->statistics;
    const BifurcationSpread *symmetry = &statistics->symmetry, *area = &statistics->area_ratio;
    Text text = TEXT_INIT;
    text_puts(&text, "table,number,quantity,mean,sd\n");
    put_count(&text, "tree", -1, "vessels", (double)statistics->vessels);
    put_count(&text, "tree", -1, "volume_mm3", statistics->volume_mm3);
    put_count(&text, "tree", -1, "components", (double)report->summary.components);
    put_count(&text, "tree", -1, "loops", (double)report->summary.loops);
    if (statistics->has_orders) {
        put_row(&text, "tree", -1, "symmetry", (Spread){symmetry->mean, symmetry->sd});
        put_row(&text, "tree", -1, "area_ratio", (Spread){area->mean, area->sd});
    }
    for (int k = 0; k <= READ_MAX_DEGREE; k++)
        if (statistics->nodes_of_degree[k] > 0)
            put_count(&text, "degree", k, "nodes", (double)statistics->nodes_of_degree[k]);
    put_table(&text, "level", &statistics->by_level);
    if (statistics->has_orders)
        put_orders(&text, statistics);
    put_vessels(&text, tree, statistics);
    put_points(&text, tree, statistics);
    Status status = file_write_text(path, &text, err);
    text_release(&text);
    return status;
}

Status info_make(void *options, Parsed *parsed, InfoReport *report, Err *err)
{
    const InfoOptions *own_options = options;
    *report = (InfoReport){.name = parsed->operands[0]};
    TRY(reading_tree(parsed, report->name, &report->tree, &report->reading, err));
    TRY(blood_apply(&own_options->blood, parsed, &report->tree, err));
    TRY(measure(own_options, report, err));
    return own_options->output ? write_statistics(report, own_options->output, err) : STATUS_OK;
}

void inforeport_release(InfoReport *report)
{
    reading_release(&report->reading);
    statistics_release(&report->statistics);
    morphometry_release(&report->table);
    for (int k = 0; k < MORPHOMETRY_ORDERS; k++)
        free(report->comparison[k].pair);
    json_decref(report->bound);
    tree_release(&report->tree);
}

const Command command_info = {
    .name = "info",
    .summary = "count, measure and check a tree",
    .operands = "T.swc [--stats [-o S.csv]] [--morphometry NAME] [--json]",
    .examples = "  corcast info tree.swc\n"
                "  corcast info tree.swc --json | jq .volume_mm3\n"
                "  corcast info tree.swc --stats -o statistics.csv\n"
                "  corcast info tree.swc --stats --json | jq .stats.by_strahler\n"
                "  corcast info coronary.swc --morphometry kassab-lad\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .size = sizeof(InfoOptions),
    .tables = {{&own_table, 0}, {&blood_table, offsetof(InfoOptions, blood)}},
};
