/* Reads from the environment which POV-Ray and which Tachyon to run, and for how long. Only the
 * command line reads the environment. The library gets these choices as parameters. */
#include "cli/programs.h"

#include <math.h>
#include <stdlib.h>

/* Sets *choice from the variable with the path, and from the variable of the time limit, which both
 * programs share. */
static Status choose(const char *variable, ProgramChoice *choice, Err *err)
{
    static const char patience[] = "CORCAST_POVRAY_PATIENCE";
    const char *seconds = getenv(patience);
    *choice = (ProgramChoice){
        .path = getenv(variable), .patience_s = PROGRAM_PATIENCE_S, .patience_name = patience};
    if (!seconds || (number_parse(seconds, &choice->patience_s) && isfinite(choice->patience_s) &&
                     choice->patience_s >= 0))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "%s: '%s' is not a number of seconds of at least 0", patience,
                   seconds);
}

Status povray_from_environment(ProgramChoice *povray, Err *err)
{
    return choose("CORCAST_POVRAY", povray, err);
}

Status tachyon_from_environment(ProgramChoice *tachyon, Err *err)
{
    return choose("CORCAST_TACHYON", tachyon, err);
}
