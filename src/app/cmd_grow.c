#include "app/commands.h"
#include "app/options.h"
#include "app/refining.h"
#include "domain/domain.h"
#include "grow/grow.h"
#include "treeio/treeio.h"
#include <stdio.h>
#include <stdlib.h>

static const Command command = {
    .name = "grow",
    .summary = "grow an arterial tree by constrained constructive optimization",
    .operands = "-o T.swc",
    .examples = "  corcast grow --terminals 4000 --seed 7 -o tree.swc\n"
                "  corcast grow --domain ball:30 --gamma 2.55 --lambda 1 -o tree.swc\n",
    .max_operands = 0,
    .needs_output = true,
};

static Status write_report(const char *path, const GrowReport *report, const RefineReport *refined,
                           int threads, Err *err)
{
    double target = refined->target_before > 0 ? refined->target_after : report->target;
    json_t *json =
        json_pack("{s:s, s:f, s:I, s:f, s:f, s:I, s:I, s:f, s:I, s:b, s:i}", "generator", GENERATOR,
                  "seconds", report->seconds + refined->seconds, "terminals",
                  (json_int_t)report->terminals, "target", target, "root_radius_mm",
                  report->root_radius_mm, "tosses", (json_int_t)report->tosses, "rejected",
                  (json_int_t)report->rejected, "thickness", report->thickness, "broken",
                  (json_int_t)report->broken, "complete", report->complete, "threads", threads);
    return json_write(json, path, err);
}

static void print_report(const GrowReport *report)
{
    fprintf(stderr, "grew %zu terminals in %.3g s: target %.6g, root radius %.4g mm\n",
            report->terminals, report->seconds, report->target, report->root_radius_mm);
    if (report->thickness < 1)
        fprintf(stderr,
                "corcast: the domain was too full for vessels of their real thickness: they keep "
                "clear of each other at %g of it only; ask for fewer terminals, a larger domain or "
                "a smaller --q-perf\n",
                report->thickness);
}

Status run_grow(int argc, char **argv, Err *err)
{
    static const char *const tosses[] = {
        [GROW_TOSS_SEGMENT] = "segment", [GROW_TOSS_TERMINAL] = "terminal", NULL};
    GrowParams params = grow_defaults();
    Refining refining;
    refining_init(&refining);
    const char *output = NULL, *json = NULL, *domain_spec = "disc:50";
    int toss = (int)params.toss;
    const double huge = 1e300;
    const Option own[] = {
        {"output", OPTION_TEXT, &output, NULL, 0, 0, NULL, "T.swc", "the tree"},
        {"terminals", OPTION_COUNT, &params.terminals, NULL, 1, 8000000, NULL, NULL, "(1000)"},
        {"domain", OPTION_TEXT, &domain_spec, NULL, 0, 0, NULL, "SHAPE",
         "tissue, mm: disc:R, ball:R, rect:W,H, box:A,B,C, ellipsoid:A,B,C, "
         "shell:A,B,C,THICKNESS,\n"
         "                                 polygon:FILE, mask:FILE, mesh:FILE (disc:50)"},
        {"inlet", OPTION_VECTOR, &params.inlet, &params.has_inlet, 0, 0, NULL, NULL,
         "where the tree starts, mm (top of the rim)"},
        {"gamma", OPTION_NUMBER, &params.gamma, NULL, -huge, huge, NULL, NULL,
         "Murray exponent (3)"},
        {"lambda", OPTION_NUMBER, &params.lambda, NULL, -huge, huge, NULL, NULL,
         "target: sum of length * radius^lambda (2)"},
        {"p-perf", OPTION_NUMBER, &params.p_perf_mmhg, NULL, -huge, huge, NULL, "MMHG",
         "pressure at the inlet (100)"},
        {"p-term", OPTION_NUMBER, &params.p_term_mmhg, NULL, -huge, huge, NULL, "MMHG",
         "pressure at every terminal (60)"},
        {"q-perf", OPTION_NUMBER, &params.q_perf_ml_min, NULL, -huge, huge, NULL, "ML/MIN",
         "flow through the inlet (500)"},
        {"viscosity", OPTION_NUMBER, &params.viscosity_cp, NULL, -huge, huge, NULL, "CP",
         "of the blood (3.6)"},
        {"candidates", OPTION_WHOLE, &params.candidates, NULL, 1, 1000, NULL, "K",
         "nearest segments tried for each terminal (8)"},
        {"toss", OPTION_CHOICE, &toss, NULL, 0, 0, tosses, NULL,
         "new terminals keep their distance to (segment)"},
        {"partial", OPTION_FLAG, &params.partial, NULL, 0, 0, NULL, NULL,
         "write the tree so far when no more terminals find room"},
        {"json", OPTION_TEXT, &json, NULL, 0, 0, NULL, "FILE", "what was done, as JSON"},
        {0},
    };
    const Option *const tables[] = {own, refining.table, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Tree tree = {0};
    GrowReport report;
    RefineReport refined;
    Err why;
    Domain domain = {0};
    Progress progress;
    if (parsed.common.help)
        goto done;
    params.seed = parsed.common.seed;
    params.toss = (GrowToss)toss;
    params.threads = parsed.common.threads;
    params.progress = progress_report;
    params.progress_context = &progress;
    if (!tree_format_known(output)) {
        status = err_set(err, STATUS_USAGE, "-o: '%s' does not end in .swc", output);
        goto done;
    }
    TRY_GOTO(domain_parse(&domain, domain_spec, err));
    progress_start(&progress, "growing", parsed.common.quiet);
    status = grow_tree(&params, &domain, &tree, &report, err);
    why = *err;
    progress_end(&progress);
    TRY_GOTO(status);
    TRY_GOTO(refining_apply(&refining, &parsed.common, &domain, &tree, &refined, err));
    report.root_radius_mm = tree.radius_mm[0];
    TRY_GOTO(tree_write(&tree, output, err));
    if (json)
        TRY_GOTO(write_report(json, &report, &refined,
                              params.threads ? params.threads : threads_available(), err));
    if (!report.complete)
        fprintf(stderr, "corcast grow: %s\n", why.text);
    if (!parsed.common.quiet) {
        print_report(&report);
        refining_print(&refined);
    }
done:
    domain_release(&domain);
    tree_release(&tree);
    parsed_release(&parsed);
    return status;
}
