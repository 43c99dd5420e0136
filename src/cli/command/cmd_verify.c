/* Prints the verdict of a verification. */
#include "cli/commands.h"
#include "cli/programs.h"
#include "job/verify/verify.h"
#include "options/output.h"

static Status print(const VerifyOptions *options, const Verification *found, bool quiet, Err *err)
{
    Text text = TEXT_INIT;
    if (options->json)
        return json_write(verify_json(found), "-", err);
    if (!quiet)
        verify_text(found, &text);
    return command_print(STATUS_OK, &text, err);
}

Status run_verify(void *options, Parsed *parsed, Err *err)
{
    VerifyOptions *verify = options;
    Verification found;
    TRY(povray_from_environment(&verify->povray, err));
    TRY(tachyon_from_environment(&verify->tachyon, err));
    TRY(verify_run(verify, parsed, &found, err));
    Status status = print(verify, &found, parsed->common.quiet, err);
    if (status == STATUS_OK && !found.agrees)
        status = STATUS_DIFFERS;
    verification_release(&found);
    return status;
}
