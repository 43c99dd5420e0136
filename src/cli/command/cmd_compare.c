/* Prints a comparison. The exit status is the verdict. */
#include "cli/command/compare_serve.h"
#include "cli/commands.h"
#include "job/verify/compare.h"
#include "options/output.h"

static Status print(const CompareOptions *options, const Comparison *comparison, bool quiet,
                    Err *err)
{
    Text text = TEXT_INIT;
    if (options->json && comparison->kind != COMPARED_NOTHING)
        return json_write(comparison_json(comparison), "-", err);
    if (!quiet)
        comparison_text(options, comparison, &text);
    return command_print(STATUS_OK, &text, err);
}

Status run_compare(void *options, Parsed *parsed, Err *err)
{
    Comparison comparison;
    Status status;
    if (((const CompareOptions *)options)->serve)
        return parsed->n_operands == 0 ? compare_serve(err)
                                       : err_set(err, STATUS_USAGE, "--serve takes no operands");
    TRY(compare_make(options, parsed, &comparison, err));
    TRY_GOTO(compare_write(options, parsed, &comparison, err));
    TRY_GOTO(print(options, &comparison, parsed->common.quiet, err));
    status = comparison.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    comparison_release(&comparison);
    return status;
}
