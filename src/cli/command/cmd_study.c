/* Runs a study. Prints the commands of --commands or the table of --table. */
#include "cli/commands.h"
#include "study/study.h"

Status run_study(void *options, Parsed *parsed, Err *err)
{
    Text lines = TEXT_TO(stdout);
    Status status;
    TRY_GOTO(study_run(options, parsed, &lines, err));
    status = text_flush(&lines, err);
done:
    text_release(&lines);
    return status;
}
