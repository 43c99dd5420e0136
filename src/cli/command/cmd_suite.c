/* Runs `suite`, and prints the score card. The exit status is 1 if a picture is not certified. */
#include "cli/commands.h"
#include "job/verify/tubesuite.h"
#include "options/output.h"
#include <stdio.h>

static Status print(const TubeSuiteOptions *options, const TubeSuite *suite, Err *err)
{
    Text text = TEXT_INIT;
    if (options->renderer.json)
        return json_write(tubesuite_json(suite), "-", err);
    tubesuite_text(suite, &text);
    return command_print(STATUS_OK, &text, err);
}

Status run_suite(void *options, Parsed *parsed, Err *err)
{
    TubeSuite suite = {0};
    (void)parsed;
    Status status = tubesuite_run(options, &suite, err);
    if (status == STATUS_OK)
        status = print(options, &suite, err);
    if (status == STATUS_OK && suite.certified < suite.cases.n)
        status = STATUS_DIFFERS;
    tubesuite_release(&suite);
    return status;
}
