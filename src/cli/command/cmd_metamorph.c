/* Runs `metamorph`, and prints the causes of differences that the search found. The exit status is
 * 1 if there is one. */
#include "cli/commands.h"
#include "job/verify/metamorph_job.h"
#include "options/output.h"
#include <stdio.h>

static Status print(const MetamorphOptions *options, const Metamorph *result, Err *err)
{
    Text text = TEXT_INIT;
    if (options->renderer.json)
        return json_write(metamorph_json(result), "-", err);
    metamorph_text(result, &text);
    return command_print(STATUS_OK, &text, err);
}

Status run_metamorph(void *options, Parsed *parsed, Err *err)
{
    Metamorph result = {0};
    Status status = metamorph_make(options, parsed, &result, err);
    if (status == STATUS_OK)
        status = print(options, &result, err);
    if (status == STATUS_OK && result.causes.n > 0)
        status = STATUS_DIFFERS;
    metamorph_release(&result);
    return status;
}
