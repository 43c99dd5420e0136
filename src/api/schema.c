/* Describes all commands and options as JSON, for programs that show or check them. */
#include "api/reports.h"
#include "api/request.h"

#include "job/job.h"
#include "options/schema.h"

static Status describe(const char *name, corcast_report **out, Err *err)
{
    json_t *commands = json_array();
    const Command *only = NULL;
    Status status = STATUS_OK;
    TRY_GOTO(argument_check(out, "out", err));
    if (name)
        TRY_GOTO(request_require_command(name, &only, err));
    for (const Command *const *command = job_commands; *command; command++)
        if (!only || *command == only)
            TRY_GOTO(schema_add(*command, NULL, &commands, err));
    status = report_new(schema_document(commands), out, err);
    commands = NULL;
done:
    json_decref(commands);
    return status;
}

int corcast_schema(const char *command, corcast_report **out, corcast_error *error)
{
    Call call = call_begin(error);
    return call_end(&call, describe(command, out, &call.err));
}
