/* Runs POV-Ray, which the environment may replace. The job writes the picture and reports the time.
 */
#include "cli/commands.h"
#include "cli/programs.h"
#include "job/verify/povray.h"

Status run_povray(void *options, Parsed *parsed, Err *err)
{
    PovrayOptions *povray = options;
    PovrayRun run;
    TRY(povray_from_environment(&povray->program, err));
    return povray_run(povray, parsed, &run, err);
}
