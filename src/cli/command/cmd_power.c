/* Prints what a rule misses. The exit status says whether it calls two equal scenes different. */
#include "cli/commands.h"
#include "job/verify/power.h"
#include "options/output.h"
#include <stdio.h>

static Status print(const PowerOptions *options, const Power *power, Err *err)
{
    Text text = TEXT_TO(stdout);
    if (options->json)
        return json_write(power_json(power), "-", err);
    power_text(power, &text);
    Status status = text_flush(&text, err);
    text_release(&text);
    return status;
}

Status run_power(void *options, Parsed *parsed, Err *err)
{
    Power power;
    TRY(power_run(options, parsed, &power, err));
    Status status = print(options, &power, err);
    if (status == STATUS_OK && power.alarm[0])
        status = STATUS_DIFFERS;
    power_release(&power);
    return status;
}
