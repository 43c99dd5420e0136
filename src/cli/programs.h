/* The environment variables that select other programs. */
#ifndef CORCAST_CLI_PROGRAMS_H
#define CORCAST_CLI_PROGRAMS_H

#include "oracle/program.h"

/* Read which program to run, CORCAST_POVRAY or CORCAST_TACHYON, and how long to wait for it,
 * CORCAST_POVRAY_PATIENCE in seconds. The strings of the result are borrowed from the environment.
 * Errors: STATUS_USAGE if the patience is not a number of 0 or more. */
MUST_CHECK Status povray_from_environment(ProgramChoice *povray, Err *err);
MUST_CHECK Status tachyon_from_environment(ProgramChoice *tachyon, Err *err);

#endif
