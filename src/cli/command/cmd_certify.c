/* Prints the bound and how far the target is above it; writes the proof to --certificate. */
#include "cli/commands.h"
#include "job/tree/certify.h"
#include "options/output.h"
#include <stdio.h>

static void print(const char *path, const Certified *found)
{
    const Bound *bound = &found->bound;
    printf("%s\n", path);
    printf("  target        %.9g (sum of length * radius^%g)\n", bound->target, bound->lambda);
    printf("  lower bound   %.9g, proved for all trees with this topology and these %zu terminals, "
           "flows and pressures\n",
           bound->bound, bound->outlets);
    printf("  best found    %.9g, with unconstrained radii and positions\n", bound->best);
    printf("  above bound   %.3g %% of the bound, of which\n",
           100 * (bound->target / bound->bound - 1));
    for (int k = 0; k < GAP_PARTS; k++)
        if (!isnan(found->part[k]))
            printf("    %-11s %.3g %% (%s)\n", gap_part_rows[k].key,
                   100 * found->part[k] / bound->bound, gap_part_rows[k].meaning);
}

Status run_certify(void *options, Parsed *parsed, Err *err)
{
    const char *certificate = parsed_text(parsed, "certificate");
    Status status = STATUS_OK;
    Certified found;
    TRY_GOTO(certify_make(options, parsed, &found, err));
    if (options_specified(parsed, "json"))
        TRY_GOTO(json_write(certified_json(&found), "-", err));
    else
        print(parsed->operands[0], &found);
    if (certificate)
        status = file_write_text(certificate, &found.certificate, err);
done:
    certified_release(&found);
    return status;
}
