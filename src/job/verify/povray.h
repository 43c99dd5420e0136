/* The operation `povray`: runs POV-Ray on a scene file, and writes its picture. */
#ifndef CORCAST_JOB_VERIFY_POVRAY_H
#define CORCAST_JOB_VERIFY_POVRAY_H

#include "options/options.h"
#include "oracle/povray.h"

/* What the options of `povray` set. */
typedef struct PovrayOptions {
    const char *output;
    PictureSize size;
    bool has_size;       /* false: the size is read from the scene */
    int antialias, bits; /* as PovrayParams.antialias and PovrayParams.bits [oracle/povray.h] */
    bool alpha;
    PovrayPlane plane;
    ProgramChoice program; /* set by the caller; zeroed: "povray" in PATH */
} PovrayOptions;

/* Describes the operation. Its options set a PovrayOptions. */
extern const Command command_povray;

/* Runs POV-Ray on the scene that is the first operand, and writes its picture to options->output,
 * which must be a file.
 *
 * options  if has_size is false, `size` receives the size that the scene states.
 * run      receives version and duration; set on success only.
 * Errors   STATUS_USAGE if an option has no effect, or if neither an option nor the scene states a
 *          size; STATUS_INPUT if the scene cannot be read; STATUS_TOOL if POV-Ray is missing or
 *          fails; STATUS_IO; STATUS_MEMORY. */
MUST_CHECK Status povray_run(PovrayOptions *options, Parsed *parsed, PovrayRun *run, Err *err);

#endif
