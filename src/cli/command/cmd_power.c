/* Prints which faults a tolerance fails to detect. The exit status is 1 if the tolerance rejects a
 * second rendering of the same scene. */
#include "cli/commands.h"
#include "job/verify/power.h"
#include "options/output.h"
#include <stdio.h>

static Status print(const PowerOptions *options, const PowerReport *report, Err *err)
{
    Text text = TEXT_INIT;
    if (options->json && options->choose)
        return json_write(
            json_with(power_json(&report->power), "choice", choice_json(&report->choice)), "-",
            err);
    if (options->json)
        return json_write(power_json(&report->power), "-", err);
    power_text(&report->power, &text);
    if (options->choose)
        choice_text(&report->choice, &text);
    return command_print(STATUS_OK, &text, err);
}

Status run_power(void *options, Parsed *parsed, Err *err)
{
    const PowerOptions *own = options;
    PowerReport report;
    TRY(power_run(own, parsed, &report, err));
    Status status = print(own, &report, err);
    if (status == STATUS_OK && !own->choose && report.power.alarm[0])
        status = STATUS_DIFFERS;
    power_release(&report.power);
    return status;
}
