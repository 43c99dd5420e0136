#include "app/commands.h"
#include "app/refining.h"
#include "app/tree_domain.h"
#include "treeio/treeio.h"
#include <stdio.h>

static const Command command = {
    .name = "refine",
    .summary = "lower the target of a grown or measured tree",
    .operands = "T.swc -o R.swc",
    .examples = "  corcast refine tree.swc --refine topology -o better.swc\n"
                "  corcast refine tree.swc --refine anneal --refine-seconds 30 -o best.swc\n",
    .min_operands = 1,
    .max_operands = 1,
    .needs_output = true,
};

Status run_refine(int argc, char **argv, Err *err)
{
    Refining refining;
    refining_init(&refining);
    refining.level = GROW_REFINE_TOPOLOGY;
    const char *output = NULL, *spec = NULL;
    const Option own[] = {
        {"output", OPTION_OUTPUT, &output, NULL, 0, 0, NULL, "R.swc", "the refined tree"},
        {"domain", OPTION_TEXT, &spec, NULL, 0, 0, NULL, "SHAPE",
         "tissue to stay in (the tree's; a tree without one may go anywhere)"},
        {0},
    };
    const Option *const tables[] = {own, refining.table, NULL};
    Parsed parsed;
    TRY(options_parse(&command, tables, argc, argv, &parsed, err));
    Status status = STATUS_OK;
    Tree tree = {0};
    Domain domain = {0};
    bool has_domain = true;
    RefineReport report;
    if (parsed.common.help)
        goto done;
    if (!tree_format_known(output)) {
        status = err_set(err, STATUS_USAGE, "-o: '%s' does not end in .swc", output);
        goto done;
    }
    TRY_GOTO(refining_check(&refining, &parsed, err));
    TRY_GOTO(tree_read(&tree, parsed.operands[0], err));
    if (spec)
        TRY_GOTO(domain_parse(&domain, spec, err));
    else
        TRY_GOTO(tree_domain(&tree, &domain, &has_domain, err));
    if (domain.file)
        TRY_GOTO(files_read(&parsed.files, "--domain", domain.file, err));
    TRY_GOTO(refining_apply(&refining, &parsed.common, has_domain ? &domain : NULL, &tree, &report,
                            err));
    TRY_GOTO(tree_write(&tree, output, err));
    if (!parsed.common.quiet)
        refining_print(&report);
done:
    domain_release(&domain);
    tree_release(&tree);
    parsed_release(&parsed);
    return status;
}
