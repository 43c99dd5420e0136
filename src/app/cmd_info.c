#include "app/commands.h"
#include "app/info_statistics.h"
#include "app/options.h"
#include "derive/derive.h"
#include "treeio/treeio.h"
#include <stdio.h>

static const Command command = {
    .name = "info",
    .summary = "count, measure and check a tree",
    .operands = "T.swc [--stats] [--json]",
    .examples = "  corcast info tree.swc\n"
                "  corcast info tree.swc --json | jq .volume_mm3\n"
                "  corcast info tree.swc --stats --json | jq .stats.by_strahler\n",
    .min_operands = 1,
    .max_operands = 1,
};

static json_t *summary_json(const TreeSummary *summary)
{
    const Box *box = &summary->bounds;
    const JsonMember members[] = {
        {"segments", json_integer((json_int_t)summary->segments)},
        {"terminals", json_integer((json_int_t)summary->terminals)},
        {"bifurcations", json_integer((json_int_t)summary->bifurcations)},
        {"roots", json_integer((json_int_t)summary->roots)},
        {"total_length_mm", json_number(summary->total_length_mm)},
        {"volume_mm3", json_number(summary->volume_mm3)},
        {"target", summary->has.target ? json_number(summary->target) : json_null()},
        {"gamma", summary->has.gamma ? json_number(summary->gamma) : json_null()},
        {"lambda", summary->has.lambda ? json_number(summary->lambda) : json_null()},
        {"root_radius_mm", json_number(summary->root_radius_mm)},
        {"min_radius_mm", json_number(summary->min_radius_mm)},
        {"max_level", json_integer(summary->max_level)},
        {"max_strahler", json_integer(summary->max_strahler)},
        {"bbox_mm", json_pack("[[f,f,f],[f,f,f]]", box->low.x, box->low.y, box->low.z, box->high.x,
                              box->high.y, box->high.z)},
    };
    json_t *json = json_with_members(json_object(), members, sizeof members / sizeof *members);
    if (summary->has.terminal_pressure)
        json = json_with(json, "terminal_pressure_mmHg",
                         json_pack("{s:f, s:f, s:f}", "min", summary->terminal_pressure_min_mmhg,
                                   "mean", summary->terminal_pressure_mean_mmhg, "max",
                                   summary->terminal_pressure_max_mmhg));
    return json;
}

static void print_summary(const char *path, const TreeSummary *summary)
{
    const Box *box = &summary->bounds;
    printf("%s\n", path);
    printf("  segments      %zu (%zu terminals, %zu bifurcations, %zu root%s)\n", summary->segments,
           summary->terminals, summary->bifurcations, summary->roots,
           summary->roots == 1 ? "" : "s");
    printf("  total length  %.6g mm\n", summary->total_length_mm);
    printf("  volume        %.6g mm^3\n", summary->volume_mm3);
    if (summary->has.target)
        printf("  target        %.6g (sum of length * radius^%g)\n", summary->target,
               summary->lambda);
    if (summary->has.gamma)
        printf("  gamma         %g\n", summary->gamma);
    printf("  radius        %.6g mm at the root, %.6g mm at the thinnest\n",
           summary->root_radius_mm, summary->min_radius_mm);
    printf("  orders        bifurcation level %d, Strahler %d\n", summary->max_level,
           summary->max_strahler);
    if (summary->has.terminal_pressure)
        printf("  terminals at  %.9g to %.9g mmHg\n", summary->terminal_pressure_min_mmhg,
               summary->terminal_pressure_max_mmhg);
    printf("  extent        x %.4g to %.4g, y %.4g to %.4g, z %.4g to %.4g mm\n", box->low.x,
           box->high.x, box->low.y, box->high.y, box->low.z, box->high.z);
}

Status run_info(int argc, char **argv, Err *err)
{
    bool as_json = false, with_statistics = false;
    TreeMeta flow = {0};
    int law = VISCOSITY_CONSTANT;
    const double huge = 1e300;
    const Option own[] = {
        {"json", OPTION_FLAG, &as_json, NULL, 0, 0, NULL, NULL, "as JSON"},
        {"stats", OPTION_FLAG, &with_statistics, NULL, 0, 0, NULL, NULL,
         "radius and length by level and order, branching ratios"},
        {"lambda", OPTION_NUMBER, &flow.number[META_LAMBDA], &flow.known[META_LAMBDA], 0, huge,
         NULL, NULL, "exponent of the target (the tree's)"},
        {"q-perf", OPTION_NUMBER, &flow.number[META_Q_PERF], &flow.known[META_Q_PERF], 1e-300, huge,
         NULL, "ML/MIN", "flow through the inlet (the tree's)"},
        {"p-perf", OPTION_NUMBER, &flow.number[META_P_PERF], &flow.known[META_P_PERF], -huge, huge,
         NULL, "MMHG", "pressure at the inlet (the tree's)"},
        {"viscosity", OPTION_NUMBER, &flow.number[META_VISCOSITY], &flow.known[META_VISCOSITY],
         1e-300, huge, NULL, "CP", "of the blood (the tree's)"},
        {"viscosity-law", OPTION_CHOICE, &law, &flow.known[META_VISCOSITY_LAW], 0, 0,
         meta_rows[META_VISCOSITY_LAW].words, NULL,
         "constant, or pries: by vessel diameter (the tree's)"},
        {"hematocrit", OPTION_NUMBER, &flow.number[META_HEMATOCRIT], &flow.known[META_HEMATOCRIT],
         0, MAX_HEMATOCRIT, NULL, "H", "of the blood, for pries (the tree's)"},
        {"plasma-viscosity", OPTION_NUMBER, &flow.number[META_PLASMA_VISCOSITY],
         &flow.known[META_PLASMA_VISCOSITY], 1e-300, huge, NULL, "CP",
         "of the plasma, for pries (the tree's)"},
        {0},
    };
    const Option *const tables[] = {own, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Tree tree = {0};
    TreeSummary summary;
    TreeStatistics statistics = {0};
    flow.number[META_VISCOSITY_LAW] = law;
    if (parsed.common.help)
        goto done;
    TRY_GOTO(tree_read(&tree, parsed.operands[0], err));
    bool pries = derive_viscosity_law(&tree, &flow) == VISCOSITY_PRIES;
    const OptionNeed needs[] = {{"viscosity", !pries, "is for --viscosity-law constant"},
                                {"hematocrit", pries, "is for --viscosity-law pries"},
                                {"plasma-viscosity", pries, "is for --viscosity-law pries"},
                                {0}};
    TRY_GOTO(options_check_needs(&parsed, needs, err));
    TRY_GOTO(derive_summary(&tree, &flow, &summary, err));
    if (with_statistics)
        TRY_GOTO(derive_statistics(&tree, &statistics, err));
    if (as_json) {
        json_t *json = summary_json(&summary);
        if (with_statistics)
            json = json_with(json, "stats", statistics_json(&statistics));
        status = json_write(json, "-", err);
    } else {
        print_summary(parsed.operands[0], &summary);
        if (with_statistics)
            statistics_print(&statistics);
    }
done:
    statistics_release(&statistics);
    tree_release(&tree);
    parsed_release(&parsed);
    return status;
}
