/* Prints a comparison. The exit status is the verdict. */
#include "cli/commands.h"
#include "job/verify/compare.h"
#include "options/output.h"

static Status print(const CompareOptions *options, const Comparison *comparison, bool quiet,
                    Err *err)
{
    Text text = TEXT_TO(stdout);
    if (comparison->kind == COMPARED_NOTHING)
        return STATUS_OK;
    if (options->json)
        return json_write(comparison_json(comparison), "-", err);
    if (!quiet)
        comparison_text(options, comparison, &text);
    Status status = text_flush(&text, err);
    text_release(&text);
    return status;
}

Status run_compare(void *options, Parsed *parsed, Err *err)
{
    Comparison comparison;
    Status status;
    TRY(compare_make(options, parsed, &comparison, err));
    TRY_GOTO(compare_write(options, parsed, &comparison, err));
    TRY_GOTO(print(options, &comparison, parsed->common.quiet, err));
    status = comparison.agrees ? STATUS_OK : STATUS_DIFFERS;
done:
    comparison_release(&comparison);
    return status;
}
