/* Reads the environment variables that name the executables of POV-Ray and Tachyon. Only the
 * command line reads the environment; the library receives a ProgramChoice [oracle/program.h] as a
 * parameter. */
#ifndef CORCAST_CLI_PROGRAMS_H
#define CORCAST_CLI_PROGRAMS_H

#include "oracle/program.h"

/* Read the program's path and its time limit from the environment. The path is CORCAST_POVRAY or
 * CORCAST_TACHYON; without the variable, the path is NULL, which selects the default name. The time
 * limit of both programs is CORCAST_POVRAY_PATIENCE, in seconds, 0: no limit; its default is
 * PROGRAM_PATIENCE_S.
 *
 * povray, tachyon  are set also on failure. The strings are borrowed from the environment.
 * Errors           STATUS_USAGE if the time limit is not a finite number of 0 or more. */
MUST_CHECK Status povray_from_environment(ProgramChoice *povray, Err *err);
MUST_CHECK Status tachyon_from_environment(ProgramChoice *tachyon, Err *err);

#endif
