/* A bound, the target's distance from it and, on request, its proof as a file. */
#include "cli/commands.h"
#include "job/tree/certifying.h"
#include "options/output.h"
#include "options/reading.h"
#include <stdio.h>

typedef struct CertifyOptions {
    bool json;
    Certifying certifying;
} CertifyOptions;

static const Option own[] = {{.name = "json", SETS(FLAG, CertifyOptions, json), .help = "as JSON"}};

static const OptionTable own_table = OPTION_TABLE(own);

static Status show_json(const Certified *found, Err *err)
{
    const Bound *bound = &found->bound;
    json_t *parts = json_object();
    for (int k = 0; k < PARTS; k++)
        parts = json_with(parts, part_rows[k].key, json_number(found->part[k]));
    const JsonMember members[] = {
        {"target", json_number(bound->target)},
        {"lambda", json_number(bound->lambda)},
        {"bound", json_number(bound->bound)},
        {"gap", json_number(bound->best / bound->bound - 1)},
        {"best_geometry", json_number(bound->best)},
        {"best_murray", json_number(bound->murray)},
        {"refined", json_number(found->refined)},
        {"parts", parts},
        {"terminals", json_count(bound->outlets)},
        {"seconds", json_number(found->seconds)},
    };
    return json_write(json_with_members(json_object(), members, sizeof members / sizeof *members),
                      "-", err);
}

static void show_text(const char *path, const Certified *found)
{
    const Bound *bound = &found->bound;
    printf("%s\n", path);
    printf("  target        %.9g (sum of length * radius^%g)\n", bound->target, bound->lambda);
    printf("  bound         %.9g, proved: with this topology, these %zu terminals, their flows and "
           "pressures, none is below\n",
           bound->bound, bound->outlets);
    printf("  best found    %.9g, with free radii and places\n", bound->best);
    printf("  above bound   %.3g %%, of it\n", 100 * (bound->target / bound->bound - 1));
    for (int k = 0; k < PARTS; k++)
        if (!isnan(found->part[k]))
            printf("    %-11s %.3g %% (%s)\n", part_rows[k].key,
                   100 * found->part[k] / bound->bound, part_rows[k].meaning);
}

Status run_certify(void *options, Parsed *parsed, Err *err)
{
    const CertifyOptions *own_options = options;
    const char *path = parsed->operands[0];
    Status status = STATUS_OK;
    Tree tree = {0};
    Certified found = {0};
    TRY(reading_tree(parsed, path, &tree, NULL, err));
    TRY_GOTO(certifying_apply(&own_options->certifying, parsed, &tree, &found, err));
    if (own_options->json)
        TRY_GOTO(show_json(&found, err));
    else
        show_text(path, &found);
    if (own_options->certifying.certificate)
        status = file_write_text(own_options->certifying.certificate, &found.certificate, err);
done:
    bound_release(&found.bound);
    text_release(&found.certificate);
    tree_release(&tree);
    return status;
}

const Command command_certify = {
    .name = "certify",
    .summary = "prove how low the target of a tree can get",
    .operands = "T.swc [--certificate FILE] [--json]",
    .examples = "  corcast certify tree.swc\n"
                "  corcast certify tree.swc --parts\n"
                "  corcast certify tree.swc --certificate tree.cert --json | jq .gap\n",
    .min_operands = 1,
    .max_operands = 1,
    .reads_tree = true,
    .size = sizeof(CertifyOptions),
    .tables = {{&own_table, 0}, {&certifying_table, offsetof(CertifyOptions, certifying)}},
};
